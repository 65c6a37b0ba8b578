// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Geometry/SelfIntersections.h"

#include "Core/Geometry/TriangleTree.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace SurfaceDiffusion
{

namespace
{

/// Distances below this, over the size of the surface, are rounding of coordinates.
constexpr double Touching = 1e-12;

class CrossingTest
{
public:
  CrossingTest(const Points& points, const Triangles& triangles)
    : Places(points)
    , Faces(triangles)
  {
    if (points.rows() > 0)
    {
      this->Tolerance =
        Touching * (points.colwise().maxCoeff() - points.colwise().minCoeff()).maxCoeff();
    }
  }

  bool Cross(Index t, Index u) const
  {
    int common = 0;
    std::array<bool, 3> inFirst{};
    std::array<bool, 3> inSecond{};
    for (std::size_t a = 0; a < 3; ++a)
    {
      for (std::size_t b = 0; b < 3; ++b)
      {
        if (this->Faces(t, static_cast<int>(a)) == this->Faces(u, static_cast<int>(b)))
        {
          ++common;
          inFirst[a] = true;
          inSecond[b] = true;
        }
      }
    }
    return common < 2 &&
      (this->AnyEdgePasses(t, u, inFirst) || this->AnyEdgePasses(u, t, inSecond));
  }

private:
  Eigen::Vector3d Place(Index t, int corner) const
  {
    return this->Places.row(this->Faces(t, corner)).transpose();
  }

  /// Whether an edge of t passes through u. Edges at a common vertex start in u.
  bool AnyEdgePasses(Index t, Index u, const std::array<bool, 3>& isCommon) const
  {
    for (int a = 0; a < 3; ++a)
    {
      const int b = (a + 1) % 3;
      if (!isCommon[static_cast<std::size_t>(a)] && !isCommon[static_cast<std::size_t>(b)] &&
        this->Passes(this->Place(t, a), this->Place(t, b), u))
      {
        return true;
      }
    }
    return false;
  }

  /// Both ends are clearly on different sides of the plane, and the line is clearly within the
  /// triangle.
  bool Passes(const Eigen::Vector3d& p, const Eigen::Vector3d& q, Index u) const
  {
    const std::array<Eigen::Vector3d, 3> corners{ this->Place(u, 0), this->Place(u, 1),
      this->Place(u, 2) };
    const Eigen::Vector3d along = corners[1] - corners[0];
    const Eigen::Vector3d across = corners[2] - corners[0];
    const Eigen::Vector3d normal = along.cross(across);
    const double first = normal.dot(p - corners[0]);
    const double second = normal.dot(q - corners[0]);
    // The normal of a needle may be rounding alone, and is small against the product of its sides.
    const double least = this->Tolerance * along.norm() * across.norm();
    if (!(std::min(first, second) < -least && std::max(first, second) > least))
    {
      return false;
    }
    const Eigen::Vector3d through = p + (q - p) * (first / (first - second));
    for (std::size_t a = 0; a < 3; ++a)
    {
      const Eigen::Vector3d side = corners[(a + 1) % 3] - corners[a];
      const double inside = side.cross(through - corners[a]).dot(normal);
      if (!(inside > this->Tolerance * side.norm() * normal.norm()))
      {
        return false;
      }
    }
    return true;
  }

  const Points& Places;
  const Triangles& Faces;
  double Tolerance = 0.0;
};

} // namespace

std::vector<char> FindSelfIntersections(const Points& points, const Triangles& triangles,
  const ParallelFor& parallel, const ProgressMonitor& progress)
{
  const TriangleTree tree(points, triangles);
  const CrossingTest test(points, triangles);
  std::vector<char> crosses(static_cast<std::size_t>(triangles.rows()), 0);
  const auto find = [&](Index t)
  {
    TriangleTree::Box box;
    for (int a = 0; a < 3; ++a)
    {
      box.extend(points.row(triangles(t, a)).transpose());
    }
    char& found = crosses[static_cast<std::size_t>(t)];
    tree.Visit([&](const TriangleTree::Box& other) { return !found && box.intersects(other); },
      [&](Index u)
      {
        if (!found && u != t)
        {
          found = test.Cross(t, u);
        }
      });
  };
  constexpr Index perReport = 1 << 16;
  const auto count = static_cast<Index>(triangles.rows());
  for (Index begin = 0; begin < count; begin += perReport)
  {
    progress.Report(static_cast<double>(begin) / count);
    ForEach(parallel, std::min(perReport, count - begin), [&](Index k) { find(begin + k); });
  }
  return crosses;
}

} // namespace SurfaceDiffusion
