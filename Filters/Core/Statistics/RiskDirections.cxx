// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Statistics/RiskDirections.h"

#include "Core/Foundation/Random.h"
#include "Core/Statistics/MeasuredVertices.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <numeric>
#include <tuple>

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

double RandomSign(std::size_t direction, Eigen::Index column, std::int64_t rank)
{
  return UniformRandom(static_cast<int>(direction), column, rank) < 0.5 ? -1.0 : 1.0;
}

/// The rank of each cell by the mean of its data in its part of the surface. Cells that were one when
/// they were measured have that of the first.
std::vector<std::int64_t> RankCells(const CellTransfer& cells, const std::vector<Index>& givenCells,
  const PointData& data, const std::vector<VertexRange>& parts)
{
  std::vector<std::size_t> partOf(static_cast<std::size_t>(data.Given.rows()));
  for (std::size_t part = 0; part < parts.size(); ++part)
  {
    std::fill(partOf.begin() + parts[part].Begin, partOf.begin() + parts[part].End, part);
  }
  std::vector<std::tuple<std::size_t, double, Index>> order;
  for (Index c = 0; c < cells.NumberOfCells(); ++c)
  {
    if (cells.Participates(c))
    {
      Index vertex = 0;
      cells.ForEachVertexOf(c, [&](Index i) { vertex = i; });
      const auto row = [&](Index i) { return data.Missing[i] ? 0.0 : data.Given.row(i).sum(); };
      order.emplace_back(partOf[static_cast<std::size_t>(vertex)], cells.MeanOver(c, row), c);
    }
  }
  std::sort(order.begin(), order.end());
  std::vector<std::int64_t> ranks(static_cast<std::size_t>(cells.NumberOfCells()), 0);
  std::map<Index, std::int64_t> rankOfMeasured;
  std::size_t lastPart = 0;
  std::int64_t next = 0;
  for (const auto& [part, mean, c] : order)
  {
    next = part == lastPart ? next : 0;
    lastPart = part;
    const Index measured = givenCells.empty() ? c : givenCells[static_cast<std::size_t>(c)];
    const auto [entry, isNew] = rankOfMeasured.try_emplace(measured, next);
    next += isNew ? 1 : 0;
    ranks[static_cast<std::size_t>(c)] = entry->second;
  }
  return ranks;
}

} // namespace

int NumberOfRiskDirections(Index numberOfVertices)
{
  return std::clamp(8000 / std::max(numberOfVertices, Index{ 1 }), Index{ 1 }, Index{ 8 });
}

void SetRiskDirections(const TriangleMesh& mesh, const SparsePattern& pattern,
  const Eigen::Ref<const Points>& points, const PointData& data, VertexRange range, double noise,
  std::size_t count, std::vector<Values>& directions)
{
  directions.resize(
    std::max(directions.size(), count), Values::Zero(data.Given.rows(), data.Given.cols()));
  const auto isUsed = [&](Index i)
  {
    return !data.Fixed[i] && data.FidelityFactor(i) > 0.0 &&
      !(data.Measured && data.Measured->IsBetween[i]);
  };
  std::int64_t rank = 0;
  for (const Index i : SortByValues(mesh, points, data.Given, range))
  {
    for (Eigen::Index k = 0; isUsed(i) && k < data.Given.cols(); ++k)
    {
      const double deviation =
        DeviationAt(i, k, data, pattern, noise / std::sqrt(data.FidelityFactor(i))) / noise;
      for (std::size_t d = 0; d < count; ++d)
      {
        directions[d](i, k) = RandomSign(d, k, rank) * deviation;
      }
    }
    rank += isUsed(i) ? 1 : 0;
  }
  for (std::size_t d = 0; d < count && data.Measured; ++d)
  {
    InterpolateBetween(mesh, pattern, points, data, range, directions[d]);
  }
}

void SetRiskDirectionsOfCells(const CellTransfer& cells, const std::vector<Index>& givenCells,
  const PointData& data, const PointData& compared, const std::vector<VertexRange>& parts,
  double gain, std::vector<Values>& directions)
{
  const std::vector<std::int64_t> ranks = RankCells(cells, givenCells, data, parts);
  for (std::size_t d = 0; d < directions.size(); ++d)
  {
    Values signs(cells.NumberOfCells(), data.Given.cols());
    for (Eigen::Index c = 0; c < signs.rows(); ++c)
    {
      for (Eigen::Index k = 0; k < signs.cols(); ++k)
      {
        signs(c, k) = RandomSign(d, k, ranks[static_cast<std::size_t>(c)]);
      }
    }
    directions[d] = cells.ToVertices(signs, Vector::Ones(cells.NumberOfCells())).Of;
    for (Index i = 0; i < static_cast<Index>(directions[d].rows()); ++i)
    {
      const bool isBetween = data.Measured && data.Measured->IsBetween[i];
      const double factor = (isBetween ? data : compared).FidelityFactor(i);
      const bool isUsed = !data.Fixed[i] && factor > 0.0;
      directions[d].row(i) *= isUsed ? 1.0 / (gain * std::sqrt(factor)) : 0.0;
    }
  }
}

} // namespace SurfaceDiffusion
