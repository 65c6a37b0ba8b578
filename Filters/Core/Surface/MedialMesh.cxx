// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Surface/MedialMesh.h"

#include "Core/Foundation/DisjointSets.h"

#include <algorithm>
#include <numeric>

namespace SurfaceDiffusion
{

namespace
{

/// The distinct edges as pairs of vertices, smaller one first, ascending: neighbours along the
/// vertices' curve stay neighbours.
std::vector<std::array<Index, 2>> ListEdges(const TriangleMesh& mesh)
{
  std::vector<std::array<Index, 2>> edges;
  edges.reserve(mesh.NumberOfEdges());
  std::vector<Index> ends;
  for (Index i = 0; i < mesh.NumberOfVertices(); ++i)
  {
    ends.clear();
    for (Index c = mesh.VertexCornersBegin()[i]; c < mesh.VertexCornersBegin()[i + 1]; ++c)
    {
      for (const int step : { 1, 2 })
      {
        const Index j = mesh.OtherCorner(mesh.VertexCorners()[c], step);
        if (j >= i)
        {
          ends.push_back(j);
        }
      }
    }
    std::sort(ends.begin(), ends.end());
    ends.erase(std::unique(ends.begin(), ends.end()), ends.end());
    for (const Index j : ends)
    {
      edges.push_back({ i, j });
    }
  }
  return edges;
}

} // namespace

MedialMesh::MedialMesh(const TriangleMesh& mesh)
{
  const std::vector<std::array<Index, 2>> edges = ListEdges(mesh);
  const Index edgeCount = static_cast<Index>(edges.size());
  const Index triangleCount = mesh.NumberOfTriangles();
  const Triangles& vertices = mesh.TriangleVertices();
  Triangles corners(triangleCount, 3);
  for (Index t = 0; t < triangleCount; ++t)
  {
    for (int a = 0; a < 3; ++a)
    {
      const Index i = vertices(t, (a + 1) % 3);
      const Index j = vertices(t, (a + 2) % 3);
      const std::array<Index, 2> edge = { std::min(i, j), std::max(i, j) };
      corners(t, a) =
        static_cast<Index>(std::lower_bound(edges.begin(), edges.end(), edge) - edges.begin());
    }
  }

  // Gather components, keeping the order within each. Triangles that share a vertex but no edge are
  // not connected here.
  DisjointSets connected(edgeCount);
  for (Index t = 0; t < triangleCount; ++t)
  {
    connected.Join(corners(t, 0), corners(t, 1));
    connected.Join(corners(t, 0), corners(t, 2));
  }
  const std::vector<Index> label = connected.Labels();
  std::vector<Index> order(edgeCount);
  std::iota(order.begin(), order.end(), 0);
  std::stable_sort(
    order.begin(), order.end(), [&](Index a, Index b) { return label[a] < label[b]; });
  std::vector<Index> number(edgeCount);
  auto medial = std::shared_ptr<TriangleMesh>(new TriangleMesh);
  this->EdgeEnds.resize(edgeCount);
  for (Index e = 0; e < edgeCount; ++e)
  {
    number[order[e]] = e;
    this->EdgeEnds[e] = edges[order[e]];
    if (e == 0 || label[order[e]] != label[order[e - 1]])
    {
      medial->Components.push_back(e);
    }
  }
  medial->Components.push_back(edgeCount);
  medial->Corners = corners.unaryExpr([&](Index e) { return number[e]; });

  medial->TriangleShapes.reserve(triangleCount);
  for (const TriangleMesh::Shape& s : mesh.Shapes())
  {
    medial->TriangleShapes.push_back({ 0.5 * s.Length, 0.5 * s.X, 0.5 * s.Y, s.Weight });
  }
  medial->InputVertices.resize(edgeCount);
  std::iota(medial->InputVertices.begin(), medial->InputVertices.end(), 0);
  medial->InputTriangles = mesh.InputTriangle();
  medial->ListCorners();
  medial->MeasureAreas(SerialFor());
  medial->Unit = mesh.LengthUnit();
  medial->EdgeLength = 0.5 * mesh.TotalEdgeLength();
  medial->Edges = mesh.NumberOfEdges();
  this->Medial = medial;
}

} // namespace SurfaceDiffusion
