// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Geometry/FaceGraph.h"

#include "Core/Geometry/VertexFans.h"

#include <Eigen/Geometry>

#include <algorithm>

namespace SurfaceDiffusion
{

namespace
{

int NumberOfSharedVertices(const Triangles& triangles, Index t, Index u)
{
  int shared = 0;
  for (int a = 0; a < 3; ++a)
  {
    for (int b = 0; b < 3; ++b)
    {
      shared += triangles(t, a) == triangles(u, b);
    }
  }
  return shared;
}

/// Append the neighbours of triangle t.
void AppendRing(const VertexFans& fans, Index t, std::vector<Index>& entries)
{
  const auto first = static_cast<std::ptrdiff_t>(entries.size());
  for (int a = 0; a < 3; ++a)
  {
    fans.ForEachNeighbour(t, a,
      [&](Index other)
      {
        if (other != t)
        {
          entries.push_back(other);
        }
      });
  }
  const auto begin = entries.begin() + first;
  std::sort(begin, entries.end());
  entries.erase(std::unique(begin, entries.end()), entries.end());
}

/// Fill the lists whose members append(i, entries) appends.
template <typename Append>
void FillLists(IndexLists& lists, Index count, const ParallelFor& parallel, const Append& append)
{
  lists.Begin.assign(static_cast<std::size_t>(count) + 1, 0);
  std::vector<std::vector<Index>> blocks(NumberOfBlocks(count));
  ForEachBlock(parallel, count,
    [&](Index block, Index begin, Index end)
    {
      std::vector<Index>& entries = blocks[block];
      for (Index i = begin; i < end; ++i)
      {
        const std::size_t before = entries.size();
        append(i, entries);
        lists.Begin[i] = static_cast<Offset>(entries.size() - before);
      }
    });
  CountsToOffsets(lists.Begin);
  lists.Entries.resize(static_cast<std::size_t>(lists.Begin.back()));
  ForEachBlock(parallel, count,
    [&](Index block, Index begin, Index)
    {
      std::copy(
        blocks[block].begin(), blocks[block].end(), lists.Entries.begin() + lists.Begin[begin]);
    });
}

} // namespace

FaceGraph::FaceGraph(const TriangleMesh& mesh, const ParallelFor& parallel)
  : Mesh(mesh)
{
  const Index count = mesh.NumberOfTriangles();
  const VertexFans fans(mesh);
  FillLists(this->Ring, count, parallel,
    [&](Index t, std::vector<Index>& entries) { AppendRing(fans, t, entries); });
  FillLists(this->Across, count, parallel,
    [&](Index t, std::vector<Index>& entries)
    {
      for (Offset k = this->Ring.Begin[t]; k < this->Ring.Begin[t + 1]; ++k)
      {
        if (NumberOfSharedVertices(mesh.TriangleVertices(), t, this->Ring.Entries[k]) > 1)
        {
          entries.push_back(this->Ring.Entries[k]);
        }
      }
    });
  FillLists(this->Inside, count, parallel,
    [&](Index t, std::vector<Index>& entries)
    {
      const auto begin = this->Ring.Entries.begin() + this->Ring.Begin[t];
      const auto end = this->Ring.Entries.begin() + this->Ring.Begin[t + 1];
      const auto appendPairs = [&](Index f)
      {
        for (Offset k = this->Across.Begin[f]; k < this->Across.Begin[f + 1]; ++k)
        {
          const Index g = this->Across.Entries[k];
          if (g > f && (g == t || std::binary_search(begin, end, g)))
          {
            entries.push_back(static_cast<Index>(k));
          }
        }
      };
      appendPairs(t);
      std::for_each(begin, end, appendPairs);
    });
}

void FaceGeometry::Measure(
  const TriangleMesh& mesh, const Points& points, const ParallelFor& parallel)
{
  const Index count = mesh.NumberOfTriangles();
  this->Normals.resize(count, 3);
  this->Areas.resize(count);
  this->Centroids.resize(count, 3);
  ForEach(parallel, count,
    [&](Index t)
    {
      const auto triangle = mesh.TriangleVertices().row(t);
      const Eigen::RowVector3d a = points.row(triangle[0]);
      const Eigen::RowVector3d b = points.row(triangle[1]);
      const Eigen::RowVector3d c = points.row(triangle[2]);
      const Eigen::RowVector3d cross = (b - a).cross(c - a);
      const double length = cross.norm();
      this->Areas[t] = 0.5 * length;
      this->Normals.row(t) = length > 0.0 ? Eigen::RowVector3d(cross / length)
                                          : Eigen::RowVector3d(Eigen::RowVector3d::Zero());
      this->Centroids.row(t) = (a + b + c) / 3.0;
    });
}

} // namespace SurfaceDiffusion
