// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Operators/LineFieldOperator.h"

#include "Core/Operators/CotanWeights.h"
#include "Core/Surface/MedialMesh.h"

#include <cmath>

namespace SurfaceDiffusion
{

namespace
{

/// exp(2 i a) for a vector at angle a and of any length, zero for the zero vector.
Eigen::Vector2d Square(double x, double y)
{
  const double square = x * x + y * y;
  return square > 0.0 ? Eigen::Vector2d((x * x - y * y) / square, 2.0 * x * y / square)
                      : Eigen::Vector2d(Eigen::Vector2d::Zero());
}

} // namespace

Eigen::Matrix2d LineFieldOperator::Transport::Matrix() const
{
  Eigen::Matrix2d matrix;
  matrix << this->Real, -this->Imaginary, this->Imaginary, this->Real;
  if (this->Reflect)
  {
    matrix.col(1) *= -1.0;
  }
  return matrix;
}

LineFieldOperator::LineFieldOperator(std::shared_ptr<const TriangleMesh> mesh)
  : Surface(std::move(mesh))
  , Medial(MedialMesh(*this->Surface, true).Edges())
{
  this->MakeTransports();
  this->AssembleMatrices();
}

/// An edge's axes are those of its first triangle, turned so that the edge is the first axis. A
/// triangle that runs along the edge in the same direction as the first one has the other
/// orientation.
void LineFieldOperator::MakeTransports()
{
  const Triangles& corners = this->Surface->TriangleVertices();
  const Triangles& edges = this->Medial->TriangleVertices();
  const Index triangleCount = this->Surface->NumberOfTriangles();
  this->Transports.resize(3 * static_cast<std::size_t>(triangleCount));
  std::vector<signed char> firstWay(this->Medial->NumberOfVertices(), 0);
  for (Index t = 0; t < triangleCount; ++t)
  {
    const TriangleMesh::Shape s = this->Surface->Shapes()[t];
    const Eigen::Vector2d along[3] = { Square(s.X - s.Length, s.Y), Square(s.X, s.Y),
      Square(s.Length, 0.0) };
    for (int a = 0; a < 3; ++a)
    {
      const Index from = corners(t, (a + 1) % 3);
      const Index to = corners(t, (a + 2) % 3);
      signed char& first = firstWay[edges(t, a)];
      signed char way = from < to ? 1 : -1;
      if (from == to) // of an intrinsic triangulation: its triangles have one orientation
      {
        way = first == 0 ? 1 : static_cast<signed char>(-first);
      }
      this->Transports[3 * t + a] = { along[a][0], along[a][1], first == way };
      first = first == 0 ? way : first;
    }
  }
}

void LineFieldOperator::AssembleMatrices()
{
  const Triangles& edges = this->Medial->TriangleVertices();
  const Index triangleCount = this->Surface->NumberOfTriangles();
  const Index edgeCount = this->Medial->NumberOfVertices();
  const CornerWeights c = CotanWeights(*this->Surface);
  std::vector<Eigen::Triplet<double, Index>> entries;
  constexpr std::size_t entriesPerTriangle = 36;
  entries.reserve(entriesPerTriangle * static_cast<std::size_t>(triangleCount));
  this->M = Vector::Zero(2 * edgeCount);
  for (Index t = 0; t < triangleCount; ++t)
  {
    for (int a = 0; a < 3; ++a)
    {
      const int b = (a + 1) % 3;
      const double weight =
        4.0 * c(t, (a + 2) % 3); // gradients of edge functions are twice as steep
      const Index i = 2 * edges(t, a);
      const Index j = 2 * edges(t, b);
      const Eigen::Matrix2d coupling = -weight * this->Transports[3 * t + a].Matrix().transpose() *
        this->Transports[3 * t + b].Matrix();
      for (int k = 0; k < 2; ++k)
      {
        entries.emplace_back(i + k, i + k, weight);
        entries.emplace_back(j + k, j + k, weight);
        for (int l = 0; l < 2; ++l)
        {
          entries.emplace_back(i + k, j + l, coupling(k, l));
          entries.emplace_back(j + l, i + k, coupling(k, l));
        }
      }
      this->M.segment(i, 2).array() += this->Surface->Shapes()[t].Area() / 3.0;
    }
  }
  this->K.resize(2 * edgeCount, 2 * edgeCount);
  this->K.setFromTriplets(entries.begin(), entries.end());
}

void LineFieldOperator::Project(const Eigen::Ref<const TangentVectors>& lines,
  const Eigen::Ref<const Vector>& weights, Vector& load, Vector& diagonal) const
{
  load = Vector::Zero(this->M.size());
  diagonal = Vector::Zero(this->M.size());
  for (Index t = 0; t < this->Surface->NumberOfTriangles(); ++t)
  {
    const Eigen::Vector2d line = Square(lines(t, 0), lines(t, 1));
    if (line.isZero(0.0))
    {
      continue;
    }
    const double share = weights[t] * this->Surface->Shapes()[t].Area() / 3.0;
    for (int a = 0; a < 3; ++a)
    {
      const Index i = 2 * this->Medial->TriangleVertices()(t, a);
      load.segment(i, 2) += share * this->Transports[3 * t + a].Matrix().transpose() * line;
      diagonal.segment(i, 2).array() += share;
    }
  }
}

void LineFieldOperator::Integrate(
  const Eigen::Ref<const TangentVectors>& w, Values& load, const ParallelFor& parallel) const
{
  load.resize(this->M.size(), 1);
  const std::vector<Index>& begin = this->Medial->VertexCornersBegin();
  ForEach(parallel, this->Medial->NumberOfVertices(),
    [&](Index e)
    {
      Eigen::Vector2d sum = Eigen::Vector2d::Zero();
      for (Index c = begin[e]; c < begin[e + 1]; ++c)
      {
        const Index corner = this->Medial->VertexCorners()[c];
        const double share = this->Surface->Shapes()[corner / 3].Area() / 3.0;
        sum +=
          share * this->Transports[corner].Matrix().transpose() * w.row(corner / 3).transpose();
      }
      load.block<2, 1>(2 * e, 0) = sum;
    });
}

Eigen::Vector2d LineFieldOperator::Mean(const Eigen::Ref<const Vector>& z, Index t) const
{
  Eigen::Vector2d sum = Eigen::Vector2d::Zero();
  for (int a = 0; a < 3; ++a)
  {
    sum += this->Transports[3 * t + a].Matrix() *
      z.segment<2>(2 * this->Medial->TriangleVertices()(t, a));
  }
  return sum / 3.0;
}

TangentVectors LineFieldOperator::Lines(const Eigen::Ref<const Vector>& z) const
{
  TangentVectors lines(this->Surface->NumberOfTriangles(), 2);
  for (Index t = 0; t < this->Surface->NumberOfTriangles(); ++t)
  {
    const Eigen::Vector2d mean = this->Mean(z, t);
    const double angle = 0.5 * std::atan2(mean[1], mean[0]);
    lines.row(t) << std::cos(angle), std::sin(angle);
    lines.row(t) *= mean.isZero(0.0) ? 0.0 : 1.0;
  }
  return lines;
}

} // namespace SurfaceDiffusion
