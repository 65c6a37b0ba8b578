// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Statistics/UnbiasedRisk.h"

#include "Core/Foundation/Random.h"
#include "Core/Statistics/MeasuredVertices.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <vector>

namespace SurfaceDiffusion
{

namespace
{

constexpr double OutlierMargin = 2.0; ///< of the noise

/// The vertices of the range by their values, and by their places where these are equal.
std::vector<Index> SortByValues(const TriangleMesh& mesh, const Eigen::Ref<const Points>& points,
  const Values& values, VertexRange range)
{
  std::vector<Index> order(static_cast<std::size_t>(range.Size()));
  std::iota(order.begin(), order.end(), range.Begin);
  std::sort(order.begin(), order.end(),
    [&](Index a, Index b)
    {
      const auto ofA = values.row(a);
      const auto ofB = values.row(b);
      if (ofA != ofB)
      {
        return std::lexicographical_compare(ofA.begin(), ofA.end(), ofB.begin(), ofB.end());
      }
      const auto placeOfA = points.row(mesh.InputVertex()[a]);
      const auto placeOfB = points.row(mesh.InputVertex()[b]);
      return placeOfA != placeOfB ? std::lexicographical_compare(placeOfA.begin(), placeOfA.end(),
                                      placeOfB.begin(), placeOfB.end())
                                  : a < b;
    });
  return order;
}

/// The noise at vertex i: of deviation `noise`, unless it is an outlier.
double DeviationAt(
  Index i, Eigen::Index column, const PointData& data, const SparsePattern& pattern, double noise)
{
  const double own = data.Given(i, column);
  double least = std::numeric_limits<double>::infinity();
  double largest = -least;
  double sum = 0.0;
  double count = 0.0;
  for (Index slot = pattern.Outer[i]; slot < pattern.Outer[i + 1]; ++slot)
  {
    if (const Index j = pattern.Inner[slot]; j != i && data.FidelityFactor(j) > 0.0)
    {
      const double value = data.Given(j, column);
      least = std::min(least, value);
      largest = std::max(largest, value);
      sum += value;
      count += 1.0;
    }
  }
  const bool isOutlier =
    count > 0.0 && (own > largest + OutlierMargin * noise || own < least - OutlierMargin * noise);
  return isOutlier ? std::abs(own - sum / count) : noise;
}

/// Rows of vertices in between, as their data are made: linearly along the straight line through the
/// two neighbours between which the vertex lies, the halves of an edge that was bisected, each of
/// which may be bisected again.
void InterpolateBetween(const TriangleMesh& mesh, const SparsePattern& pattern,
  const Eigen::Ref<const Points>& points, const PointData& data, VertexRange range,
  Values& direction)
{
  struct Middle
  {
    Index Vertex, Ends[2];
    double Share; ///< of the first end
  };
  std::vector<Middle> middles;
  for (Index i = range.Begin; i < range.End; ++i)
  {
    if (!data.Measured->IsBetween[i] || data.Fixed[i])
    {
      continue;
    }
    const auto to = [&](Index slot) -> Eigen::RowVector3d {
      return points.row(mesh.InputVertex()[pattern.Inner[slot]]) -
        points.row(mesh.InputVertex()[i]);
    };
    Middle middle{ i, { i, i }, 0.5 };
    double least = std::numeric_limits<double>::infinity(); // cosine
    for (Index j = pattern.Outer[i]; j < pattern.Outer[i + 1]; ++j)
    {
      for (Index k = pattern.Outer[i]; k < j; ++k)
      {
        const double lengthOfJ = to(j).norm();
        const double lengthOfK = to(k).norm();
        const double cosine = to(j).dot(to(k)) / (lengthOfJ * lengthOfK);
        if (cosine < least)
        {
          least = cosine;
          middle = { i, { pattern.Inner[j], pattern.Inner[k] },
            lengthOfK / (lengthOfJ + lengthOfK) };
        }
      }
    }
    middles.push_back(middle);
  }
  for (int sweep = 0; sweep < 50; ++sweep)
  {
    for (const Middle& middle : middles)
    {
      direction.row(middle.Vertex) = middle.Share * direction.row(middle.Ends[0]) +
        (1.0 - middle.Share) * direction.row(middle.Ends[1]);
    }
  }
}

} // namespace

int NumberOfRiskDirections(Index numberOfVertices)
{
  return std::clamp(8000 / std::max(numberOfVertices, Index{ 1 }), Index{ 1 }, Index{ 8 });
}

void SetRiskDirection(const TriangleMesh& mesh, const SparsePattern& pattern,
  const Eigen::Ref<const Points>& points, const PointData& data, VertexRange range, double noise,
  int number, Values& direction)
{
  const auto isUsed = [&](Index i)
  {
    return !data.Fixed[i] && data.FidelityFactor(i) > 0.0 &&
      !(data.Measured && data.Measured->IsBetween[i]);
  };
  direction.middleRows(range.Begin, range.Size()).setZero();
  std::int64_t rank = 0;
  for (const Index i : SortByValues(mesh, points, data.Given, range))
  {
    if (isUsed(i))
    {
      for (Eigen::Index k = 0; k < direction.cols(); ++k)
      {
        const double sign = UniformRandom(number, k, rank) < 0.5 ? -1.0 : 1.0;
        direction(i, k) = sign *
          DeviationAt(i, k, data, pattern, noise / std::sqrt(data.FidelityFactor(i))) / noise;
      }
      ++rank;
    }
  }
  if (data.Measured)
  {
    InterpolateBetween(mesh, pattern, points, data, range, direction);
  }
}

NoiseResponse MeasureNoiseResponse(const TriangleMesh& mesh, const PointData& data, const Values& u,
  const std::vector<Values>& changed, const std::vector<Values>& directions, int count, double step,
  VertexRange range)
{
  NoiseResponse found;
  double area = 0.0;
  for (Index i = range.Begin; i < range.End; ++i)
  {
    const double factor = data.FidelityFactor(i);
    if (factor > 0.0)
    {
      const double weight = mesh.ControlAreas()[i] * factor;
      area += mesh.ControlAreas()[i];
      found.MeanSquare += weight * (u.row(i) - data.Given.row(i)).squaredNorm();
      for (std::size_t d = 0; d < static_cast<std::size_t>(count); ++d)
      {
        const auto p = directions[d].row(i);
        const Eigen::RowVectorXd kept = (changed[d].row(i) - u.row(i)) / step;
        found.Freedom += weight / count * p.dot(kept);
        found.Removed += weight / count * (p - kept).squaredNorm();
        found.Direction += weight / count * p.squaredNorm();
      }
    }
  }
  const double total = area * static_cast<double>(u.cols());
  if (total > 0.0)
  {
    found.MeanSquare /= total;
    found.Freedom /= total;
    found.Removed /= total;
    found.Direction /= total;
  }
  return found;
}

} // namespace SurfaceDiffusion
