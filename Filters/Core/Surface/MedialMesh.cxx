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

/// An edge: its vertices, the smaller one first, and its number if these do not determine it.
using Edge = std::array<Index, 3>;

/// The edge opposite corner a of triangle t.
Edge OppositeEdge(const TriangleMesh& mesh, Index t, int a)
{
  const Index i = mesh.TriangleVertices()(t, (a + 1) % 3);
  const Index j = mesh.TriangleVertices()(t, (a + 2) % 3);
  const Index number = mesh.TriangleEdges().rows() > 0 ? mesh.TriangleEdges()(t, a) : 0;
  return { std::min(i, j), std::max(i, j), number };
}

/// The distinct edges in ascending order: edges that are neighbours on the surface stay neighbours
/// in memory.
std::vector<Edge> ListEdges(const TriangleMesh& mesh)
{
  std::vector<Edge> edges;
  edges.reserve(mesh.NumberOfEdges());
  std::vector<Edge> here;
  for (Index i = 0; i < mesh.NumberOfVertices(); ++i)
  {
    here.clear();
    for (Index c = mesh.VertexCornersBegin()[i]; c < mesh.VertexCornersBegin()[i + 1]; ++c)
    {
      const Index corner = mesh.VertexCorners()[c];
      for (const int a : { (corner + 1) % 3, (corner + 2) % 3 })
      {
        const Edge edge = OppositeEdge(mesh, corner / 3, a);
        if (edge[0] == i)
        {
          here.push_back(edge);
        }
      }
    }
    std::sort(here.begin(), here.end());
    here.erase(std::unique(here.begin(), here.end()), here.end());
    edges.insert(edges.end(), here.begin(), here.end());
  }
  return edges;
}

/// For every corner of a triangle the place of the opposite edge in the list.
Triangles OppositeEdges(const TriangleMesh& mesh, const std::vector<Edge>& edges)
{
  Triangles opposite(mesh.NumberOfTriangles(), 3);
  for (Index t = 0; t < mesh.NumberOfTriangles(); ++t)
  {
    for (int a = 0; a < 3; ++a)
    {
      const Edge edge = OppositeEdge(mesh, t, a);
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

/// Give each triangle of an edge of three or more an edge of its own: the first one this edge, the others
/// new ones at the end of the list.
void SplitJunctions(std::vector<Edge>& edges, Triangles& corners)
{
  constexpr Index taken = -1;
  std::vector<Index> uses(edges.size(), 0);
  for (const auto& opposite : corners.rowwise())
  {
    for (const Index e : opposite)
    {
      ++uses[e];
    }
  }
  for (auto&& opposite : corners.rowwise())
  {
    for (Index& e : opposite)
    {
      if (uses[e] > 2)
      {
        uses[e] = taken;
      }
      else if (uses[e] == taken)
      {
        edges.push_back(Edge(edges[e]));
        e = static_cast<Index>(edges.size()) - 1;
      }
    }
  }
}

} // namespace

MedialMesh::MedialMesh(const TriangleMesh& mesh, bool splitsJunctions)
{
  std::vector<Edge> edges = ListEdges(mesh);
  Triangles corners = OppositeEdges(mesh, edges);
  if (splitsJunctions)
  {
    SplitJunctions(edges, corners);
  }
  const auto edgeCount = static_cast<Index>(edges.size());
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
    this->EdgeEnds[e] = { edges[order[e]][0], edges[order[e]][1] };
    if (e == 0 || component[order[e]] != component[order[e - 1]])
    {
      medial.ComponentsBegin.push_back(e);
    }
  }
  medial.ComponentsBegin.push_back(edgeCount);
  medial.TriangleVertices = corners.unaryExpr([&](Index e) { return number[e]; });

  medial.Shapes = TriangleMesh::ShapeList(mesh.Shapes().Size(), mesh.Shapes().GetWeight());
  for (Index t = 0; t < mesh.Shapes().Size(); ++t)
  {
    const TriangleMesh::Shape s = mesh.Shapes()[t];
    medial.Shapes.Set(t, 0.5 * s.Length, 0.5 * s.X, 0.5 * s.Y);
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
