// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "vtkSurfaceDistanceFilter.h"

#include "Conversion/FieldReader.h"
#include "Conversion/InputArrays.h"
#include "Conversion/PointInput.h"
#include "Conversion/SourceInput.h"
#include "Conversion/SurfaceRuns.h"
#include "Run/DistanceRun.h"
#include "Run/OwnedSettings.h"
#include "vtkSurfaceFilterInternals.h"

#include "vtkObjectFactory.h"

using namespace SurfaceDiffusion;

vtkStandardNewMacro(vtkSurfaceDistanceFilter);

struct vtkSurfaceDistanceFilter::UpdateState
{
  SurfaceRuns<DistanceRun> Runs;
  bool HasSources = false; ///< a second input, during an update
  std::shared_ptr<const SourceShapes> Sources;
  Problems ProblemsOfSources;
};

vtkSurfaceDistanceFilter::vtkSurfaceDistanceFilter()
  : Superclass(OwnedSettings::Make<DistanceSettings>())
  , State(std::make_unique<UpdateState>())
{
  this->DeclareNumber("NumberOfSources");
  this->DeclareNumber("NumberOfUnreachedPoints");
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
  UpdateState& state = *this->State;
  vtkDataObject* const sources = FindSecondInput(inputs);
  state.HasSources = sources != nullptr;
  state.ProblemsOfSources.clear();
  if (sources)
  {
    state.Sources = ReadSources(sources, this->GetController(), state.ProblemsOfSources);
  }
  const int result = this->Superclass::RequestData(request, inputs, outputs);
  state.Sources.reset();
  return result;
}

void vtkSurfaceDistanceFilter::ProcessSurfaces(
  const std::vector<SurfaceBlock>& blocks, const ProgressMonitor& progress)
{
  UpdateState& state = *this->State;
  // A copy: an observer of the progress may change properties during the update.
  const auto copy = std::static_pointer_cast<DistanceSettings>(this->Private->Properties.Copy());
  DistanceSettings& settings = *copy;
  Problems problems = state.ProblemsOfSources;
  settings.Check(nullptr, problems);
  this->CheckSurfaceProperties(problems);
  std::vector<SurfaceBlock> surfaces = this->SelectSurfaces(blocks, problems);
  std::vector<InputFields> fields(surfaces.size());
  BlockSentences found;
  std::vector<std::string> names;
  for (std::size_t b = 0; b < surfaces.size(); ++b)
  {
    Problems here;
    const InputArrays inputs(this, surfaces[b].Input, fields[b], here);
    fields[b].Sources = state.Sources;
    if (!state.HasSources)
    {
      fields[b].Data = inputs.Find(0, "SourceArray", 1);
      fields[b].StartTimes = inputs.Find(9, "SourceTimes", 1);
    }
    fields[b].Mask = inputs.Find(1, "MaskArray", 1);
    fields[b].Direction = inputs.Find(2, "DirectionArray", 3);
    fields[b].Speeds = inputs.Find(8, "SpeedArray", 1);
    const std::pair<const LocatedArray*, const char*> ofPoints[] = {
      { &fields[b].Data, "SourceArray" }, { &fields[b].StartTimes, "SourceTimes" }
    };
    for (const auto& [array, name] : ofPoints)
    {
      if (array->OnCells)
      {
        here.push_back(
          std::string(name) + " is a cell array; allowed: point arrays of 1 component");
      }
    }
    found.Add(here, surfaces[b].Name);
    names.push_back(surfaces[b].Name);
  }
  Problems absences;
  SettleAbsence(fields, names, problems, absences);
  if (!state.HasSources)
  {
    PassBlocksWithoutData(surfaces, fields);
  }
  for (std::size_t b = 0; b < surfaces.size(); ++b)
  {
    Problems here;
    const FieldSummary summary = fields[b].Summarize();
    settings.Check(state.ProblemsOfSources.empty() ? &summary : nullptr, here);
    found.Add(here, surfaces[b].Name);
  }
  found.AppendTo(problems, names.size());
  if (this->ReportProblems(problems))
  {
    return;
  }

  auto& runs = state.Runs;
  runs.Update(surfaces, fields, settings, progress);
  std::vector<const DistanceRun*> updated;
  for (std::size_t b = 0; b < surfaces.size(); ++b)
  {
    updated.push_back(&runs.RunOf(b));
  }
  DistanceRun::RequireSource(updated);
  this->BeginWriting();
  std::vector<Warning> warnings =
    runs.Write(surfaces, fields, nullptr, this->ResultArrayName, absences);
  this->Private->Numbers = runs.FindNumbers();
  this->ReportWarnings(std::move(warnings));
}

void vtkSurfaceDistanceFilter::ReleaseCache()
{
  this->Superclass::ReleaseCache();
  this->State->Runs.Clear();
}
