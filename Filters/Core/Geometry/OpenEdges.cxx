// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Geometry/OpenEdges.h"

#include "Core/Foundation/Quantile.h"
#include "Core/Surface/MergePoints.h"

#include <algorithm>
#include <cstddef>
#include <numeric>

namespace SurfaceDiffusion
{

namespace
{

constexpr double Rounding = 1e-5; ///< of the diagonal
constexpr double RoundingOfEdges = 0.01; ///< of the median edge

} // namespace

TriangleSides OpenSides(const Triangles& triangles)
{
  const std::vector<Index> firsts = FindFirsts(triangles);
  TriangleSides open;
  TriangleSides sides = SortSides(triangles);
  sides.erase(std::remove_if(sides.begin(), sides.end(),
                [&](const TriangleSide& side) { return firsts[side.Triangle] != side.Triangle; }),
    sides.end());
  ForEachEdge(sides,
    [&](auto first, auto last)
    {
      if (last - first == 1)
      {
        open.push_back(*first);
      }
    });
  return open;
}

std::vector<Index> EndsOf(const TriangleSides& sides)
{
  std::vector<Index> ends;
  for (const TriangleSide& side : sides)
  {
    ends.insert(ends.end(), { side.Low, side.High });
  }
  std::sort(ends.begin(), ends.end());
  ends.erase(std::unique(ends.begin(), ends.end()), ends.end());
  return ends;
}

double DefaultWeldTolerance(const Points& points, const Triangles& triangles)
{
  TriangleSides sides = OpenSides(triangles);
  if (sides.empty())
  {
    sides = SortSides(triangles);
  }
  if (sides.empty())
  {
    return 0.0;
  }
  std::vector<double> lengths;
  lengths.reserve(sides.size());
  for (const TriangleSide& side : sides)
  {
    lengths.push_back((points.row(side.Low) - points.row(side.High)).norm());
  }
  const double diagonal = (points.colwise().maxCoeff() - points.colwise().minCoeff()).norm();
  return std::min(Rounding * diagonal, RoundingOfEdges * QuantileOf(lengths, 0.5));
}

std::vector<Index> JoinOpenEdges(const Points& points, const Triangles& triangles, double tolerance)
{
  std::vector<Index> pointOf(static_cast<std::size_t>(points.rows()));
  std::iota(pointOf.begin(), pointOf.end(), 0);
  const std::vector<Index> ends = EndsOf(OpenSides(triangles));
  Points places(static_cast<Eigen::Index>(ends.size()), 3);
  for (std::size_t k = 0; k < ends.size(); ++k)
  {
    places.row(static_cast<Eigen::Index>(k)) = points.row(ends[k]);
  }
  const std::vector<Index> merged = MergePoints(places, tolerance);
  for (std::size_t k = 0; k < ends.size(); ++k)
  {
    pointOf[ends[k]] = ends[merged[k]];
  }
  std::vector<char> isNeeded(pointOf.size(), 0);
  for (Index t = 0; t < static_cast<Index>(triangles.rows()); ++t)
  {
    for (int a = 0; a < 3; ++a)
    {
      const Index i = triangles(t, a);
      const Index j = triangles(t, (a + 1) % 3);
      isNeeded[pointOf[i]] |= static_cast<char>(i != j && pointOf[i] == pointOf[j]);
    }
  }
  for (std::size_t i = 0; i < pointOf.size(); ++i)
  {
    pointOf[i] = isNeeded[pointOf[i]] ? static_cast<Index>(i) : pointOf[i];
  }
  return pointOf;
}

} // namespace SurfaceDiffusion
