// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Core/Foundation/Parallel.h"
#include "Core/Foundation/ProgressMonitor.h"
#include "Core/Foundation/Reduction.h"
#include "Core/Foundation/Types.h"

#include <memory>
#include <stdexcept>

namespace SurfaceDiffusion
{

struct SolveReport
{
  int Iterations = 0; ///< the most over the columns; 0 for a direct method
  /// Largest over the columns of |b - A x| / |b| in the norm of diag(A)^-1, in which the equations
  /// of small and of badly shaped cells count alike; or a bound of it that is within the tolerance.
  double Residual = 0.0;
  /// Whether Residual is within the tolerance.
  bool Converged = true;
  /// Whether no method is left that could come closer: a direct one does not, and Automatic has
  /// tried them all. The answer is then used as it is.
  bool IsFinal = false;
  /// The largest number of iterations that the rate of convergence let expect; see
  /// ConvergenceForecast.
  double Forecast = 0.0;
};

struct IterationLimits
{
  double Tolerance = 1e-10; ///< on SolveReport::Residual
  int MaximumNumberOfIterations = 1000;
  /// End as soon as the rate of convergence shows that these iterations are not enough.
  bool StopsEarly = false;
  double AskedTolerance = 0.0; ///< by the user, if it is larger; see RequireAnswer()
};

/// Conjugate gradients take no step along p if p.A p is not above this share of p.diag(A) p: it is
/// then the round-off of A's entries, as on surfaces with triangles that are nearly flat, and the
/// step would have no bounds.
constexpr double ResolvedShare = 2e-15;

/// Thrown by RequireAnswer() if a solver ended at its iteration limit.
struct NotConverged : std::runtime_error
{
  explicit NotConverged(const SolveReport& report);
};

/// An answer within AnswerFactor times the tolerance is used, and the run says so in a warning.
constexpr double AnswerFactor = 10.0;

/// Throws NotConverged unless the residual is within AnswerFactor times the larger tolerance or the
/// report is final.
void RequireAnswer(const SolveReport& report, const IterationLimits& limits);

/// A power of two near the largest entry of two columns. The squares of entries divided by it
/// neither overflow nor underflow, and the division is exact.
double ScaleOf(const Values& a, const Values& b, Eigen::Index column, const ParallelFor& parallel,
  const Reduction& overProcesses = Reduction::Serial());

/// Solves A x = b for symmetric positive definite matrices of one pattern. After a solve that
/// failed it gives the same results as a new one.
class LinearSolver
{
public:
  virtual ~LinearSolver() = default;

  void SetLimits(const IterationLimits& limits) { this->Limits = limits; }
  const IterationLimits& GetLimits() const { return this->Limits; }

  /// Take the matrix, which must stay as it is until the next call. An ordering is kept from call
  /// to call while the pattern is the same, a factor while the values are the same too.
  virtual void SetMatrix(
    const SparseMatrix& matrix, const ProgressMonitor& progress = ProgressMonitor()) = 0;

  /// x: the start of an iterative method on entry, the solution on return; b, x: n x k. Throws
  /// std::runtime_error if no finite solution exists.
  virtual SolveReport Solve(
    const Values& b, Values& x, const ProgressMonitor& progress = ProgressMonitor()) = 0;

  /// z = B r with B near A^-1, symmetric and linear, as a preconditioner of other iterations has to
  /// be: the solution of a direct method, one cycle of multigrid, diag(A)^-1 r of conjugate
  /// gradients. Over several processes r is consistent.
  virtual void Precondition(const Values& r, Values& z) = 0;

  /// Whether Solve() leaves the other threads idle, so that another solver can run beside it.
  virtual bool RunsOnOneThread() const { return false; }

  /// The number of factorisations that a direct method has computed so far.
  virtual long NumberOfFactorizations() const { return 0; }

protected:
  IterationLimits Limits;
};

/// Sparse Cholesky factorisation L D L^T, and one step of iterative refinement if the residual is
/// above the tolerance. Its reports are final. A nearly singular matrix is regularised: see
/// SparseFactor.
std::unique_ptr<LinearSolver> MakeCholeskySolver(const ParallelFor& parallel = SerialFor());

/// Conjugate gradients with the preconditioner StrongLines, all columns in one pass over the
/// matrix, each with its own step lengths. The paper's PBCG is this method for symmetric matrices
/// (Appendix). Unless the matrix is stiff, the iterations are in single precision and measure their
/// residuals in double precision (SinglePrecisionSolver), but for a last one that round-off cannot
/// have moved, to the same tolerance.
std::unique_ptr<LinearSolver> MakeConjugateGradientSolver(
  const ParallelFor& parallel = SerialFor());

/// The same over processes: matrices and right-hand sides are accumulated, solutions consistent
/// vectors (see Reduction).
std::unique_ptr<LinearSolver> MakeConjugateGradientSolver(
  std::shared_ptr<const Reduction> overProcesses, const ParallelFor& parallel);

/// Conjugate gradients with a cycle of Multigrid as preconditioner: the number of iterations hardly
/// grows with size and time step.
std::unique_ptr<LinearSolver> MakeMultigridSolver(const ParallelFor& parallel = SerialFor());
std::unique_ptr<LinearSolver> MakeMultigridSolver(
  std::shared_ptr<const Reduction> overProcesses, const ParallelFor& parallel);

/// The largest matrix that every process factorises, in 0.25 GB.
constexpr Index LargestReplicated = 200000;

/// Over processes each of which factorises the matrix of all of them, as preconditioner. Throws
/// std::runtime_error if that has more than LargestReplicated rows.
std::unique_ptr<LinearSolver> MakeGatheredSolver(
  std::shared_ptr<const Reduction> overProcesses, const ParallelFor& parallel);

/// The same for matrices of the pattern of `model`, whose hierarchies all take the aggregates of
/// that of `model`: SetMatrix() takes a fraction of the time.
std::unique_ptr<LinearSolver> MakeMultigridSolver(
  const SparseMatrix& model, const ParallelFor& parallel);

} // namespace SurfaceDiffusion
