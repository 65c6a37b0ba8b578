// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Solvers/FallBackSolver.h"

#include "Core/Operators/SparsePattern.h"

#include <algorithm>
#include <cmath>
#include <exception>
#include <limits>
#include <stdexcept>

namespace SurfaceDiffusion
{

namespace
{

/// Iterations from the answer of a factorisation rarely come closer.
constexpr int MostAfterFactorization = 128;

/// Whether triangles are so narrow that iterations end at round-off before they resolve the
/// differences across them to the tolerance. The diagonal entries of such vertices are 1e8 times
/// larger than others, and cancel in the row sums, which are the right-hand side of a step from the
/// constant 1. diagonal, sums: work.
bool HasUnresolvedNeedles(const SparseMatrix& matrix, double tolerance, const ParallelFor& parallel,
  Vector& diagonal, Vector& sums)
{
  constexpr double large = 1e8;
  const auto n = static_cast<Index>(matrix.rows());
  diagonal.resize(n);
  sums.resize(n);
  ForEach(parallel, n,
    [&](Index i)
    {
      diagonal[i] = DiagonalEntry(matrix, i);
      sums[i] = 0.0;
      for (SparseMatrix::InnerIterator a(matrix, i); a; ++a)
      {
        sums[i] += a.value();
      }
    });
  const double mean =
    std::exp(Sum(parallel, n, [&](Index i) { return std::log(diagonal[i]); }) / std::max(n, 1));
  if (!(Max(parallel, n, [&](Index i) { return diagonal[i]; }) > large * mean))
  {
    return false;
  }
  const auto square = [&](Index i) { return sums[i] * sums[i] / diagonal[i]; };
  const auto ofNeedle = [&](Index i) {
    return diagonal[i] > large * mean && std::abs(sums[i]) * large < diagonal[i] ? square(i) : 0.0;
  };
  return Sum(parallel, n, ofNeedle) > tolerance * tolerance * Sum(parallel, n, square);
}

} // namespace

void FallBackSolver::SetMatrix(const SparseMatrix& matrix, const ProgressMonitor& progress)
{
  this->Matrix = &matrix;
  this->IsUndecided = true;
  if (this->Patience > 0 &&
    HasUnresolvedNeedles(
      matrix, this->Limits.Tolerance, this->Parallel, this->Diagonal, this->RowSums))
  {
    try
    {
      this->Methods[this->Factor]->SetMatrix(matrix, progress);
      this->First = this->Factor;
      this->HasMatrix = this->Factor + 1;
      return;
    }
    catch (const std::runtime_error&)
    {
    }
  }
  for (this->First = 0;; ++this->First)
  {
    try
    {
      this->Methods[this->First]->SetMatrix(matrix, progress);
      this->HasMatrix = this->First + 1;
      return;
    }
    catch (const std::runtime_error&)
    {
      if (this->First + 1 == this->Methods.size())
      {
        throw;
      }
    }
  }
}

SolveReport FallBackSolver::Solve(const Values& b, Values& x, const ProgressMonitor& progress)
{
  SolveReport best;
  best.Residual = std::numeric_limits<double>::infinity();
  std::exception_ptr failure;
  double done = 0.0;
  int iterations = 0;
  bool isFactorized = false;
  const std::size_t first = this->First;
  for (std::size_t m = first; m < this->Methods.size(); ++m)
  {
    const double end = m + 1 < this->Methods.size() ? 0.5 * (1.0 + done) : 1.0;
    try
    {
      IterationLimits limits = this->Limits;
      limits.StopsEarly = m > first;
      if (isFactorized)
      {
        limits.MaximumNumberOfIterations =
          std::min(limits.MaximumNumberOfIterations, MostAfterFactorization);
      }
      SolveReport report = this->TrySolve(m, limits, m > first, b, x, progress.Part(done, end));
      isFactorized = isFactorized || m == this->Factor;
      iterations += report.Iterations;
      report.Iterations = iterations;
      // What a factorisation leaves is round-off.
      const bool isRoundOff =
        report.IsFinal && report.Residual <= AnswerFactor * this->Limits.Tolerance;
      if (report.Converged || isRoundOff)
      {
        progress.Report(1.0);
        return report;
      }
      if (report.Residual < best.Residual)
      {
        best = report;
        this->Best = x;
      }
    }
    catch (const std::runtime_error&)
    {
      if (!b.allFinite())
      {
        throw; // no method has an answer
      }
      failure = failure ? failure : std::current_exception();
      x.setZero(b.rows(), b.cols());
      this->Decide(m, false);
    }
    done = end;
  }
  if (!std::isfinite(best.Residual))
  {
    std::rethrow_exception(failure);
  }
  x = this->Best;
  best.Iterations = iterations;
  best.IsFinal = true;
  return best;
}

SolveReport FallBackSolver::TrySolve(std::size_t number, IterationLimits limits, bool isFallBack,
  const Values& b, Values& x, const ProgressMonitor& progress)
{
  LinearSolver& method = *this->Methods[number];
  const double begin = isFallBack ? 0.8 : 0.0;
  if (number >= this->HasMatrix)
  {
    method.SetMatrix(*this->Matrix, progress.Part(0.0, begin));
    this->HasMatrix = number + 1;
  }
  const bool isTrial = this->IsTrial(number);
  if (isTrial)
  {
    limits.StopsEarly = true;
    limits.MaximumNumberOfIterations = std::min(limits.MaximumNumberOfIterations, this->Patience);
  }
  method.SetLimits(limits);
  const SolveReport report = method.Solve(b, x, progress.Part(begin, 1.0));
  if (isTrial)
  {
    const double forecast = std::max<double>(report.Forecast, report.Iterations);
    this->Needed =
      std::max(this->Needed, report.Converged ? forecast : std::numeric_limits<double>::infinity());
  }
  this->Decide(number, report.Converged);
  return report;
}

/// After a trial.
void FallBackSolver::Decide(std::size_t method, bool isGood)
{
  if (this->IsTrial(method))
  {
    this->First = isGood ? 0 : 1;
    this->IsUndecided = false;
  }
}

} // namespace SurfaceDiffusion
