// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Geometry/CorrelatedVertexNoise.h"

#include "Core/Geometry/QuadricDistances.h"

#include <Eigen/QR>

#include <algorithm>
#include <cmath>
#include <limits>

namespace SurfaceDiffusion
{

namespace
{

constexpr Index FewestVertices = 3200; ///< four times those within sixteen rings
constexpr double LeastGrowth = 1.3; ///< from two to four rings
constexpr double LeastGrowthToLevel = 1.8; ///< the same, to a level that is given
constexpr double LargestLateGrowth = 1.6; ///< from eight to sixteen rings
constexpr double SmallestTail = 0.8; ///< of Gaussian noise, over sigma_r
constexpr double SmallestCorrelated = 0.1; ///< in h
constexpr double LargestCorrelated = 1.0; ///< in h
constexpr double RadiusOfLength =
  3.0; ///< at which half of the variance is reached, over the length
/// Of FitCorrelation(): how far sigma_r^2 up to eight rings is explained by the noise, and by all terms.
constexpr double SmallestShare = 0.7;
constexpr double LargestMisfit = 0.6;
constexpr double LargestUncertain = 0.5; ///< level that may be relief, in h

/// f of EstimateCorrelatedNoise().
double ShareOfLevel(double rings)
{
  return std::pow(1.0 + std::pow(4.1 / rings, 2.83), -1.06);
}

constexpr Eigen::Index NumberFitted =
  6; ///< without 16 rings, of which the shape is too large a part

/// sigma_r explained by noise of one deviation s of its kernel and by the shape.
struct CorrelationFit
{
  double Level = 0.0; ///< in h
  double Misfit = std::numeric_limits<double>::infinity(); ///< of sigma_r^2, relative
};

/// The best fit with terms of the shape that are not negative, see EstimateCorrelatedNoise().
/// sigmas: in h; s: in edges; leastShare: of the noise.
CorrelationFit FitWithLength(
  const std::vector<int>& rings, const std::vector<double>& sigmas, double s, double leastShare)
{
  using Terms = Eigen::Matrix<double, NumberFitted, 4>;
  Terms terms; // over sigma_r^2
  for (Eigen::Index k = 0; k < NumberFitted; ++k)
  {
    const double r = rings[static_cast<std::size_t>(k)];
    const double sigma = std::max(sigmas[static_cast<std::size_t>(k)], 1e-5);
    const double square = r * r / 144.0;
    terms.row(k) << std::pow(ShareOfLevel(r / s), 2), std::pow(square, 4), std::pow(square, 3), 1.0;
    terms.row(k) /= sigma * sigma;
  }
  CorrelationFit best;
  for (unsigned others = 0; others < 8; ++others) // which of the other terms there are
  {
    Terms chosen = terms;
    for (Eigen::Index j = 0; j < 3; ++j)
    {
      chosen.col(j + 1) *= (others >> j) & 1U;
    }
    const Eigen::Vector4d factors = chosen.completeOrthogonalDecomposition().solve(
      Eigen::Matrix<double, NumberFitted, 1>::Ones());
    const double misfit = ((chosen * factors).array() - 1.0).matrix().norm();
    const double share = (factors[0] * terms.col(0).head<5>()).minCoeff();
    if (misfit < best.Misfit && factors.minCoeff() >= 0.0 && share >= leastShare)
    {
      best = { std::sqrt(factors[0]), misfit };
    }
  }
  return best;
}

std::vector<double> SigmasOf(const std::vector<Deviation>& deviations, double h)
{
  std::vector<double> sigmas;
  sigmas.reserve(deviations.size());
  for (const Deviation& deviation : deviations)
  {
    sigmas.push_back(deviation.Sigma / h);
  }
  return sigmas;
}

/// The noise that may explain sigma_r, by the fit that EstimateCorrelatedNoise() describes.
CorrelatedNoise FitCorrelation(
  const std::vector<int>& rings, const std::vector<Deviation>& deviations, double h)
{
  const std::vector<double> sigmas = SigmasOf(deviations, h);
  double best = LargestMisfit;
  CorrelatedNoise found;
  for (double s = 0.7; s < 8.0; s *= 1.04)
  {
    const CorrelationFit fit = FitWithLength(rings, sigmas, s, SmallestShare);
    if (fit.Misfit < best)
    {
      best = fit.Misfit;
      found = { fit.Level * h, std::sqrt(2.0) * s * h, true };
    }
  }
  const bool isInRange = found.Level > SmallestCorrelated * h && found.Level < LargestUncertain * h;
  return isInRange ? found : CorrelatedNoise();
}

} // namespace

CorrelatedNoise EstimateCorrelatedNoise(
  const TriangleMesh& mesh, const Points& points, double given, const ParallelFor& parallel)
{
  if (mesh.NumberOfVertices() < FewestVertices)
  {
    return CorrelatedNoise();
  }
  const std::vector<int> rings{ 2, 3, 4, 6, 8, 12, 16 };
  const std::vector<Deviation> deviations =
    MeasureDeviations(mesh, points, rings, StrideFor(mesh, EnoughWideNeighbourhoods), parallel);
  const bool hasTails = std::all_of(deviations.begin() + 2, deviations.begin() + 5,
    [](const Deviation& deviation) { return deviation.Tail >= SmallestTail * deviation.Sigma; });
  const double h = mesh.MeanEdgeLength();
  if (given > 0.0 && given * given <= 2.0 * deviations[0].Sigma * deviations[0].Sigma)
  {
    return CorrelatedNoise(); // independent noise explains the level
  }
  const double growth = deviations[2].Sigma / deviations[0].Sigma;
  const double last = deviations.back().Sigma;
  const bool hasLevel = growth > LeastGrowth && hasTails &&
    last < LargestLateGrowth * deviations[4].Sigma && last > SmallestCorrelated * h &&
    last < LargestCorrelated * h;
  const bool reachesLevel = given > 0.0 && growth > LeastGrowthToLevel;
  if (!hasLevel && !reachesLevel)
  {
    return given > 0.0 || growth <= LeastGrowth || !hasTails ? CorrelatedNoise()
                                                             : FitCorrelation(rings, deviations, h);
  }
  const double level = given > 0.0 ? given : last;
  std::size_t k = 1;
  while (k + 1 < rings.size() && 2.0 * deviations[k].Sigma * deviations[k].Sigma < level * level)
  {
    ++k;
  }
  // interpolated between the two numbers of rings
  const double below = deviations[k - 1].Sigma * deviations[k - 1].Sigma;
  const double above = deviations[k].Sigma * deviations[k].Sigma;
  const double share =
    above > below ? std::clamp((0.5 * level * level - below) / (above - below), 0.0, 1.0) : 1.0;
  const double radius = rings[k - 1] + share * (rings[k] - rings[k - 1]);
  return { level, radius * h / RadiusOfLength, false };
}

CorrelatedNoise NoiseOfLength(const TriangleMesh& mesh, const Points& points, double deviation,
  double given, const ParallelFor& parallel)
{
  const double h = mesh.MeanEdgeLength();
  CorrelatedNoise noise{ given, std::sqrt(2.0) * deviation * h, false };
  if (!(given > 0.0))
  {
    const std::vector<int> rings{ 2, 3, 4, 6, 8, 12 };
    const Index stride = StrideFor(mesh, EnoughWideNeighbourhoods);
    const std::vector<double> sigmas =
      SigmasOf(MeasureDeviations(mesh, points, rings, stride, parallel), h);
    noise.Level = h * FitWithLength(rings, sigmas, deviation, 0.0).Level;
  }
  return noise;
}

} // namespace SurfaceDiffusion
