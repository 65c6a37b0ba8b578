// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Core/Foundation/Columns.h"
#include "Core/Solvers/ConjugateGradientSystem.h"
#include "Core/Solvers/ConvergenceForecast.h"
#include "Core/Solvers/LinearSolver.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <vector>

namespace SurfaceDiffusion
{

/// Copies of S numbers, or S = 0 a reference to any number of them: stores into vectors do not make
/// the compiler load copies again.
template <int S>
class SystemNumbers
{
public:
  explicit SystemNumbers(const std::vector<double>& numbers)
  {
    std::copy_n(numbers.begin(), S, this->Copies);
  }
  double operator[](int s) const { return this->Copies[s]; }

private:
  double Copies[S];
};
template <>
class SystemNumbers<0>
{
public:
  explicit SystemNumbers(const std::vector<double>& numbers)
    : All(numbers.data())
  {
  }
  double operator[](int s) const { return this->All[s]; }

private:
  const double* All;
};

/// Preconditioned conjugate gradients (M. Hestenes, E. Stiefel, J. Res. Nat. Bur. Stand. 49, 1952)
/// for A x = b with a symmetric positive definite matrix A: the recurrence of all solvers in double
/// precision. SinglePrecisionSolver has its own.
/// K: the number of columns, or 0 for any. An iteration makes three passes over memory:
///   q = A p, p.q;   r -= alpha q, r.D^-1 r;   x += alpha p, p = B r + beta p.
/// Nothing but the residual and x is taken over from an earlier solve.
template <int K, typename System>
class ConjugateGradients
{
public:
  /// residual: b - A x on entry, n x k, in units of work.Unit; consistent. It is updated.
  ConjugateGradients(const System& system, Values& residual, ConjugateGradientWork& work,
    const ParallelFor& parallel)
    : S(system)
    , R(residual)
    , W(work)
    , Parallel(parallel)
    , Rows(static_cast<Index>(residual.rows()))
    , Columns(static_cast<int>(residual.cols()))
  {
    work.Resize(this->Rows, this->Columns, System::IsCoupled ? 1 : this->Columns);
  }

  /// Iterate until all residuals are within the tolerance. Throws std::runtime_error if one is not
  /// finite. Not converged: more iterations are needed than allowed, or expected to be if limits
  /// say so, or the matrix is not positive definite beyond round-off.
  SolveReport Solve(Values& x, const IterationLimits& limits, const ProgressMonitor& progress)
  {
    SolveReport report;
    this->Start(limits.Tolerance);
    const double start = this->FiniteResidual();
    double fraction = 0.0;
    ConvergenceForecast forecast(start, limits);
    while (!this->IsFinished())
    {
      if (report.Iterations == limits.MaximumNumberOfIterations)
      {
        report.Converged = false;
        break;
      }
      ++report.Iterations;
      if (!this->Multiply())
      {
        report.Converged = false;
        break;
      }
      this->Advance(x, report.Iterations == limits.MaximumNumberOfIterations);
      const double left = this->FiniteResidual();
      if (report.Iterations % 8 == 0)
      {
        // The residual falls by about a constant factor per iteration.
        const double all = std::log(start / limits.Tolerance);
        fraction = std::max(fraction, std::min(0.99, std::log(start / left) / all));
        progress.Report(fraction);
      }
      if (forecast.Update(report.Iterations, left))
      {
        report.Converged = false;
        break;
      }
    }
    report.Forecast = forecast.Largest();
    report.Residual = this->Residual();
    progress.Report(1.0);
    return report;
  }

  /// The first direction.
  void Start(double tolerance)
  {
    this->Tolerance = tolerance;
    const ColumnCount<K> k(this->Columns);
    const double* const r = this->R.data();
    double* const p = this->W.P.data();
    this->Sum(
      [this, k, r, p](Index i, double* sums)
      {
        const std::ptrdiff_t at = static_cast<std::ptrdiff_t>(i) * k;
        const bool counts = this->Counts(i);
        for (int c = 0; c < k; ++c)
        {
          const double z = this->S.Scale(i, c, r + at);
          p[at + c] = z;
          sums[System::IsCoupled ? 0 : c] += counts ? r[at + c] * z : 0.0;
        }
      });
    this->TakeSquares();
    if (this->S.HasPreconditioner() && !this->IsFinished())
    {
      this->Precondition();
      ForEach(this->Parallel, this->Rows, [this](Index i) { this->W.P.row(i) = this->W.Q.row(i); });
    }
    for (int s = 0; s < this->Systems(); ++s)
    {
      this->W.Rho[s] = this->W.Length[s] = this->RhoOf(s);
    }
  }

  /// q = A p and the step lengths. False if a step has no bounds but those of round-off: its length
  /// is then 0.
  bool Multiply()
  {
    const ColumnCount<K> k(this->Columns);
    const double* const p = this->W.P.data();
    double* const q = this->W.Q.data();
    this->S.PrepareProduct(this->W.P);
    const auto multiply = [this](Index begin, Index end)
    { this->S.template MultiplyRows<K>(this->W.P, this->W.Q, begin, end); };
    if (System::IsProjected && !this->S.OverProcesses.IsSerial())
    {
      ForEachBlock(
        this->Parallel, this->Rows, [&](Index, Index begin, Index end) { multiply(begin, end); });
      this->S.OverProcesses.Accumulate(this->W.Q);
      this->Sum(
        [this, k, p, q](Index i, double* sums)
        {
          const std::ptrdiff_t at = static_cast<std::ptrdiff_t>(i) * k;
          this->S.template Project<K>(i, q + at);
          if (this->Counts(i))
          {
            AddProduct(p + at, q + at, k, sums);
          }
        });
    }
    else
    {
      // The product of a consistent and an accumulated vector needs no owners.
      this->Sum(multiply,
        [this, k, p, q](Index i, double* sums)
        {
          const std::ptrdiff_t at = static_cast<std::ptrdiff_t>(i) * k;
          this->S.template Project<K>(i, q + at);
          AddProduct(p + at, q + at, k, sums);
        });
      this->S.OverProcesses.Accumulate(this->W.Q);
    }
    bool isResolved = true;
    for (int s = 0; s < this->Systems(); ++s)
    {
      const bool isPositive = this->W.Sums[s] > ResolvedShare * this->W.Length[s];
      const bool isFinished = this->IsFinished(s);
      isResolved = isResolved && (isPositive || isFinished);
      this->W.Alpha[s] = isPositive && !isFinished ? this->W.Rho[s] / this->W.Sums[s] : 0.0;
      this->W.Step[s] = this->W.Alpha[s] * this->W.Unit[s];
    }
    return isResolved;
  }

  /// The step along p, and the next direction unless this is the last iteration.
  void Advance(Values& x, bool isLast)
  {
    const ColumnCount<K> k(this->Columns);
    double* const r = this->R.data();
    const double* const q = this->W.Q.data();
    const Numbers alpha(this->W.Alpha);
    this->Sum(
      [this, k, r, q, alpha](Index i, double* sums)
      {
        const std::ptrdiff_t at = static_cast<std::ptrdiff_t>(i) * k;
        for (int c = 0; c < k; ++c)
        {
          r[at + c] -= alpha[System::IsCoupled ? 0 : c] * q[at + c];
        }
        const bool counts = this->Counts(i);
        for (int c = 0; c < k; ++c)
        {
          const double square = r[at + c] * this->S.Scale(i, c, r + at);
          sums[System::IsCoupled ? 0 : c] += counts ? square : 0.0;
        }
      });
    this->TakeSquares();
    if (isLast || this->IsFinished())
    {
      this->Turn<false>(x, [](std::ptrdiff_t, Index, int) { return 0.0; });
      return;
    }
    if (this->S.HasPreconditioner())
    {
      this->Precondition();
    }
    for (int s = 0; s < this->Systems(); ++s)
    {
      const double rho = this->RhoOf(s);
      this->W.Beta[s] = this->W.Rho[s] > 0.0 ? rho / this->W.Rho[s] : 0.0;
      this->W.Rho[s] = rho;
      // B r and the last p are orthogonal in B^-1
      this->W.Length[s] = rho + this->W.Beta[s] * this->W.Beta[s] * this->W.Length[s];
    }
    if (this->S.HasPreconditioner())
    {
      this->Turn<true>(x, [q](std::ptrdiff_t at, Index, int c) { return q[at + c]; });
    }
    else
    {
      this->Turn<true>(
        x, [this, r](std::ptrdiff_t at, Index i, int c) { return this->S.Scale(i, c, r + at); });
    }
  }

  void SetTolerance(double tolerance) { this->Tolerance = tolerance; }

  /// Whether all systems are within the tolerance; false if a residual is not a number.
  bool IsFinished() const { return this->Residual() <= this->Tolerance; }

  /// The largest over the systems.
  double Residual() const
  {
    double largest = 0.0;
    for (int s = 0; s < this->Systems(); ++s)
    {
      const double residual = std::sqrt(this->W.Square[s] / this->W.Reference[s]);
      if (std::isnan(residual))
      {
        return residual;
      }
      largest = std::max(largest, residual);
    }
    return largest;
  }

private:
  static constexpr int KnownSystems = System::IsCoupled ? 1 : K;
  using Numbers = SystemNumbers<KnownSystems>;

  int Systems() const { return System::IsCoupled ? 1 : ColumnCount<K>(this->Columns); }

  bool IsFinished(int s) const
  {
    return std::sqrt(this->W.Square[s] / this->W.Reference[s]) <= this->Tolerance;
  }

  double FiniteResidual() const
  {
    const double residual = this->Residual();
    if (!std::isfinite(residual))
    {
      throw std::runtime_error("the linear system has no finite solution");
    }
    return residual;
  }

  void TakeSquares()
  {
    std::copy_n(this->W.Sums.Totals().begin(), this->Systems(), this->W.Square.begin());
  }

  double RhoOf(int s) const
  {
    return this->S.HasPreconditioner() ? this->W.Sums[s] : this->W.Square[s];
  }

  /// Q = B R, and the products of both.
  void Precondition()
  {
    this->S.Precondition(this->R, this->W.Square, this->W.Q);
    const ColumnCount<K> k(this->Columns);
    const double* const r = this->R.data();
    double* const q = this->W.Q.data();
    this->Sum(
      [this, k, r, q](Index i, double* sums)
      {
        const std::ptrdiff_t at = static_cast<std::ptrdiff_t>(i) * k;
        this->S.template Project<K>(i, q + at);
        if (this->Counts(i))
        {
          AddProduct(r + at, q + at, k, sums);
        }
      });
  }

  /// x takes its step along p, which is in the cache here; then p = z + beta p.
  template <bool HasNext, typename Z>
  void Turn(Values& x, const Z& z)
  {
    const ColumnCount<K> k(this->Columns);
    double* const u = x.data();
    double* const p = this->W.P.data();
    const Numbers step(this->W.Step);
    const Numbers beta(this->W.Beta);
    ForEach(this->Parallel, this->Rows,
      [=](Index i)
      {
        const std::ptrdiff_t at = static_cast<std::ptrdiff_t>(i) * k;
        for (int c = 0; c < k; ++c)
        {
          const int s = System::IsCoupled ? 0 : c;
          const double last = p[at + c];
          u[at + c] += step[s] * last;
          if constexpr (HasNext)
          {
            p[at + c] = z(at, i, c) + beta[s] * last;
          }
        }
      });
  }

  static void AddProduct(const double* a, const double* b, int k, double* sums)
  {
    if constexpr (System::IsCoupled)
    {
      double product = 0.0;
      for (int c = 0; c < k; ++c)
      {
        product += a[c] * b[c];
      }
      sums[0] += product;
    }
    else
    {
      for (int c = 0; c < k; ++c)
      {
        sums[c] += a[c] * b[c];
      }
    }
  }

  /// Whether this process is the one that counts vertex i.
  bool Counts(Index i) const { return this->S.OverProcesses.Owns(i); }

  template <typename Add>
  void Sum(const Add& add)
  {
    this->Sum([](Index, Index) {}, add);
  }

  template <typename First, typename Add>
  void Sum(const First& first, const Add& add)
  {
    this->W.Sums.template Run<KnownSystems>(
      this->Parallel, this->Rows, this->Systems(), first, add);
    this->W.Sums.Reduce(this->S.OverProcesses);
  }

  const System& S;
  Values& R;
  ConjugateGradientWork& W;
  const ParallelFor& Parallel;
  const Index Rows;
  const int Columns;
  double Tolerance = 0.0;
};

} // namespace SurfaceDiffusion
