// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Core/Solvers/LinearSolver.h"
#include "Core/Surface/TriangleMesh.h"

#include <cstdint>
#include <memory>

namespace SurfaceDiffusion
{

/// Line fields that vary as little as the surface allows. A line at angle a is the complex number
/// z = exp(2 i a), which does not see its sign; int |grad z|^2, with the surface's own parallel
/// transport (the connection Laplacian), is what a field varies. Nothing but the triangles' shapes
/// enters: any topology, orientable or not; curvature forces singularities where it must.
///
/// Discretised with one z per edge, linear on each triangle and compared within triangles only,
/// which are flat: no transport around vertices, exact energies on any triangles (O. Stein, M.
/// Wardetzky, A. Jacobson, E. Grinspun, A Simple Discretization of the Vector Dirichlet Energy,
/// Computer Graphics Forum 39(5), 2020).
class LineFieldOperator
{
public:
  explicit LineFieldOperator(std::shared_ptr<const TriangleMesh> mesh);

  /// Two rows per edge, real and imaginary part of z in the edge's own axes: K with
  /// z^T K z = int |grad z|^2, and the diagonal mass matrix M with z^T M z = int |z|^2.
  const SparseMatrix& Stiffness() const { return this->K; }
  const Vector& Mass() const { return this->M; }
  std::shared_ptr<const TriangleMesh> Edges() const { return this->Medial; }

  /// Load b with z^T b = int w z . exp(2 i a) for lines `frames` (zero rows: no line) and weights
  /// per triangle, and the diagonal of int w |z|^2 over the triangles with lines.
  void Project(const Eigen::Ref<const TangentVectors>& frames,
    const Eigen::Ref<const Vector>& weights, Vector& load, Vector& diagonal) const;

  /// The lines of z in the middle of each triangle; zero where z is.
  TangentVectors Frames(const Eigen::Ref<const Vector>& z) const;

private:
  /// From an edge's axes to a triangle's: z -> Turn z, or Turn conj(z) where their orientations
  /// differ.
  struct Transport
  {
    double Real, Imaginary;
    bool Reflect;
    Eigen::Matrix2d Matrix() const;
  };

  std::shared_ptr<const TriangleMesh> Surface, Medial;
  std::vector<Transport> Transports; ///< 3 t + a: of the edge opposite corner a of triangle t
  SparseMatrix K;
  Vector M;
};

/// The globally smoothest line field: the eigenvector of K z = lambda M z of the smallest lambda
/// (F. Knoppel, K. Crane, U. Pinkall, P. Schroder, Globally Optimal Direction Fields, ACM Trans.
/// Graph. 32(4), 2013), by inverse iteration from `start` (lines per triangle, zero rows: none),
/// which picks one of the fields that are equally smooth. Every connected component has its own;
/// lambda, if given, takes the largest eigenvalue of them.
TangentVectors SmoothestLineField(const LineFieldOperator& lines,
  const Eigen::Ref<const TangentVectors>& start, const Eigen::Ref<const Vector>& weights,
  LinearSolver& solver, const ProgressMonitor& progress = ProgressMonitor(),
  double* lambda = nullptr);

/// The line field that minimises int |grad z|^2 + w |z - hint|^2, hints and their weights w (in
/// 1/LengthUnit()^2) per triangle; zero rows: no hint. Connected components without hints get
/// zero.
TangentVectors LineFieldFromHints(const LineFieldOperator& lines,
  const Eigen::Ref<const TangentVectors>& hints, const Eigen::Ref<const Vector>& weights,
  LinearSolver& solver, const ProgressMonitor& progress = ProgressMonitor());

} // namespace SurfaceDiffusion
