// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "LinearSolver.h"

namespace SurfaceDiffusion
{

/// Solves P A P x = P b for symmetric positive definite A, where P takes each row x_i to its part
/// orthogonal to u_i, and to 0 at fixed vertices: the linear system of a step whose unknowns lie
/// in the tangent spaces of the sphere. Conjugate gradients from x = 0 with one recurrence for all
/// columns, which P couples. Every iterate has a smaller 1/2 x.Ax - b.x than the one before: a step
/// that uses an unfinished x still goes downhill.
class TangentSolver
{
public:
  explicit TangentSolver(const ParallelFor& parallel = SerialFor())
    : Parallel(parallel)
  {
  }

  /// u: n x m, nonzero rows. preconditioner: a direct solver that has taken a matrix near A; none:
  /// the diagonal of A (Jacobi). The report is in the terms of LinearSolver.
  SolveReport Solve(const SparseMatrix& matrix, const Values& u, const Flags& fixed,
    const Values& b, Values& x, LinearSolver* preconditioner, const IterationLimits& limits,
    const Monitor& monitor = Monitor());

private:
  template <int K>
  SolveReport SolveColumns(const SparseMatrix& matrix, const Values& u, const Flags& fixed,
    const Values& b, Values& x, LinearSolver* preconditioner, const IterationLimits& limits,
    const Monitor& monitor);
  template <int K>
  double Precondition(LinearSolver* preconditioner, const Values& u, const Flags& fixed);

  const ParallelFor& Parallel;
  Vector InverseDiagonal;
  Values R, Z, P, Q;
};

} // namespace SurfaceDiffusion
