// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Core/Foundation/Columns.h"
#include "Core/Foundation/Parallel.h"
#include "Core/Operators/GradientMap.h"

#include <array>
#include <memory>
#include <utility>
#include <vector>

namespace SurfaceDiffusion
{

/// The linear operator B of total generalised variation. It acts on x = (u, w), where u has a row
/// per vertex and w two rows per triangle, a vector in the triangle's own axes, and has a group of
/// two rows
///   grad u - w_t         for each triangle t, and then
///   w_left - P w_right   for each edge of two triangles,
/// where P rotates from the axes of one triangle to those of the other with both laid in one plane.
/// Edges of one triangle, and of three or more, where there is no such rotation, have no group.
class GeneralizedGradient
{
public:
  GeneralizedGradient(std::shared_ptr<const TriangleMesh> mesh, const ParallelFor& parallel);

  Index NumberOfVertices() const { return this->Mesh->NumberOfVertices(); }
  Index NumberOfTriangles() const { return this->Mesh->NumberOfTriangles(); }
  Index NumberOfEdges() const { return static_cast<Index>(this->Edges.size()); }
  Index NumberOfGroups() const { return this->NumberOfTriangles() + this->NumberOfEdges(); }
  Index NumberOfRows() const { return this->NumberOfVertices() + 2 * this->NumberOfTriangles(); }

  struct Edge
  {
    Index Left, Right; ///< triangles
    double Length; ///< times the weight of the mesh's areas
    Eigen::Matrix2d P;
  };
  const Edge& GetEdge(Index e) const { return this->Edges[static_cast<std::size_t>(e)]; }

  /// Group g of B x, for column k.
  Eigen::Vector2d Apply(Index g, const Values& x, Eigen::Index k) const
  {
    if (g < this->NumberOfTriangles())
    {
      const Triangles& corners = this->Mesh->TriangleVertices();
      const GradientMap& map = this->Maps[static_cast<std::size_t>(g)];
      const double x0 = x(corners(g, 0), k);
      return (x(corners(g, 1), k) - x0) * map.First + (x(corners(g, 2), k) - x0) * map.Second -
        this->VectorOf(g, x, k);
    }
    const Edge& edge = this->GetEdge(g - this->NumberOfTriangles());
    return this->VectorOf(edge.Left, x, k) - edge.P * this->VectorOf(edge.Right, x, k);
  }

  /// Add to the K columns of `row` the row of vertex i of B^T y. y(t, k): the vector of triangle t.
  template <int K, typename Y>
  void GatherAtVertex(Index i, const Y& y, double* row, int count) const
  {
    const ColumnCount<K> columns(count);
    for (Index c = this->Mesh->VertexCornersBegin()[i]; c < this->Mesh->VertexCornersBegin()[i + 1];
         ++c)
    {
      const Index corner = this->Mesh->VertexCorners()[c];
      const Index t = corner / 3;
      const Eigen::Vector2d gradient =
        this->Maps[static_cast<std::size_t>(t)].OfCorner(corner - 3 * t);
      for (int k = 0; k < columns; ++k)
      {
        row[k] += gradient.dot(y(t, k));
      }
    }
  }
  /// What edges give to column k of the rows of triangle t of B^T y. y(e): the vector of edge e.
  template <typename Y>
  Eigen::Vector2d GatherAtTriangle(Index t, const Y& y) const
  {
    Eigen::Vector2d sum = Eigen::Vector2d::Zero();
    for (const Index side : this->Sides[static_cast<std::size_t>(t)])
    {
      if (side >= 0)
      {
        const Index e = side / 2;
        const Eigen::Vector2d vector = y(e);
        sum += side % 2 == 0 ? vector : Eigen::Vector2d(-this->GetEdge(e).P.transpose() * vector);
      }
    }
    return sum;
  }

  /// w of triangle t in column k of x.
  Eigen::Vector2d VectorOf(Index t, const Values& x, Eigen::Index k) const
  {
    const Index row = this->NumberOfVertices() + 2 * t;
    return { x(row, k), x(row + 1, k) };
  }

  /// B^T diag(weights) B, with one weight for each group.
  SparseMatrix MakeMatrix(const Vector& weights, const ParallelFor& parallel) const;

private:
  using Entries = std::vector<std::pair<Index, double>>;

  void ListEdges();
  void AddEdge(Index side, Index other);
  Eigen::Matrix2d AxesOfSide(Index side) const;
  template <typename Use>
  void ForEachEntry(Index g, const Use& use) const;
  template <typename Use>
  void ForEachGroup(Index row, const Use& use) const;
  void MakeRow(Index row, const Vector& weights, Entries& entries) const;

  std::shared_ptr<const TriangleMesh> Mesh;
  std::vector<GradientMap> Maps;
  std::vector<Edge> Edges;
  /// Per triangle and corner: of the edge opposite, twice its number, and one more at its right
  /// triangle; -1 without a group.
  std::vector<std::array<Index, 3>> Sides;
};

} // namespace SurfaceDiffusion
