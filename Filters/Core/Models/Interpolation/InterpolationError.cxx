// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
//
// The standard error of SmoothInterpolation of few values, whose mu is found.

#include "Core/Models/Interpolation/SlopeSquares.h"
#include "Core/Models/Interpolation/SmoothInterpolationWork.h"
#include "Core/Models/Interpolation/SmoothingPosterior.h"

#include <limits>
#include <utility>

namespace SurfaceDiffusion
{

/// Of the fit of a column, with which work.Fit is prepared. NaN if it is not known.
std::pair<Vector, Vector> SmoothInterpolation::ErrorOverSmoothing(
  Work& work, Result& result, Eigen::Index column, const ProgressMonitor& progress) const
{
  const double mu = work.Fit.GetSmoothing();
  const SmoothingPosterior posterior(*work.Spectrum, work.Rows, column, this->Options.NoiseLevel);
  constexpr double resolved = 16.0 * std::numeric_limits<double>::epsilon();
  const bool showsDeviation = this->Options.NoiseLevel > 0.0 ||
    posterior.Contrast() > work.RoundOff(column, resolved, result.IsFlattest) ||
    work.Rows.Scatter.col(column).sum() > 0.0;
  if (!posterior.IsKnown() || !showsDeviation)
  {
    const Vector unknown =
      Vector::Constant(work.Start.rows(), std::numeric_limits<double>::quiet_NaN());
    return { unknown, unknown };
  }
  const double other = posterior.Resolving(mu);
  if (other != mu)
  {
    this->Prepare(work, result, other, work.None, progress.Part(0.0, 0.2));
  }
  const SlopeSquares slopes(this->Assembly->Mesh(), this->Parallel);
  Vector ofSlopes;
  Vector squares = posterior.SquareOfError(work.Fit, mu, slopes, ofSlopes, progress.Part(0.2, 0.8));
  if (this->Options.Kappa > 0.0)
  {
    const Vector ofMean =
      this->VarianceOfMean(work, work.None, false, progress.Part(0.8, 0.9)); // of this mu
    const double ofNoise = 1.0 / work.TotalWeight;
    squares += ofMean *
      (posterior.MeanOf(ofNoise, work.EnergyOfMean) /
        (ofNoise + work.EnergyOfMean / work.Fit.GetSmoothing()));
  }
  if (other != mu)
  {
    this->Prepare(work, result, mu, work.None, progress.Part(0.9, 1.0));
  }
  return { squares.cwiseSqrt(), ofSlopes.cwiseSqrt() };
}

} // namespace SurfaceDiffusion
