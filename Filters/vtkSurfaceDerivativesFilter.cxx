// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "vtkSurfaceDerivativesFilter.h"

#include "Conversion/FieldReader.h"
#include "Conversion/InputArrays.h"
#include "Conversion/SurfaceRuns.h"
#include "Run/DerivativesRun.h"
#include "Run/OwnedSettings.h"
#include "vtkSurfaceFilterInternals.h"

#include "vtkDataObject.h"
#include "vtkDataSetAttributes.h"
#include "vtkObjectFactory.h"

using namespace SurfaceDiffusion;

vtkStandardNewMacro(vtkSurfaceDerivativesFilter);

struct vtkSurfaceDerivativesFilter::UpdateState
{
  SurfaceRuns<DerivativesRun> Runs;
};

vtkSurfaceDerivativesFilter::vtkSurfaceDerivativesFilter()
  : Superclass(OwnedSettings::Make<DerivativesSettings>())
  , State(std::make_unique<UpdateState>())
{
  this->SetInputArrayToProcess(
    0, 0, 0, vtkDataObject::FIELD_ASSOCIATION_POINTS_THEN_CELLS, vtkDataSetAttributes::SCALARS);
}

vtkSurfaceDerivativesFilter::~vtkSurfaceDerivativesFilter() = default;

void vtkSurfaceDerivativesFilter::ProcessSurfaces(
  const std::vector<SurfaceBlock>& blocks, const ProgressMonitor& progress)
{
  // A copy: an observer of the progress may change properties during the update.
  const auto copy = std::static_pointer_cast<DerivativesSettings>(this->Private->Properties.Copy());
  DerivativesSettings& settings = *copy;
  Problems problems;
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
    fields[b].Data = inputs.Find(0, "InputArray", InputArrays::AnyNumberOfComponents);
    fields[b].Mask = inputs.Find(1, "MaskArray", 1);
    found.Add(here, surfaces[b].Name);
    names.push_back(surfaces[b].Name);
  }
  Problems absences;
  SettleAbsence(fields, names, problems, absences);
  PassBlocksWithoutData(surfaces, fields);
  for (std::size_t b = surfaces.size(); b-- > 0;)
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
    runs.Write(surfaces, fields, &InputFields::Data, this->ResultArrayName, absences);
  this->Private->Numbers = runs.FindNumbers();
  this->ReportWarnings(std::move(warnings));
}

void vtkSurfaceDerivativesFilter::ReleaseCache()
{
  this->Superclass::ReleaseCache();
  this->State->Runs.Clear();
}
