// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Solvers/LinearSolver.h"

#include "Core/Foundation/ColumnSums.h"
#include "Core/Operators/Assembler.h"
#include "Core/Operators/SparsePattern.h"
#include "Core/Operators/SparseProduct.h"
#include "Core/Solvers/Multigrid.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <vector>

namespace SurfaceDiffusion
{

namespace
{

class ConjugateGradientSolver : public LinearSolver
{
public:
  ConjugateGradientSolver(std::unique_ptr<Multigrid> hierarchy, const ParallelFor& parallel)
    : Parallel(parallel)
    , Hierarchy(std::move(hierarchy))
  {
  }

  void SetMatrix(const SparseMatrix& matrix, const ProgressMonitor& progress) override
  {
    this->Matrix = &matrix;
    const Index n = static_cast<Index>(matrix.rows());
    this->InverseDiagonal.resize(n);
    ForEach(this->Parallel, n,
      [&](Index i) { this->InverseDiagonal[i] = 1.0 / DiagonalEntry(matrix, i); });
    if (this->Hierarchy)
    {
      this->Hierarchy->SetMatrix(matrix, progress);
    }
    progress.Report(1.0);
  }

  SolveReport Solve(const Values& b, Values& x, const ProgressMonitor& progress) override
  {
    switch (b.cols())
    {
      case 1:
        return this->SolveColumns<1>(b, x, progress);
      case 2:
        return this->SolveColumns<2>(b, x, progress);
      case 3:
        return this->SolveColumns<3>(b, x, progress);
      default:
        return this->SolveColumns<0>(b, x, progress);
    }
  }

private:
  /// K columns, or as many as b has where K is 0. Every column runs its own recurrence and stops by
  /// itself, so that its bits do not depend on its company.
  template <int K>
  SolveReport SolveColumns(const Values& b, Values& x, const ProgressMonitor& progress)
  {
    const int k = K > 0 ? K : static_cast<int>(b.cols());
    const Index n = static_cast<Index>(b.rows());
    this->Resize(n, k);

    // r = b - A x in units of each column's own
    Multiply(*this->Matrix, x, this->Q, this->Parallel);
    for (int c = 0; c < k; ++c)
    {
      this->Unit[c] = ScaleOf(b, this->Q, c, this->Parallel);
    }
    this->Sums.Run<K>(this->Parallel, n, k, 2,
      [&](Index i, double* sums)
      {
        for (int c = 0; c < k; ++c)
        {
          const double bi = b(i, c) / this->Unit[c];
          const double r = bi - this->Q(i, c) / this->Unit[c];
          this->R(i, c) = r;
          sums[c] += r * this->InverseDiagonal[i] * r; // as in Iterate(), to the bit
          sums[k + c] += bi * this->InverseDiagonal[i] * bi;
        }
      });
    for (int c = 0; c < k; ++c)
    {
      this->Square[c] = this->Sums[c];
      this->Scale[c] = this->Sums[k + c] > 0.0 ? this->Sums[k + c] : 1.0;
    }
    this->Rho.assign(k, 0.0);
    this->Step.assign(k, 0.0);
    this->Length.assign(k, 0.0);
    this->Turn<K>(n, k, x);

    SolveReport report;
    double fraction = 0.0;
    const double start = this->Residual(k);
    if (!std::isfinite(start))
    {
      throw std::runtime_error("the linear system has no finite solution");
    }
    while (this->Residual(k) > this->Limits.Tolerance)
    {
      if (report.Iterations == this->Limits.MaximumNumberOfIterations)
      {
        report.Converged = false;
        break;
      }
      ++report.Iterations;
      if (!this->Iterate<K>(n, k, x))
      {
        report.Converged = false; // the matrix is not positive definite, or not beyond round-off
        break;
      }
      const double left = this->Residual(k);
      if (!std::isfinite(left))
      {
        throw std::runtime_error("the linear system has no finite solution");
      }
      if (report.Iterations % 8 == 0)
      {
        // The residual falls by a constant factor per iteration: its logarithm tells how far.
        const double all = std::log(start / this->Limits.Tolerance);
        fraction = std::max(fraction, std::min(0.99, std::log(start / left) / all));
        progress.Report(fraction);
      }
    }
    report.Residual = this->Residual(k);
    progress.Report(1.0);
    return report;
  }

  /// False where no further fraction is possible.
  template <int K>
  bool Iterate(Index n, int columns, Values& x)
  {
    const int k = K > 0 ? K : columns;
    this->Sums.Run<K>(
      this->Parallel, n, k, 1,
      [&](Index begin, Index end) { MultiplyRows<K>(*this->Matrix, this->P, this->Q, begin, end); },
      [&](Index i, double* sums)
      {
        for (int c = 0; c < k; ++c)
        {
          sums[c] += this->P(i, c) * this->Q(i, c);
        }
      });
    for (int c = 0; c < k; ++c)
    {
      const bool finished = this->Finished(c);
      if (!finished && !(this->Sums[c] > ResolvedShare * this->Length[c]))
      {
        return false;
      }
      this->Alpha[c] = finished ? 0.0 : this->Rho[c] / this->Sums[c];
    }
    this->Sums.Run<K>(this->Parallel, n, k, 1,
      [&](Index i, double* sums)
      {
        for (int c = 0; c < k; ++c)
        {
          const double r = this->R(i, c) - this->Alpha[c] * this->Q(i, c);
          this->R(i, c) = r;
          sums[c] += r * this->InverseDiagonal[i] * r;
        }
      });
    for (int c = 0; c < k; ++c)
    {
      this->Square[c] = this->Sums[c];
    }
    for (int c = 0; c < k; ++c)
    {
      this->Step[c] = this->Alpha[c] * this->Unit[c];
    }
    this->Turn<K>(n, k, x);
    return true;
  }

  /// x goes its step along P, which is in the cache here; then P = B r + beta P, conjugate to what
  /// it was; B is diag(A)^-1 or a multigrid cycle.
  template <int K>
  void Turn(Index n, int columns, Values& x)
  {
    const int k = K > 0 ? K : columns;
    if (this->Hierarchy)
    {
      for (int c = 0; c < k; ++c)
      {
        this->Alpha[c] = this->Square[c] > 0.0 ? 1.0 / std::sqrt(this->Square[c]) : 1.0;
      }
      this->Hierarchy->Apply(this->R, this->Alpha, this->Q);
      this->Sums.Run<K>(this->Parallel, n, k, 1,
        [&](Index i, double* sums)
        {
          for (int c = 0; c < k; ++c)
          {
            sums[c] += this->R(i, c) * this->Q(i, c);
          }
        });
    }
    for (int c = 0; c < k; ++c)
    {
      const double rho = this->Hierarchy ? this->Sums[c] : this->Square[c];
      this->Beta[c] = this->Rho[c] > 0.0 ? rho / this->Rho[c] : 0.0;
      this->Rho[c] = rho;
      // B r and the last P are orthogonal in B^-1
      this->Length[c] = rho + this->Beta[c] * this->Beta[c] * this->Length[c];
    }
    ForEach(this->Parallel, n,
      [&](Index i)
      {
        for (int c = 0; c < k; ++c)
        {
          const double z =
            this->Hierarchy ? this->Q(i, c) : this->InverseDiagonal[i] * this->R(i, c);
          const double p = this->P(i, c);
          x(i, c) += this->Step[c] * p;
          this->P(i, c) = z + this->Beta[c] * p;
        }
      });
  }

  bool Finished(int c) const
  {
    return std::sqrt(this->Square[c] / this->Scale[c]) <= this->Limits.Tolerance;
  }

  double Residual(int k) const
  {
    double largest = 0.0;
    for (int c = 0; c < k; ++c)
    {
      const double residual = std::sqrt(this->Square[c] / this->Scale[c]);
      largest = residual <= largest ? largest : residual; // keeps NaN
    }
    return largest;
  }

  void Resize(Index n, int k)
  {
    if (this->R.rows() != n || this->R.cols() != k)
    {
      this->R.resize(n, k);
      this->P.setZero(n, k); // what the first direction is turned from
      this->Q.resize(n, k);
      for (std::vector<double>* scalars : { &this->Unit, &this->Square, &this->Rho, &this->Scale,
             &this->Alpha, &this->Step, &this->Beta, &this->Length })
      {
        scalars->assign(k, 0.0);
      }
      this->Sums.Resize(n, 2 * k);
    }
  }

  const ParallelFor& Parallel;
  std::unique_ptr<Multigrid> Hierarchy;
  const SparseMatrix* Matrix = nullptr;
  Vector InverseDiagonal;
  Values R, P, Q;
  std::vector<double> Unit, Square, Rho, Scale, Alpha, Step, Beta; // one per column
  std::vector<double> Length; ///< per column, P . B^-1 P
  ColumnSums Sums;
};

} // namespace

std::unique_ptr<LinearSolver> MakeConjugateGradientSolver(const ParallelFor& parallel)
{
  return std::make_unique<ConjugateGradientSolver>(nullptr, parallel);
}

std::unique_ptr<LinearSolver> MakeMultigridSolver(const ParallelFor& parallel)
{
  return std::make_unique<ConjugateGradientSolver>(std::make_unique<Multigrid>(parallel), parallel);
}

} // namespace SurfaceDiffusion
