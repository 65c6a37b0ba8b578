// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "vtkSurfaceDenoisingFilter.h"

#include "Conversion/FieldReader.h"
#include "Conversion/InputArrays.h"
#include "Conversion/SurfaceRuns.h"
#include "Run/DenoisingRun.h"
#include "Run/OwnedSettings.h"
#include "vtkSurfaceFilterInternals.h"

#include "vtkObjectFactory.h"

using namespace SurfaceDiffusion;

vtkStandardNewMacro(vtkSurfaceDenoisingFilter);

struct vtkSurfaceDenoisingFilter::UpdateState
{
  SurfaceRuns<DenoisingRun> Runs;
};

vtkSurfaceDenoisingFilter::vtkSurfaceDenoisingFilter()
  : Superclass(OwnedSettings::Make<DenoisingRunSettings>())
  , State(std::make_unique<UpdateState>())
{
  this->DeclareNumber("EffectiveNoiseLevel");
  this->DeclareNumber("CorrelationLength");
  this->DeclareNumber("EffectiveSurfaceType");
  this->DeclareNumber("MeanDisplacement");
  this->DeclareNumber("MaximumDisplacement");
  this->DeclareNumber("VolumeBefore");
  this->DeclareNumber("VolumeAfter");
  this->ResultArrayName = "Displacement";
}

vtkSurfaceDenoisingFilter::~vtkSurfaceDenoisingFilter() = default;

void vtkSurfaceDenoisingFilter::ProcessSurfaces(
  const std::vector<SurfaceBlock>& blocks, const ProgressMonitor& progress)
{
  // A copy: an observer of the progress may change properties during the update.
  const auto copy =
    std::static_pointer_cast<DenoisingRunSettings>(this->Private->Properties.Copy());
  DenoisingRunSettings& settings = *copy;
  Problems problems;
  settings.Check(nullptr, problems);
  this->CheckSurfaceProperties(problems);
  if (this->ResultArrayName.empty())
  {
    problems.emplace_back("ResultArrayName is empty; allowed: any name");
  }
  const std::vector<SurfaceBlock> surfaces = this->SelectSurfaces(blocks, problems);
  std::vector<InputFields> fields(surfaces.size());
  BlockSentences found;
  std::vector<std::string> names;
  for (std::size_t b = 0; b < surfaces.size(); ++b)
  {
    Problems here;
    const InputArrays inputs(this, surfaces[b].Input, fields[b], here);
    fields[b].Fixed = inputs.Find(3, "FixedArray", 1);
    found.Add(here, surfaces[b].Name);
    names.push_back(surfaces[b].Name);
  }
  found.AppendTo(problems, surfaces.size());
  Problems absences;
  SettleAbsence(fields, names, problems, absences);
  if (this->ReportProblems(problems))
  {
    return;
  }

  auto& runs = this->State->Runs;
  runs.Update(surfaces, fields, settings, progress);
  this->BeginWriting();
  std::vector<Warning> warnings =
    runs.Write(surfaces, fields, nullptr, this->ResultArrayName, absences);
  this->Private->Numbers = runs.FindNumbers();
  this->ReportWarnings(std::move(warnings));
}

void vtkSurfaceDenoisingFilter::ReleaseCache()
{
  this->Superclass::ReleaseCache();
  this->State->Runs.Clear();
}
