// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Models/Interpolation/InterpolationModel.h"

#include <utility>

namespace SurfaceDiffusion
{

namespace
{

Values MeanEverywhere(Index rows, const ScatteredValues& data)
{
  const Eigen::RowVectorXd mean =
    (data.Weights.asDiagonal() * data.Given).colwise().sum() / data.Weights.sum();
  return Vector::Ones(rows) * mean;
}

} // namespace

InterpolationModel::InterpolationModel(std::shared_ptr<const Assembler> assembler,
  CornerWeights coefficients, ScatteredValues data, const SmoothInterpolation::Settings& settings,
  const ParallelFor& parallel)
  : StateModel(MeanEverywhere(assembler->Mesh().NumberOfVertices(), data))
  , Method(std::move(assembler), std::move(coefficients), settings, parallel)
  , Data(std::move(data))
{
  if (this->U.rows() > 0) // otherwise no triangle has an area
  {
    const Values misfit = this->Data.Given.rowwise() - this->U.row(0);
    this->EnergyOfStart = 0.5 * this->Data.Weights.dot(misfit.rowwise().squaredNorm());
  }
}

StepReport InterpolationModel::Advance(const ProgressMonitor& progress)
{
  this->Last = this->Method.Fit(this->Data, progress);
  this->U = std::move(this->Last.U);
  this->EnergyOfFit = 0.0;
  for (const SmoothInterpolation::Column& column : this->Last.Columns)
  {
    this->EnergyOfFit += column.Energy;
  }
  this->IsFitted = true;
  return {};
}

/// The state, and whether it is the fit.
std::size_t InterpolationModel::CheckpointSize() const
{
  return this->StateModel::CheckpointSize() + 1;
}

void InterpolationModel::Save(double* checkpoint) const
{
  this->StateModel::Save(checkpoint);
  checkpoint[this->U.size()] = this->IsFitted ? 1.0 : 0.0;
}

void InterpolationModel::Restore(const double* checkpoint)
{
  this->StateModel::Restore(checkpoint);
  this->IsFitted = checkpoint[this->U.size()] != 0.0;
}

} // namespace SurfaceDiffusion
