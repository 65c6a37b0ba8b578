// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Geometry/FaceGraph.h"

#include "Core/Foundation/Offsets.h"

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

/// The triangles that share a vertex with triangle t.
void FindRing(const TriangleMesh& mesh, Index t, std::vector<Index>& ring)
{
  ring.clear();
  for (int a = 0; a < 3; ++a)
  {
    const Index v = mesh.TriangleVertices()(t, a);
    for (Index k = mesh.VertexCornersBegin()[v]; k < mesh.VertexCornersBegin()[v + 1]; ++k)
    {
      ring.push_back(mesh.VertexCorners()[k] / 3);
    }
  }
  std::sort(ring.begin(), ring.end());
  ring.erase(std::unique(ring.begin(), ring.end()), ring.end());
  ring.erase(std::lower_bound(ring.begin(), ring.end(), t));
}

/// Fill the lists whose members find(i, members) returns. It is called twice per list.
template <typename Find>
void FillLists(IndexLists& lists, Index count, const ParallelFor& parallel, const Find& find)
{
  lists.Begin.assign(static_cast<std::size_t>(count) + 1, 0);
  const auto each = [&](const auto& use)
  {
    ForEachBlock(parallel, count,
      [&](Index, Index begin, Index end)
      {
        std::vector<Index> members;
        for (Index i = begin; i < end; ++i)
        {
          find(i, members);
          use(i, members);
        }
      });
  };
  each([&](Index i, const std::vector<Index>& members)
    { lists.Begin[i] = static_cast<Index>(members.size()); });
  CountsToOffsets(lists.Begin);
  lists.Entries.resize(static_cast<std::size_t>(lists.Begin.back()));
  each([&](Index i, const std::vector<Index>& members)
    { std::copy(members.begin(), members.end(), lists.Entries.begin() + lists.Begin[i]); });
}

} // namespace

FaceGraph::FaceGraph(const TriangleMesh& mesh, const ParallelFor& parallel)
  : Mesh(mesh)
{
  const Index count = mesh.NumberOfTriangles();
  FillLists(this->Ring, count, parallel,
    [&](Index t, std::vector<Index>& members) { FindRing(mesh, t, members); });
  FillLists(this->Across, count, parallel,
    [&](Index t, std::vector<Index>& members)
    {
      members.clear();
      for (Index k = this->Ring.Begin[t]; k < this->Ring.Begin[t + 1]; ++k)
      {
        if (NumberOfSharedVertices(mesh.TriangleVertices(), t, this->Ring.Entries[k]) > 1)
        {
          members.push_back(this->Ring.Entries[k]);
        }
      }
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
