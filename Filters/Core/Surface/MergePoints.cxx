// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Surface/MergePoints.h"

#include "Core/Foundation/DisjointSets.h"
#include "Core/Surface/SideLengths.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <numeric>

namespace SurfaceDiffusion
{

namespace
{

using Cell = std::array<double, 3>; ///< integers, as doubles that cannot overflow

/// The points sorted into the cells of a grid; with tolerance 0 a cell is one place.
class PointGrid
{
public:
  PointGrid(const Points& points, double tolerance)
    : Cells(static_cast<std::size_t>(points.rows()))
    , Order(this->Cells.size())
  {
    for (std::size_t i = 0; i < this->Cells.size(); ++i)
    {
      for (int k = 0; k < 3; ++k)
      {
        const double x = points(static_cast<Eigen::Index>(i), k);
        this->Cells[i][k] = (tolerance > 0.0 ? std::floor(x / tolerance) : x) + 0.0; // no -0
      }
    }
    std::iota(this->Order.begin(), this->Order.end(), 0);
    std::sort(this->Order.begin(), this->Order.end(),
      [&](Index a, Index b)
      {
        const Cell& first = this->Cells[static_cast<std::size_t>(a)];
        const Cell& second = this->Cells[static_cast<std::size_t>(b)];
        return first != second ? first < second : a < b;
      });
  }

  const Cell& CellOf(Index point) const { return this->Cells[static_cast<std::size_t>(point)]; }

  /// Call visit(j) for the points of a cell, in ascending order.
  template <typename Visitor>
  void VisitCell(const Cell& cell, const Visitor& visit) const
  {
    auto next = std::lower_bound(this->Order.begin(), this->Order.end(), cell,
      [&](Index j, const Cell& sought) { return this->CellOf(j) < sought; });
    for (; next != this->Order.end() && this->CellOf(*next) == cell; ++next)
    {
      visit(*next);
    }
  }

private:
  std::vector<Cell> Cells;
  std::vector<Index> Order;
};

} // namespace

std::vector<Index> MergePoints(const Points& points, double tolerance)
{
  const PointGrid grid(points, tolerance);
  const auto count = static_cast<Index>(points.rows());
  std::vector<Index> representative(static_cast<std::size_t>(count), -1);
  const int reach = tolerance > 0.0 ? 1 : 0;
  for (Index i = 0; i < count; ++i)
  {
    if (representative[static_cast<std::size_t>(i)] >= 0)
    {
      continue;
    }
    const auto take = [&](Index j)
    {
      const bool near = (points.row(i) - points.row(j)).norm() <= tolerance;
      if (representative[static_cast<std::size_t>(j)] < 0 && (j == i || near))
      {
        representative[static_cast<std::size_t>(j)] = i;
      }
    };
    const Cell& center = grid.CellOf(i);
    for (int x = -reach; x <= reach; ++x)
    {
      for (int y = -reach; y <= reach; ++y)
      {
        for (int z = -reach; z <= reach; ++z)
        {
          grid.VisitCell({ center[0] + x, center[1] + y, center[2] + z }, take);
        }
      }
    }
  }
  return representative;
}

std::vector<Index> JoinShortEdges(
  const Points& points, const Triangles& triangles, const ParallelFor& parallel)
{
  constexpr double shortest = 1e-10; // of the longest side of the triangle
  // Halves and the largest component neither overflow nor underflow.
  const auto halfSide = [&](Index t, int a)
  {
    return (0.5 * points.row(triangles(t, Next(a))) - 0.5 * points.row(triangles(t, Last(a))))
      .lpNorm<Eigen::Infinity>();
  };
  const auto visitShort = [&](Index t, const auto& visit)
  {
    const std::array<double, 3> sides{ halfSide(t, 0), halfSide(t, 1), halfSide(t, 2) };
    const double longest = *std::max_element(sides.begin(), sides.end());
    for (int a = 0; a < 3; ++a)
    {
      const Index first = triangles(t, Next(a));
      const Index second = triangles(t, Last(a));
      if (first != second && sides[a] <= shortest * longest)
      {
        visit(first, second);
      }
    }
  };
  const auto count = static_cast<Index>(triangles.rows());
  const double found = Max(parallel, count,
    [&](Index t)
    {
      double any = 0.0;
      visitShort(t, [&](Index, Index) { any = 1.0; });
      return any;
    });
  if (found == 0.0)
  {
    return {};
  }
  DisjointSets sets(static_cast<Index>(points.rows()));
  for (Index t = 0; t < count; ++t)
  {
    visitShort(t, [&](Index first, Index second) { sets.Join(first, second); });
  }
  std::vector<Index> representative(static_cast<std::size_t>(points.rows()));
  for (Index i = 0; i < static_cast<Index>(points.rows()); ++i)
  {
    representative[static_cast<std::size_t>(i)] = sets.Find(i);
  }
  return representative;
}

} // namespace SurfaceDiffusion
