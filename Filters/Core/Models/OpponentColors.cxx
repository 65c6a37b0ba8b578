// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Models/OpponentColors.h"

#include <cmath>

namespace SurfaceDiffusion
{

namespace
{

/// The axes as columns: a row of colours times it has the components of the colour.
Eigen::Matrix3d OpponentAxes()
{
  Eigen::Matrix3d axes;
  axes.col(0) = Eigen::Vector3d(1.0, 1.0, 1.0) / std::sqrt(3.0);
  axes.col(1) = Eigen::Vector3d(1.0, -1.0, 0.0) / std::sqrt(2.0);
  axes.col(2) = Eigen::Vector3d(1.0, 1.0, -2.0) / std::sqrt(6.0);
  return axes;
}

} // namespace

OpponentColors::OpponentColors(
  PointData data, const ModelMaker& makeModel, const ParallelFor& parallel)
  : Parallel(parallel)
  , Start(data.Start)
  , Fixed(data.Fixed)
  , U(data.Start)
{
  const Eigen::Matrix3d axes = OpponentAxes();
  data.Given = (data.Given * axes).eval();
  data.Start = (data.Start * axes).eval();
  this->Opponents = makeModel(std::move(data));
}

StepReport OpponentColors::Advance(const ProgressMonitor& progress)
{
  const StepReport report = this->Opponents->Advance(progress);
  this->Started = true;
  this->UpdateState();
  return report;
}

DiffusionStep OpponentColors::Diffusion() const
{
  DiffusionStep step = this->Opponents->Diffusion();
  step.SharesTensor = true;
  return step;
}

void OpponentColors::UpdateState()
{
  if (!this->Started)
  {
    this->U = this->Start;
    return;
  }
  const Eigen::Matrix3d toColors = OpponentAxes().transpose();
  ForEach(this->Parallel, static_cast<Index>(this->U.rows()),
    [&](Index i)
    {
      if (this->Fixed[i])
      {
        this->U.row(i) = this->Start.row(i);
        return;
      }
      const Eigen::RowVector3d opponents = this->Opponents->State().row(i);
      this->U.row(i) = opponents * toColors;
    });
}

void OpponentColors::Save(double* checkpoint) const
{
  *checkpoint = this->Started ? 1.0 : 0.0;
  this->Opponents->Save(checkpoint + 1);
}

void OpponentColors::Restore(const double* checkpoint)
{
  this->Started = *checkpoint > 0.0;
  this->Opponents->Restore(checkpoint + 1);
  this->UpdateState();
}

} // namespace SurfaceDiffusion
