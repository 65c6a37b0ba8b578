// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Geometry/TriangleOrientation.h"

#include "Core/Geometry/TriangleSides.h"

#include <Eigen/Geometry>

#include <algorithm>
#include <array>
#include <utility>
#include <vector>

namespace SurfaceDiffusion
{

namespace
{

/// The other triangle of a side, if its edge has two.
struct Neighbour
{
  Index Triangle = -1;
  bool IsOpposite = false; ///< whether one of the two has to be turned
};

using Neighbours = std::vector<std::array<Neighbour, 3>>;

Neighbours FindNeighbours(const Triangles& triangles)
{
  Neighbours neighbours(static_cast<std::size_t>(triangles.rows()));
  ForEachEdge(SortSides(triangles),
    [&](auto first, auto last)
    {
      if (last - first == 2)
      {
        const TriangleSide& other = first[1];
        const bool isOpposite = first->Rises == other.Rises;
        neighbours[first->Triangle][first->Number] = { other.Triangle, isOpposite };
        neighbours[other.Triangle][other.Number] = { first->Triangle, isOpposite };
      }
    });
  return neighbours;
}

constexpr double SmallestHeight = 1e-6; ///< over the longest side of a triangle with an orientation

double Area(const Points& points, const Triangles& triangles, Index t)
{
  const Eigen::RowVector3d a = points.row(triangles(t, 0));
  const Eigen::RowVector3d b = points.row(triangles(t, 1));
  const Eigen::RowVector3d c = points.row(triangles(t, 2));
  return 0.5 * (b - a).cross(c - a).norm();
}

enum class Turn : char
{
  Unknown,
  Kept,
  Turned
};

/// That of the neighbour of a triangle with this turn.
Turn TurnBeside(Turn turn, const Neighbour& neighbour)
{
  return (turn == Turn::Kept) == neighbour.IsOpposite ? Turn::Turned : Turn::Kept;
}

/// Decides the triangles that those of `patch` connect, if `takes` accepts them, and appends these.
template <typename Takes>
void Follow(const Neighbours& neighbours, const Takes& takes, std::vector<Turn>& turns,
  std::vector<Index>& patch)
{
  for (std::size_t next = 0; next < patch.size(); ++next)
  {
    for (const Neighbour& neighbour : neighbours[patch[next]])
    {
      const Index t = neighbour.Triangle;
      if (t >= 0 && turns[t] == Turn::Unknown && takes(t))
      {
        turns[t] = TurnBeside(turns[patch[next]], neighbour);
        patch.push_back(t);
      }
    }
  }
}

} // namespace

bool HasOrientation(const Points& points, const Triangles& triangles, Index t)
{
  double longest = 0.0; // squared
  for (int a = 0; a < 3; ++a)
  {
    longest = std::max(
      longest, (points.row(triangles(t, a)) - points.row(triangles(t, (a + 1) % 3))).squaredNorm());
  }
  return 2.0 * Area(points, triangles, t) > SmallestHeight * longest;
}

void OrientTriangles(const Points& points, Triangles& triangles, std::vector<char>* onOneSide)
{
  const Neighbours neighbours = FindNeighbours(triangles);
  std::vector<Turn> turns(neighbours.size(), Turn::Unknown);
  std::vector<char> isOriented(neighbours.size());
  for (Index t = 0; t < static_cast<Index>(triangles.rows()); ++t)
  {
    isOriented[t] = HasOrientation(points, triangles, t);
  }
  std::vector<Index> patch;
  for (Index seed = 0; seed < static_cast<Index>(triangles.rows()); ++seed)
  {
    if (!isOriented[seed] || turns[seed] != Turn::Unknown)
    {
      continue;
    }
    turns[seed] = Turn::Kept;
    patch.assign(1, seed);
    Follow(
      neighbours, [&](Index t) { return isOriented[t] != 0; }, turns, patch);
    double keptArea = 0.0; // less the area of turned triangles
    for (const Index t : patch)
    {
      keptArea += (turns[t] == Turn::Kept ? 1.0 : -1.0) * Area(points, triangles, t);
    }
    const auto isAcross = [&](Index t)
    {
      return std::any_of(neighbours[t].begin(), neighbours[t].end(),
        [&](const Neighbour& other)
        {
          return other.Triangle >= 0 && isOriented[other.Triangle] &&
            TurnBeside(turns[t], other) != turns[other.Triangle];
        });
    };
    if (onOneSide && std::any_of(patch.begin(), patch.end(), isAcross))
    {
      onOneSide->resize(neighbours.size(), 0);
      for (const Index t : patch)
      {
        (*onOneSide)[t] = 1;
      }
    }
    if (keptArea < 0.0)
    {
      for (const Index t : patch)
      {
        turns[t] = turns[t] == Turn::Kept ? Turn::Turned : Turn::Kept;
      }
    }
  }
  patch.clear();
  for (Index t = 0; t < static_cast<Index>(triangles.rows()); ++t)
  {
    if (isOriented[t])
    {
      patch.push_back(t);
    }
  }
  Follow(
    neighbours, [](Index) { return true; }, turns, patch);
  for (Index t = 0; t < static_cast<Index>(triangles.rows()); ++t)
  {
    if (turns[t] == Turn::Turned)
    {
      std::swap(triangles(t, 1), triangles(t, 2));
    }
  }
}

} // namespace SurfaceDiffusion
