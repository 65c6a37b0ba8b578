// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Surface/MergePoints.h"

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

} // namespace SurfaceDiffusion
