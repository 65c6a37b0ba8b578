// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Models/Textures/CoarseStart.h"

#include "Core/Operators/MeanCorrection.h"

#include <algorithm>

namespace SurfaceDiffusion
{

CoarseStart::CoarseStart(CoarseSpace space, std::unique_ptr<ReactionDiffusion> coarse,
  std::unique_ptr<ReactionDiffusion> surface, const ParallelFor& parallel)
  : Space(std::move(space))
  , Coarse(std::move(coarse))
  , Surface(std::move(surface))
  , Parallel(parallel)
  , CoarseBegin(this->Coarse->CheckpointSize())
  , Prolonged(Values::Zero(this->Surface->State().rows(), this->Surface->State().cols()))
{
  this->Coarse->Save(this->CoarseBegin.data());
}

const Values& CoarseStart::State() const
{
  if (this->Current != Phase::Coarse)
  {
    return this->Surface->State();
  }
  if (!this->IsProlonged)
  {
    this->Space.Prolong(this->Coarse->State(), this->Prolonged, this->Parallel);
    this->IsProlonged = true;
  }
  return this->Prolonged;
}

bool CoarseStart::SumState(std::vector<double>& totals) const
{
  if (this->Current != Phase::Coarse)
  {
    return false;
  }
  Total(this->Space.Assembly->Mesh(), this->Coarse->State(), totals, this->Parallel);
  return true;
}

StepReport CoarseStart::Advance(const ProgressMonitor& progress)
{
  if (this->Finished())
  {
    return StepReport();
  }
  if (this->Current == Phase::Coarse && this->Coarse->Finished())
  {
    this->MoveToSurface();
  }
  if (this->Current == Phase::Surface)
  {
    ++this->Steps;
    return this->Surface->Advance(progress);
  }
  this->Current = Phase::Coarse;
  this->IsProlonged = false;
  return this->Coarse->Advance(progress);
}

void CoarseStart::MoveToSurface()
{
  const Values& state = this->State();
  std::vector<double> checkpoint(this->Surface->CheckpointSize(), 0.0); // not finished
  std::copy(state.data(), state.data() + state.size(), checkpoint.begin());
  this->Surface->Restore(checkpoint.data());
  this->Current = Phase::Surface;
  this->Steps = 0;
}

bool CoarseStart::Finished() const
{
  return this->Current == Phase::Surface &&
    (this->Steps >= StepsOnSurface || this->Surface->Finished());
}

double CoarseStart::Energy() const
{
  return this->Current == Phase::Coarse ? this->Coarse->Energy() : this->Surface->Energy();
}

std::size_t CoarseStart::CheckpointSize() const
{
  return 2 + std::max(this->Coarse->CheckpointSize(), this->Surface->CheckpointSize());
}

void CoarseStart::Save(double* checkpoint) const
{
  checkpoint[0] = static_cast<double>(this->Current);
  checkpoint[1] = this->Steps;
  if (this->Current == Phase::Coarse)
  {
    this->Coarse->Save(checkpoint + 2);
  }
  else
  {
    this->Surface->Save(checkpoint + 2);
  }
}

void CoarseStart::Restore(const double* checkpoint)
{
  this->Current = static_cast<Phase>(static_cast<int>(checkpoint[0]));
  this->Steps = static_cast<Index>(checkpoint[1]);
  this->IsProlonged = false;
  if (this->Current == Phase::Coarse)
  {
    this->Coarse->Restore(checkpoint + 2);
    return;
  }
  this->Surface->Restore(checkpoint + 2);
  this->Coarse->Restore(this->CoarseBegin.data()); // used at the start only
}

} // namespace SurfaceDiffusion
