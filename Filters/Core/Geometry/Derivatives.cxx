// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Geometry/Derivatives.h"

#include "Core/Operators/CotanWeights.h"

#include <Eigen/Geometry>

namespace SurfaceDiffusion
{

namespace
{

/// Column c of a row of vectors.
Eigen::RowVector3d VectorAt(const Values& vectors, Index row, Eigen::Index c)
{
  return vectors.row(row).segment<3>(3 * c);
}

Eigen::RowVector3d WithoutNormal(const Eigen::RowVector3d& v, const Eigen::RowVector3d& normal)
{
  return v - v.dot(normal) * normal;
}

} // namespace

Derivatives::Derivatives(
  const TriangleMesh& mesh, const Points& positions, const ParallelFor& parallel)
  : Mesh(mesh)
  , Positions(positions)
  , Parallel(parallel)
  , Oriented(FindOrientedNormals(mesh, positions, parallel))
{
  this->FindBoundary();
}

void Derivatives::FindBoundary()
{
  std::vector<char> atBoundary(static_cast<std::size_t>(this->Mesh.NumberOfVertices()), 0);
  for (const Index i : this->Mesh.BoundaryVertices())
  {
    atBoundary[i] = 1;
  }
  this->BoundarySides.assign(static_cast<std::size_t>(this->Mesh.NumberOfTriangles()), 0);
  ForEach(this->Parallel, this->Mesh.NumberOfTriangles(),
    [&](Index t)
    {
      for (int a = 0; a < 3; ++a)
      {
        Index i = this->Mesh.TriangleVertices()(t, (a + 1) % 3);
        Index j = this->Mesh.TriangleVertices()(t, (a + 2) % 3);
        if (!atBoundary[i] || !atBoundary[j])
        {
          continue;
        }
        const auto& begin = this->Mesh.VertexCornersBegin();
        if (begin[i + 1] - begin[i] > begin[j + 1] - begin[j])
        {
          std::swap(i, j);
        }
        int count = 0;
        for (Index c = begin[i]; c < begin[i + 1]; ++c)
        {
          const Index corner = this->Mesh.VertexCorners()[c];
          count += this->Mesh.OtherCorner(corner, 1) == j || this->Mesh.OtherCorner(corner, 2) == j;
        }
        this->BoundarySides[t] |= static_cast<std::uint8_t>(count == 1 ? 1U << a : 0U);
      }
    });
}

Eigen::RowVector3d Derivatives::BasisGradient(Index t, int a) const
{
  const auto corner = [&](int b) -> Eigen::RowVector3d
  { return this->Positions.row(this->Mesh.TriangleVertices()(t, b)); };
  const Eigen::RowVector3d x = (corner(1) - corner(0)).stableNormalized();
  const Eigen::RowVector3d side = corner(2) - corner(0);
  const Eigen::RowVector3d y = (side - side.dot(x) * x).stableNormalized();
  const Eigen::Vector2d g =
    Gradient(this->Mesh.Shapes()[t], a == 0 ? 1.0 : 0.0, a == 1 ? 1.0 : 0.0, a == 2 ? 1.0 : 0.0);
  return g[0] * x + g[1] * y;
}

Values Derivatives::Gradients(const Values& u) const
{
  Values gradients(this->Mesh.NumberOfTriangles(), 3 * u.cols());
  ForEach(this->Parallel, this->Mesh.NumberOfTriangles(),
    [&](Index t)
    {
      const auto corners = this->Mesh.TriangleVertices().row(t);
      const Eigen::RowVector3d first = this->BasisGradient(t, 1);
      const Eigen::RowVector3d second = this->BasisGradient(t, 2);
      for (Eigen::Index c = 0; c < u.cols(); ++c)
      {
        gradients.row(t).segment<3>(3 * c) = (u(corners[1], c) - u(corners[0], c)) * first +
          (u(corners[2], c) - u(corners[0], c)) * second;
      }
    });
  return gradients;
}

Values Derivatives::ToVertices(const Values& ofTriangles) const
{
  Values means(this->Mesh.NumberOfVertices(), ofTriangles.cols());
  ForEach(this->Parallel, this->Mesh.NumberOfVertices(),
    [&](Index i)
    {
      auto mean = means.row(i);
      mean.setZero();
      double area = 0.0;
      for (Index c = this->Mesh.VertexCornersBegin()[i]; c < this->Mesh.VertexCornersBegin()[i + 1];
           ++c)
      {
        const Index t = this->Mesh.VertexCorners()[c] / 3;
        mean += this->Mesh.Shapes()[t].Area() * ofTriangles.row(t);
        area += this->Mesh.Shapes()[t].Area();
      }
      for (Eigen::Index c = 0; c < means.cols() / 3; ++c)
      {
        mean.segment<3>(3 * c) =
          WithoutNormal(mean.segment<3>(3 * c) / area, this->Oriented.OfVertices.row(i));
      }
    });
  return means;
}

Values Derivatives::ToTriangles(const Values& ofVertices) const
{
  Values means(this->Mesh.NumberOfTriangles(), ofVertices.cols());
  ForEach(this->Parallel, this->Mesh.NumberOfTriangles(),
    [&](Index t)
    {
      const auto corners = this->Mesh.TriangleVertices().row(t);
      for (Eigen::Index c = 0; c < means.cols() / 3; ++c)
      {
        const Eigen::RowVector3d sum = VectorAt(ofVertices, corners[0], c) +
          VectorAt(ofVertices, corners[1], c) + VectorAt(ofVertices, corners[2], c);
        means.row(t).segment<3>(3 * c) =
          WithoutNormal(sum / 3.0, this->Oriented.OfTriangles.row(t));
      }
    });
  return means;
}

template <typename OnTriangle, typename OnEdge>
Values Derivatives::SumFluxes(
  Eigen::Index columns, const OnTriangle& onTriangle, const OnEdge& onEdge) const
{
  Values sums(this->Mesh.NumberOfVertices(), columns);
  ForEach(this->Parallel, this->Mesh.NumberOfVertices(),
    [&](Index i)
    {
      auto sum = sums.row(i);
      sum.setZero();
      for (Index k = this->Mesh.VertexCornersBegin()[i]; k < this->Mesh.VertexCornersBegin()[i + 1];
           ++k)
      {
        const Index corner = this->Mesh.VertexCorners()[k];
        const Index t = corner / 3;
        const auto own = static_cast<int>(corner % 3);
        const double area = this->Mesh.Shapes()[t].Area();
        const Eigen::RowVector3d inward = this->BasisGradient(t, own);
        for (Eigen::Index c = 0; c < columns; ++c)
        {
          sum[c] -= area * onTriangle(t, c).dot(inward);
        }
        for (int a = 0; a < 3; ++a) // the edges at the vertex are opposite the other corners
        {
          if (a != own && (this->BoundarySides[t] & (1U << a)))
          {
            // The length of the edge times its conormal.
            const Eigen::RowVector3d outward = -2.0 * area * this->BasisGradient(t, a);
            const Index other = this->Mesh.TriangleVertices()(t, 3 - a - own);
            for (Eigen::Index c = 0; c < columns; ++c)
            {
              sum[c] += onEdge(t, i, other, c).dot(outward);
            }
          }
        }
      }
      sum /= this->Mesh.ControlAreas()[i];
    });
  return sums;
}

template <typename Turn>
Values Derivatives::SumOfTriangles(const Values& ofTriangles, const Turn& turn) const
{
  const auto of = [&](Index t, Eigen::Index c) { return turn(VectorAt(ofTriangles, t, c), t); };
  return this->SumFluxes(ofTriangles.cols() / 3, of,
    [&](Index t, Index, Index, Eigen::Index c) { return Eigen::RowVector3d(0.5 * of(t, c)); });
}

template <typename Turn>
Values Derivatives::SumOfVertices(const Values& ofVertices, const Turn& turn) const
{
  const Values means = this->ToTriangles(ofVertices);
  return this->SumFluxes(
    means.cols() / 3, [&](Index t, Eigen::Index c) { return turn(VectorAt(means, t, c), t); },
    [&](Index t, Index i, Index j, Eigen::Index c)
    {
      const Eigen::RowVector3d onEdge =
        VectorAt(ofVertices, i, c) / 3.0 + VectorAt(ofVertices, j, c) / 6.0;
      return turn(onEdge, t);
    });
}

Values Derivatives::Divergence(const Values& ofTriangles) const
{
  return this->SumOfTriangles(ofTriangles, [](const Eigen::RowVector3d& v, Index) { return v; });
}

Values Derivatives::DivergenceOfVertices(const Values& ofVertices) const
{
  return this->SumOfVertices(ofVertices, [](const Eigen::RowVector3d& v, Index) { return v; });
}

Values Derivatives::Curl(const Values& ofTriangles) const
{
  return this->SumOfTriangles(ofTriangles,
    [this](const Eigen::RowVector3d& v, Index t)
    { return Eigen::RowVector3d(v.cross(this->Oriented.OfTriangles.row(t))); });
}

Values Derivatives::CurlOfVertices(const Values& ofVertices) const
{
  return this->SumOfVertices(ofVertices,
    [this](const Eigen::RowVector3d& v, Index t)
    { return Eigen::RowVector3d(v.cross(this->Oriented.OfTriangles.row(t))); });
}

} // namespace SurfaceDiffusion
