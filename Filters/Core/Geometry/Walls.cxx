// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Geometry/Walls.h"

#include "Core/Geometry/Ray.h"
#include "Core/Geometry/TriangleTree.h"

#include <Eigen/Geometry>

#include <algorithm>
#include <limits>
#include <vector>

namespace SurfaceDiffusion
{

namespace
{

using Vector3 = Eigen::Vector3d;

/// cos 30 degrees: normals of a wall's two sides are opposite within this angle.
constexpr double WallCosine = 0.866;
/// Longer directions are those of edges.
constexpr double LongestOnFaces = 1.05;

Vector3 PositionOf(const Points& points, Index vertex)
{
  return points.row(vertex).transpose();
}

} // namespace

std::vector<double> FindWalls(const Points& before, const Points& after, const Triangles& faces,
  const Points& normals, const Points& directions, const ParallelFor& parallel)
{
  const TriangleTree tree(after, faces);
  const auto count = static_cast<Index>(before.rows());
  std::vector<double> walls(
    static_cast<std::size_t>(count), std::numeric_limits<double>::infinity());
  const double least = 1e-9 * (before.colwise().maxCoeff() - before.colwise().minCoeff()).norm();
  ForEach(parallel, count,
    [&](Index i)
    {
      const double length = directions.row(i).norm();
      if (!(length > 0.0) || length > LongestOnFaces)
      {
        return;
      }
      const Ray ray(PositionOf(after, i), -directions.row(i).transpose() / length);
      double& wall = walls[static_cast<std::size_t>(i)];
      tree.Visit([&](const TriangleTree::Box& box) { return ray.Meets(box, 0.0, wall); },
        [&](Index t)
        {
          if (normals.row(t).dot(ray.Way) < WallCosine || faces(t, 0) == i || faces(t, 1) == i ||
            faces(t, 2) == i)
          {
            return;
          }
          const Vector3 a = PositionOf(after, faces(t, 0));
          const Vector3 b = PositionOf(after, faces(t, 1));
          const Vector3 c = PositionOf(after, faces(t, 2));
          const Vector3 normal = (b - a).cross(c - a);
          const double distance = normal.dot(ray.Way) > 0.0 ? ray.DistanceTo(a, b, c, normal) : 0.0;
          if (distance > least && distance < wall)
          {
            wall = distance;
          }
        });
    });
  return walls;
}

} // namespace SurfaceDiffusion
