// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
//
// InfluenceSpectrum: the smoothing that a criterion chooses.

#include "Core/Models/Interpolation/InfluenceSpectrum.h"

#include <algorithm>
#include <cmath>

namespace SurfaceDiffusion
{

namespace
{

constexpr double LeastDifference = 1e-8; ///< difference of eigenvalues from 0 and 1
constexpr double PriorExponent = 0.1; ///< a of the likelihood

} // namespace

double InfluenceSpectrum::BestSmoothing(Eigen::Index column, double noise) const
{
  if (noise > 0.0)
  {
    return this->Minimiser(Criterion::Risk, column, noise);
  }
  constexpr double most = 0.9;
  const double mu = this->Minimiser(Criterion::Score, column, noise);
  const bool isDoubtful = this->IsExact && this->DegreesOfFreedom(mu) > most * this->Count;
  return isDoubtful ? std::max(mu, this->Minimiser(Criterion::Likelihood, column, noise)) : mu;
}

double InfluenceSpectrum::Minimiser(Criterion criterion, Eigen::Index column, double noise) const
{
  const auto cost = [&](double exponent)
  { return this->CostOf(criterion, this->Mu * std::exp(exponent), column, noise); };
  // The range in which degrees of freedom change, as far as it is resolved.
  constexpr double margin = 4.6; // a factor of 100
  constexpr double farthest = 40.0;
  constexpr double nearest = 2.3; // a factor of 10, over which the residual is resolved
  double low = 0.0;
  double high = 0.0;
  for (const auto& [share, weight] : this->Trace)
  {
    if (share > LeastDifference && share < 1.0 - LeastDifference && weight > 0.0)
    {
      const double own = std::log(share / (1.0 - share)); // of its mu over mu_0
      low = std::min(low, own);
      high = std::max(high, own);
    }
  }
  low = std::max(this->IsExact ? low - margin : -nearest, -farthest);
  high = std::min(this->IsExact ? high + margin : nearest, farthest);
  constexpr int intervals = 200;
  double best = this->IsExact ? low : 0.0;
  for (int i = 1; i <= intervals && this->IsExact; ++i)
  {
    const double x = low + (high - low) * i / intervals;
    best = cost(x) < cost(best) ? x : best;
  }
  // Far from mu_0 the measures of many values are rough: downhill from it.
  const double step = (high - low) / intervals;
  for (const double way : { step, -step })
  {
    while (
      !this->IsExact && best + way >= low && best + way <= high && cost(best + way) < cost(best))
    {
      best += way;
    }
  }
  double left = std::max(low, best - step);
  double right = std::min(high, best + step);
  // The minimum is where the slope changes its sign, which is sharper than the least value.
  for (int i = 0; i < 60; ++i)
  {
    const double middle = 0.5 * (left + right);
    const double mu = this->Mu * std::exp(middle);
    (this->SlopeOf(criterion, mu, column, noise) > 0.0 ? right : left) = middle;
  }
  return this->Mu * std::exp(0.5 * (left + right));
}

double InfluenceSpectrum::CostOf(
  Criterion criterion, double mu, Eigen::Index column, double noise) const
{
  if (criterion == Criterion::Score)
  {
    return this->Score(mu, column);
  }
  if (criterion == Criterion::Risk)
  {
    return this->Residual(mu, column) + 2.0 * noise * noise * this->DegreesOfFreedom(mu);
  }
  double square = 0.0;
  for (const auto& [share, weight] : this->Columns[static_cast<std::size_t>(column)])
  {
    square += weight * Left(share, mu / this->Mu);
  }
  double logarithms = 0.0;
  double count = 0.0;
  for (const auto& [share, weight] : this->Trace)
  {
    if (share < 1.0 - LeastDifference)
    {
      logarithms += weight * std::log(Left(share, mu / this->Mu));
      count += weight;
    }
  }
  const double prior = PriorExponent * std::log(mu);
  return count > 0.0 ? std::log(square) - (logarithms + prior) / count : 0.0;
}

/// Of CostOf() by log(mu), up to a positive factor.
double InfluenceSpectrum::SlopeOf(
  Criterion criterion, double mu, Eigen::Index column, double noise) const
{
  const double ratio = mu / this->Mu;
  double square = 0.0;
  double ofSquare = 0.0;
  double ofResidual = 0.0;
  for (const auto& [share, weight] : this->Columns[static_cast<std::size_t>(column)])
  {
    const double left = Left(share, ratio);
    square += weight * left;
    ofSquare += weight * left * (1.0 - left);
    ofResidual += 2.0 * weight * left * left * (1.0 - left);
  }
  double count = 0.0;
  double ofLogarithms = 0.0;
  double ofFreedom = 0.0;
  for (const auto& [share, weight] : this->Trace)
  {
    const double left = Left(share, ratio);
    ofFreedom -= weight * left * (1.0 - left);
    if (share < 1.0 - LeastDifference)
    {
      count += weight;
      ofLogarithms += weight * (1.0 - left);
    }
  }
  switch (criterion)
  {
    case Criterion::Risk:
      return ofResidual + 2.0 * noise * noise * ofFreedom;
    case Criterion::Likelihood:
      return ofSquare * count - square * (ofLogarithms + PriorExponent);
    default:
      return ofResidual * (this->Count - this->DegreesOfFreedom(mu)) +
        2.0 * this->Residual(mu, column) * ofFreedom;
  }
}

} // namespace SurfaceDiffusion
