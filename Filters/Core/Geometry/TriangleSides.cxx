// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Geometry/TriangleSides.h"

#include <array>
#include <cstddef>
#include <tuple>
#include <utility>

namespace SurfaceDiffusion
{

bool IsCollapsed(const Triangles& triangles, Index t)
{
  return triangles(t, 0) == triangles(t, 1) || triangles(t, 1) == triangles(t, 2) ||
    triangles(t, 2) == triangles(t, 0);
}

TriangleSides SortSides(const Triangles& triangles)
{
  TriangleSides sides;
  sides.reserve(3 * static_cast<std::size_t>(triangles.rows()));
  for (Index t = 0; t < static_cast<Index>(triangles.rows()); ++t)
  {
    if (IsCollapsed(triangles, t))
    {
      continue;
    }
    for (int a = 0; a < 3; ++a)
    {
      const Index from = triangles(t, a);
      const Index to = triangles(t, (a + 1) % 3);
      sides.push_back({ std::min(from, to), std::max(from, to), t, a, from < to });
    }
  }
  std::sort(sides.begin(), sides.end(),
    [](const TriangleSide& a, const TriangleSide& b)
    { return std::tie(a.Low, a.High, a.Triangle) < std::tie(b.Low, b.High, b.Triangle); });
  return sides;
}

EdgeDefects FindEdgeDefects(const Triangles& triangles, Index numberOfVertices)
{
  EdgeDefects defects;
  defects.IsRim.assign(static_cast<std::size_t>(numberOfVertices), 0);
  ForEachEdge(SortSides(triangles),
    [&](auto first, auto last)
    {
      const auto count = last - first;
      const auto rising =
        std::count_if(first, last, [](const TriangleSide& side) { return side.Rises; });
      defects.Open += count == 1;
      defects.NonManifold += count > 2;
      defects.Misoriented += count > 1 && 2 * rising != count;
      if (count != 2)
      {
        defects.IsRim[static_cast<std::size_t>(first->Low)] = 1;
        defects.IsRim[static_cast<std::size_t>(first->High)] = 1;
      }
    });
  return defects;
}

std::vector<Index> FindFirsts(const Triangles& triangles)
{
  using Corners = std::array<Index, 3>;
  std::vector<std::pair<Corners, Index>> sorted;
  sorted.reserve(static_cast<std::size_t>(triangles.rows()));
  for (Index t = 0; t < static_cast<Index>(triangles.rows()); ++t)
  {
    Corners corners{ triangles(t, 0), triangles(t, 1), triangles(t, 2) };
    std::sort(corners.begin(), corners.end());
    sorted.emplace_back(corners, t);
  }
  std::sort(sorted.begin(), sorted.end());
  std::vector<Index> firsts(sorted.size());
  for (std::size_t k = 0; k < sorted.size(); ++k)
  {
    const bool isFirst = k == 0 || sorted[k].first != sorted[k - 1].first;
    firsts[static_cast<std::size_t>(sorted[k].second)] =
      isFirst ? sorted[k].second : firsts[static_cast<std::size_t>(sorted[k - 1].second)];
  }
  return firsts;
}

} // namespace SurfaceDiffusion
