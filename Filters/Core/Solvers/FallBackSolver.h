// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Core/Solvers/LinearSolver.h"
#include "Core/Solvers/SolverChoice.h"

#include <cstddef>
#include <memory>
#include <utility>
#include <vector>

namespace SurfaceDiffusion
{

/// Several methods: the first, and the next ones for the systems on which those before fail. If the
/// first one has a limited patience, the first solve with a matrix is its trial: it ends when its
/// rate of convergence lets expect more iterations than that (ConvergenceForecast), and later
/// solves begin with the next method. If the matrix lets forecast that many iterations of conjugate
/// gradients (ForecastOf), all solves do, and the first one is the trial of the next method. On
/// needles that nothing but a factorisation resolves, this is the first method at once; also around
/// hubs, where the factor has few entries (IsAroundHubs), unless the patience has no limit. All this
/// depends on the matrix and the first right-hand side only: if later failures were remembered, the
/// bits of a step would depend on the steps computed before it.
class FallBackSolver : public LinearSolver
{
public:
  /// factor: the number of the method that is a factorisation, or that of methods if there is none.
  /// overProcesses: over which the matrices are accumulated.
  FallBackSolver(std::vector<std::unique_ptr<LinearSolver>> methods, std::size_t factor,
    const SolverChoice& choice, const ParallelFor& parallel,
    std::shared_ptr<const Reduction> overProcesses)
    : Methods(std::move(methods))
    , Factor(factor)
    , Patience(choice.Patience)
    , ExpectedIterations(choice.ExpectedIterations)
    , DiffusionNumber(choice.DiffusionNumber)
    , Parallel(parallel)
    , OverProcesses(std::move(overProcesses))
  {
  }

  void SetMatrix(const SparseMatrix& matrix, const ProgressMonitor& progress) override;
  SolveReport Solve(const Values& b, Values& x, const ProgressMonitor& progress) override;

  void Precondition(const Values& r, Values& z) override
  {
    this->Methods[this->First]->Precondition(r, z);
  }
  bool RunsOnOneThread() const override { return this->Methods[this->First]->RunsOnOneThread(); }

  /// Whether the trials so far went well, and would have with this patience.
  bool EndsAlike(int patience) const { return this->Needed <= patience; }

private:
  SolveReport TrySolve(std::size_t number, IterationLimits limits, bool isFallBack, const Values& b,
    Values& x, const ProgressMonitor& progress);
  bool IsTrial(std::size_t method) const
  {
    return method == this->First && method != this->Factor && method + 1 < this->Methods.size() &&
      this->IsUndecided && this->Patience > 0;
  }
  double RoundOff(const Values& b, const Values& x) const;
  double TakeForecast(const SparseMatrix& matrix);
  void MeasureRows(const SparseMatrix& matrix);
  void Decide(std::size_t method, bool isGood);

  std::vector<std::unique_ptr<LinearSolver>> Methods;
  const std::size_t Factor;
  const int Patience;
  const double ExpectedIterations, DiffusionNumber;
  const ParallelFor& Parallel;
  const std::shared_ptr<const Reduction> OverProcesses;
  const SparseMatrix* Matrix = nullptr;
  std::size_t First = 0; ///< the method that solves begin with
  std::size_t HasMatrix = 0; ///< the methods before this one have the matrix or are out of use
  bool IsUndecided = true; ///< no solve with the matrix yet
  Values Best;
  Vector Diagonal, RowSums; ///< of the matrix, kept so that time steps do not allocate
  double Needed = 0.0; ///< the least patience of all trials; infinite if one went wrong
};

} // namespace SurfaceDiffusion
