// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Core/Foundation/Parallel.h"
#include "Core/Foundation/ProgressMonitor.h"
#include "Core/Solvers/LinearSolver.h"
#include "Core/Surface/TriangleMesh.h"

#include <functional>
#include <vector>

namespace SurfaceDiffusion
{

/// Functions of the Laplace-Beltrami operator L = M^-1 K applied to the columns of u, from the Krylov
/// spaces of the resolvent
///   Y = (1 + s L)^-1 = (M + s K)^-1 M.
/// Lanczos' recurrence gives a basis V of that of u, orthonormal in the inner product of M, and the
/// tridiagonal matrix T of Y in it. Then f(L) u is near to |u| V f((T^-1 - 1) / s) e_1 (J. van den
/// Eshof, M. Hochbruck, SIAM J. Sci. Comput. 27, 2006), and its integrals of squares are those of
/// Gauss's quadrature, which needs no basis and half the steps. One space serves all functions: a
/// further one costs no solve unless it needs a larger space.
class ResolventSpace
{
public:
  /// y becomes Y y, to round-off or nearly.
  using Resolvent = std::function<void(Values& y, const ProgressMonitor& progress)>;
  using Function = std::function<double(double)>;

  /// step: s > 0. u: n x k, best without its mean, so that errors are relative to the contrast.
  ResolventSpace(
    const TriangleMesh& mesh, double step, Values u, const ParallelFor& parallel = SerialFor());

  /// result = f(L) u, to the tolerance of the limits relative to its norm. The report counts the columns
  /// of the space; not converged: more are needed than its limits allow.
  SolveReport Apply(const Function& f, const Resolvent& resolvent, const IterationLimits& limits,
    Values& result, const ProgressMonitor& progress = ProgressMonitor());

private:
  /// Of one column of u.
  struct Recurrence
  {
    double Norm = 0.0;
    std::vector<double> Diagonal, Below;
  };

  void Extend(const Resolvent& resolvent, const ProgressMonitor& progress);
  Vector Coefficients(const Recurrence& column, const Function& f, std::size_t size) const;
  double Change(const Function& f, std::vector<Vector>& coefficients) const;

  const TriangleMesh& Mesh;
  const ParallelFor& Parallel;
  double Step;
  std::vector<Values> Basis; ///< the next one of each column, too
  std::vector<Recurrence> Columns;
};

} // namespace SurfaceDiffusion
