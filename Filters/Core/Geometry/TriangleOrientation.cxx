// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Geometry/TriangleOrientation.h"

#include <Eigen/Geometry>

#include <algorithm>
#include <array>
#include <tuple>
#include <utility>
#include <vector>

namespace SurfaceDiffusion
{

namespace
{

/// An edge of a triangle, by its vertices.
struct Side
{
  Index Low, High;
  Index Triangle;
  int Number; ///< of the side in the triangle
  bool Rises; ///< whether the triangle passes it from Low to High

  bool IsOfSameEdge(const Side& other) const
  {
    return this->Low == other.Low && this->High == other.High;
  }
  bool operator<(const Side& other) const
  {
    return std::tie(this->Low, this->High, this->Triangle) <
      std::tie(other.Low, other.High, other.Triangle);
  }
};

/// The other triangle of a side, if its edge has two.
struct Neighbour
{
  Index Triangle = -1;
  bool IsOpposite = false; ///< whether one of the two has to be turned
};

using Neighbours = std::vector<std::array<Neighbour, 3>>;

Neighbours FindNeighbours(const Triangles& triangles)
{
  std::vector<Side> sides;
  sides.reserve(3 * static_cast<std::size_t>(triangles.rows()));
  for (Index t = 0; t < static_cast<Index>(triangles.rows()); ++t)
  {
    for (int a = 0; a < 3; ++a)
    {
      const Index from = triangles(t, a);
      const Index to = triangles(t, (a + 1) % 3);
      sides.push_back({ std::min(from, to), std::max(from, to), t, a, from < to });
    }
  }
  std::sort(sides.begin(), sides.end());
  Neighbours neighbours(static_cast<std::size_t>(triangles.rows()));
  for (auto first = sides.begin(); first != sides.end();)
  {
    const auto last = std::find_if(
      first, sides.end(), [&](const Side& side) { return !side.IsOfSameEdge(*first); });
    if (last - first == 2)
    {
      const Side& other = first[1];
      const bool isOpposite = first->Rises == other.Rises;
      neighbours[first->Triangle][first->Number] = { other.Triangle, isOpposite };
      neighbours[other.Triangle][other.Number] = { first->Triangle, isOpposite };
    }
    first = last;
  }
  return neighbours;
}

double Area(const Points& points, const Triangles& triangles, Index t)
{
  const Eigen::RowVector3d a = points.row(triangles(t, 0));
  const Eigen::RowVector3d b = points.row(triangles(t, 1));
  const Eigen::RowVector3d c = points.row(triangles(t, 2));
  return 0.5 * (b - a).cross(c - a).norm();
}

} // namespace

void OrientTriangles(const Points& points, Triangles& triangles)
{
  const Neighbours neighbours = FindNeighbours(triangles);
  enum : char
  {
    Unknown,
    Kept,
    Turned
  };
  std::vector<char> side(neighbours.size(), Unknown);
  std::vector<Index> patch;
  for (Index seed = 0; seed < static_cast<Index>(triangles.rows()); ++seed)
  {
    if (side[seed] != Unknown)
    {
      continue;
    }
    side[seed] = Kept;
    patch.assign(1, seed);
    double keptArea = 0.0; // less the area of turned triangles
    for (std::size_t next = 0; next < patch.size(); ++next)
    {
      const Index t = patch[next];
      keptArea += (side[t] == Kept ? 1.0 : -1.0) * Area(points, triangles, t);
      for (const Neighbour& neighbour : neighbours[t])
      {
        if (neighbour.Triangle >= 0 && side[neighbour.Triangle] == Unknown)
        {
          side[neighbour.Triangle] = (side[t] == Kept) == neighbour.IsOpposite ? Turned : Kept;
          patch.push_back(neighbour.Triangle);
        }
      }
    }
    const char turned = keptArea < 0.0 ? Kept : Turned;
    for (const Index t : patch)
    {
      if (side[t] == turned)
      {
        std::swap(triangles(t, 1), triangles(t, 2));
      }
    }
  }
}

} // namespace SurfaceDiffusion
