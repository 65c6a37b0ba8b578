// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Core/Surface/TriangleMesh.h"

#include <memory>
#include <vector>

namespace SurfaceDiffusion
{

/// The connection Laplacian of line fields on a surface, discretised with Crouzeix-Raviart
/// elements.
///
/// A line at angle a is the complex number z = exp(2 i a), which is the same for both of its
/// directions. The Dirichlet energy int |grad z|^2, with the surface's parallel transport, measures
/// how much a field varies. It depends on the triangles' shapes alone, so that surfaces of any
/// topology, orientable or not, are allowed. By Poincare-Hopf, the indices of the singularities of
/// a line field on a closed surface add up to its Euler characteristic: on a sphere there are at
/// least four, of index 1/2.
///
/// There is one z per edge, linear on each triangle and compared within triangles only, which are
/// flat: there is no transport around vertices, and energies are exact on any triangles (O. Stein,
/// M. Wardetzky, A. Jacobson, E. Grinspun, A Simple Discretization of the Vector Dirichlet Energy,
/// Computer Graphics Forum 39(5), 2020). Where three or more triangles meet in an edge, a line has no
/// one continuation: the sheets end there.
class LineFieldOperator
{
public:
  explicit LineFieldOperator(std::shared_ptr<const TriangleMesh> mesh);

  /// Two rows per edge, real and imaginary part of z in the edge's own axes: the stiffness matrix K
  /// with z^T K z = int |grad z|^2, and the diagonal of the lumped mass matrix M with
  /// z^T M z = int |z|^2.
  const SparseMatrix& Stiffness() const { return this->K; }
  const Vector& Mass() const { return this->M; }
  std::shared_ptr<const TriangleMesh> Edges() const { return this->Medial; }

  /// The load b with z^T b = int w z . exp(2 i a) for lines at angles a and weights w per triangle,
  /// and the diagonal of int w |z|^2 over the triangles with a line (zero rows: no line).
  void Project(const Eigen::Ref<const TangentVectors>& lines,
    const Eigen::Ref<const Vector>& weights, Vector& load, Vector& diagonal) const;

  /// The load b with z^T b = int z . w for one number w per triangle, real and imaginary part in
  /// the triangle's axes (m x 2). b: a column, allocated if it has another size.
  void Integrate(const Eigen::Ref<const TangentVectors>& w, Values& load,
    const ParallelFor& parallel = SerialFor()) const;

  /// z at the barycentre of triangle t, real and imaginary part in the triangle's axes.
  Eigen::Vector2d Mean(const Eigen::Ref<const Vector>& z, Index t) const;

  /// The lines of z at the barycentre of each triangle, zero where z is.
  TangentVectors Lines(const Eigen::Ref<const Vector>& z) const;

private:
  /// From an edge's axes to a triangle's: z -> r z, or r conj(z) if their orientations differ.
  struct Transport
  {
    double Real, Imaginary; ///< of r
    bool Reflect;
    Eigen::Matrix2d Matrix() const;
  };

  void MakeTransports();
  void AssembleMatrices();

  std::shared_ptr<const TriangleMesh> Surface, Medial;
  std::vector<Transport> Transports; ///< 3 t + a: from the edge opposite corner a of triangle t
  SparseMatrix K;
  Vector M;
};

} // namespace SurfaceDiffusion
