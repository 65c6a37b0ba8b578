// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Geodesics/CurveSides.h"

#include <algorithm>
#include <deque>
#include <map>
#include <set>
#include <utility>

namespace SurfaceDiffusion
{

namespace
{

using VertexPair = std::pair<Index, Index>; ///< vertices, the lower number first

/// The edges that closed curves cross an odd number of times.
class Crossings
{
public:
  explicit Crossings(const TriangleMesh& mesh)
    : Mesh(mesh)
  {
  }

  /// From the triangle of one segment to that of the next one, around a vertex that both have: where the
  /// curve goes over an edge, over this one, and where it goes through the vertex by one of the sides.
  void Add(const PathSegment& from, const PathSegment& to)
  {
    if (from.Triangle == to.Triangle)
    {
      return;
    }
    Index around = -1;
    double nearest = -1.0;
    for (Index a = 0; a < 3; ++a)
    {
      const Index vertex = this->Mesh.TriangleVertices()(from.Triangle, a);
      const double share = from.To[static_cast<std::size_t>(a)];
      if (share > nearest && this->Has(to.Triangle, vertex))
      {
        nearest = share;
        around = vertex;
      }
    }
    if (around >= 0)
    {
      this->Turn(around, from.Triangle, to.Triangle);
    }
  }

  bool IsCrossed(Index i, Index j) const
  {
    return this->Odd.count({ std::min(i, j), std::max(i, j) }) > 0;
  }

private:
  bool Has(Index triangle, Index vertex) const
  {
    const auto row = this->Mesh.TriangleVertices().row(triangle);
    return row[0] == vertex || row[1] == vertex || row[2] == vertex;
  }

  /// Over the edges at a vertex between two of its triangles, as few as possible.
  void Turn(Index vertex, Index from, Index to)
  {
    const std::vector<Index>& begin = this->Mesh.VertexCornersBegin();
    std::multimap<Index, Index> trianglesOf; // per other vertex of an edge here
    for (Index k = begin[static_cast<std::size_t>(vertex)];
         k < begin[static_cast<std::size_t>(vertex) + 1]; ++k)
    {
      const Index corner = this->Mesh.VertexCorners()[static_cast<std::size_t>(k)];
      trianglesOf.emplace(this->Mesh.OtherCorner(corner, 1), corner / 3);
      trianglesOf.emplace(this->Mesh.OtherCorner(corner, 2), corner / 3);
    }
    std::map<Index, std::pair<Index, Index>> cameFrom{ { from, { -1, -1 } } }; // triangle, over
    std::deque<Index> queue{ from };
    while (!queue.empty() && cameFrom.count(to) == 0)
    {
      const Index t = queue.front();
      queue.pop_front();
      for (Index a = 0; a < 3; ++a)
      {
        const Index other = this->Mesh.TriangleVertices()(t, a);
        const auto [first, last] = trianglesOf.equal_range(other);
        for (auto next = first; next != last; ++next)
        {
          if (cameFrom.emplace(next->second, std::pair(t, other)).second)
          {
            queue.push_back(next->second);
          }
        }
      }
    }
    for (Index t = to; t != from && cameFrom.count(t) > 0; t = cameFrom.at(t).first)
    {
      const Index other = cameFrom.at(t).second;
      const VertexPair edge{ std::min(vertex, other), std::max(vertex, other) };
      if (!this->Odd.insert(edge).second)
      {
        this->Odd.erase(edge);
      }
    }
  }

  const TriangleMesh& Mesh;
  std::set<VertexPair> Odd;
};

} // namespace

std::vector<char> FindSmallerSide(
  const TriangleMesh& mesh, const std::vector<std::vector<PathSegment>>& curves)
{
  Crossings crossings(mesh);
  for (const std::vector<PathSegment>& curve : curves)
  {
    for (std::size_t k = 0; k < curve.size(); ++k)
    {
      crossings.Add(curve[k], curve[(k + 1) % curve.size()]);
    }
  }
  // Vertices of an edge are on one side unless it is crossed.
  constexpr char unknown = 2;
  std::vector<char> sides(static_cast<std::size_t>(mesh.NumberOfVertices()), unknown);
  for (std::size_t c = 0; c + 1 < mesh.ComponentsBegin().size(); ++c)
  {
    double areas[2] = { 0.0, 0.0 };
    const Index first = mesh.ComponentsBegin()[c], last = mesh.ComponentsBegin()[c + 1];
    std::deque<Index> queue{ first };
    sides[static_cast<std::size_t>(first)] = 0;
    while (!queue.empty())
    {
      const Index v = queue.front();
      queue.pop_front();
      const char side = sides[static_cast<std::size_t>(v)];
      areas[static_cast<std::size_t>(side)] += mesh.ThirdOfTriangles(v);
      for (Index k = mesh.VertexCornersBegin()[static_cast<std::size_t>(v)];
           k < mesh.VertexCornersBegin()[static_cast<std::size_t>(v) + 1]; ++k)
      {
        for (const int step : { 1, 2 })
        {
          const Index other =
            mesh.OtherCorner(mesh.VertexCorners()[static_cast<std::size_t>(k)], step);
          char& there = sides[static_cast<std::size_t>(other)];
          const auto want = static_cast<char>(side ^ (crossings.IsCrossed(v, other) ? 1 : 0));
          if (there == unknown)
          {
            queue.push_back(other);
            there = want;
          }
          if (there != want)
          {
            return {};
          }
        }
      }
    }
    const char smaller = areas[1] <= areas[0] ? 1 : 0;
    for (Index v = first; v < last; ++v)
    {
      char& side = sides[static_cast<std::size_t>(v)];
      side = side == smaller ? 1 : 0;
    }
  }
  return sides;
}

} // namespace SurfaceDiffusion
