// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "vtkSurfaceDistanceFilter.h"

#include "Conversion/FieldReader.h"
#include "Conversion/InputArrays.h"
#include "Conversion/PointInput.h"
#include "Conversion/SourceInput.h"
#include "Conversion/SurfaceRuns.h"
#include "Run/DistanceRun.h"
#include "Run/InputSentences.h"
#include "Run/OwnedSettings.h"

#include "vtkObjectFactory.h"

using namespace SurfaceDiffusion;

VTK_ABI_NAMESPACE_BEGIN
vtkObjectFactoryNewMacro(vtkSurfaceDistanceFilter);

vtkSurfaceDistanceFilter::vtkSurfaceDistanceFilter()
  : Superclass(OwnedSettings::Make<DistanceSettings>(), SurfaceRuns::Of<DistanceRun>())
{
  this->DeclareNumber("NumberOfSources");
  this->DeclareNumber("NumberOfUnreachedPoints");
  this->DeclareNumber("EffectiveMethod");
  this->SetNumberOfInputPorts(2);
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

int vtkSurfaceDistanceFilter::RequestData(
  vtkInformation* request, vtkInformationVector** inputs, vtkInformationVector* outputs)
{
  vtkDataObject* const sources = FindSecondInput(inputs);
  this->HasSources = sources != nullptr;
  this->ProblemsOfSources.clear();
  if (sources)
  {
    this->Sources = ReadSources(sources, this->GetController(), this->ProblemsOfSources);
  }
  const int result = this->Superclass::RequestData(request, inputs, outputs);
  this->Sources.reset();
  return result;
}

bool vtkSurfaceDistanceFilter::FindFields(
  vtkPolyData* block, InputFields& fields, Problems& problems)
{
  const InputArrays inputs(this, block, fields, problems);
  problems.insert(problems.end(), this->ProblemsOfSources.begin(), this->ProblemsOfSources.end());
  fields.Sources = this->Sources;
  if (!this->HasSources)
  {
    fields.Data = inputs.Find(0, "SourceArray", 1);
    fields.StartTimes = inputs.Find(9, "SourceTimes", 1);
  }
  fields.Mask = inputs.Find(1, "MaskArray", 1);
  fields.Direction = inputs.Find(2, "DirectionArray", 3);
  fields.Speeds = inputs.Find(8, "SpeedArray", 1);
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
  for (std::size_t b = 0; b < surfaces.size(); ++b)
  {
    updated.push_back(static_cast<const DistanceRun*>(&runs.RunOf(b)));
  }
  DistanceRun::RequireSource(updated);
}
VTK_ABI_NAMESPACE_END
