// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Core/Solvers/LinearSolver.h"
#include "Core/Surface/TriangleMesh.h"

#include <cstdint>
#include <memory>

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
/// Computer Graphics Forum 39(5), 2020).
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

/// How the solution for a line field ended.
struct LineFieldReport
{
  /// The largest relative residual of the solves that missed the tolerance, otherwise 0.
  double MissedResidual = 0.0;
  /// If the inverse iteration ended at its largest number of steps: the largest change of an
  /// eigenvalue in the last one, relative to it. Otherwise 0.
  double UnsettledChange = 0.0;
  /// The largest eigenvalue over the connected components.
  double Lambda = 0.0;
};

/// The globally smoothest line field: the eigenvector of K z = lambda M z of the smallest lambda
/// (F. Knoppel, K. Crane, U. Pinkall, P. Schroder, Globally Optimal Direction Fields, ACM Trans.
/// Graph. 32(4), 2013), by inverse iteration. It starts at `start`, lines and their weights per
/// triangle (zero rows: none), which selects one of several equally smooth fields. Every connected
/// component has a field of its own.
///
/// `solver` is given K + 1e-3/area M, which is definite on flat surfaces too and has the same
/// eigenvectors.
TangentVectors SmoothestLineField(const LineFieldOperator& laplacian,
  const Eigen::Ref<const TangentVectors>& start, const Eigen::Ref<const Vector>& weights,
  LinearSolver& solver, const ProgressMonitor& progress = ProgressMonitor(),
  LineFieldReport* report = nullptr, int maximumNumberOfSteps = 50);

/// The line field that minimises int |grad z|^2 + w |z - hint|^2 + 1e-9/area |z|^2 for hints and
/// their weights w, in 1/LengthUnit()^2, per triangle (zero rows: no hint). The last term keeps the
/// matrix definite on connected components without hints, whose field is zero. Elsewhere it is far
/// below any w that has an effect.
TangentVectors LineFieldFromHints(const LineFieldOperator& laplacian,
  const Eigen::Ref<const TangentVectors>& hints, const Eigen::Ref<const Vector>& weights,
  LinearSolver& solver, const ProgressMonitor& progress = ProgressMonitor(),
  LineFieldReport* report = nullptr);

} // namespace SurfaceDiffusion
