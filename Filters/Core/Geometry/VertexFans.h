// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Core/Surface/TriangleMesh.h"

#include <array>
#include <vector>

namespace SurfaceDiffusion
{

/// Around vertices with more triangles, a triangle has not all others as neighbours.
constexpr Index LargestFan = 32;

inline Index NumberOfTrianglesAt(const TriangleMesh& mesh, Index vertex)
{
  return mesh.VertexCornersBegin()[vertex + 1] - mesh.VertexCornersBegin()[vertex];
}

/// The neighbours of triangles at their vertices. At a vertex with up to LargestFan triangles, all
/// of them are neighbours of each other. At one with more, such as the middle of a disc that is cut
/// into slices, a triangle has neighbours 1, 2, 3, 4, 8, 16, ... places before and after itself
/// in the order around the vertex, so that their number grows with the logarithm of the valence.
/// The relation is symmetric.
class VertexFans
{
public:
  explicit VertexFans(const TriangleMesh& mesh);

  /// use(u) for the neighbours u of triangle t at its corner a, maybe several times.
  template <typename Use>
  void ForEachNeighbour(Index t, int a, const Use& use) const
  {
    const Index v = this->Mesh.TriangleVertices()(t, a);
    const Index begin = this->Mesh.VertexCornersBegin()[v];
    const Index count = NumberOfTrianglesAt(this->Mesh, v);
    if (count <= LargestFan)
    {
      for (Index k = begin; k < begin + count; ++k)
      {
        use(this->Mesh.VertexCorners()[k] / 3);
      }
      return;
    }
    const Index place = this->PlaceOfCorner[3 * t + a];
    for (Index step = 1; 2 * step <= count; step += step < 4 ? 1 : step)
    {
      use(this->TriangleAt[begin + (place + step) % count]);
      use(this->TriangleAt[begin + (place + count - step) % count]);
    }
  }

private:
  const TriangleMesh& Mesh;
  /// Of vertices with more than LargestFan triangles; no entries if there are none.
  std::vector<Index> TriangleAt; ///< as VertexCorners(), in the order around the vertex
  std::vector<Index> PlaceOfCorner; ///< in that order, per corner of the triangles
};

} // namespace SurfaceDiffusion
