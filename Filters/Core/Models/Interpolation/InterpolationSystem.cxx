// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
//
// SmoothInterpolation: the system of a part, what its energy and its values leave open, and the error of the mean.

#include "Core/Foundation/Random.h"
#include "Core/Models/Interpolation/SmoothInterpolationWork.h"
#include "Core/Operators/CotanWeights.h"
#include "Core/Solvers/NotPositiveDefinite.h"

#include <algorithm>
#include <cmath>

namespace SurfaceDiffusion
{

/// mu at which the fit smooths over three times the distance of the values.
double SmoothInterpolation::StartSmoothing(const Work& work) const
{
  constexpr double reach = 3.0;
  const ScatteredValues& rows = work.Rows;
  const double diffusivity = work.Energy.IsFree()
    ? 1.0
    : this->Coefficients.sum() / CotanWeights(this->Assembly->Mesh(), this->Parallel).sum();
  const double square = reach * reach * work.Area / rows.Count();
  const double scale =
    this->Options.Kappa * this->Options.Kappa + std::max(diffusivity, 1e-300) / square;
  return rows.Weights.sum() / work.Area / (scale * scale);
}

void SmoothInterpolation::DropNegativeCurvature(Work& work, Result& result)
{
  work.Energy.DropNegativeCurvature();
  work.EnergyOfMean = -1.0;
  result.DropsNegativeCurvature = true;
}

void SmoothInterpolation::Prepare(
  Work& work, Result& result, double mu, const Flags& held, const ProgressMonitor& progress) const
{
  const bool isExact = this->Options.Smoothing == Choice::Exact || result.PartsWithTooFewValues > 0;
  PivotCounts pivots = work.Fit.Prepare(mu, held, isExact, progress);
  if (pivots.Negative > 0 && work.Energy.IsFree() && !result.DropsNegativeCurvature)
  {
    DropNegativeCurvature(work, result);
    pivots = work.Fit.Prepare(mu, held, isExact, progress);
  }
  if (pivots.Open > 0 && !isExact && !result.IsFlattest)
  {
    // mu may be so large that what the values determine is lost in round-off.
    const double moderate = std::min(mu, this->StartSmoothing(work));
    const bool isOpen =
      moderate == mu || work.Fit.Prepare(moderate, held, isExact, progress).Open > 0;
    while (!isOpen && pivots.Open > 0 && mu > moderate)
    {
      mu = std::max(moderate, 0.1 * mu);
      pivots = work.Fit.Prepare(mu, held, isExact, progress);
    }
  }
  if (pivots.Open > 0 && !result.IsFlattest)
  {
    // Enough to be resolved, and little beside the energy.
    const double n = static_cast<double>(held.size());
    work.Energy.AddTension(std::max(1e-6, 1e-12 * n * n) / work.Area);
    work.EnergyOfMean = -1.0;
    work.Open = pivots.Open;
    result.IsFlattest = true;
    pivots = work.Fit.Prepare(mu, held, isExact, progress);
  }
  if (pivots.Open > 0)
  {
    throw NotPositiveDefinite();
  }
}

/// The vertices that functions reach which have neither values nor, but for the tension, an energy: of
/// all functions the inverse keeps these when it is applied again and again.
Flags SmoothInterpolation::FindOpen(const Work& work) const
{
  constexpr Index samples = 8; // one of them may vanish where others do not
  constexpr double resolved = 1e-6;
  if (work.Open == 0)
  {
    return work.None;
  }
  Values v(work.None.size(), samples);
  for (Index i = 0; i < static_cast<Index>(v.rows()); ++i)
  {
    for (Index c = 0; c < samples; ++c)
    {
      v(i, c) = UniformRandom(0, c, i);
    }
  }
  for (int round = 0; round < 6; ++round)
  {
    Values forces;
    work.Energy.MultiplyStiffness(v, forces);
    work.Fit.ApplyInverse(forces);
    v = forces / forces.cwiseAbs().maxCoeff();
  }
  return v.array().abs().rowwise().maxCoeff() > resolved;
}

/// What the error of the mean adds to the variance of the fit that is prepared, in units of s^2. The
/// variance of exact values is in units of s^2 / mu, with mu = 1. `held`: vertices that the data hold.
Vector SmoothInterpolation::VarianceOfMean(
  Work& work, const Flags& held, bool isExact, const ProgressMonitor& progress) const
{
  const ScatteredValues& rows = work.Rows;
  const auto n = static_cast<Index>(held.size());
  if (!(this->Options.Kappa > 0.0))
  {
    return Vector::Zero(n);
  }
  if (work.EnergyOfMean < 0.0)
  {
    ScatteredValues weightless = rows;
    weightless.Weights.setZero();
    SmoothFit prior(work.Energy, weightless, Work::IsRegularMesh(*this->Assembly), this->Parallel);
    const PivotCounts pivots = prior.Prepare(1.0, work.None, false, progress);
    const Values weights = rows.Weights / work.TotalWeight;
    // Constants that have no energy within round-off leave no error: all of it is in the fit.
    work.EnergyOfMean = 0.0;
    if (pivots.Open + pivots.Negative == 0)
    {
      work.EnergyOfMean = std::max(0.0, weights.cwiseProduct(prior.InverseAtPoints(weights)).sum());
    }
  }
  Values ones = held.select(Values::Ones(n, 1), 0.0);
  work.Fit.Solve(Values::Ones(rows.Count(), 1), ones);
  const double ofNoise = isExact ? 0.0 : 1.0 / work.TotalWeight;
  const double variance = ofNoise + work.EnergyOfMean / work.Fit.GetSmoothing();
  return variance * (1.0 - ones.col(0).array()).square();
}

} // namespace SurfaceDiffusion
