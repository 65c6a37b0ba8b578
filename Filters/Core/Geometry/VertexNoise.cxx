// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Geometry/VertexNoise.h"

#include "Core/Geometry/QuadricDistances.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace SurfaceDiffusion
{

namespace
{

/// Of larger surfaces, every second, third, ... vertex is used: that many have a quantile within
/// about 1 %.
constexpr Index EnoughVertices = 20000;
/// The least radius of a neighbourhood, in deviations of the noise, and the fraction of vertices whose
/// neighbourhoods may be smaller.
constexpr double LeastRadius = 2.2;
constexpr double NarrowFraction = 0.3;
/// Of sigma in wide neighbourhoods; details have less.
constexpr double LeastShareOfNoise = 0.85;
/// (3/2)^3: the variance of details from three rings of neighbours over that from two.
constexpr double GrowthOfDetails = 3.375;
/// R0 of EstimateVertexNoise().
constexpr double GrowthOfRoughDetails = 1.6;

/// Whether a neighbourhood is so wide that its axes are those of the surface under this noise.
bool IsWide(const QuadricDistance& distance, double noise)
{
  return distance.Radius >= LeastRadius * noise;
}

/// sigma_2 and sigma_3, with so many more rings around each vertex that these are wide under the noise
/// that is found with them.
struct WideDeviations
{
  std::array<Deviation, 2> Of{};
  double NarrowShare = 0.0; ///< of vertices whose two rings are not
};

WideDeviations MeasureInWideNeighbourhoods(
  const TriangleMesh& mesh, const Points& points, const ParallelFor& parallel)
{
  const std::vector<int> rings{ 2, 3, 4, 6, 8, 12 };
  const auto distances =
    MeasureDistances(mesh, points, rings, StrideFor(mesh, EnoughWideNeighbourhoods), parallel);
  const std::size_t count = distances[0].size();
  std::vector<double> start = Standardized(distances[3]);
  double noise = DeviationOf(start).Sigma; // that of two rings may be far too small
  WideDeviations found;
  for (int repetition = 0; repetition < 8; ++repetition)
  {
    std::array<std::vector<double>, 2> of;
    std::size_t narrow = 0;
    for (std::size_t i = 0; i < count; ++i)
    {
      std::size_t k = 0;
      while (k + 2 < rings.size() && !IsWide(distances[k][i], noise))
      {
        ++k;
      }
      narrow += k > 0 ? 1 : 0;
      of[0].push_back(distances[k][i].Standardized);
      of[1].push_back(distances[k + 1][i].Standardized);
    }
    found = { { DeviationOf(of[0]), DeviationOf(of[1]) },
      static_cast<double>(narrow) / static_cast<double>(count) };
    if (std::abs(found.Of[0].Sigma - noise) <= 0.01 * noise)
    {
      break;
    }
    noise = found.Of[0].Sigma;
  }
  return found;
}

/// The noise in sigma_2 and sigma_3, see EstimateVertexNoise().
double WithoutDetails(const std::array<Deviation, 2>& deviations)
{
  const double two = deviations[0].Sigma;
  const double three = std::max(two, deviations[1].Sigma);
  if (!(two > 0.0))
  {
    return 0.0;
  }
  const double growth = three * three / (two * two) - 1.0;
  const double relative = growth / GrowthOfRoughDetails;
  const double rest = 1.0 - GrowthOfRoughDetails / (GrowthOfDetails - 1.0);
  return two *
    std::sqrt(std::max(
      0.0, 1.0 - growth / (GrowthOfDetails - 1.0) - rest * relative * relative * relative));
}

} // namespace

double EstimateVertexNoise(
  const TriangleMesh& mesh, const Points& points, const ParallelFor& parallel)
{
  const std::vector<Deviation> deviations =
    MeasureDeviations(mesh, points, { 2, 3 }, StrideFor(mesh, EnoughVertices), parallel);
  if (!deviations[0].IsOfEnough)
  {
    return std::numeric_limits<double>::quiet_NaN();
  }
  const double noise = WithoutDetails({ deviations[0], deviations[1] });
  const WideDeviations wide = MeasureInWideNeighbourhoods(mesh, points, parallel);
  const double found = WithoutDetails(wide.Of);
  const bool isNoise =
    wide.NarrowShare > NarrowFraction && found > LeastShareOfNoise * wide.Of[0].Sigma;
  return isNoise ? std::max(noise, found) : noise;
}
} // namespace SurfaceDiffusion
