// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Core/Solvers/ConjugateGradientSystem.h"
#include "Core/Solvers/LinearSolver.h"

namespace SurfaceDiffusion
{

/// P A P x = P b for symmetric positive definite A, where P projects each row x_i onto
/// the plane orthogonal to u_i, and to 0 at fixed vertices: the linear system of a time step whose
/// unknowns lie in the tangent spaces of the sphere.
struct TangentSystem
{
  const SparseMatrix& Matrix;
  const Values& U; ///< n x m, no row zero
  const Flags& Fixed;
  const Values& B;
  const Vector& Inertia; ///< the part of diag(A) that multiplies u itself in a time step
  /// Matrix, B and Inertia are accumulated, U is consistent.
  const SurfaceDiffusion::Reduction& Reduction = SurfaceDiffusion::Reduction::Serial();
  /// n x m unit vectors orthogonal to the rows of U, to which the rows of x are orthogonal, too; or null.
  const Values* Normals = nullptr;
};

/// Solves P A P x = P b by conjugate gradients from x = 0, as one system of all columns, which P
/// couples. Every iterate has a smaller 1/2 x.Ax - b.x than the one before: a time step with an
/// unfinished x still decreases the energy.
class TangentSolver
{
public:
  explicit TangentSolver(const ParallelFor& parallel = SerialFor())
    : Parallel(parallel)
  {
  }

  /// preconditioner: a solver that has taken a matrix near A. Null: the diagonal of A (Jacobi). The
  /// residual is measured in the norm of LinearSolver, relative to the larger of P b and Inertia u,
  /// which is the size of the right-hand side if x is as large as u.
  SolveReport Solve(const TangentSystem& system, Values& x, LinearSolver* preconditioner,
    const IterationLimits& limits, const ProgressMonitor& progress = ProgressMonitor());

private:
  template <int K>
  SolveReport SolveColumns(const TangentSystem& system, Values& x, LinearSolver* preconditioner,
    const IterationLimits& limits, const ProgressMonitor& progress);

  const ParallelFor& Parallel;
  Vector InverseDiagonal, Inertia;
  Values Residual;
  ConjugateGradientWork Work;
};

} // namespace SurfaceDiffusion
