// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
//
// The standard error of SmoothInterpolation over the distribution of a mu that is found.

#include "Core/Models/Interpolation/SlopeSquares.h"
#include "Core/Models/Interpolation/SmoothInterpolationWork.h"
#include "Core/Models/Interpolation/SmoothingPosterior.h"
#include "Core/Statistics/StudentFactor.h"

#include <algorithm>
#include <array>
#include <cmath>
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

/// Of many values, whose eigenvectors are not known: the distribution of SmoothingPosterior from factors at
/// several mu, with log(prod (1 - s)) = (r - k) log(mu) - log(det(H)) + const of H with r rows, where k
/// functions have no energy, and with the mu_h of Weyl's law. u: the fit of the column, of the mu that
/// work.Fit is prepared with, which it is not any more then. Empty if a factor fails.
std::pair<Vector, Vector> SmoothInterpolation::ErrorOverFactors(
  Work& work, Eigen::Index column, const Values& u, const ProgressMonitor& progress) const
{
  constexpr std::array<double, 10> steps = { 0.0, 1.0, 2.0, 3.0, 4.0, 6.0, 8.0, 11.0, 15.0, 20.0 };
  constexpr double least = 0.01; // weight beside the largest
  constexpr double pi = 3.14159265358979323846;
  const RepeatedValues& rows = work.Rows;
  double done = 0.0; // of at most 20 factors
  const auto prepare = [&](double mu)
  {
    done = std::min(done + 0.05, 0.95);
    const PivotCounts pivots =
      work.Fit.Prepare(mu, work.None, false, progress.Part(done - 0.05, done - 0.02));
    return pivots.Open + pivots.Negative == 0;
  };
  const auto rest = [&](double from, double to)
  { return progress.Part(done - 0.02 + 0.02 * from, done - 0.02 + 0.02 * to); };
  const double count = rows.Count();
  const double middle = work.TotalWeight * work.Area / std::pow(2.0 * pi * count, 2);
  const double fitted = work.Fit.GetSmoothing();
  // Only functions without energy are left of the trace.
  if (!prepare(std::min(work.LargestSmoothing(), 1e4 * count * count * middle)))
  {
    return {};
  }
  const double free =
    std::round(rows.Weights.cwiseProduct(work.Fit.VarianceAtPoints(rest(0.0, 1.0))).sum());
  const double freedom = count - free + rows.Repeats.sum();
  const double student = this->Options.NoiseLevel > 0.0 ? 1.0 : StudentFactor(freedom);
  const SlopeSquares slopes(this->Assembly->Mesh(), this->Parallel);
  const Vector given = rows.Given.col(column);
  double most = -std::numeric_limits<double>::infinity();
  double sum = 0.0;
  Vector squares = Vector::Zero(u.rows());
  Vector ofSlopes = squares;
  const auto add = [&](double mu, double width) // returns false where the distribution ends
  {
    if (!prepare(mu))
    {
      return false;
    }
    Values other = u;
    work.Fit.Solve(given, other);
    const double misfit =
      given.dot(rows.Weights.cwiseProduct(given - work.Fit.AtPoints(other).col(0))) +
      rows.Scatter.col(column).sum();
    const double noise = this->Options.NoiseLevel;
    double logarithm = SmoothingPosterior::LogPrior(mu / middle) +
      0.5 * ((work.Fit.NumberOfRows() - free) * std::log(mu) - work.Fit.LogDeterminant());
    logarithm -= noise > 0.0 ? 0.5 * misfit / (noise * noise) : 0.5 * freedom * std::log(misfit);
    if (logarithm > most)
    {
      const double scale = std::exp(most - logarithm);
      sum *= scale;
      squares *= scale;
      ofSlopes *= scale;
      most = logarithm;
    }
    const double weight = width * std::exp(logarithm - most);
    const double variance = noise > 0.0 ? noise * noise : misfit / freedom;
    const double factor = weight * student * student * variance;
    std::vector<InverseEntry> edges = slopes.Edges();
    const Vector diagonal = work.Fit.InverseDiagonal(rest(0.0, 0.8), &edges);
    const Values step = other - u;
    sum += weight;
    squares += factor *
        (diagonal.cwiseMax(0.0) + this->VarianceOfMean(work, work.None, false, rest(0.8, 1.0))) +
      weight * step.col(0).cwiseAbs2();
    ofSlopes +=
      factor * slopes.OfCovariance(diagonal, edges) + slopes.Of(step, Vector::Constant(1, weight));
    return weight > least * width;
  };
  const double reach = std::exp(SmoothingPosterior::Farthest);
  const double begin =
    std::min({ std::max(fitted, middle / reach), middle * reach, work.LargestSmoothing() });
  for (const double way : { 1.0, -1.0 })
  {
    for (std::size_t k = way > 0.0 ? 0 : 1; k + 1 < steps.size(); ++k)
    {
      const double mu = begin * std::exp(way * steps[k]);
      const bool isIn =
        mu >= middle / reach && mu <= middle * reach && mu <= work.LargestSmoothing();
      const double width = 0.5 * (steps[k + 1] - (k > 0 ? steps[k - 1] : -1.0));
      if (k > 0 && (!isIn || !add(mu, width)))
      {
        break;
      }
      if (k == 0 && !add(mu, width) && !(sum > 0.0))
      {
        return {};
      }
    }
  }
  return { (squares / sum).cwiseSqrt(), (ofSlopes / sum).cwiseSqrt() };
}

} // namespace SurfaceDiffusion
