// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Solvers/FallBackSolver.h"

#include "Core/Operators/SparsePattern.h"
#include "Core/Solvers/NestedDissection.h"
#include "Core/Solvers/StrongLines.h"

#include <algorithm>
#include <cmath>
#include <exception>
#include <limits>
#include <stdexcept>

namespace SurfaceDiffusion
{

namespace
{

/// Of multigrid, which takes a tenth of them on needles that it resolves.
constexpr int MostOfSecondTrial = 128;

/// Iterations from the answer of a factorisation rarely come closer, and not where its residual is
/// at most this many times what the last places leave: a quarter to eleven times was measured.
constexpr int MostAfterFactorization = 128;
constexpr double LargestOfRoundOff = 16.0;

/// Whether triangles are so narrow that iterations end at round-off before they resolve the
/// differences across them to the tolerance. The diagonal entries of such vertices are 1e8 times
/// larger than others, and cancel in the row sums, which are the right-hand side of a step from the
/// constant 1.
bool HasUnresolvedNeedles(const Vector& diagonal, const Vector& sums, double tolerance,
  const ParallelFor& parallel, const Reduction& overProcesses)
{
  constexpr double large = 1e8;
  const auto n = static_cast<Index>(diagonal.size());
  const double all = overProcesses.SumOverVertices(parallel, n, [](Index) { return 1.0; });
  const auto logarithm = [&](Index i) { return std::log(diagonal[i]); };
  const double mean =
    std::exp(overProcesses.SumOverVertices(parallel, n, logarithm) / std::max(all, 1.0));
  const double largest = Max(parallel, n, [&](Index i) { return diagonal[i]; });
  if (!overProcesses.Any(largest > large * mean))
  {
    return false;
  }
  const auto square = [&](Index i) { return sums[i] * sums[i] / diagonal[i]; };
  const auto ofNeedle = [&](Index i) {
    return diagonal[i] > large * mean && std::abs(sums[i]) * large < diagonal[i] ? square(i) : 0.0;
  };
  return overProcesses.SumOverVertices(parallel, n, ofNeedle) >
    tolerance * tolerance * overProcesses.SumOverVertices(parallel, n, square);
}

} // namespace

void FallBackSolver::SetMatrix(const SparseMatrix& matrix, const ProgressMonitor& progress)
{
  this->Matrix = &matrix;
  this->IsUndecided = true;
  std::size_t begin = 0;
  if (this->Patience > 0)
  {
    this->MeasureRows(matrix);
    const bool hasNeedles = (this->Patience < std::numeric_limits<int>::max() &&
                              IsAroundHubs(matrix, *this->OverProcesses)) ||
      HasUnresolvedNeedles(this->Diagonal, this->RowSums, this->Limits.Tolerance, this->Parallel,
        *this->OverProcesses);
    const double forecast = this->TakeForecast(matrix);
    const bool isHopeless = forecast > this->Patience;
    begin = isHopeless ? 1 : 0;
    this->Needed =
      std::max(this->Needed, isHopeless ? std::numeric_limits<double>::infinity() : forecast);
    if (hasNeedles && this->Factor < this->Methods.size())
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
  }
  for (this->First = begin;; ++this->First)
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

void FallBackSolver::MeasureRows(const SparseMatrix& matrix)
{
  const auto n = static_cast<Index>(matrix.rows());
  this->Diagonal.resize(n);
  this->RowSums.resize(n);
  ForEach(this->Parallel, n,
    [&](Index i)
    {
      this->Diagonal[i] = DiagonalEntry(matrix, i);
      this->RowSums[i] = 0.0;
      for (SparseMatrix::InnerIterator a(matrix, i); a; ++a)
      {
        this->RowSums[i] += a.value();
      }
    });
  this->OverProcesses->Accumulate(this->Diagonal);
  this->OverProcesses->Accumulate(this->RowSums);
}

/// Of conjugate gradients, from MeasureRows(), whose results are lost: they need the iterations of
/// even meshes on which the diffusion number is that of the stiffest fiftieth of the vertices, but
/// for entries along lines. Few stiffer ones only add few eigenvalues, which are found one by one.
/// 0: no forecast, or nothing is stiff.
double FallBackSolver::TakeForecast(const SparseMatrix& matrix)
{
  // dt K_ii / M_ii of these vertices on the surfaces of the model; 4 on an even mesh
  constexpr double perDiffusionNumber = 27.0;
  constexpr double exponent = 0.4; // of the diffusion number in the model of iterations
  constexpr double stiffest = 0.02; // of the vertices
  if (this->ExpectedIterations == 0.0)
  {
    return 0.0;
  }
  Vector& stiffness = this->RowSums;
  StrongLines lines(this->Parallel);
  lines.Set(matrix, this->Diagonal.cwiseInverse(), *this->OverProcesses);
  ForEach(this->Parallel, static_cast<Index>(lines.Vertices().size()),
    [&](Index k) { this->Diagonal[lines.Vertices()[k]] *= 1.0 - lines.Share(k); });
  ForEach(this->Parallel, static_cast<Index>(stiffness.size()),
    [&](Index i)
    {
      const double sum = this->RowSums[i];
      stiffness[i] = sum > 0.0 ? (this->Diagonal[i] - sum) / sum : 0.0;
    });
  const double found = this->OverProcesses->QuantileInPlace(stiffness, 1.0 - stiffest);
  const double ratio = found / (perDiffusionNumber * this->DiffusionNumber);
  return this->ExpectedIterations * std::pow(std::max(ratio, 0.0), exponent);
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
      const bool isRoundOff = report.IsFinal &&
        (report.Residual <= AnswerFactor * this->Limits.Tolerance ||
          (report.Residual < 1.0 && report.Residual <= LargestOfRoundOff * this->RoundOff(b, x)));
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
      if (this->OverProcesses->Any(!b.allFinite()))
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

/// What the last places of the entries of x leave of the residual, in the norm of
/// SolveReport::Residual, of the column in which this is least. On needles it is above the
/// tolerance.
double FallBackSolver::RoundOff(const Values& b, const Values& x) const
{
  const SparseMatrix& matrix = *this->Matrix;
  const Reduction& reduction = *this->OverProcesses;
  const auto n = static_cast<Index>(b.rows());
  Values storage;
  const Values& consistent = reduction.Accumulated(b, storage);
  Vector diagonal(n), terms(n);
  ForEach(this->Parallel, n, [&](Index i) { diagonal[i] = DiagonalEntry(matrix, i); });
  reduction.Accumulate(diagonal);
  double least = std::numeric_limits<double>::infinity();
  for (Eigen::Index c = 0; c < b.cols(); ++c)
  {
    const double unit = ScaleOf(b, x, c, this->Parallel, reduction);
    const auto sumOfSquares = [&](const auto& number)
    {
      return reduction.SumOverVertices(this->Parallel, n,
        [&](Index i) { return number(i) / unit / diagonal[i] * (number(i) / unit); });
    };
    ForEach(this->Parallel, n,
      [&](Index i)
      {
        terms[i] = 0.0;
        for (Index slot = matrix.outerIndexPtr()[i]; slot < matrix.outerIndexPtr()[i + 1]; ++slot)
        {
          terms[i] += std::abs(matrix.valuePtr()[slot] * x(matrix.innerIndexPtr()[slot], c));
        }
      });
    reduction.Accumulate(terms);
    const double ofTerms = sumOfSquares([&](Index i) { return terms[i]; });
    const double ofB = sumOfSquares([&](Index i) { return consistent(i, c); });
    least = std::min(least, ofB > 0.0 ? ofTerms / ofB : 0.0);
  }
  return std::numeric_limits<double>::epsilon() * std::sqrt(least);
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
    limits.MaximumNumberOfIterations =
      std::min(limits.MaximumNumberOfIterations, number == 0 ? this->Patience : MostOfSecondTrial);
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
    this->IsUndecided = !isGood && method + 1 < this->Methods.size();
    this->First = this->IsUndecided ? method + 1 : method;
  }
}

} // namespace SurfaceDiffusion
