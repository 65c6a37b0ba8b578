// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Solvers/ConjugateGradients.h"

#include "Core/Foundation/Resize.h"
#include "Core/Operators/Assembler.h"
#include "Core/Operators/SparsePattern.h"
#include "Core/Solvers/Multigrid.h"
#include "Core/Solvers/SinglePrecisionPasses.h"
#include "Core/Solvers/SinglePrecisionSolver.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <stdexcept>

namespace SurfaceDiffusion
{

namespace
{

/// Independent columns, preconditioned with lines or with multigrid.
struct ColumnSystem : LineSystem
{
  Multigrid* Hierarchy; ///< null: lines
  std::vector<double>& Scales; ///< work, one number per column

  bool HasPreconditioner() const { return this->Hierarchy || LineSystem::HasPreconditioner(); }
  void Precondition(const Values& r, const std::vector<double>& squares, Values& z) const
  {
    if (!this->Hierarchy)
    {
      LineSystem::Precondition(r, squares, z);
      return;
    }
    for (std::size_t c = 0; c < squares.size(); ++c)
    {
      this->Scales[c] = squares[c] > 0.0 ? 1.0 / std::sqrt(squares[c]) : 1.0;
    }
    this->Hierarchy->Apply(r, this->Scales, z);
  }
};

class ConjugateGradientSolver : public LinearSolver
{
public:
  ConjugateGradientSolver(std::unique_ptr<Multigrid> hierarchy,
    std::shared_ptr<const Reduction> overProcesses, const ParallelFor& parallel)
    : Parallel(parallel)
    , KeptProcesses(std::move(overProcesses))
    , OverProcesses(*this->KeptProcesses)
    , Hierarchy(std::move(hierarchy))
    , Lines(parallel)
    , Single(parallel, this->OverProcesses)
  {
  }

  void SetMatrix(const SparseMatrix& matrix, const ProgressMonitor& progress) override
  {
    this->Matrix = &matrix;
    const Index n = static_cast<Index>(matrix.rows());
    this->InverseDiagonal.resize(n);
    if (this->Hierarchy)
    {
      ForEach(
        this->Parallel, n, [&](Index i) { this->InverseDiagonal[i] = DiagonalEntry(matrix, i); });
      this->TakeInverse();
      this->Hierarchy->SetMatrix(matrix, progress);
    }
    else
    {
      this->InvertDiagonal(matrix);
      this->Lines.Set(matrix, this->InverseDiagonal, this->OverProcesses);
      const double alongLines = this->OverProcesses.Sum(
        Sum(this->Parallel, static_cast<Index>(this->Lines.Vertices().size()),
          [&](Index k)
          { return this->Lines.Share(k) / this->InverseDiagonal[this->Lines.Vertices()[k]]; }));
      this->Passes.SetShares(this->RowSums[0] / (this->RowSums[1] - alongLines),
        this->OverProcesses.IsSerial() ? 1.0 / this->RowSums.Largest(2) : 0.0);
    }
    if (this->Passes.MayHelp())
    {
      this->Single.SetMatrix(matrix, this->InverseDiagonal, this->Lines);
    }
    progress.Report(1.0);
  }

  SolveReport Solve(const Values& b, Values& x, const ProgressMonitor& progress) override
  {
    return ForColumns(
      b.cols(), [&](auto k) { return this->SolveColumns<decltype(k)::value>(b, x, progress); });
  }

  void Precondition(const Values& r, Values& z) override
  {
    const Index n = static_cast<Index>(r.rows());
    Resize(z, r.rows(), r.cols());
    if (!this->Hierarchy)
    {
      this->Lines.Precondition(this->InverseDiagonal, r, z);
      return;
    }
    std::vector<double> squares(r.cols());
    SumColumns(
      this->Parallel, n, r.cols(),
      [&](Index i, Eigen::Index c)
      {
        const double square = r(i, c) * this->InverseDiagonal[i] * r(i, c);
        return this->OverProcesses.Owns(i) ? square : 0.0;
      },
      squares.data());
    this->OverProcesses.Sum(squares.data(), static_cast<Index>(squares.size()));
    this->Scales.resize(r.cols());
    this->System().Precondition(r, squares, z);
  }

private:
  /// InverseDiagonal, the sums of the rows and of the diagonal, and the largest ratio of an entry
  /// of the diagonal to what it exceeds the others of its row by, in one pass over the matrix.
  void InvertDiagonal(const SparseMatrix& matrix)
  {
    const Index n = static_cast<Index>(matrix.rows());
    const Index* const outer = matrix.outerIndexPtr();
    const Index* const inner = matrix.innerIndexPtr();
    const double* const values = matrix.valuePtr();
    this->RowSums.Resize(n, 3);
    this->RowSums.Run<3>(this->Parallel, n, 3,
      [&](Index i, double* sums)
      {
        double sum = 0.0; // of a row first: large entries cancel
        double absolute = 0.0;
        Index below = 0; // entries before the diagonal, see DiagonalEntry()
        for (Index slot = outer[i]; slot < outer[i + 1]; ++slot)
        {
          sum += values[slot];
          absolute += std::abs(values[slot]);
          below += inner[slot] < i;
        }
        const double diagonal = values[outer[i] + below];
        this->InverseDiagonal[i] = diagonal;
        sums[0] += sum;
        sums[1] += diagonal;
        const double excess = 2.0 * diagonal - absolute;
        sums[2] = std::max(
          sums[2], excess > 0.0 ? diagonal / excess : std::numeric_limits<double>::infinity());
      });
    this->RowSums.Reduce(this->OverProcesses);
    this->TakeInverse();
  }

  /// InverseDiagonal, from the diagonal of the process.
  void TakeInverse()
  {
    this->OverProcesses.Accumulate(this->InverseDiagonal);
    ForEach(this->Parallel, static_cast<Index>(this->InverseDiagonal.size()),
      [&](Index i) { this->InverseDiagonal[i] = 1.0 / this->InverseDiagonal[i]; });
  }

  ColumnSystem System()
  {
    return { { *this->Matrix, this->InverseDiagonal, this->Lines, this->Parallel,
               this->OverProcesses },
      this->Hierarchy.get(), this->Scales };
  }

  template <int K>
  SolveReport SolveColumns(const Values& accumulatedB, Values& x, const ProgressMonitor& progress)
  {
    const Values& b = this->OverProcesses.Accumulated(accumulatedB, this->ConsistentB);
    const ColumnCount<K> k(b.cols());
    const Index n = static_cast<Index>(b.rows());
    if (this->Residual.cols() != k)
    {
      std::swap(this->Residual, this->OtherResidual);
      std::swap(this->Work, this->OtherWork);
    }
    Resize(this->Residual, n, k);
    this->Scales.resize(k);
    this->Work.ResizeSums(n, k);

    // b - A x in units of each column's own
    double startsElsewhere = Max(this->Parallel, n,
      [&](Index i)
      {
        bool isZero = true;
        for (int c = 0; c < k; ++c)
        {
          isZero = isZero && x(i, c) == 0.0;
        }
        return isZero ? 0.0 : 1.0;
      });
    this->OverProcesses.Max(&startsElsewhere, 1);
    if (startsElsewhere > 0.0)
    {
      this->MultiplyByMatrix(x);
    }
    else
    {
      this->Residual.setZero();
    }
    std::vector<double>& unit = this->Work.Unit;
    for (int c = 0; c < k; ++c)
    {
      unit[c] = ScaleOf(b, this->Residual, c, this->Parallel, this->OverProcesses);
    }
    this->Work.Sums.Run<K>(this->Parallel, n, k,
      [&](Index i, double* sums)
      {
        const bool counts = this->OverProcesses.Owns(i);
        for (int c = 0; c < k; ++c)
        {
          const double bi = b(i, c) / unit[c];
          sums[c] += counts ? bi * this->InverseDiagonal[i] * bi : 0.0;
        }
      });
    this->Work.Sums.Reduce(this->OverProcesses);
    for (int c = 0; c < k; ++c)
    {
      this->Work.Reference[c] = this->Work.Sums[c] > 0.0 ? this->Work.Sums[c] : 1.0;
    }
    this->SubtractProduct<K>(b);
    SolveReport report;
    report.Converged = false;
    this->HasStoppedEarly = false;
    const bool refines = this->Passes.MayHelp();
    const double begin = refines ? 0.9 : 0.0;
    if (refines)
    {
      report = this->Refine<K>(b, x, progress.Part(0.0, begin));
    }
    if (!report.Converged && !this->HasStoppedEarly)
    {
      this->Iterate<K>(b, x, report, progress.Part(begin, 1.0));
    }
    progress.Report(1.0);
    return report;
  }

  /// Iterations in double precision. They know their residual by recurrence, which loses the true
  /// one where an iterate is much larger than the solution: they go on from the true one then, as
  /// long as that helps.
  template <int K>
  void Iterate(const Values& b, Values& x, SolveReport& report, const ProgressMonitor& progress)
  {
    constexpr double drifted = 2.0; // times the tolerance
    constexpr double least = 0.1; // a start that gains less is the last one
    const ColumnSystem system = this->System();
    double last = std::numeric_limits<double>::infinity();
    while (true)
    {
      const int before = report.Iterations;
      const double forecast = report.Forecast;
      IterationLimits limits = this->Limits;
      limits.MaximumNumberOfIterations -= before;
      report =
        ConjugateGradients<K, ColumnSystem>(system, this->Residual, this->Work, this->Parallel)
          .Solve(x, limits, progress.Part(std::isinf(last) ? 0.0 : 1.0, 1.0));
      report.Iterations += before;
      report.Forecast = std::max(forecast, before + report.Forecast);
      this->UpdateResidual<K>(b, x);
      report.Residual = this->LargestResidual();
      const bool hasDrifted = !(report.Residual <= drifted * this->Limits.Tolerance);
      if (!report.Converged || !hasDrifted)
      {
        return;
      }
      report.Converged = false;
      if (!(report.Residual <= least * last))
      {
        return;
      }
      last = report.Residual;
    }
  }

  /// Of the columns whose residuals have been measured. Throws std::runtime_error if it is not
  /// finite.
  double LargestResidual() const
  {
    double largest = 0.0;
    for (std::size_t c = 0; c < this->Work.Reference.size(); ++c)
    {
      const double residual = std::sqrt(this->Work.Sums[c] / this->Work.Reference[c]);
      if (!std::isfinite(residual))
      {
        throw std::runtime_error("the linear system has no finite solution");
      }
      largest = std::max(largest, residual);
    }
    return largest;
  }

  /// Iterations in single precision with residuals in double precision, except a last one that
  /// round-off cannot have moved, until all columns are within the tolerance or can come no closer.
  template <int K>
  SolveReport Refine(const Values& b, Values& x, const ProgressMonitor& progress)
  {
    constexpr int longestPass = 256;
    std::optional<ConvergenceForecast> forecast;
    const ColumnCount<K> k(b.cols());
    this->Passes.Start(k);
    Values& before = this->Work.P; // iterations in double precision begin with a new one
    Resize(before, x.rows(), x.cols());
    SolveReport report;
    double done = 0.0;
    while (true)
    {
      const double passes = this->Passes.Plan(this->Work, this->Limits.Tolerance, report);
      const int left = this->Limits.MaximumNumberOfIterations - report.Iterations;
      if (!forecast)
      {
        forecast.emplace(report.Residual, this->Limits);
      }
      report.Forecast = forecast->Largest();
      this->HasStoppedEarly = !report.Converged && forecast->IsHopeless();
      if (report.Converged || passes == 0.0 || left <= 0 || this->HasStoppedEarly)
      {
        return report;
      }
      const double end = done + (1.0 - done) / passes;
      ForEachBlock(this->Parallel, static_cast<Index>(x.rows()),
        [&](Index, Index first, Index last)
        {
          const double* const from = x.data() + static_cast<std::ptrdiff_t>(first) * k;
          double* const to = before.data() + static_cast<std::ptrdiff_t>(first) * k;
          std::copy_n(from, static_cast<std::ptrdiff_t>(last - first) * k, to);
        });
      forecast->StartPass(report.Iterations);
      const int iterations = this->Single.Correct(this->Residual, this->Passes.Columns,
        std::min(left, longestPass), x, progress.Part(done, end), &*forecast);
      report.Iterations += iterations;
      done = end;
      if (passes == 1.0 &&
        this->Passes.HaveReachedGoals(iterations, this->Limits.Tolerance, report))
      {
        report.Forecast = forecast->Largest();
        return report;
      }
      this->UpdateResidual<K>(b, x);
      if (this->TakeBackFailures(before, x))
      {
        this->UpdateResidual<K>(b, x);
      }
    }
  }

  /// Take a pass back that has made the residual of a column larger: round-off of single precision
  /// can make an iterate so large that double precision would not recover from it. Returns whether
  /// there is one.
  bool TakeBackFailures(const Values& before, Values& x)
  {
    bool any = false;
    for (std::size_t c = 0; c < this->Passes.Columns.size(); ++c)
    {
      if (!(std::sqrt(this->Work.Sums[c]) <= this->Passes.Columns[c].Length))
      {
        x.col(static_cast<Eigen::Index>(c)) = before.col(static_cast<Eigen::Index>(c));
        any = true;
      }
    }
    return any;
  }

  /// The residual and its squares in the norm of D^-1, in Work.Sums.
  template <int K>
  void UpdateResidual(const Values& b, const Values& x)
  {
    this->MultiplyByMatrix(x);
    this->SubtractProduct<K>(b);
  }

  /// Residual = A x.
  void MultiplyByMatrix(const Values& x)
  {
    Multiply(*this->Matrix, x, this->Residual, this->Parallel);
    this->OverProcesses.Accumulate(this->Residual);
  }

  /// The residual from A x, and its squares.
  template <int K>
  void SubtractProduct(const Values& b)
  {
    const ColumnCount<K> k(b.cols());
    const std::vector<double>& unit = this->Work.Unit;
    this->Work.Sums.Run<K>(this->Parallel, static_cast<Index>(b.rows()), k,
      [&](Index i, double* sums)
      {
        const bool counts = this->OverProcesses.Owns(i);
        for (int c = 0; c < k; ++c)
        {
          const double r = b(i, c) / unit[c] - this->Residual(i, c) / unit[c];
          this->Residual(i, c) = r;
          sums[c] += counts ? r * this->InverseDiagonal[i] * r : 0.0;
        }
      });
    this->Work.Sums.Reduce(this->OverProcesses);
  }

  const ParallelFor& Parallel;
  const std::shared_ptr<const Reduction> KeptProcesses;
  const Reduction& OverProcesses;
  std::unique_ptr<Multigrid> Hierarchy;
  const SparseMatrix* Matrix = nullptr;
  Vector InverseDiagonal;
  StrongLines Lines; ///< without a hierarchy
  SinglePrecisionSolver Single;
  SinglePrecisionPasses Passes;
  bool HasStoppedEarly = false; ///< before iterations in double precision
  ColumnSums RowSums;
  Values Residual; ///< in Work.Unit
  Values ConsistentB; ///< over several processes
  std::vector<double> Scales;
  ConjugateGradientWork Work;
  // Those of another number of columns, for which the solver may be used in turn:
  Values OtherResidual;
  ConjugateGradientWork OtherWork;
};

} // namespace

std::unique_ptr<LinearSolver> MakeConjugateGradientSolver(const ParallelFor& parallel)
{
  return MakeConjugateGradientSolver(Reduction::SharedSerial(), parallel);
}

std::unique_ptr<LinearSolver> MakeConjugateGradientSolver(
  std::shared_ptr<const Reduction> overProcesses, const ParallelFor& parallel)
{
  return std::make_unique<ConjugateGradientSolver>(nullptr, std::move(overProcesses), parallel);
}

std::unique_ptr<LinearSolver> MakeMultigridSolver(const ParallelFor& parallel)
{
  return MakeMultigridSolver(Reduction::SharedSerial(), parallel);
}

std::unique_ptr<LinearSolver> MakeMultigridSolver(
  std::shared_ptr<const Reduction> overProcesses, const ParallelFor& parallel)
{
  auto hierarchy = std::make_unique<Multigrid>(parallel, overProcesses);
  return std::make_unique<ConjugateGradientSolver>(
    std::move(hierarchy), std::move(overProcesses), parallel);
}

std::unique_ptr<LinearSolver> MakeGatheredSolver(
  std::shared_ptr<const Reduction> overProcesses, const ParallelFor& parallel)
{
  auto hierarchy = std::make_unique<Multigrid>(parallel, overProcesses);
  hierarchy->UseNoLevels();
  return std::make_unique<ConjugateGradientSolver>(
    std::move(hierarchy), std::move(overProcesses), parallel);
}

std::unique_ptr<LinearSolver> MakeMultigridSolver(
  const SparseMatrix& model, const ParallelFor& parallel)
{
  auto hierarchy = std::make_unique<Multigrid>(parallel);
  hierarchy->KeepAggregates(model);
  return std::make_unique<ConjugateGradientSolver>(
    std::move(hierarchy), Reduction::SharedSerial(), parallel);
}

} // namespace SurfaceDiffusion
