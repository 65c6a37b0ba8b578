// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Models/Interpolation/Outliers.h"

#include "Core/Foundation/Quantile.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace SurfaceDiffusion
{

namespace
{

/// Quantiles of the magnitudes of normal numbers. Where a fit is worse in some places than in others, the
/// second one says more of the deviation there; a tenth of outliers raise it by a quarter.
struct Quantile
{
  double Fraction;
  double Deviations;
};
constexpr Quantile Median = { 0.5, 0.6745 };
constexpr Quantile Upper = { 0.8, 1.2816 };
/// Outliers are farther from the result without them than this share of the range of most values.
constexpr double LeastShareOfRange = 0.02;
/// Beyond so many deviations Huber's weights fall; they have 95 % of the efficiency of equal ones.
constexpr double HuberDeviations = 1.345;
constexpr int HuberSteps = 5;
constexpr int LargestNumberOfRounds = 20;
constexpr Index FewestValues = 8;
constexpr Index FewestToCount = 20;
/// Of the weight of an outlier, which leaves it without influence, and its leverage known.
constexpr double NoWeight = 1e-6;

double DeviationOf(std::vector<double> magnitudes)
{

  return std::max(QuantileOf(magnitudes, Median.Fraction) / Median.Deviations,
    QuantileOf(magnitudes, Upper.Fraction) / Upper.Deviations);
}

/// From the tenth to the ninetieth percentile.
double RangeOfMost(const Vector& values)
{
  std::vector<double> sorted(values.data(), values.data() + values.size());
  std::sort(sorted.begin(), sorted.end());
  const std::size_t tenth = sorted.size() / 10;
  return sorted[sorted.size() - 1 - tenth] - sorted[tenth];
}

/// Per value, in units of 1/sqrt(w): the residual over the deviation of residuals of this leverage, and
/// the residual of the fit without it.
struct Standardized
{
  Vector Residuals;
  Vector WithoutIt;
};

/// weights: those of the fit.
Standardized Standardize(
  const ScatteredValues& data, const SmoothInterpolation::Result& fit, const Vector& weights)
{
  const Vector residuals = ResidualsOf(data, fit.U).col(0);
  Standardized found{ Vector(data.Count()), Vector(data.Count()) };
  for (Index i = 0; i < data.Count(); ++i)
  {
    const double leverage = std::min(fit.Leverage(i, 0), 1.0 - 1e-9);
    const bool isIn = weights[i] > NoWeight * data.Weights[i];
    const double ofField = leverage * data.Weights[i] / weights[i]; // w_i H^-1_ii
    const double variance = isIn ? 1.0 - leverage : 1.0 + ofField;
    found.Residuals[i] = std::abs(residuals[i]) * std::sqrt(data.Weights[i] / variance);
    found.WithoutIt[i] = std::abs(residuals[i]) / (isIn ? 1.0 - leverage : 1.0);
  }
  return found;
}

} // namespace

Values ResidualsOf(const ScatteredValues& data, const Values& u)
{
  return data.Given - data.AtPlaces(u);
}

Index CountOutliers(const ScatteredValues& data, const Values& residuals, Eigen::Index column)
{
  const Index count = data.Count();
  if (count < FewestToCount)
  {
    return 0;
  }
  std::vector<double> magnitudes;
  magnitudes.reserve(static_cast<std::size_t>(count));
  for (Index i = 0; i < count; ++i)
  {
    magnitudes.push_back(std::abs(residuals(i, column)) * std::sqrt(data.Weights[i]));
  }
  const double sigma = DeviationOf(magnitudes);
  const auto beyond = static_cast<Index>(std::count_if(magnitudes.begin(), magnitudes.end(),
    [&](double magnitude) { return magnitude > OutlierDeviations * sigma; }));
  // The probability that white noise has so many: the tail of Poisson's distribution is near its first term.
  const double expected = count * std::erfc(OutlierDeviations / std::sqrt(2.0));
  double probability = std::exp(-expected);
  for (Index k = 1; k <= beyond; ++k)
  {
    probability *= expected / k;
  }
  return beyond > expected && probability < 0.02 ? beyond : 0;
}

std::vector<char> FindOutliers(const SmoothInterpolation& search, const ScatteredValues& data,
  Eigen::Index column, const ProgressMonitor& progress)
{
  const Index count = data.Count();
  std::vector<char> outliers(static_cast<std::size_t>(count), 0);
  if (count < FewestValues)
  {
    return outliers;
  }
  ScatteredValues weighted;
  weighted.Places = data.Places;
  weighted.Given = data.Given.col(column);
  weighted.Weights = data.Weights;
  ScatteredValues own = weighted; // with the given weights
  double last = std::numeric_limits<double>::infinity();
  double sigma = last;
  const double least = LeastShareOfRange * RangeOfMost(own.Given);
  Standardized standardized;
  const Vector& magnitudes = standardized.Residuals;
  const auto fit = [&](double begin, double end)
  {
    standardized =
      Standardize(own, search.Fit(weighted, progress.Part(begin, end)), weighted.Weights);
  };
  for (int step = 0; step < HuberSteps; ++step)
  {
    fit(0.5 * step / HuberSteps, 0.5 * (step + 1) / HuberSteps);
    sigma = DeviationOf({ magnitudes.data(), magnitudes.data() + count });
    for (Index i = 0; i < count; ++i)
    {
      const double bound = HuberDeviations * sigma;
      weighted.Weights[i] =
        own.Weights[i] * (magnitudes[i] > bound ? std::max(NoWeight, bound / magnitudes[i]) : 1.0);
    }
    if (!(sigma > 0.0) || std::abs(sigma - last) < 0.05 * sigma)
    {
      break;
    }
    last = sigma;
  }
  for (int round = 0; round < LargestNumberOfRounds && sigma > 0.0; ++round)
  {
    std::vector<char> found(static_cast<std::size_t>(count), 0);
    for (Index i = 0; i < count; ++i)
    {
      found[static_cast<std::size_t>(i)] =
        magnitudes[i] > OutlierDeviations * sigma && standardized.WithoutIt[i] > least ? 1 : 0;
      weighted.Weights[i] = (found[static_cast<std::size_t>(i)] ? NoWeight : 1.0) * own.Weights[i];
    }
    if (round > 0 && found == outliers)
    {
      break;
    }
    outliers = found;
    fit(0.5 + 0.5 * round / LargestNumberOfRounds, 0.5 + 0.5 * (round + 1) / LargestNumberOfRounds);
    std::vector<double> kept;
    for (Index i = 0; i < count; ++i)
    {
      if (!outliers[static_cast<std::size_t>(i)])
      {
        kept.push_back(magnitudes[i]);
      }
    }
    sigma = DeviationOf(kept);
  }
  progress.Report(1.0);
  return outliers;
}

} // namespace SurfaceDiffusion
