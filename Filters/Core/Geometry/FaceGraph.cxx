// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Geometry/FaceGraph.h"

#include "Core/Geometry/VertexFans.h"

#include <Eigen/Geometry>

#include <algorithm>
#include <array>

namespace SurfaceDiffusion
{

namespace
{

/// The mean distance to the triangles that share a vertex over that to the neighbours across edges.
constexpr double RingDistance = 1.5;

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
  const std::size_t first = entries.size();
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
  SortUnique(entries, first);
}

} // namespace

FaceGraph::FaceGraph(
  const TriangleMesh& mesh, const ParallelFor& parallel, const ProgressMonitor& progress)
  : Mesh(mesh)
{
  const Index count = mesh.NumberOfTriangles();
  const VertexFans fans(mesh);
  progress.Report(0.2);
  this->Ring = MakeLists(
    count, parallel, [&](Index t, std::vector<Index>& entries) { AppendRing(fans, t, entries); });
  progress.Report(0.5);
  this->Across = MakeLists(count, parallel,
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
}

void FaceGraph::Separate(const VertexPairs& edges, const ParallelFor& parallel)
{
  std::vector<char> isEnd(static_cast<std::size_t>(this->Mesh.NumberOfVertices()), 0);
  for (const auto& [i, j] : edges)
  {
    isEnd[i] = isEnd[j] = 1;
  }
  const Triangles& triangles = this->Mesh.TriangleVertices();
  const auto areSeparate = [&](Index t, Index u)
  {
    std::array<Index, 3> shared{};
    int count = 0;
    for (int a = 0; a < 3; ++a)
    {
      const Index vertex = triangles(t, a);
      if (vertex == triangles(u, 0) || vertex == triangles(u, 1) || vertex == triangles(u, 2))
      {
        shared[count++] = vertex;
      }
    }
    const std::pair<Index, Index> edge = std::minmax(shared[0], shared[1]);
    return count == 2 ? std::binary_search(edges.begin(), edges.end(), edge)
                      : count == 1 && isEnd[shared[0]];
  };
  for (IndexLists* const lists : { &this->Ring, &this->Across })
  {
    *lists = MakeLists(this->NumberOfFaces(), parallel,
      [&](Index t, std::vector<Index>& entries)
      {
        for (Offset k = lists->Begin[t]; k < lists->Begin[t + 1]; ++k)
        {
          if (!areSeparate(t, lists->Entries[k]))
          {
            entries.push_back(lists->Entries[k]);
          }
        }
      });
  }
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

void FaceGeometry::MeasureWidths(const FaceGraph& graph, const ParallelFor& parallel)
{
  this->Widths.resize(graph.NumberOfFaces());
  ForEach(parallel, graph.NumberOfFaces(),
    [&](Index f)
    {
      double sum = 0.0;
      const Offset begin = graph.Ring.Begin[f];
      const Offset end = graph.Ring.Begin[f + 1];
      for (Offset k = begin; k < end; ++k)
      {
        sum += (this->Centroids.row(graph.Ring.Entries[k]) - this->Centroids.row(f)).norm();
      }
      this->Widths[f] = end > begin ? sum / (RingDistance * static_cast<double>(end - begin)) : 0.0;
    });
}

} // namespace SurfaceDiffusion
