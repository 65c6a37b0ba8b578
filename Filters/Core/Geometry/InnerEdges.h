// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Core/Surface/TriangleMesh.h"

#include <algorithm>
#include <tuple>
#include <vector>

namespace SurfaceDiffusion
{

/// body(low, high, first, second) for the edges with two triangles, by their two vertices, ascending,
/// and the vertices opposite. At an edge of more triangles, for each pair that follows each other.
template <typename Body>
void ForEachInnerEdge(const TriangleMesh& mesh, const Body& body)
{
  using Side = std::tuple<Index, Index, Index>; // two vertices and the one opposite
  std::vector<Side> sides;
  sides.reserve(3 * static_cast<std::size_t>(mesh.NumberOfTriangles()));
  for (Index c = 0; c < 3 * mesh.NumberOfTriangles(); ++c)
  {
    const auto [low, high] = std::minmax({ mesh.OtherCorner(c, 1), mesh.OtherCorner(c, 2) });
    sides.emplace_back(low, high, mesh.TriangleVertices()(c / 3, c % 3));
  }
  std::sort(sides.begin(), sides.end());
  for (std::size_t k = 0; k + 1 < sides.size(); ++k)
  {
    const auto [low, high, first] = sides[k];
    const auto [otherLow, otherHigh, second] = sides[k + 1];
    if (low == otherLow && high == otherHigh)
    {
      body(low, high, first, second);
    }
  }
}

} // namespace SurfaceDiffusion
