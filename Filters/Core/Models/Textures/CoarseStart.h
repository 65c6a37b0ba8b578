// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Core/Models/Textures/CoarseSpace.h"
#include "Core/Models/Textures/ReactionDiffusion.h"

#include <memory>
#include <vector>

namespace SurfaceDiffusion
{

/// Reaction-diffusion whose pattern grows in a coarse space (nested iteration): the steps run there
/// until the pattern is stationary, and the last StepsOnSurface steps run on the surface itself, to
/// remove the traces of interpolation. All steps have the same length, so that the states are those
/// of one evolution with a discretisation that changes once. The coarse space is given the initial
/// state of the surface, whose waves it resolves.
class CoarseStart : public Model
{
public:
  static constexpr Index StepsOnSurface = 2;

  /// coarse, surface: in their initial states; coarse: on space.Assembly, from
  /// space.Restrict(start), with a StopTolerance.
  CoarseStart(CoarseSpace space, std::unique_ptr<ReactionDiffusion> coarse,
    std::unique_ptr<ReactionDiffusion> surface, const ParallelFor& parallel = SerialFor());

  /// Prolonged when it is asked for.
  const Values& State() const override;
  bool SumState(std::vector<double>& totals) const override;
  StepReport Advance(const ProgressMonitor& progress) override;
  bool Finished() const override;
  double Energy() const override;

  std::size_t CheckpointSize() const override;
  void Save(double* checkpoint) const override;
  void Restore(const double* checkpoint) override;

private:
  enum class Phase
  {
    Start,
    Coarse,
    Surface
  };

  void MoveToSurface();

  CoarseSpace Space;
  std::unique_ptr<ReactionDiffusion> Coarse;
  std::unique_ptr<ReactionDiffusion> Surface;
  const ParallelFor& Parallel;
  std::vector<double> CoarseBegin; ///< checkpoint of Coarse in its initial state
  Phase Current = Phase::Start;
  Index Steps = 0; ///< on the surface
  mutable Values Prolonged;
  mutable bool IsProlonged = false; ///< from the current state of Coarse
};

} // namespace SurfaceDiffusion
