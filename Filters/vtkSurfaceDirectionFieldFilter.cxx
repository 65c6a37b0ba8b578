// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "vtkSurfaceDirectionFieldFilter.h"

#include "Conversion/DirectionArrays.h"
#include "Conversion/EnumText.h"
#include "Conversion/InputArrays.h"
#include "Conversion/SMPParallelFor.h"
#include "Core/Geometry/DirectionField.h"
#include "Distributed/GatheredSurfaces.h"

#include "vtkCellData.h"
#include "vtkDataArray.h"
#include "vtkDemandDrivenPipeline.h"
#include "vtkInformation.h"
#include "vtkInformationVector.h"
#include "vtkMath.h"
#include "vtkMultiProcessController.h"
#include "vtkObjectFactory.h"
#include "vtkPolyData.h"

#include <algorithm>
#include <cmath>
#include <new>
#include <sstream>

using namespace SurfaceDiffusion;

vtkStandardNewMacro(vtkSurfaceDirectionFieldFilter);

vtkSurfaceDirectionFieldFilter::vtkSurfaceDirectionFieldFilter()
{
  this->SetController(vtkMultiProcessController::GetGlobalController());
  this->HasWholeSurface = false; // unless told so
}

vtkSurfaceDirectionFieldFilter::~vtkSurfaceDirectionFieldFilter()
{
  this->SetController(nullptr);
}

void vtkSurfaceDirectionFieldFilter::SetController(vtkMultiProcessController* controller)
{
  if (this->HasWholeSurface != !controller)
  {
    this->HasWholeSurface = !controller;
    this->Modified();
  }
  vtkSetObjectBodyMacro(Controller, vtkMultiProcessController, controller);
}

const char* vtkSurfaceDirectionFieldFilter::GetMethodAsString()
{
  return EnumText(this->Method, { "PrincipalCurvature", "CurvatureAligned", "Smooth", "Hints" });
}

const char* vtkSurfaceDirectionFieldFilter::GetPrincipalDirectionAsString()
{
  return EnumText(this->PrincipalDirection, { "Minimum", "Maximum" });
}

std::vector<std::string> vtkSurfaceDirectionFieldFilter::FindProblems(
  vtkPolyData* input, vtkDataArray*& hints, bool& onCells)
{
  std::vector<std::string> problems;
  const auto require = [&](bool holds, const char* property, double value, const char* allowed)
  {
    if (!holds)
    {
      std::ostringstream text;
      text << property << " is " << value << "; allowed: " << allowed;
      problems.push_back(text.str());
    }
  };
  require(this->Method >= METHOD_PRINCIPAL_CURVATURE && this->Method <= METHOD_HINTS, "Method",
    this->Method, "0 PrincipalCurvature, 1 CurvatureAligned, 2 Smooth, 3 Hints");
  require(this->PrincipalDirection == PRINCIPAL_DIRECTION_MINIMUM ||
      this->PrincipalDirection == PRINCIPAL_DIRECTION_MAXIMUM,
    "PrincipalDirection", this->PrincipalDirection, "0 Minimum, 1 Maximum");
  require(std::isfinite(this->SmoothingLength) &&
      (this->SmoothingLength >= 0.0 || this->SmoothingLength == -1.0),
    "SmoothingLength", this->SmoothingLength,
    "finite numbers, 0 or more, or -1: four mean edge lengths");
  require(std::isfinite(this->HintWeight) && this->HintWeight > 0.0, "HintWeight", this->HintWeight,
    "finite numbers above 0");
  require(std::isfinite(this->Angle), "Angle", this->Angle, "finite numbers");
  require(std::isfinite(this->MergeTolerance) && this->MergeTolerance >= 0.0, "MergeTolerance",
    this->MergeTolerance, "finite numbers, 0 or more");
  require(std::isfinite(this->SeamTolerance) &&
      (this->SeamTolerance >= 0.0 || this->SeamTolerance == -1.0),
    "SeamTolerance", this->SeamTolerance,
    "finite numbers, 0 or more, or -1: 1e-6 of the bounding box");
  if (this->ResultArrayName.empty())
  {
    problems.emplace_back("ResultArrayName is empty; allowed: any name");
  }
  if (input->GetNumberOfPoints() == 0)
  {
    problems.emplace_back("the input is empty; a surface of polygons or strips is needed");
  }
  else if (input->GetNumberOfPolys() + input->GetNumberOfStrips() == 0)
  {
    problems.emplace_back("the input has no polygons or strips; a surface is needed");
  }
  else if (this->Method == METHOD_HINTS)
  {
    const std::size_t before = problems.size();
    hints = InputArrays(this, input, problems).Find(2, "DirectionArray", 3, onCells);
    if (!hints && problems.size() == before)
    {
      problems.emplace_back("Method is Hints but DirectionArray is not set; allowed: an array of "
                            "directions on points or cells");
    }
  }
  return problems;
}

int vtkSurfaceDirectionFieldFilter::FillInputPortInformation(int, vtkInformation* info)
{
  // Composite data come as a whole: several of them may be pieces of one surface.
  info->Set(vtkAlgorithm::INPUT_REQUIRED_DATA_TYPE(), "vtkCompositeDataSet");
  info->Append(vtkAlgorithm::INPUT_REQUIRED_DATA_TYPE(), "vtkPolyData");
  return 1;
}

int vtkSurfaceDirectionFieldFilter::FillOutputPortInformation(int, vtkInformation* info)
{
  info->Set(vtkDataObject::DATA_TYPE_NAME(), "vtkDataObject");
  return 1;
}

vtkTypeBool vtkSurfaceDirectionFieldFilter::ProcessRequest(
  vtkInformation* request, vtkInformationVector** inputs, vtkInformationVector* outputs)
{
  if (request->Has(vtkDemandDrivenPipeline::REQUEST_DATA_OBJECT()))
  {
    return MakeOutputObject(inputs, outputs) ? 1 : 0;
  }
  return this->Superclass::ProcessRequest(request, inputs, outputs);
}

int vtkSurfaceDirectionFieldFilter::RequestData(
  vtkInformation*, vtkInformationVector** inputs, vtkInformationVector* outputs)
{
  const std::vector<SurfacePiece> pieces =
    CopyStructure(vtkDataObject::GetData(inputs[0]), vtkDataObject::GetData(outputs, 0));
  if (IsLonePiece(this, inputs, this->Controller, this->HasWholeSurface))
  {
    return 1;
  }
  UpdateOfPieces(this, Processes(this->Controller), pieces, this->SeamTolerance, this->Gathered,
    [&](const std::vector<SurfacePiece>& surfaces)
    {
      const double count = static_cast<double>(surfaces.size());
      for (std::size_t s = 0; s < surfaces.size(); ++s)
      {
        this->Execute(surfaces[s].Input, surfaces[s].Output, s / count, (s + 1) / count);
      }
    });
  return 1;
}

void vtkSurfaceDirectionFieldFilter::Execute(
  vtkPolyData* input, vtkPolyData* output, double begin, double end)
{
  vtkDataArray* hints = nullptr;
  bool onCells = false;
  const std::vector<std::string> problems = this->FindProblems(input, hints, onCells);
  if (!problems.empty())
  {
    std::string text;
    for (const std::string& problem : problems)
    {
      text += (text.empty() ? "" : "; ") + problem;
    }
    vtkErrorMacro(<< text);
    return;
  }
  double reported = begin;
  const ProgressMonitor::Callback callback = [&](double fraction)
  {
    reported = std::max(reported, fraction);
    this->UpdateProgress(reported);
    return !this->GetAbortExecute();
  };
  LoopWatch watch([&] { return callback(reported); });
  try
  {
    this->MakeField(input, hints, onCells, output, ProgressMonitor(callback).Part(begin, end));
  }
  catch (const Aborted&)
  {
    // The output is the unchanged input.
  }
  catch (const std::bad_alloc&)
  {
    vtkErrorMacro(<< "not enough memory");
  }
  catch (const std::exception& error)
  {
    vtkErrorMacro(<< error.what());
  }
}

void vtkSurfaceDirectionFieldFilter::MakeField(vtkPolyData* input, vtkDataArray* hints,
  bool onCells, vtkPolyData* output, const ProgressMonitor& progress)
{
  const ParallelFor& parallel = SMPParallelFor::Instance();

  PolyDataSurface::Options options;
  options.MergeCoincidentPoints = this->MergeCoincidentPoints;
  options.MergeTolerance = this->MergeTolerance;
  const PolyDataSurface surface(input, options, progress.Part(0.0, 0.1));
  const TriangleMesh& mesh = *surface.Mesh;
  if (surface.Found.DegenerateTriangles > 0)
  {
    vtkWarningMacro(<< surface.Found.DegenerateTriangles
                    << " triangles of zero area get no direction");
  }
  const double h = mesh.NumberOfEdges() > 0 ? mesh.TotalEdgeLength() / mesh.NumberOfEdges() : 1.0;
  DirectionSettings settings;
  settings.Method = static_cast<DirectionMethod>(this->Method);
  settings.Perpendicular = this->PrincipalDirection == PRINCIPAL_DIRECTION_MAXIMUM;
  settings.SmoothingLength =
    this->SmoothingLength == -1.0 ? 4.0 * h : this->SmoothingLength / mesh.LengthUnit();
  settings.HintWeight = this->HintWeight / (h * h);
  settings.Angle = vtkMath::RadiansFromDegrees(this->Angle);
  const TangentVectors given =
    hints ? ReadFrames(surface, hints, onCells, parallel) : TangentVectors(0, 2);
  const TangentVectors frames = MakeDirectionField(*surface.Operators, surface.Points,
    surface.Triangles, given, settings, parallel, progress.Part(0.1, 0.95));
  const auto array = WriteFrames(surface, input, frames, this->ResultArrayName, parallel);
  progress.Report(0.99); // the last chance to abort: from here on the output changes
  output->GetCellData()->AddArray(array);
  output->GetCellData()->SetActiveVectors(this->ResultArrayName.c_str());
  progress.Report(1.0);
}

void vtkSurfaceDirectionFieldFilter::PrintSelf(ostream& os, vtkIndent indent)
{
  this->Superclass::PrintSelf(os, indent);
  os << indent << "Method: " << this->GetMethodAsString() << "\n";
  os << indent << "PrincipalDirection: " << this->GetPrincipalDirectionAsString() << "\n";
  os << indent << "SmoothingLength: " << this->SmoothingLength << "\n";
  os << indent << "HintWeight: " << this->HintWeight << "\n";
  os << indent << "Angle: " << this->Angle << "\n";
  os << indent << "MergeCoincidentPoints: " << (this->MergeCoincidentPoints ? "On" : "Off") << "\n";
  os << indent << "MergeTolerance: " << this->MergeTolerance << "\n";
  os << indent << "SeamTolerance: " << this->SeamTolerance << "\n";
  os << indent << "Controller: " << this->Controller << "\n";
  os << indent << "ResultArrayName: " << this->ResultArrayName << "\n";
}
