// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Run/Run.h"

#include "Run/BlockSentences.h"
#include "Run/Collective.h"

namespace SurfaceDiffusion
{

namespace
{

SurfaceOptions MakeOptions(const RunSettings& settings)
{
  SurfaceOptions options;
  options.MergeCoincidentPoints = settings.MergeCoincidentPoints;
  options.MergeTolerance = settings.MergeTolerance;
  options.IntrinsicDelaunay = settings.IntrinsicDelaunay;
  return options;
}

void Attach(Run::Block& block)
{
  if (block.Decomposition)
  {
    block.Decomposition->Attach(*block.Surface, block.Solvers);
  }
}

} // namespace

void Run::UpdateSurfaces(const std::vector<BlockInput>& inputs, const Reduction& processes,
  const ProgressMonitor& progress)
{
  const SettingsSnapshot snapshot(*this->Settings, SettingScope::Surface);
  this->Blocks.resize(inputs.size());
  for (std::size_t b = 0; b < inputs.size(); ++b)
  {
    std::unique_ptr<Block>& block = this->Blocks[b];
    if (processes.Any(!block || !block->Surface ||
          block->SurfaceVersion != inputs[b].SurfaceVersion || block->SurfaceSettings != snapshot))
    {
      block.reset(); // before the new one takes memory
      block = std::make_unique<Block>();
      const double share = static_cast<double>(inputs.size());
      NameBlockInErrors(inputs[b].Name, *this->Settings,
        [&]
        {
          block->Surface =
            this->MakeSurface(inputs[b], processes, {}, progress.Part(b / share, (b + 1) / share));
          block->Decomposition = inputs[b].Decomposition;
          Attach(*block);
        });
      block->SurfaceVersion = inputs[b].SurfaceVersion;
      block->SurfaceSettings = snapshot;
    }
    block->Name = inputs[b].Name;
  }
}

std::unique_ptr<Surface> Run::MakeSurface(const BlockInput& input, const Reduction& processes,
  std::vector<char> undetermined, const ProgressMonitor& progress) const
{
  SurfaceOptions options = MakeOptions(*this->Settings);
  if (input.Decomposition)
  {
    options.LengthUnit = input.Decomposition->FindLengthUnit();
    options.JoinShortEdges = false;
  }
  std::unique_ptr<Surface> surface;
  RunCollectively(processes,
    [&]
    {
      SurfaceArrays arrays = input.ReadSurface();
      arrays.Undetermined = std::move(undetermined);
      surface = std::make_unique<Surface>(std::move(arrays), options, this->Parallel, progress);
    });
  return surface;
}

/// Makes a surface of the determined components if there are others. The whole surface is kept, to
/// find the components of the next data.
void Run::LeaveOutUndetermined(const BlockInput& input, const Fields& fields,
  const Reduction& processes, Block& block, const ProgressMonitor& progress)
{
  const ModelTraits traits = this->Settings->DescribeModel();
  if (!traits.StartsFromKnownValues)
  {
    return;
  }
  block.Undetermined = FindUndetermined(block.WholeSurface ? *block.WholeSurface : *block.Surface,
    fields, this->Settings->MaskMode == MaskMode::Inpaint, traits.StateIsUnitVectors, processes);
  if (!processes.Any(block.Undetermined.Points != block.Surface->Undetermined()))
  {
    return;
  }
  std::unique_ptr<Surface>& former = block.WholeSurface ? block.WholeSurface : block.Surface;
  std::unique_ptr<Surface> whole = std::move(former);
  block.Edges.reset();
  block.Surface.reset(); // if the work below ends early, all is made again
  block.WholeSurface.reset();
  block.Solvers = SolverStore();
  if (processes.Any(!block.Undetermined.Points.empty()))
  {
    block.Surface = this->MakeSurface(input, processes, block.Undetermined.Points, progress);
    block.WholeSurface = std::move(whole);
  }
  else
  {
    block.Surface = std::move(whole);
  }
  Attach(block);
}

/// Blocks without data have no undetermined components.
void Run::RequireKnownValue(
  const std::vector<std::unique_ptr<Fields>>& fields, const Reduction& processes) const
{
  bool known = false;
  bool undetermined = false;
  bool weighted = false;
  Word name = Fields().DataName;
  for (std::size_t b = 0; b < this->Blocks.size(); ++b)
  {
    const Undetermined& found = this->Blocks[b]->Undetermined;
    known = known || found.HasKnown;
    undetermined = undetermined || found.NumberOfComponents > 0.0;
    weighted = weighted || (fields[b] && !fields[b]->Weightless.empty());
    name = fields[b] && found.NumberOfComponents > 0.0 ? fields[b]->DataName : name;
  }
  if (processes.Any(undetermined) && !processes.Any(known))
  {
    const bool vectors = this->Settings->DescribeModel().StateIsUnitVectors;
    throw InputError(Sentence(name)
      << " has no known value: it is NaN" << (vectors ? ", of length zero" : "")
      << (weighted ? ", of weight 0" : "")
      << " or masked everywhere; allowed: data with a known value");
  }
}

} // namespace SurfaceDiffusion
