// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Geometry/SmallestWall.h"

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

double FindSmallestWall(const Points& before, const Points& after, const Triangles& faces,
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
      const Vector3 from = PositionOf(after, i);
      const Vector3 ray = -directions.row(i).transpose() / length;
      const Vector3 inverse = ray.cwiseInverse();
      double& wall = walls[static_cast<std::size_t>(i)];
      const auto enters = [&](const TriangleTree::Box& box)
      {
        const Vector3 low = (box.min() - from).cwiseProduct(inverse);
        const Vector3 high = (box.max() - from).cwiseProduct(inverse);
        double first = 0.0;
        double last = wall;
        for (int k = 0; k < 3; ++k)
        {
          if (ray[k] == 0.0)
          {
            if (from[k] < box.min()[k] || from[k] > box.max()[k])
            {
              return false;
            }
            continue;
          }
          first = std::max(first, std::min(low[k], high[k]));
          last = std::min(last, std::max(low[k], high[k]));
        }
        return first <= last;
      };
      tree.Visit(enters,
        [&](Index t)
        {
          if (normals.row(t).dot(ray) < WallCosine || faces(t, 0) == i || faces(t, 1) == i ||
            faces(t, 2) == i)
          {
            return;
          }
          const Vector3 a = PositionOf(after, faces(t, 0));
          const Vector3 b = PositionOf(after, faces(t, 1));
          const Vector3 c = PositionOf(after, faces(t, 2));
          const Vector3 normal = (b - a).cross(c - a);
          const double along = normal.dot(ray);
          if (!(along > 0.0))
          {
            return;
          }
          const double distance = normal.dot(a - from) / along;
          const Vector3 hit = from + distance * ray;
          if (distance > least && distance < wall && (b - a).cross(hit - a).dot(normal) >= 0.0 &&
            (c - b).cross(hit - b).dot(normal) >= 0.0 && (a - c).cross(hit - c).dot(normal) >= 0.0)
          {
            wall = distance;
          }
        });
    });
  return walls.empty() ? std::numeric_limits<double>::infinity()
                       : *std::min_element(walls.begin(), walls.end());
}

} // namespace SurfaceDiffusion
