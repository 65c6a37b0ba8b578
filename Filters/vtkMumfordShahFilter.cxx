// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "vtkMumfordShahFilter.h"

#include "Conversion/ResultWriter.h"
#include "Conversion/RunState.h"
#include "Run/MumfordShahSettings.h"

#include "vtkCellArray.h"
#include "vtkCellData.h"
#include "vtkDataArray.h"
#include "vtkDataObject.h"
#include "vtkDoubleArray.h"
#include "vtkInformation.h"
#include "vtkInformationVector.h"
#include "vtkNew.h"
#include "vtkObjectFactory.h"
#include "vtkPointData.h"
#include "vtkPoints.h"
#include "vtkPolyData.h"

using namespace SurfaceDiffusion;

vtkStandardNewMacro(vtkMumfordShahFilter);

namespace
{

constexpr const char* EdgesName = "Edges";

/// The curves of one surface, appended to those of others.
void AppendCurves(const RunResult& result, vtkPolyData* output)
{
  const Polylines& curves = result.EdgeCurves;
  vtkPoints* const points = output->GetPoints();
  vtkDataArray* const edges = output->GetPointData()->GetArray(EdgesName);
  vtkDataArray* const lengths = output->GetCellData()->GetArray("Length");
  for (Index l = 0; l < curves.NumberOfLines(); ++l)
  {
    const bool closed =
      curves.Vertices[curves.Begin[l]] == curves.Vertices[curves.Begin[l + 1] - 1];
    const vtkIdType first = points->GetNumberOfPoints();
    output->GetLines()->InsertNextCell(curves.Begin[l + 1] - curves.Begin[l]);
    for (Index k = curves.Begin[l]; k < curves.Begin[l + 1]; ++k)
    {
      if (closed && k + 1 == curves.Begin[l + 1])
      {
        output->GetLines()->InsertCellPoint(first);
        break;
      }
      output->GetLines()->InsertCellPoint(points->InsertNextPoint(curves.Points.row(k).data()));
      edges->InsertNextTuple1(result.Edges[curves.Vertices[k]]);
    }
    lengths->InsertNextTuple1(curves.Length(l));
  }
}

vtkSmartPointer<vtkPolyData> MakeEmptyCurves()
{
  auto curves = vtkSmartPointer<vtkPolyData>::New();
  vtkNew<vtkPoints> points;
  points->SetDataTypeToDouble();
  curves->SetPoints(points);
  curves->SetLines(vtkNew<vtkCellArray>());
  vtkNew<vtkDoubleArray> edges;
  edges->SetName(EdgesName);
  curves->GetPointData()->AddArray(edges);
  vtkNew<vtkDoubleArray> lengths;
  lengths->SetName("Length");
  curves->GetCellData()->AddArray(lengths);
  return curves;
}

} // namespace

vtkMumfordShahFilter::vtkMumfordShahFilter()
{
  this->SetNumberOfOutputPorts(3);
  this->FidelityWeight = 1.0;
  this->NumberOfTimeSteps = 1000;
  this->Tolerance = 0.1;
  this->InitialFill = INITIAL_FILL_HARMONIC;
}

vtkMumfordShahFilter::~vtkMumfordShahFilter() = default;

std::unique_ptr<RunSettings> vtkMumfordShahFilter::MakeSettings() const
{
  auto settings = std::make_unique<MumfordShahSettings>();
  this->CopyProperties(*settings);
  settings->SmoothingLength = this->SmoothingLength;
  settings->EdgeThreshold = this->EdgeThreshold;
  settings->EdgeWidth = this->EdgeWidth;
  settings->StopTolerance = this->StopTolerance;
  settings->EdgeCurves = this->EdgeCurves;
  return settings;
}

int vtkMumfordShahFilter::FillOutputPortInformation(int port, vtkInformation* info)
{
  if (port == 2)
  {
    info->Set(vtkDataObject::DATA_TYPE_NAME(), "vtkPolyData");
    return 1;
  }
  return this->Superclass::FillOutputPortInformation(port, info);
}

int vtkMumfordShahFilter::RequestDataObject(
  vtkInformation* request, vtkInformationVector** inputs, vtkInformationVector* outputs)
{
  if (!this->Superclass::RequestDataObject(request, inputs, outputs))
  {
    return 0;
  }
  if (!vtkPolyData::GetData(outputs, 2))
  {
    vtkNew<vtkPolyData> curves;
    outputs->GetInformationObject(2)->Set(vtkDataObject::DATA_OBJECT(), curves);
  }
  return 1;
}

int vtkMumfordShahFilter::RequestData(
  vtkInformation* request, vtkInformationVector** inputs, vtkInformationVector* outputs)
{
  vtkPolyData* const output = vtkPolyData::GetData(outputs, 2);
  output->Initialize();
  this->Curves = nullptr;
  const int result = this->Superclass::RequestData(request, inputs, outputs);
  if (this->Curves)
  {
    output->ShallowCopy(this->Curves);
    this->Curves = nullptr;
  }
  return result;
}

void vtkMumfordShahFilter::WriteResult(
  std::size_t index, const InputFields& fields, vtkPolyData* output)
{
  const Run::Block& block = this->State->Run.GetBlock(index);
  const bool single = this->FindResultType(fields) == VTK_FLOAT;
  this->AddResult(WriteScalars(*block.Surface, EdgesName, block.Result.Edges, single, nullptr, 0),
    fields, output->GetPointData());
  this->Superclass::WriteResult(index, fields, output);
}

void vtkMumfordShahFilter::TakeResults()
{
  this->Superclass::TakeResults();
  this->Curves = MakeEmptyCurves();
  this->EdgeLength = 0.0;
  for (std::size_t b = 0; b < this->State->Run.NumberOfBlocks(); ++b)
  {
    const RunResult& result = this->State->Run.GetBlock(b).Result;
    AppendCurves(result, this->Curves);
    for (Index l = 0; l < result.EdgeCurves.NumberOfLines(); ++l)
    {
      this->EdgeLength += result.EdgeCurves.Length(l);
    }
  }
}

void vtkMumfordShahFilter::VisitReported(const std::function<void(double&)>& visit)
{
  this->Superclass::VisitReported(visit);
  visit(this->EdgeLength);
}

void vtkMumfordShahFilter::PrintSelf(ostream& os, vtkIndent indent)
{
  this->Superclass::PrintSelf(os, indent);
  os << indent << "EdgeLength: " << this->EdgeLength << "\n";
}
