// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "vtkSurfaceCurvatureFilter.h"

#include "Conversion/FieldReader.h"
#include "Conversion/InputArrays.h"
#include "Conversion/SurfaceRuns.h"
#include "Run/CurvatureRun.h"
#include "Run/OwnedSettings.h"
#include "vtkSurfaceFilterInternals.h"

#include "vtkObjectFactory.h"

using namespace SurfaceDiffusion;

vtkStandardNewMacro(vtkSurfaceCurvatureFilter);

struct vtkSurfaceCurvatureFilter::UpdateState
{
  SurfaceRuns<CurvatureRun> Runs;
};

vtkSurfaceCurvatureFilter::vtkSurfaceCurvatureFilter()
  : Superclass(OwnedSettings::Make<CurvatureSettings>())
  , State(std::make_unique<UpdateState>())
{
}

vtkSurfaceCurvatureFilter::~vtkSurfaceCurvatureFilter() = default;

void vtkSurfaceCurvatureFilter::ProcessSurfaces(
  const std::vector<SurfaceBlock>& blocks, const ProgressMonitor& progress)
{
  // A copy: an observer of the progress may change properties during the update.
  const auto copy = std::static_pointer_cast<CurvatureSettings>(this->Private->Properties.Copy());
  CurvatureSettings& settings = *copy;
  Problems problems;
  settings.Check(nullptr, problems);
  this->CheckSurfaceProperties(problems);
  const std::vector<SurfaceBlock> surfaces = this->SelectSurfaces(blocks, problems);
  std::vector<InputFields> fields(surfaces.size());
  BlockSentences found;
  std::vector<std::string> names;
  for (std::size_t b = 0; b < surfaces.size(); ++b)
  {
    Problems here;
    const InputArrays inputs(this, surfaces[b].Input, fields[b], here);
    fields[b].Mask = inputs.Find(1, "MaskArray", 1);
    found.Add(here, surfaces[b].Name);
    names.push_back(surfaces[b].Name);
  }
  Problems absences;
  SettleAbsence(fields, names, problems, absences);
  found.AppendTo(problems, surfaces.size());
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

void vtkSurfaceCurvatureFilter::ReleaseCache()
{
  this->Superclass::ReleaseCache();
  this->State->Runs.Clear();
}
