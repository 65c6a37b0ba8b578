// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Solvers/ConjugateGradients.h"

#include "Core/Foundation/Resize.h"
#include "Core/Solvers/MatrixDiagonal.h"
#include "Core/Solvers/Multigrid.h"
#include "Core/Solvers/ScaledResidual.h"
#include "Core/Solvers/SinglePrecisionPasses.h"
#include "Core/Solvers/SinglePrecisionSolver.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

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
    , Diagonal(parallel, this->OverProcesses)
    , Lines(parallel)
    , Single(parallel, this->OverProcesses)
    , Residual(this->Diagonal, parallel, this->OverProcesses)
  {
  }

  void SetMatrix(const SparseMatrix& matrix, const ProgressMonitor& progress) override
  {
    this->Matrix = &matrix;
    if (this->Hierarchy)
    {
      this->Diagonal.Invert(matrix);
      this->Hierarchy->SetMatrix(matrix, progress);
    }
    else
    {
      this->Diagonal.InvertAndMeasure(matrix);
      const Vector& inverse = this->Diagonal.Inverse();
      this->Lines.Set(matrix, inverse, this->OverProcesses);
      const double alongLines = this->OverProcesses.Sum(
        Sum(this->Parallel, static_cast<Index>(this->Lines.Vertices().size()),
          [&](Index k) { return this->Lines.Share(k) / inverse[this->Lines.Vertices()[k]]; }));
      this->Passes.SetShares(
        this->Diagonal.SumOfRows() / (this->Diagonal.SumOfDiagonal() - alongLines),
        this->Diagonal.LeastExcess());
    }
    if (this->Passes.MayHelp())
    {
      this->Single.SetMatrix(matrix, this->Diagonal.Inverse(), this->Lines);
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
      this->Lines.Precondition(this->Diagonal.Inverse(), r, z);
      return;
    }
    std::vector<double> squares(r.cols());
    SumColumns(
      this->Parallel, n, r.cols(),
      [&](Index i, Eigen::Index c)
      {
        const double square = r(i, c) * this->Diagonal.Inverse()[i] * r(i, c);
        return this->OverProcesses.Owns(i) ? square : 0.0;
      },
      squares.data());
    this->OverProcesses.Sum(squares.data(), static_cast<Index>(squares.size()));
    this->Scales.resize(r.cols());
    this->System().Precondition(r, squares, z);
  }

private:
  ColumnSystem System()
  {
    return { { *this->Matrix, this->Diagonal.Inverse(), this->Lines, this->Parallel,
               this->OverProcesses },
      this->Hierarchy.get(), this->Scales };
  }

  template <int K>
  SolveReport SolveColumns(const Values& accumulatedB, Values& x, const ProgressMonitor& progress)
  {
    const Values& b = this->OverProcesses.Accumulated(accumulatedB, this->ConsistentB);
    this->Scales.resize(b.cols());
    this->Residual.Start<K>(*this->Matrix, b, x);
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
      report = ConjugateGradients<K, ColumnSystem>(
        system, this->Residual.Entries, this->Residual.Work, this->Parallel)
                 .Solve(x, limits, progress.Part(std::isinf(last) ? 0.0 : 1.0, 1.0));
      report.Iterations += before;
      report.Forecast = std::max(forecast, before + report.Forecast);
      this->Residual.Update<K>(*this->Matrix, b, x);
      report.Residual = this->Residual.Largest();
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

  /// Iterations in single precision with residuals in double precision, except a last one that
  /// round-off cannot have moved, until all columns are within the tolerance or can come no closer.
  template <int K>
  SolveReport Refine(const Values& b, Values& x, const ProgressMonitor& progress)
  {
    constexpr int longestPass = 256;
    std::optional<ConvergenceForecast> forecast;
    const ColumnCount<K> k(b.cols());
    this->Passes.Start(k);
    Values& before = this->Residual.Work.P; // iterations in double precision begin with a new one
    Resize(before, x.rows(), x.cols());
    SolveReport report;
    double done = 0.0;
    while (true)
    {
      const double passes = this->Passes.Plan(this->Residual.Work, this->Limits.Tolerance, report);
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
      const int iterations = this->Single.Correct(this->Residual.Entries, this->Passes.Columns,
        std::min(left, longestPass), x, progress.Part(done, end), &*forecast);
      report.Iterations += iterations;
      done = end;
      if (passes == 1.0 &&
        this->Passes.HaveReachedGoals(iterations, this->Limits.Tolerance, report))
      {
        report.Forecast = forecast->Largest();
        return report;
      }
      this->Residual.Update<K>(*this->Matrix, b, x);
      if (this->TakeBackFailures(before, x))
      {
        this->Residual.Update<K>(*this->Matrix, b, x);
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
      if (!(std::sqrt(this->Residual.Work.Sums[c]) <= this->Passes.Columns[c].Length))
      {
        x.col(static_cast<Eigen::Index>(c)) = before.col(static_cast<Eigen::Index>(c));
        any = true;
      }
    }
    return any;
  }

  const ParallelFor& Parallel;
  const std::shared_ptr<const Reduction> KeptProcesses;
  const Reduction& OverProcesses;
  std::unique_ptr<Multigrid> Hierarchy;
  const SparseMatrix* Matrix = nullptr;
  MatrixDiagonal Diagonal;
  StrongLines Lines; ///< without a hierarchy
  SinglePrecisionSolver Single;
  SinglePrecisionPasses Passes;
  bool HasStoppedEarly = false; ///< before iterations in double precision
  ScaledResidual Residual;
  Values ConsistentB; ///< over several processes
  std::vector<double> Scales;
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
