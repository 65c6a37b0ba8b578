// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Models/Interpolation/SlopeSquares.h"

#include "Core/Operators/CotanWeights.h"

#include <algorithm>

namespace SurfaceDiffusion
{

SlopeSquares::SlopeSquares(const TriangleMesh& mesh, const ParallelFor& parallel)
  : Mesh(mesh)
  , Parallel(parallel)
  , Coefficients(CotanWeights(mesh, parallel))
{
}

template <typename Along>
Vector SlopeSquares::Around(const Along& squareAlong) const
{
  Vector integrals(this->Mesh.NumberOfTriangles()); // |T| |grad u|^2
  ForEach(this->Parallel, this->Mesh.NumberOfTriangles(),
    [&](Index t)
    {
      integrals[t] = 0.0;
      for (int a = 0; a < 3; ++a)
      {
        integrals[t] += this->Coefficients(t, a) * squareAlong(t, a);
      }
    });
  Vector squares(this->Mesh.NumberOfVertices());
  ForEach(this->Parallel, this->Mesh.NumberOfVertices(),
    [&](Index i)
    {
      const std::vector<Index>& begin = this->Mesh.VertexCornersBegin();
      double integral = 0.0;
      double area = 0.0;
      for (Index k = begin[i]; k < begin[i + 1]; ++k)
      {
        const Index t = this->Mesh.VertexCorners()[k] / 3;
        integral += integrals[t];
        area += this->Mesh.Shapes()[static_cast<std::size_t>(t)].Area();
      }
      squares[i] = std::max(0.0, integral / (2.0 * area));
    });
  return squares;
}

Vector SlopeSquares::Of(const Values& u, const Vector& factors) const
{
  const Triangles& corners = this->Mesh.TriangleVertices();
  return this->Around(
    [&](Index t, int a)
    {
      const Index i = corners(t, (a + 1) % 3);
      const Index j = corners(t, (a + 2) % 3);
      double sum = 0.0;
      for (Eigen::Index k = 0; k < u.cols(); ++k)
      {
        const double difference = u(i, k) - u(j, k);
        sum += factors[k] * difference * difference;
      }
      return sum;
    });
}

std::vector<InverseEntry> SlopeSquares::Edges() const
{
  std::vector<InverseEntry> edges;
  edges.reserve(3 * static_cast<std::size_t>(this->Mesh.NumberOfTriangles()));
  for (Index c = 0; c < 3 * this->Mesh.NumberOfTriangles(); ++c)
  {
    edges.push_back({ this->Mesh.OtherCorner(c, 1), this->Mesh.OtherCorner(c, 2), 0.0 });
  }
  return edges;
}

Vector SlopeSquares::OfCovariance(
  const Vector& diagonal, const std::vector<InverseEntry>& edges) const
{
  return this->Around(
    [&](Index t, int a)
    {
      const InverseEntry& edge =
        edges[3 * static_cast<std::size_t>(t) + static_cast<std::size_t>(a)];
      return diagonal[edge.Row] + diagonal[edge.Column] - 2.0 * edge.Value;
    });
}

} // namespace SurfaceDiffusion
