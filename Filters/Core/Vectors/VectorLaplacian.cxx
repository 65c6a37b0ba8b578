// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Vectors/VectorLaplacian.h"

#include "Core/Operators/CotanWeights.h"

#include <algorithm>

namespace SurfaceDiffusion
{

/// Rows 2 a and 2 a + 1 are those of corner a.
VectorStiffness::Element VectorStiffness::ElementOf(Index t) const
{
  const TriangleMesh::Shape shape = this->Planes.Mesh().Shapes()[static_cast<std::size_t>(t)];
  std::array<Eigen::Matrix2d, 3> frames; // of the corners
  for (int a = 0; a < 3; ++a)
  {
    frames[a] = this->Planes.InTriangle(3 * t + a);
  }
  Element element = Element::Zero();
  if (this->Laplacian == VectorLaplacian::Connection)
  {
    const Eigen::RowVector3d weights = this->Coefficients.rows() > 0
      ? Eigen::RowVector3d(this->Coefficients.row(t))
      : CotanWeights(shape);
    for (int a = 0; a < 3; ++a)
    {
      for (int b = 0; b < 3; ++b)
      {
        const double weight =
          a == b ? weights[(a + 1) % 3] + weights[(a + 2) % 3] : -weights[3 - a - b];
        element.block<2, 2>(2 * a, 2 * b) = weight * frames[a].transpose() * frames[b];
      }
    }
    return element;
  }
  Eigen::Matrix<double, 4, 6> derivatives; // G11, G12, G21 and G22 of each coordinate
  for (int a = 0; a < 3; ++a)
  {
    const Eigen::RowVector2d gradient = Gradient(shape, a == 0, a == 1, a == 2).transpose();
    for (int k = 0; k < 2; ++k)
    {
      const Eigen::Matrix2d g = frames[a].col(k) * gradient;
      derivatives.col(2 * a + k) << g(0, 0), g(0, 1), g(1, 0), g(1, 1);
    }
  }
  const auto trace = derivatives.row(0) + derivatives.row(3);
  if (this->Laplacian == VectorLaplacian::Hodge)
  {
    const auto rotation = derivatives.row(2) - derivatives.row(1);
    element = trace.transpose() * trace + rotation.transpose() * rotation;
  }
  else
  {
    const auto shear = derivatives.row(1) + derivatives.row(2);
    element = 2.0 * derivatives.row(0).transpose() * derivatives.row(0) +
      2.0 * derivatives.row(3).transpose() * derivatives.row(3) + shear.transpose() * shear;
  }
  return shape.Area() * element;
}

SparseMatrix VectorStiffness::Assemble(const SparsePattern& pattern, const Vector& diagonal,
  double scale, const ParallelFor& parallel) const
{
  const TriangleMesh& mesh = this->Planes.Mesh();
  const Index n = mesh.NumberOfVertices();
  SparsePattern blocks;
  blocks.Outer.resize(2 * static_cast<std::size_t>(n) + 1);
  blocks.Outer[0] = 0;
  for (Index i = 0; i < n; ++i)
  {
    const Index length = 2 * (pattern.Outer[i + 1] - pattern.Outer[i]);
    blocks.Outer[2 * i + 1] = blocks.Outer[2 * i] + length;
    blocks.Outer[2 * i + 2] = blocks.Outer[2 * i + 1] + length;
  }
  SparseMatrix matrix;
  matrix.resize(2 * n, 2 * n);
  matrix.resizeNonZeros(blocks.Outer.back());
  std::copy(blocks.Outer.begin(), blocks.Outer.end(), matrix.outerIndexPtr());
  ForEach(parallel, n,
    [&](Index i)
    {
      const Index* const neighbours = pattern.Inner.data() + pattern.Outer[i];
      const Index degree = pattern.Outer[i + 1] - pattern.Outer[i];
      for (Index row = 2 * i; row < 2 * i + 2; ++row)
      {
        const Index begin = blocks.Outer[row];
        for (Index k = 0; k < degree; ++k)
        {
          matrix.innerIndexPtr()[begin + 2 * k] = 2 * neighbours[k];
          matrix.innerIndexPtr()[begin + 2 * k + 1] = 2 * neighbours[k] + 1;
        }
        std::fill_n(matrix.valuePtr() + begin, 2 * degree, 0.0);
      }
      const auto slotOf = [&](Index j)
      {
        return 2 *
          static_cast<Index>(std::lower_bound(neighbours, neighbours + degree, j) - neighbours);
      };
      for (Index c = mesh.VertexCornersBegin()[i]; c < mesh.VertexCornersBegin()[i + 1]; ++c)
      {
        const Index corner = mesh.VertexCorners()[c];
        const Element element = this->ElementOf(corner / 3);
        for (int b = 0; b < 3; ++b)
        {
          const Index slot = slotOf(mesh.TriangleVertices()(corner / 3, b));
          for (int k = 0; k < 4; ++k) // the entries of a block
          {
            matrix.valuePtr()[blocks.Outer[2 * i + k / 2] + slot + k % 2] +=
              scale * element(2 * (corner % 3) + k / 2, 2 * b + k % 2);
          }
        }
      }
      const Index own = slotOf(i);
      matrix.valuePtr()[blocks.Outer[2 * i] + own] += diagonal[2 * i];
      matrix.valuePtr()[blocks.Outer[2 * i + 1] + own + 1] += diagonal[2 * i + 1];
    });
  return matrix;
}

double VectorStiffness::Energy(const Values& w, const ParallelFor& parallel) const
{
  const Triangles& corners = this->Planes.Mesh().TriangleVertices();
  return Sum(parallel, this->Planes.Mesh().NumberOfTriangles(),
    [&](Index t)
    {
      const Element element = this->ElementOf(t);
      double energy = 0.0;
      for (Eigen::Index k = 0; k < w.cols(); ++k)
      {
        Eigen::Matrix<double, 6, 1> own;
        for (int row = 0; row < 6; ++row)
        {
          own[row] = w(2 * corners(t, row / 2) + row % 2, k);
        }
        energy += 0.5 * own.dot(element * own);
      }
      return energy;
    });
}

} // namespace SurfaceDiffusion
