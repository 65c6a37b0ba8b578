// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Surface/MedialMesh.h"

#include "Core/Foundation/DisjointSets.h"

#include <algorithm>
#include <numeric>
#include <utility>

namespace SurfaceDiffusion
{

namespace
{

/// The distinct edges as pairs of vertices, the smaller one first, in ascending order: edges that
/// are neighbours on the surface stay neighbours in memory.
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

/// For every corner of a triangle the place of the opposite edge in the list.
Triangles OppositeEdges(const TriangleMesh& mesh, const std::vector<std::array<Index, 2>>& edges)
{
  const Triangles& vertices = mesh.TriangleVertices();
  Triangles opposite(mesh.NumberOfTriangles(), 3);
  for (Index t = 0; t < mesh.NumberOfTriangles(); ++t)
  {
    for (int a = 0; a < 3; ++a)
    {
      const Index i = vertices(t, (a + 1) % 3);
      const Index j = vertices(t, (a + 2) % 3);
      const std::array<Index, 2> edge = { std::min(i, j), std::max(i, j) };
      opposite(t, a) =
        static_cast<Index>(std::lower_bound(edges.begin(), edges.end(), edge) - edges.begin());
    }
  }
  return opposite;
}

/// The connected component of every edge. Triangles that share a vertex but no edge are not
/// connected here.
std::vector<Index> ComponentOfEdges(const Triangles& corners, Index edgeCount)
{
  DisjointSets connected(edgeCount);
  for (const auto& edges : corners.rowwise())
  {
    connected.Join(edges[0], edges[1]);
    connected.Join(edges[0], edges[2]);
  }
  return connected.Labels();
}

} // namespace

MedialMesh::MedialMesh(const TriangleMesh& mesh)
{
  const std::vector<std::array<Index, 2>> edges = ListEdges(mesh);
  const auto edgeCount = static_cast<Index>(edges.size());
  const Triangles corners = OppositeEdges(mesh, edges);
  const std::vector<Index> component = ComponentOfEdges(corners, edgeCount);

  // Edges of a component become consecutive and keep their order.
  std::vector<Index> order(edgeCount);
  std::iota(order.begin(), order.end(), 0);
  std::stable_sort(
    order.begin(), order.end(), [&](Index a, Index b) { return component[a] < component[b]; });
  std::vector<Index> number(edgeCount);
  this->EdgeEnds.resize(edgeCount);
  TriangleMesh::Contents medial;
  for (Index e = 0; e < edgeCount; ++e)
  {
    number[order[e]] = e;
    this->EdgeEnds[e] = edges[order[e]];
    if (e == 0 || component[order[e]] != component[order[e - 1]])
    {
      medial.ComponentsBegin.push_back(e);
    }
  }
  medial.ComponentsBegin.push_back(edgeCount);
  medial.TriangleVertices = corners.unaryExpr([&](Index e) { return number[e]; });

  medial.Shapes.reserve(mesh.Shapes().size());
  for (const TriangleMesh::Shape& s : mesh.Shapes())
  {
    medial.Shapes.push_back({ 0.5 * s.Length, 0.5 * s.X, 0.5 * s.Y, s.Weight });
  }
  medial.InputVertex.resize(edgeCount);
  std::iota(medial.InputVertex.begin(), medial.InputVertex.end(), 0);
  medial.InputTriangle = mesh.InputTriangle();
  medial.LengthUnit = mesh.LengthUnit();
  medial.TotalEdgeLength = 0.5 * mesh.TotalEdgeLength();
  medial.NumberOfEdges = mesh.NumberOfEdges();
  this->Medial = std::make_shared<TriangleMesh>(std::move(medial));
}

} // namespace SurfaceDiffusion
