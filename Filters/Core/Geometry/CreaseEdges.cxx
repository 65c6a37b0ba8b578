// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Geometry/CreaseEdges.h"

#include "Core/Geometry/InnerEdges.h"

#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <utility>

namespace SurfaceDiffusion
{

VertexPairs FindCreases(
  const TriangleMesh& mesh, const Points& points, double angle, const VertexPairs& given)
{
  VertexPairs creases;
  if (angle > 0.0)
  {
    const double radians = angle * 3.14159265358979323846 / 180.0;
    ForEachInnerEdge(mesh,
      [&](Index low, Index high, Index first, Index second)
      {
        // The angle is that between the directions from the edge to the vertices opposite.
        const Eigen::RowVector3d from = points.row(low);
        const Eigen::RowVector3d along = (points.row(high) - from).stableNormalized();
        const auto away = [&](Index vertex) -> Eigen::RowVector3d
        {
          const Eigen::RowVector3d d = points.row(vertex) - from;
          return (d - along.dot(d) * along).stableNormalized();
        };
        const Eigen::RowVector3d a = away(first);
        const Eigen::RowVector3d b = away(second);
        if (std::atan2(a.cross(b).norm(), -a.dot(b)) >= radians)
        {
          creases.emplace_back(low, high);
        }
      });
  }
  if (!given.empty())
  {
    std::vector<Index> vertexOf(static_cast<std::size_t>(mesh.NumberOfVertices()), -1);
    for (Index i = 0; i < mesh.NumberOfVertices(); ++i)
    {
      vertexOf[mesh.InputVertex()[i]] = i;
    }
    for (const auto& [i, j] : given)
    {
      creases.push_back(std::minmax({ vertexOf[i], vertexOf[j] }));
    }
  }
  std::sort(creases.begin(), creases.end());
  creases.erase(std::unique(creases.begin(), creases.end()), creases.end());
  return creases;
}

std::vector<VertexPairs> DivideCreases(
  const TriangleMesh& mesh, const std::vector<SurfacePart>& parts, const VertexPairs& creases)
{
  std::vector<VertexPairs> divided(parts.size());
  if (creases.empty())
  {
    return divided;
  }
  std::vector<std::pair<std::size_t, Index>> rows(
    static_cast<std::size_t>(mesh.NumberOfVertices())); // part, row
  for (std::size_t p = 0; p < parts.size(); ++p)
  {
    for (std::size_t row = 0; row < parts[p].Vertices.size(); ++row)
    {
      rows[parts[p].Vertices[row]] = { p, static_cast<Index>(row) };
    }
  }
  for (const auto& [i, j] : creases)
  {
    divided[rows[i].first].emplace_back(rows[i].second, rows[j].second);
  }
  return divided;
}

} // namespace SurfaceDiffusion
