// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Core/Foundation/Parallel.h"
#include "Core/Solvers/ConjugateGradientSystem.h"
#include "Core/Solvers/LinearSolver.h"
#include "Core/Solvers/SinglePrecisionSolver.h"

#include <memory>

namespace SurfaceDiffusion
{

/// Minimises 1/2 x.Ax - b.x by a few conjugate gradient iterations with the preconditioner
/// StrongLines, with shifts that of Jacobi, or around hubs (IsAroundHubs) with a factorisation of
/// the matrix without shifts, as the inner iteration of an outer one that changes b a
/// little from call to call and carries x along. Unlike a LinearSolver it keeps the residual
/// between calls, so that no product is spent on computing it.
class QuadraticDescent
{
public:
  explicit QuadraticDescent(const ParallelFor& parallel = SerialFor())
    : Parallel(parallel)
    , Lines(parallel)
    , Single(parallel)
  {
  }

  /// matrix: symmetric positive (semi)definite, with a positive diagonal. shifts: added to the
  /// diagonal in each column, n x k; without columns: nothing. Both must stay as they are. Over
  /// several processes both are accumulated.
  void SetMatrix(const SparseMatrix& matrix, const Values& shifts,
    const Reduction& reduction = Reduction::Serial());
  void SetMatrix(const SparseMatrix& matrix, const Reduction& reduction = Reduction::Serial())
  {
    this->SetMatrix(matrix, this->NoShifts, reduction);
  }

  /// The residual b - A x, n x k. The caller sets it before the first call of Improve, and adds to
  /// it every later change of b. It is consistent, as x is.
  Values Residual;

  /// Iterate in single precision, in one process and without shifts. It is for outer iterations
  /// that renew the residual now and then, of which round-off takes about 1e-6 per call, and up to
  /// 1e-3 where lines of vertices are hardly connected with others.
  void SetSinglePrecision(bool isSingle) { this->IsSingle = isSingle; }

  /// Iterations until each column of the residual is reduced by the factor `reduction`, in the norm
  /// of the inverse diagonal, or until there have been as many as allowed.
  void Improve(Values& x, double reduction, int maximumNumberOfIterations);

private:
  bool Factorize(const SparseMatrix& matrix);
  bool ImproveInSinglePrecision(Values& x, double reduction, int maximumNumberOfIterations);
  template <typename System>
  void Improve(const System& system, Values& x, double reduction, int maximumNumberOfIterations);

  const ParallelFor& Parallel;
  const SparseMatrix* Matrix = nullptr;
  const Values NoShifts;
  const Values* Shifts = nullptr;
  const Reduction* OverProcesses = &Reduction::Serial();
  Vector InverseDiagonal;
  Values InverseDiagonals; ///< with shifts, one column for each
  StrongLines Lines; ///< without shifts
  ConjugateGradientWork Work;
  bool IsSingle = false;
  SinglePrecisionSolver Single; ///< of the matrix if HasSingle
  bool HasSingle = false;
  std::unique_ptr<LinearSolver> Factor; ///< of the matrix if HasFactor
  bool HasFactor = false;
  Values Change;
  ColumnSums Squares;
  std::vector<double> Lengths;
};

} // namespace SurfaceDiffusion
