// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Core/Foundation/Types.h"

#include <algorithm>
#include <vector>

namespace SurfaceDiffusion
{

/// An edge of a triangle, by its vertices.
struct TriangleSide
{
  Index Low, High;
  Index Triangle;
  int Number; ///< of the side in the triangle: from this corner to the next
  bool Rises; ///< whether the triangle passes it from Low to High

  bool IsOfSameEdge(const TriangleSide& other) const
  {
    return this->Low == other.Low && this->High == other.High;
  }
};

using TriangleSides = std::vector<TriangleSide>;

/// The sides of all triangles but collapsed ones, by edge and then by triangle.
TriangleSides SortSides(const Triangles& triangles);

/// body(first, last) for the sides of each edge.
template <typename Body>
void ForEachEdge(const TriangleSides& sides, const Body& body)
{
  for (auto first = sides.begin(); first != sides.end();)
  {
    const auto last = std::find_if(
      first, sides.end(), [&](const TriangleSide& side) { return !side.IsOfSameEdge(*first); });
    body(first, last);
    first = last;
  }
}

/// Whether two corners of triangle t are one point, as merging leaves it: it has no edges.
bool IsCollapsed(const Triangles& triangles, Index t);

/// What printing wants none of, over all edges.
struct EdgeDefects
{
  Index Open = 0; ///< of one triangle
  Index NonManifold = 0; ///< of three or more triangles
  Index Misoriented = 0; ///< not open, and not passed as often one way as the other
  std::vector<char> IsRim; ///< per vertex, whether it is on an open or a non-manifold edge
};

EdgeDefects FindEdgeDefects(const Triangles& triangles, Index numberOfVertices);

/// For each triangle, the first triangle that has the same three corners in any order.
std::vector<Index> FindFirsts(const Triangles& triangles);

} // namespace SurfaceDiffusion
