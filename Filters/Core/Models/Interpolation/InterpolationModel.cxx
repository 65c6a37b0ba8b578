// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Models/Interpolation/InterpolationModel.h"

#include "Core/Models/Interpolation/Outliers.h"

#include <algorithm>
#include <utility>
#include <vector>

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

/// The values of a column that are not left out.
ScatteredValues Kept(const ScatteredValues& data, const Values& leftOut, Eigen::Index column)
{
  ScatteredValues kept;
  const auto count = static_cast<Eigen::Index>((leftOut.col(column).array() == 0.0).count());
  kept.Given.resize(count, 1);
  kept.Weights.resize(count);
  for (Index i = 0; i < data.Count(); ++i)
  {
    if (leftOut(i, column) == 0.0)
    {
      kept.Given(kept.Count(), 0) = data.Given(i, column);
      kept.Weights[kept.Count()] = data.Weights[i];
      kept.Places.push_back(data.Places[static_cast<std::size_t>(i)]);
    }
  }
  return kept;
}

/// The fit of all columns from that of each. The leverage of values that are left out is 0.
SmoothInterpolation::Result Join(
  const std::vector<SmoothInterpolation::Result>& fits, const Values& leftOut)
{
  SmoothInterpolation::Result all = fits.front();
  const auto columns = static_cast<Eigen::Index>(fits.size());
  all.Columns.clear();
  all.U.resize(all.U.rows(), columns);
  all.Error.resize(all.Error.rows(), columns);
  all.SlopeError.resize(all.SlopeError.rows(), columns);
  all.Leverage = Values::Zero(all.Leverage.rows() > 0 ? leftOut.rows() : 0, columns);
  for (Eigen::Index c = 0; c < columns; ++c)
  {
    const SmoothInterpolation::Result& fit = fits[static_cast<std::size_t>(c)];
    all.Columns.push_back(fit.Columns.front());
    all.U.col(c) = fit.U;
    all.Error.col(c) = fit.Error;
    all.SlopeError.col(c) = fit.SlopeError;
    Eigen::Index row = 0;
    for (Eigen::Index i = 0; i < all.Leverage.rows(); ++i)
    {
      if (leftOut(i, c) == 0.0)
      {
        all.Leverage(i, c) = fit.Leverage(row++, 0);
      }
    }
    all.HasUnknownError = all.HasUnknownError || fit.HasUnknownError;
    all.HasInfiniteError = all.HasInfiniteError || fit.HasInfiniteError;
    all.ContradictingPlaces = std::max(all.ContradictingPlaces, fit.ContradictingPlaces);
    all.PartsWithTooFewValues = std::max(all.PartsWithTooFewValues, fit.PartsWithTooFewValues);
    all.IsFlattest = all.IsFlattest || fit.IsFlattest;
    all.DropsNegativeCurvature = all.DropsNegativeCurvature || fit.DropsNegativeCurvature;
    all.RangeIsOptimal = all.RangeIsOptimal && fit.RangeIsOptimal;
  }
  return all;
}

} // namespace

InterpolationModel::InterpolationModel(std::shared_ptr<const Assembler> assembler,
  CornerWeights coefficients, ScatteredValues data, const SmoothInterpolation::Settings& settings,
  const ParallelFor& parallel, bool isRobust)
  : StateModel(MeanEverywhere(assembler->Mesh().NumberOfVertices(), data))
  , Method(assembler, coefficients, settings, parallel)
  , Data(std::move(data))
  , LeftOut(Values::Zero(this->Data.Given.rows(), this->Data.Given.cols()))
{
  if (isRobust)
  {
    SmoothInterpolation::Settings search = settings;
    search.KeepRange = search.ComputeError = false;
    search.ComputeLeverage = true;
    this->Search = std::make_unique<const SmoothInterpolation>(
      std::move(assembler), std::move(coefficients), search, parallel);
  }
  if (this->U.rows() > 0) // otherwise no triangle has an area
  {
    const Values misfit = this->Data.Given.rowwise() - this->U.row(0);
    this->EnergyOfStart = 0.5 * this->Data.Weights.dot(misfit.rowwise().squaredNorm());
  }
}

StepReport InterpolationModel::Advance(const ProgressMonitor& progress)
{
  if (this->Search)
  {
    this->FitWithoutOutliers(progress);
  }
  else
  {
    this->Last = this->Method.Fit(this->Data, progress);
  }
  this->U = std::move(this->Last.U);
  this->EnergyOfFit = 0.0;
  for (const SmoothInterpolation::Column& column : this->Last.Columns)
  {
    this->EnergyOfFit += column.Energy;
  }
  this->IsFitted = true;
  return {};
}

void InterpolationModel::FitWithoutOutliers(const ProgressMonitor& progress)
{
  const Eigen::Index columns = this->Data.Given.cols();
  const auto part = [&](Eigen::Index c, double from, double to)
  {
    const double share = 0.5 / static_cast<double>(columns);
    return progress.Part(
      from + share * static_cast<double>(c), to + share * static_cast<double>(c + 1));
  };
  for (Eigen::Index c = 0; c < columns; ++c)
  {
    const std::vector<char> outliers =
      FindOutliers(*this->Search, this->Data, c, part(c, 0.0, 0.0));
    for (std::size_t i = 0; i < outliers.size(); ++i)
    {
      this->LeftOut(static_cast<Eigen::Index>(i), c) = outliers[i];
    }
  }
  if (this->LeftOut.isZero(0.0))
  {
    this->Last = this->Method.Fit(this->Data, progress.Part(0.5, 1.0));
    return;
  }
  std::vector<SmoothInterpolation::Result> fits;
  for (Eigen::Index c = 0; c < columns; ++c)
  {
    fits.push_back(this->Method.Fit(Kept(this->Data, this->LeftOut, c), part(c, 0.5, 0.5)));
  }
  this->Last = Join(fits, this->LeftOut);
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
