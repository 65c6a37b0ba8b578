// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "vtkSurfaceRunAlgorithm.h"

#include "Conversion/InputArrays.h"
#include "Conversion/ResultWriter.h"
#include "Conversion/SurfaceRuns.h"
#include "Run/BlockSentences.h"
#include "Run/InputSentences.h"
#include "vtkSurfaceFilterInternals.h"

#include <utility>

using namespace SurfaceDiffusion;

VTK_ABI_NAMESPACE_BEGIN
struct vtkSurfaceRunAlgorithm::UpdateState
{
  SurfaceRuns Runs;
  bool NeedsName = false; ///< ResultArrayName must not be empty

  // Of one update:
  std::shared_ptr<SurfaceDiffusion::Settings> Settings;
  Problems InputWarnings; ///< about arrays that some blocks do not have
};

vtkSurfaceRunAlgorithm::vtkSurfaceRunAlgorithm(
  OwnedSettings settings, SurfaceRuns runs, const char* resultArrayName)
  : Superclass(std::move(settings))
  , State(std::make_unique<UpdateState>())
{
  this->ResultArrayName = resultArrayName;
  this->State->NeedsName = !this->ResultArrayName.empty();
  this->State->Runs = std::move(runs);
}

vtkSurfaceRunAlgorithm::~vtkSurfaceRunAlgorithm() = default;

void vtkSurfaceRunAlgorithm::PrepareOutputs(const std::vector<SurfaceBlock>&, const SurfaceRuns&) {}

void vtkSurfaceRunAlgorithm::ProcessSurfaces(
  const std::vector<SurfaceBlock>& blocks, const ProgressMonitor& progress)
{
  UpdateState& state = *this->State;
  // A copy: an observer of the progress may change properties during the update.
  state.Settings = this->Private->Properties.Copy();
  Problems problems;
  state.Settings->Check(nullptr, problems);
  this->CheckSurfaceProperties(problems);
  if (state.NeedsName && this->ResultArrayName.empty())
  {
    problems.push_back(Say("NoName"));
  }
  std::vector<SurfaceBlock> surfaces;
  std::vector<InputFields> fields;
  this->FindAllFields(this->SelectSurfaces(blocks, problems), surfaces, fields, problems);
  if (this->ReportProblems(problems))
  {
    return;
  }

  state.Runs.Update(fields, *state.Settings, progress);
  this->BeginWriting();
  this->PrepareOutputs(surfaces, state.Runs);
  std::vector<std::string> replaced;
  for (std::size_t b = 0; b < surfaces.size(); ++b)
  {
    state.Runs.Write(b, fields[b], this->ResultArrayName, surfaces[b].Output, replaced);
  }
  this->Private->Numbers.Set(state.Runs.FindNumbers());
  std::vector<Warning> warnings = state.Runs.FindWarnings();
  if (!replaced.empty())
  {
    warnings.push_back({ DescribeReplacement(replaced), Fingerprint() });
  }
  for (const Sentence& sentence : state.InputWarnings)
  {
    warnings.push_back({ sentence, Fingerprint() });
  }
  this->ReportWarnings(std::move(warnings));
}

/// The surfaces that take part, their fields, and the problems of all blocks.
void vtkSurfaceRunAlgorithm::FindAllFields(const std::vector<SurfaceBlock>& blocks,
  std::vector<SurfaceBlock>& surfaces, std::vector<InputFields>& fields, Problems& problems)
{
  std::vector<InputFields> ofBlocks;
  BlockSentences problemsOfArrays;
  for (const SurfaceBlock& block : blocks)
  {
    InputFields arrays;
    arrays.Surface = block.Input;
    arrays.Name = block.Name;
    Problems here;
    const bool takesPart = this->FindFields(block.Input, arrays, here);
    problemsOfArrays.Add(here, block.Name);
    ofBlocks.push_back(arrays);
    if (takesPart)
    {
      surfaces.push_back(block);
      fields.push_back(arrays);
    }
  }
  problemsOfArrays.AppendTo(problems, blocks.size());
  const std::size_t before = problems.size();
  this->State->InputWarnings.clear();
  SettleAbsence(ofBlocks, problems, this->State->InputWarnings);
  const bool allAreFound = problems.size() == before;
  BlockSentences problemsOfSettings;
  // An array that is not found would be reported as not set, too.
  for (std::size_t b = 0; b < surfaces.size() && allAreFound; ++b)
  {
    Problems here;
    const FieldSummary summary = fields[b].Summarize();
    this->State->Settings->Check(&summary, here);
    problemsOfSettings.Add(here, surfaces[b].Name);
  }
  problemsOfSettings.AppendTo(problems, surfaces.size());
}

void vtkSurfaceRunAlgorithm::ReleaseCache()
{
  this->Superclass::ReleaseCache();
  this->State->Runs.Clear();
}
VTK_ABI_NAMESPACE_END
