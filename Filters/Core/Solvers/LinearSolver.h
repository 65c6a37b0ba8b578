// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Core/Foundation/Parallel.h"
#include "Core/Foundation/ProgressMonitor.h"
#include "Core/Foundation/Types.h"

#include <memory>
#include <stdexcept>

namespace SurfaceDiffusion
{

struct SolveReport
{
  int Iterations = 0; ///< of an iterative method, the most over the columns; 0 for a direct one
  /// Largest over the columns of |b - A x| / |b| in the norm of diag(A)^-1, in which the equations
  /// of small and of badly shaped cells count alike.
  double Residual = 0.0;
  bool Converged = true; ///< an iterative method reached its tolerance
};

struct IterationLimits
{
  double Tolerance = 1e-10; ///< on SolveReport::Residual
  int MaximumNumberOfIterations = 1000;
};

/// Of p . diag(A) p: where p . A p is less, it is round-off of A's entries, as on surfaces all of
/// whose triangles are all but flat, and a step along p could be of any length.
constexpr double ResolvedShare = 2e-15;

/// Thrown by models where a solver ended at its iteration limit.
struct NotConverged : std::runtime_error
{
  explicit NotConverged(const SolveReport& report);
};

/// Solves A x = b for symmetric positive definite matrices of one pattern.
class LinearSolver
{
public:
  virtual ~LinearSolver() = default;

  void SetLimits(const IterationLimits& limits) { this->Limits = limits; }

  /// Take the matrix, which must stay as it is until the next call. What holds for the pattern (an
  /// ordering) is kept from call to call, what holds for the values too while they are the same.
  virtual void SetMatrix(
    const SparseMatrix& matrix, const ProgressMonitor& progress = ProgressMonitor()) = 0;

  /// x: the start of an iterative method on entry, the solution on return; b, x: n x k. Throws
  /// std::runtime_error where no finite solution exists.
  virtual SolveReport Solve(
    const Values& b, Values& x, const ProgressMonitor& progress = ProgressMonitor()) = 0;

  /// z is about A^-1 r, and symmetric and linear in r as what preconditions other iterations has to
  /// be: the solution of a direct method. Over several processes r is consistent.
  virtual void Precondition(const Values& r, Values& z) { this->Solve(r, z); }

protected:
  /// A power of two near the largest of two columns: squares of what is divided by it no double
  /// need fear, and the division is exact.
  static double ScaleOf(
    const Values& a, const Values& b, Eigen::Index column, const ParallelFor& parallel);

  IterationLimits Limits;
};

/// Sparse LDL^T with approximate minimum degree ordering (Eigen::SimplicialLDLT), one step of
/// iterative refinement where the residual is above the tolerance.
std::unique_ptr<LinearSolver> MakeCholeskySolver(const ParallelFor& parallel = SerialFor());

/// Conjugate gradients with Jacobi preconditioner, all columns in one pass over the matrix, each
/// with its own step lengths. The paper's PBCG is this method for symmetric matrices (Appendix).
std::unique_ptr<LinearSolver> MakeConjugateGradientSolver(
  const ParallelFor& parallel = SerialFor());

/// Conjugate gradients with a cycle of Multigrid as preconditioner: the number of iterations hardly
/// grows with size and time step.
std::unique_ptr<LinearSolver> MakeMultigridSolver(const ParallelFor& parallel = SerialFor());

/// What decides which method is fastest.
struct SolverTask
{
  Index NumberOfVertices = 0;
  double DiffusionNumber = 1.0; ///< (largest diffusivity) x (time step) / h^2
  double NumberOfSolves = 1.0; ///< with one matrix
  double Tolerance = 1e-10;
  /// False where multigrid was measured to lose: connections of direction fields, which do not map
  /// constants to zero, and coefficients that change in every step and by orders of magnitude from
  /// triangle to triangle.
  bool AllowMultigrid = true;
};

/// In the order of vtkSurfaceDiffusionAlgorithm::SolverType, which begins with Automatic.
enum class SolverMethod
{
  Factorization,
  ConjugateGradient,
  Multigrid
};

/// The method that is expected to be fastest, by a model of measured times.
SolverMethod ChooseMethod(const SolverTask& task);

inline bool PreferFactorization(const SolverTask& task)
{
  return ChooseMethod(task) == SolverMethod::Factorization;
}

std::unique_ptr<LinearSolver> MakeSolver(
  SolverMethod method, const ParallelFor& parallel = SerialFor());

/// What ChooseMethod() says; an iteration that does not converge is followed by a factorisation.
std::unique_ptr<LinearSolver> MakeAutomaticSolver(
  const SolverTask& task, const ParallelFor& parallel = SerialFor());

} // namespace SurfaceDiffusion
