// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Geometry/Bodies.h"

#include "Core/Foundation/DisjointSets.h"
#include "Core/Geometry/TriangleOrientation.h"
#include "Core/Geometry/Windings.h"

#include <cmath>
#include <cstddef>
#include <set>
#include <utility>

namespace SurfaceDiffusion
{

namespace
{

using Vector3 = Eigen::Vector3d;
using Box = TriangleTree::Box;

/// Vertices of a shell that may touch others, before its first vertex decides.
constexpr Index Tries = 16;

/// Sets of triangles that edges connect.
struct Shells
{
  Shells(const Points& points, const Triangles& faces, const TriangleSides& sides)
    : OfTriangle(static_cast<std::size_t>(faces.rows()), -1)
  {
    DisjointSets sets(static_cast<Index>(faces.rows()));
    ForEachEdge(sides,
      [&](auto first, auto last)
      {
        for (auto other = first + 1; other != last; ++other)
        {
          sets.Join(first->Triangle, other->Triangle);
        }
      });
    const Eigen::RowVector3d center = points.colwise().mean();
    for (Index t = 0; t < static_cast<Index>(faces.rows()); ++t)
    {
      if (IsCollapsed(faces, t))
      {
        continue;
      }
      const Index first = sets.Find(t);
      if (first == t)
      {
        this->OfTriangle[static_cast<std::size_t>(t)] = static_cast<Index>(this->Table.size());
        this->Table.emplace_back();
        this->First.push_back(t);
        this->Bounds.emplace_back();
      }
      const Index shell = this->OfTriangle[static_cast<std::size_t>(first)];
      this->OfTriangle[static_cast<std::size_t>(t)] = shell;
      Body& body = this->Table[static_cast<std::size_t>(shell)];
      const Vector3 normal = DoubledNormal(points, faces, t);
      ++body.Triangles;
      body.Area += 0.5 * normal.norm();
      body.Volume += (CornerPlace(points, faces, t, 0) - center.transpose()).dot(normal) / 6.0;
      for (int a = 0; a < 3; ++a)
      {
        this->Bounds[static_cast<std::size_t>(shell)].extend(CornerPlace(points, faces, t, a));
      }
    }
    ForEachEdge(sides,
      [&](auto first, auto last)
      {
        if (last - first == 1)
        {
          this->Table[this->OfTriangle[first->Triangle]].IsClosed = false;
        }
      });
  }

  Index Count() const { return static_cast<Index>(this->Table.size()); }

  std::vector<Index> OfTriangle; ///< -1 for collapsed ones
  std::vector<Body> Table;
  std::vector<Index> First; ///< triangle of each
  std::vector<Box> Bounds;
};

/// The smallest closed shell around each closed one, -1 if there is none.
std::vector<Index> FindParents(const Points& points, const Triangles& faces, const Shells& shells)
{
  std::vector<Index> parents(static_cast<std::size_t>(shells.Count()), -1);
  if (shells.Count() < 2)
  {
    return parents;
  }
  std::vector<Index> closed = shells.OfTriangle;
  for (Index& shell : closed)
  {
    shell = shell >= 0 && shells.Table[static_cast<std::size_t>(shell)].IsClosed ? shell : -1;
  }
  const Windings windings(points, faces, closed);
  std::vector<Index> tries(static_cast<std::size_t>(shells.Count()), 0);
  const auto sizeOf = [&](Index shell) { return std::abs(shells.Table[shell].Volume); };
  for (Index t = 0; t < static_cast<Index>(faces.rows()); ++t)
  {
    const Index shell = closed[static_cast<std::size_t>(t)];
    if (shell < 0 || tries[shell]++ > Tries)
    {
      continue;
    }
    const Vector3 place = CornerPlace(points, faces, t, 0);
    bool touches = false;
    Index parent = -1;
    for (const auto& [other, sum] : windings.At(place))
    {
      const bool mayContain = other != shell && sizeOf(other) > sizeOf(shell) &&
        shells.Bounds[other].contains(shells.Bounds[shell]);
      touches = touches || (mayContain && windings.Touches(place, other));
      if (mayContain && sum != 0 && (parent < 0 || sizeOf(other) < sizeOf(parent)))
      {
        parent = other;
      }
    }
    if (!touches)
    {
      parents[shell] = parent;
      tries[shell] = Tries + 1;
    }
  }
  return parents;
}

/// The closed bodies of a surface, and what is near others.
struct ClosedBodies
{
  ClosedBodies(const Points& points, const Triangles& faces, const Bodies& found)
    : OfTriangle(found.OfTriangle)
    , OfVertex(static_cast<std::size_t>(points.rows()), -1)
    , Bounds(found.Table.size())
  {
    for (Index t = 0; t < static_cast<Index>(faces.rows()); ++t)
    {
      Index& body = this->OfTriangle[static_cast<std::size_t>(t)];
      for (int a = 0; a < 3 && body >= 0; ++a)
      {
        this->OfVertex[static_cast<std::size_t>(faces(t, a))] = body;
        if (found.Table[static_cast<std::size_t>(body)].IsClosed)
        {
          this->Bounds[static_cast<std::size_t>(body)].extend(CornerPlace(points, faces, t, a));
        }
      }
      body = body >= 0 && found.Table[static_cast<std::size_t>(body)].IsClosed ? body : -1;
    }
    this->Boxes = TriangleTree(this->Bounds);
  }

  /// Whether a place meets the box around another body.
  bool IsNearOther(const Box& place, Index own) const
  {
    bool isNear = false;
    this->Boxes.Visit([&](const Box& box) { return !isNear && box.intersects(place); },
      [&](Index body)
      { isNear = isNear || (body != own && this->Bounds[body].intersects(place)); });
    return isNear;
  }

  std::vector<Index> OfTriangle; ///< -1 for those of others
  std::vector<Index> OfVertex; ///< of all bodies
  std::vector<Box> Bounds;
  TriangleTree Boxes;
};

/// Marks what is inside other bodies, and counts pairs that overlap.
void FindOverlaps(
  const Points& points, const Triangles& faces, const ParallelFor& parallel, Bodies& found)
{
  const ClosedBodies closed(points, faces, found);
  const Windings windings(points, faces, closed.OfTriangle);
  std::vector<Index> within(closed.OfVertex.size(), -1);
  ForEach(parallel, static_cast<Index>(points.rows()),
    [&](Index i)
    {
      const Index own = closed.OfVertex[static_cast<std::size_t>(i)];
      const Vector3 place = points.row(i).transpose();
      if (own >= 0 && closed.IsNearOther(Box(place), own))
      {
        within[static_cast<std::size_t>(i)] = windings.Around(place, own);
      }
    });
  std::set<std::pair<Index, Index>> pairs;
  for (std::size_t i = 0; i < within.size(); ++i)
  {
    found.IsInside[i] = within[i] >= 0;
    if (within[i] >= 0 && found.Table[static_cast<std::size_t>(closed.OfVertex[i])].IsClosed)
    {
      pairs.emplace(std::minmax(closed.OfVertex[i], within[i]));
    }
  }
  for (Index t = 0; t < static_cast<Index>(faces.rows()); ++t)
  {
    const Index own = closed.OfTriangle[static_cast<std::size_t>(t)];
    for (int a = 0; a < 3 && own >= 0; ++a)
    {
      const Vector3 from = CornerPlace(points, faces, t, a);
      const Vector3 to = CornerPlace(points, faces, t, (a + 1) % 3);
      if (faces(t, a) < faces(t, (a + 1) % 3) &&
        closed.IsNearOther(Box(from.cwiseMin(to), from.cwiseMax(to)), own))
      {
        windings.VisitBetween(
          from, to, own, [&](Index body) { pairs.emplace(std::minmax(own, body)); });
      }
    }
  }
  found.Overlaps = static_cast<Index>(pairs.size());
}

} // namespace

Bodies FindBodies(const Points& points, const Triangles& triangles, const ParallelFor& parallel)
{
  const Shells shells(points, triangles, SortSides(triangles));
  const std::vector<Index> parents = FindParents(points, triangles, shells);
  Bodies found;
  found.Edges = FindEdgeDefects(triangles, static_cast<Index>(points.rows()));
  found.IsInside.assign(static_cast<std::size_t>(points.rows()), 0);
  const auto isCavity = [&](Index shell)
  {
    return parents[shell] >= 0 && shells.Table[shell].Volume < 0.0 &&
      shells.Table[parents[shell]].Volume > 0.0;
  };
  std::vector<Index> bodyOf(shells.Table.size(), -1);
  for (Index shell = 0; shell < shells.Count(); ++shell)
  {
    // The first shell of a body may be that of a cavity.
    const Index outer = isCavity(shell) ? parents[shell] : shell;
    if (bodyOf[outer] < 0)
    {
      bodyOf[outer] = static_cast<Index>(found.Table.size());
      found.Table.emplace_back();
    }
    bodyOf[shell] = bodyOf[outer];
    Body& body = found.Table[bodyOf[shell]];
    body.Triangles += shells.Table[shell].Triangles;
    body.Area += shells.Table[shell].Area;
    body.Volume += shells.Table[shell].Volume;
    body.IsClosed = body.IsClosed && shells.Table[shell].IsClosed;
  }
  found.OfTriangle = shells.OfTriangle;
  for (Index& set : found.OfTriangle)
  {
    set = set < 0 ? -1 : bodyOf[set];
  }
  if (found.Table.size() > 1)
  {
    FindOverlaps(points, triangles, parallel, found);
  }
  return found;
}

void TurnOutwards(const Points& points, Triangles& triangles)
{
  OrientTriangles(points, triangles);
  const Shells shells(points, triangles, SortSides(triangles));
  const std::vector<Index> parents = FindParents(points, triangles, shells);
  for (Index t = 0; t < static_cast<Index>(triangles.rows()); ++t)
  {
    Index shell = shells.OfTriangle[static_cast<std::size_t>(t)];
    while (shell >= 0 && parents[shell] >= 0)
    {
      shell = parents[shell];
    }
    if (shell >= 0 && shells.Table[shell].IsClosed && shells.Table[shell].Volume < 0.0)
    {
      std::swap(triangles(t, 1), triangles(t, 2));
    }
  }
}

} // namespace SurfaceDiffusion
