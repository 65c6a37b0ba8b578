// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Geometry/VertexFans.h"

#include <algorithm>
#include <utility>

namespace SurfaceDiffusion
{

namespace
{

/// The corners at a vertex, such that corners that follow each other are of triangles that share an
/// edge, as far as possible.
class FanOrder
{
public:
  FanOrder(const TriangleMesh& mesh, Index vertex)
    : Mesh(mesh)
    , First(mesh.VertexCornersBegin()[vertex])
    , IsListed(static_cast<std::size_t>(NumberOfTrianglesAt(mesh, vertex)), 0)
  {
    const Index end = mesh.VertexCornersBegin()[vertex + 1];
    for (Index k = this->First; k < end; ++k)
    {
      for (const int step : { 1, 2 })
      {
        this->Sides.emplace_back(mesh.OtherCorner(mesh.VertexCorners()[k], step), k);
      }
    }
    std::sort(this->Sides.begin(), this->Sides.end());
    for (const bool fromBoundary : { true, false })
    {
      for (Index k = this->First; k < end; ++k)
      {
        if (!fromBoundary || this->IsAtBoundary(k))
        {
          this->ListFrom(k);
        }
      }
    }
  }

  std::vector<Index> Corners;

private:
  using Side = std::pair<Index, Index>; ///< the other vertex of an edge, and a place of a corner

  std::pair<std::vector<Side>::const_iterator, std::vector<Side>::const_iterator> SidesTo(
    Index other) const
  {
    const auto first = std::lower_bound(this->Sides.begin(), this->Sides.end(), Side(other, 0));
    auto last = first;
    while (last != this->Sides.end() && last->first == other)
    {
      ++last;
    }
    return { first, last };
  }

  Index Other(Index k, int step) const
  {
    return this->Mesh.OtherCorner(this->Mesh.VertexCorners()[k], step);
  }

  bool IsAtBoundary(Index k) const
  {
    const auto isAlone = [&](int step)
    {
      const auto [first, last] = this->SidesTo(this->Other(k, step));
      return last - first == 1;
    };
    return isAlone(1) || isAlone(2);
  }

  /// Go from triangle to triangle until none is left.
  void ListFrom(Index k)
  {
    for (Index next = k; next >= 0 && !this->IsListed[next - this->First];)
    {
      this->IsListed[next - this->First] = 1;
      this->Corners.push_back(this->Mesh.VertexCorners()[next]);
      next = this->NextAfter(next);
    }
  }

  /// A neighbour across an edge that is not listed; -1 if there is none.
  Index NextAfter(Index k) const
  {
    for (const int step : { 1, 2 })
    {
      const auto [first, last] = this->SidesTo(this->Other(k, step));
      // Of the many triangles of one edge, a few are looked at.
      for (auto side = first; side != last && side - first < LargestFan; ++side)
      {
        if (!this->IsListed[side->second - this->First])
        {
          return side->second;
        }
      }
    }
    return -1;
  }

  const TriangleMesh& Mesh;
  const Index First; ///< place in VertexCorners()
  std::vector<Side> Sides;
  std::vector<char> IsListed; ///< per corner at the vertex
};

} // namespace

VertexFans::VertexFans(const TriangleMesh& mesh)
  : Mesh(mesh)
{
  for (Index v = 0; v < mesh.NumberOfVertices(); ++v)
  {
    if (NumberOfTrianglesAt(mesh, v) <= LargestFan)
    {
      continue;
    }
    if (this->TriangleAt.empty())
    {
      this->TriangleAt.resize(3 * static_cast<std::size_t>(mesh.NumberOfTriangles()));
      this->PlaceOfCorner.resize(this->TriangleAt.size());
    }
    const std::vector<Index> corners = FanOrder(mesh, v).Corners;
    for (Index place = 0; place < static_cast<Index>(corners.size()); ++place)
    {
      this->TriangleAt[mesh.VertexCornersBegin()[v] + place] = corners[place] / 3;
      this->PlaceOfCorner[corners[place]] = place;
    }
  }
}

} // namespace SurfaceDiffusion
