// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Geometry/Spikes.h"

#include "Core/Geometry/VertexFans.h"

#include <algorithm>

namespace SurfaceDiffusion
{

namespace
{

constexpr double Far = 5.0;
constexpr double LargestRing = 1.5;

/// The neighbours of a vertex, each once.
std::vector<Index> NeighboursOf(const TriangleMesh& mesh, Index vertex)
{
  std::vector<Index> found;
  for (Index k = mesh.VertexCornersBegin()[vertex]; k < mesh.VertexCornersBegin()[vertex + 1]; ++k)
  {
    const Index corner = mesh.VertexCorners()[k];
    found.push_back(mesh.OtherCorner(corner, 1));
    found.push_back(mesh.OtherCorner(corner, 2));
  }
  std::sort(found.begin(), found.end());
  found.erase(std::unique(found.begin(), found.end()), found.end());
  return found;
}

} // namespace

std::vector<std::pair<Index, Eigen::RowVector3d>> FindSpikes(
  const TriangleMesh& mesh, const Eigen::Ref<const Points>& points, const ParallelFor& parallel)
{
  const Index n = mesh.NumberOfVertices();
  Flags isSpike = Flags::Constant(n, false);
  Points centres(n, 3);
  ForEach(parallel, n,
    [&](Index i)
    {
      const Index valence = NumberOfTrianglesAt(mesh, i);
      if (valence < 3 || valence > LargestFan)
      {
        return;
      }
      const std::vector<Index> ring = NeighboursOf(mesh, i);
      Eigen::RowVector3d centre = Eigen::RowVector3d::Zero();
      for (const Index j : ring)
      {
        centre += points.row(j) / static_cast<double>(ring.size());
      }
      double radius = 0.0;
      for (const Index j : ring)
      {
        radius = std::max(radius, (points.row(j) - centre).norm());
      }
      if (!((points.row(i) - centre).norm() > Far * radius))
      {
        return;
      }
      std::vector<double> edges;
      std::size_t beyond = 0;
      for (const Index j : ring)
      {
        bool hasOutside = false;
        for (const Index k : NeighboursOf(mesh, j))
        {
          if (k != i)
          {
            edges.push_back((points.row(k) - points.row(j)).norm());
            hasOutside = hasOutside ||
              (points.row(k) - centre).norm() > 1.0001 * (points.row(j) - centre).norm();
          }
        }
        beyond += hasOutside ? 1 : 0;
      }
      const auto usual = edges.begin() + static_cast<std::ptrdiff_t>(3 * edges.size() / 4);
      std::nth_element(edges.begin(), usual, edges.end());
      isSpike[i] = 2 * beyond > ring.size() && radius <= LargestRing * *usual;
      centres.row(i) = centre;
    });
  std::vector<std::pair<Index, Eigen::RowVector3d>> spikes;
  for (Index i = 0; i < n; ++i)
  {
    if (isSpike[i])
    {
      spikes.emplace_back(i, centres.row(i));
    }
  }
  return spikes;
}

} // namespace SurfaceDiffusion
