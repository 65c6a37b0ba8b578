// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Geometry/Derivatives.h"

#include "Core/Geometry/QuadraticFits.h"
#include "Core/Operators/CotanWeights.h"

#include <Eigen/Geometry>

#include <limits>

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
        for (Index c = begin[i]; c < begin[i + 1] && count < 2; ++c)
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
          sum[c] -= area * onTriangle(corner, c).dot(inward);
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
              sum[c] += onEdge(corner, i, other, c).dot(outward);
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
  const auto of = [&](Index corner, Eigen::Index c)
  { return turn(VectorAt(ofTriangles, corner / 3, c), corner); };
  return this->SumFluxes(ofTriangles.cols() / 3, of,
    [&](Index corner, Index, Index, Eigen::Index c)
    { return Eigen::RowVector3d(0.5 * of(corner, c)); });
}

template <typename Turn>
Values Derivatives::SumOfVertices(const Values& ofVertices, const Turn& turn) const
{
  const Values means = this->ToTriangles(ofVertices);
  return this->SumFluxes(
    means.cols() / 3,
    [&](Index corner, Eigen::Index c) { return turn(VectorAt(means, corner / 3, c), corner); },
    [&](Index corner, Index i, Index j, Eigen::Index c)
    {
      const Eigen::RowVector3d onEdge =
        VectorAt(ofVertices, i, c) / 3.0 + VectorAt(ofVertices, j, c) / 6.0;
      return turn(onEdge, corner);
    });
}

Values Derivatives::Divergence(const Values& ofTriangles) const
{
  return this->SumOfTriangles(ofTriangles, [](const Eigen::RowVector3d& v, Index) { return v; });
}

Values Derivatives::DivergenceOfVertices(const Values& ofVertices) const
{
  const Points normals = SphericalNormals(this->Mesh, this->Oriented, this->Parallel);
  Values tangential(ofVertices.rows(), ofVertices.cols());
  ForEach(this->Parallel, this->Mesh.NumberOfVertices(),
    [&](Index i)
    {
      for (Eigen::Index c = 0; c < ofVertices.cols() / 3; ++c)
      {
        tangential.row(i).segment<3>(3 * c) =
          WithoutNormal(VectorAt(ofVertices, i, c), normals.row(i));
      }
    });
  return this->SumOfVertices(tangential, [](const Eigen::RowVector3d& v, Index) { return v; });
}

Eigen::RowVector3d Derivatives::Turned(const Eigen::RowVector3d& v, Index corner) const
{
  return this->Oriented.SideOf(corner) * v.cross(this->Oriented.OfTriangles.row(corner / 3));
}

Values Derivatives::WithoutSign(Values curl) const
{
  for (Index i = 0; i < this->Mesh.NumberOfVertices(); ++i)
  {
    if (this->Oriented.IsOnOneSide(i))
    {
      curl.row(i) = curl.row(i).cwiseAbs();
    }
  }
  return curl;
}

Values Derivatives::Curl(const Values& ofTriangles) const
{
  return this->WithoutSign(this->SumOfTriangles(ofTriangles,
    [this](const Eigen::RowVector3d& v, Index corner) { return this->Turned(v, corner); }));
}

Values Derivatives::CurlOfVertices(const Values& ofVertices) const
{
  return this->WithoutSign(this->SumOfVertices(ofVertices,
    [this](const Eigen::RowVector3d& v, Index corner) { return this->Turned(v, corner); }));
}

Values Derivatives::Laplacian(const Values& u) const
{
  Values laplacian = this->Divergence(this->Gradients(u));
  const std::vector<Index>& boundary = this->Mesh.BoundaryVertices();
  ForEachBlock(this->Parallel, static_cast<Index>(boundary.size()),
    [&](Index, Index begin, Index end)
    {
      QuadraticFits fits(this->Mesh, this->Positions, this->Oriented);
      for (Index b = begin; b < end; ++b)
      {
        const Index i = boundary[b];
        if (!fits.MoveTo(i) || !fits.IsDetermined())
        {
          laplacian.row(i).setConstant(std::numeric_limits<double>::quiet_NaN());
          continue;
        }
        for (Eigen::Index c = 0; c < u.cols(); ++c)
        {
          Vector differences(static_cast<Eigen::Index>(fits.Vertices().size()));
          for (Eigen::Index k = 0; k < differences.size(); ++k)
          {
            differences[k] = u(fits.Vertices()[static_cast<std::size_t>(k)], c) - u(i, c);
          }
          laplacian(i, c) = fits.LaplacianOf(fits.Fit(differences));
        }
      }
    });
  return laplacian;
}

} // namespace SurfaceDiffusion
