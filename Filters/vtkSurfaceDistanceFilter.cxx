// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "vtkSurfaceDistanceFilter.h"

#include "Conversion/FieldReader.h"
#include "Conversion/InputArrays.h"
#include "Conversion/PointInput.h"
#include "Conversion/ResultWriter.h"
#include "Conversion/SourceInput.h"
#include "Conversion/SurfaceRuns.h"
#include "Run/DistanceRun.h"
#include "Run/InputSentences.h"
#include "Run/OwnedSettings.h"

#include "vtkInformation.h"
#include "vtkInformationVector.h"
#include "vtkObjectFactory.h"
#include "vtkPolyData.h"

using namespace SurfaceDiffusion;

VTK_ABI_NAMESPACE_BEGIN
vtkObjectFactoryNewMacro(vtkSurfaceDistanceFilter);

vtkSurfaceDistanceFilter::vtkSurfaceDistanceFilter()
  : Superclass(OwnedSettings::Make<DistanceSettings>(), SurfaceRuns::Of<DistanceRun>())
{
  this->DeclareNumber("NumberOfSources");
  this->DeclareNumber("NumberOfUnreachedPoints");
  this->DeclareNumber("EffectiveMethod");
  this->SetNumberOfInputPorts(3);
  this->SetNumberOfOutputPorts(2);
}

vtkSurfaceDistanceFilter::~vtkSurfaceDistanceFilter() = default;

int vtkSurfaceDistanceFilter::FillInputPortInformation(int port, vtkInformation* info)
{
  if (port == 0)
  {
    return this->Superclass::FillInputPortInformation(port, info);
  }
  DescribePointPort(info);
  return 1;
}

int vtkSurfaceDistanceFilter::FillOutputPortInformation(int port, vtkInformation* info)
{
  // The executive makes the object of port 1, and RequestDataObject() that of port 0.
  info->Set(vtkDataObject::DATA_TYPE_NAME(), port == 0 ? "vtkDataObject" : "vtkPolyData");
  return 1;
}

int vtkSurfaceDistanceFilter::RequestData(
  vtkInformation* request, vtkInformationVector** inputs, vtkInformationVector* outputs)
{
  this->ProblemsOfSources.clear();
  const auto read = [&](int port, const char* name, std::shared_ptr<const SourceShapes>& shapes)
  {
    vtkDataObject* const points = FindOptionalInput(inputs, port);
    shapes =
      points ? ReadSources(points, name, this->GetController(), this->ProblemsOfSources) : nullptr;
    return points != nullptr;
  };
  this->HasSources = read(1, "the second input, the sources", this->Sources);
  read(2, "the third input, the path points", this->PathPoints);
  vtkPolyData* const paths = vtkPolyData::GetData(outputs, 1);
  paths->Initialize();
  this->Paths = nullptr;
  const int result = this->Superclass::RequestData(request, inputs, outputs);
  if (this->Paths && result != 0)
  {
    paths->ShallowCopy(this->Paths);
  }
  this->Paths = nullptr;
  this->Sources.reset();
  this->PathPoints.reset();
  return result;
}

bool vtkSurfaceDistanceFilter::FindFields(
  vtkPolyData* block, InputFields& fields, Problems& problems)
{
  const InputArrays inputs(this, block, fields, problems);
  problems.insert(problems.end(), this->ProblemsOfSources.begin(), this->ProblemsOfSources.end());
  fields.Sources = this->Sources;
  fields.PathPoints = this->PathPoints;
  if (!this->HasSources)
  {
    fields.Data = inputs.Find(0, "SourceArray", 1);
    fields.StartTimes = inputs.Find(9, "SourceTimes", 1);
  }
  fields.Mask = inputs.Find(1, "MaskArray", 1);
  fields.Direction = inputs.Find(2, "DirectionArray", 3);
  fields.Speeds = inputs.Find(8, "SpeedArray", 1);
  fields.AlongSpeeds = inputs.Find(11, "AlongSpeedArray", 1);
  fields.AcrossSpeeds = inputs.Find(12, "AcrossSpeedArray", 1);
  const std::pair<const LocatedArray*, const char*> ofPoints[] = { { &fields.Data, "SourceArray" },
    { &fields.StartTimes, "SourceTimes" } };
  for (const auto& [array, name] : ofPoints)
  {
    if (array->OnCells)
    {
      problems.push_back(Say("CellArray", name));
    }
  }
  return fields.Data.Values || fields.Sources;
}

void vtkSurfaceDistanceFilter::PrepareOutputs(
  const std::vector<SurfaceBlock>& surfaces, const SurfaceRuns& runs)
{
  std::vector<const DistanceRun*> updated;
  std::vector<const OutputList*> results;
  for (std::size_t b = 0; b < surfaces.size(); ++b)
  {
    updated.push_back(static_cast<const DistanceRun*>(&runs.RunOf(b)));
    results.push_back(&updated.back()->Outputs());
  }
  DistanceRun::RequireSource(updated);
  if (this->PathPoints)
  {
    this->Paths = vtkSmartPointer<vtkPolyData>::New();
    WriteCurves(results, this->ResultArrayName, this->Paths);
  }
}
VTK_ABI_NAMESPACE_END
