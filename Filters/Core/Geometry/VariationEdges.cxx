// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Geometry/VariationEdges.h"

#include <Eigen/Geometry>

namespace SurfaceDiffusion
{

namespace
{

/// The axes of a triangle: along the edge after one of its corners, and to the left of it.
struct Axes
{
  Axes(const TriangleMesh& mesh, const Points& points, const FaceGeometry& geometry, Index f,
    int corner)
  {
    const auto corners = mesh.TriangleVertices().row(f);
    this->First =
      (points.row(corners[(corner + 1) % 3]) - points.row(corners[corner])).normalized();
    this->Second = Eigen::RowVector3d(geometry.Normals.row(f)).cross(this->First);
  }
  Eigen::Vector2d operator()(const Eigen::RowVector3d& v) const
  {
    return { this->First.dot(v), this->Second.dot(v) };
  }

  Eigen::RowVector3d First, Second;
};

/// The corner of a triangle before its longest edge.
char CornerBeforeLongestEdge(const TriangleMesh& mesh, const Points& points, Index f)
{
  const auto corners = mesh.TriangleVertices().row(f);
  const auto square = [&](int a)
  { return (points.row(corners[(a + 1) % 3]) - points.row(corners[a])).squaredNorm(); };
  int longest = square(1) > square(0) ? 1 : 0;
  longest = square(2) > square(longest) ? 2 : longest;
  return static_cast<char>(longest);
}

/// The corner of triangle f opposite the edge that it shares with triangle g; -1: none.
int CornerOpposite(const Triangles& triangles, Index f, Index g)
{
  int opposite = -1;
  int shared = 0;
  for (int a = 0; a < 3; ++a)
  {
    const Index v = triangles(f, a);
    const bool isShared = v == triangles(g, 0) || v == triangles(g, 1) || v == triangles(g, 2);
    shared += isShared;
    opposite = isShared ? opposite : a;
  }
  return shared == 2 ? opposite : -1;
}

/// The only triangle on the other side of the edge of f opposite a corner; -1: none or several.
Index OnlyNeighbour(const FaceGraph& graph, Index f, int corner)
{
  Index found = -1;
  for (Offset k = graph.Across.Begin[f]; k < graph.Across.Begin[f + 1]; ++k)
  {
    const Index g = graph.Across.Entries[k];
    if (CornerOpposite(graph.Mesh.TriangleVertices(), f, g) == corner)
    {
      if (found >= 0)
      {
        return -1;
      }
      found = g;
    }
  }
  return found;
}

} // namespace

VariationEdges::VariationEdges(const FaceGraph& graph, double unit)
  : Graph(graph)
  , Unit(unit)
  , EdgesOf(static_cast<std::size_t>(graph.NumberOfFaces()), { -1, -1, -1 })
{
  const Triangles& triangles = graph.Mesh.TriangleVertices();
  this->Edges.reserve(graph.Across.Entries.size() / 2);
  for (Index f = 0; f < graph.NumberOfFaces(); ++f)
  {
    for (int a = 0; a < 3; ++a)
    {
      const Index g = OnlyNeighbour(graph, f, a);
      if (g > f)
      {
        const int b = CornerOpposite(triangles, g, f);
        this->EdgesOf[f][a] = this->EdgesOf[g][b] = this->Size();
        VariationEdge edge;
        edge.Faces = { f, g };
        this->Edges.push_back(edge);
      }
    }
  }
}

void VariationEdges::SetPlaces(
  const Points& points, const FaceGeometry& geometry, const ParallelFor& parallel)
{
  const TriangleMesh& mesh = this->Graph.Mesh;
  if (this->FirstCorners.empty())
  {
    this->FirstCorners.resize(this->EdgesOf.size());
    ForEach(parallel, this->Graph.NumberOfFaces(),
      [&](Index f) { this->FirstCorners[f] = CornerBeforeLongestEdge(mesh, points, f); });
  }
  ForEach(parallel, this->Size(),
    [&](Index e)
    {
      VariationEdge& edge = this->Edges[e];
      const Index f = edge.Faces[0];
      const int a = CornerOpposite(mesh.TriangleVertices(), f, edge.Faces[1]);
      const Eigen::RowVector3d first = points.row(mesh.TriangleVertices()(f, (a + 1) % 3));
      const Eigen::RowVector3d last = points.row(mesh.TriangleVertices()(f, (a + 2) % 3));
      edge.Length = static_cast<float>((last - first).norm() / this->Unit);
      for (int side = 0; side < 2; ++side)
      {
        const Index t = edge.Faces[side];
        const Axes axes(mesh, points, geometry, t, this->FirstCorners[t]);
        const Eigen::Vector2d middle =
          axes(0.5 * (first + last) - geometry.Centroids.row(t)) / this->Unit;
        const Eigen::Vector2d along = axes(last - first).normalized();
        const double out = along[0] * middle[1] - along[1] * middle[0];
        Eigen::Map<Eigen::Vector2f>(edge.Middle[side]) = middle.cast<float>();
        Eigen::Map<Eigen::Vector2f>(edge.Along[side]) = along.cast<float>();
        edge.Side[side] = out > 0.0 ? 1.0F : -1.0F;
      }
    });
}

void VariationEdges::SetWeights(const Points& normals, double range, const ParallelFor& parallel)
{
  ForEach(parallel, this->Size(),
    [&](Index e)
    {
      VariationEdge& edge = this->Edges[e];
      const double square = (normals.row(edge.Faces[0]) - normals.row(edge.Faces[1])).squaredNorm();
      edge.Weight = static_cast<float>(1.0 / (1.0 + square / (range * range)));
    });
}

} // namespace SurfaceDiffusion
