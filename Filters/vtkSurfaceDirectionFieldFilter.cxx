// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "vtkSurfaceDirectionFieldFilter.h"

#include "Conversion/FieldReader.h"
#include "Conversion/InputArrays.h"
#include "Conversion/SurfaceRuns.h"
#include "Run/DirectionFieldRun.h"
#include "Run/OwnedSettings.h"
#include "vtkSurfaceFilterInternals.h"

#include "vtkObjectFactory.h"

using namespace SurfaceDiffusion;

vtkStandardNewMacro(vtkSurfaceDirectionFieldFilter);

struct vtkSurfaceDirectionFieldFilter::UpdateState
{
  SurfaceRuns<DirectionFieldRun> Runs;
};

vtkSurfaceDirectionFieldFilter::vtkSurfaceDirectionFieldFilter()
  : Superclass(OwnedSettings::Make<DirectionFieldSettings>())
  , State(std::make_unique<UpdateState>())
{
  this->ResultArrayName = "Direction";
}

vtkSurfaceDirectionFieldFilter::~vtkSurfaceDirectionFieldFilter() = default;

void vtkSurfaceDirectionFieldFilter::ProcessSurfaces(
  const std::vector<SurfaceBlock>& blocks, const ProgressMonitor& progress)
{
  // A copy: an observer of the progress may change properties during the update.
  const auto copy =
    std::static_pointer_cast<DirectionFieldSettings>(this->Private->Properties.Copy());
  DirectionFieldSettings& settings = *copy;
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
  const bool hasHints = settings.Method == DirectionMethod::Hints;
  for (std::size_t b = 0; b < surfaces.size() && hasHints; ++b)
  {
    Problems here;
    fields[b].Direction =
      InputArrays(this, surfaces[b].Input, fields[b], here).Find(2, "DirectionArray", 3);
    found.Add(here, surfaces[b].Name);
    names.push_back(surfaces[b].Name);
  }
  const std::size_t before = problems.size();
  Problems unused; // a block without hints is an error
  SettleAbsence(fields, names, problems, unused);
  for (std::size_t b = 0; b < surfaces.size() && hasHints && problems.size() == before; ++b)
  {
    Problems here;
    const FieldSummary summary = fields[b].Summarize();
    settings.Check(&summary, here);
    found.Add(here, surfaces[b].Name);
  }
  found.AppendTo(problems, surfaces.size());
  if (this->ReportProblems(problems))
  {
    return;
  }

  auto& runs = this->State->Runs;
  runs.Update(surfaces, fields, settings, progress);
  this->BeginWriting();
  std::vector<Warning> warnings =
    runs.Write(surfaces, fields, &InputFields::Direction, this->ResultArrayName);
  this->Private->Numbers = runs.FindNumbers();
  this->ReportWarnings(std::move(warnings));
}

void vtkSurfaceDirectionFieldFilter::ReleaseCache()
{
  this->Superclass::ReleaseCache();
  this->State->Runs.Clear();
}
