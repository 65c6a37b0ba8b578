// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Solvers/LinearSolver.h"

#include "Core/Foundation/ColumnSums.h"
#include "Core/Foundation/Columns.h"
#include "Core/Operators/Assembler.h"
#include "Core/Solvers/SparseFactor.h"
#include "Core/Solvers/Substitution.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <vector>

namespace SurfaceDiffusion
{

namespace
{

class CholeskySolver : public LinearSolver
{
public:
  explicit CholeskySolver(const ParallelFor& parallel)
    : Parallel(parallel)
  {
  }

  void SetMatrix(const SparseMatrix& matrix, const ProgressMonitor& progress) override
  {
    this->Matrix = &matrix;
    if (matrix.rows() == 0) // Eigen's ordering writes beyond the end of nothing
    {
      return;
    }
    if (this->Factor && this->Factor->HasValuesOf(matrix))
    {
      return;
    }
    // A factorisation cannot be stopped: it runs on its own data, and an abort drops it.
    std::shared_ptr<SparseFactor> factor = std::move(this->Factor);
    if (!factor || !factor->HasPatternOf(matrix))
    {
      factor = std::make_shared<SparseFactor>();
    }
    factor->SetMatrix(matrix);
    ++this->Factorizations;
    constexpr Eigen::Index quick = 5000; // vertices, whose factorisation is not worth a thread
    if (matrix.rows() < quick)
    {
      factor->Compute();
      progress.Report(1.0);
    }
    else
    {
      RunInBackground([factor] { factor->Compute(); }, progress);
    }
    if (!factor->IsPositive())
    {
      throw std::runtime_error("the matrix of the linear system is not positive definite; if "
                               "triangles are all but flat, IntrinsicDelaunay makes it so");
    }
    this->Factor = std::move(factor);
  }

  SolveReport Solve(const Values& b, Values& x, const ProgressMonitor& progress) override
  {
    SolveReport report;
    if (b.rows() == 0)
    {
      x = b;
      return report;
    }
    this->Substitute(b, x);
    report.Residual = this->ComputeResidual(b, x);
    if (report.Residual > this->Limits.Tolerance)
    {
      this->Substitute(this->R, this->Correction);
      this->Correction += x;
      const double refined = this->ComputeResidual(b, this->Correction);
      if (refined < report.Residual)
      {
        x.swap(this->Correction);
        report.Residual = refined;
      }
    }
    report.Converged = report.Residual <= this->Limits.Tolerance;
    report.IsFinal = true;
    progress.Report(1.0);
    return report;
  }

  void Precondition(const Values& r, Values& z) override
  {
    if (r.rows() == 0)
    {
      z = r;
      return;
    }
    this->Substitute(r, z);
  }

  bool RunsOnOneThread() const override { return true; }

  long NumberOfFactorizations() const override { return this->Factorizations; }

private:
  /// x = P^T L^-T D^-1 L^-1 P b
  void Substitute(const Values& b, Values& x)
  {
    x.resize(b.rows(), b.cols());
    this->W.resize(b.rows(), b.cols());
    ForColumns(b.cols(), [&](auto k) { this->SubstituteColumns<decltype(k)::value>(b, x); });
  }

  /// K columns, or any number of them if K is 0, in one pass over the factor.
  template <int K>
  void SubstituteColumns(const Values& b, Values& x)
  {
    const ColumnCount<K> k(b.cols());
    const Index n = static_cast<Index>(b.rows());
    const Index* place = this->Factor->Place;
    for (Index i = 0; i < n; ++i)
    {
      for (int c = 0; c < k; ++c)
      {
        this->Row(place[i], k)[c] = b(i, c);
      }
    }
    SubstituteRows<K>(*this->Factor, this->W.data(), k);
    for (Index i = 0; i < n; ++i)
    {
      for (int c = 0; c < k; ++c)
      {
        x(i, c) = this->Row(place[i], k)[c];
      }
    }
  }

  double* Row(Index i, int columns)
  {
    return this->W.data() + static_cast<std::ptrdiff_t>(i) * columns;
  }

  /// R = b - A x. Returns SolveReport::Residual.
  double ComputeResidual(const Values& b, const Values& x)
  {
    const Vector& weights = this->Factor->InverseDiagonal;
    const Index n = static_cast<Index>(b.rows());
    this->R.resize(b.rows(), b.cols());
    this->OfR.resize(static_cast<std::size_t>(b.cols()));
    this->OfB.resize(static_cast<std::size_t>(b.cols()));
    Multiply(*this->Matrix, x, this->R, this->Parallel);
    SumColumns(
      this->Parallel, n, b.cols(),
      [&](Index i, Eigen::Index k)
      {
        const double r = b(i, k) - this->R(i, k);
        this->R(i, k) = r;
        return weights[i] * r * r;
      },
      this->OfR.data());
    SumColumns(
      this->Parallel, n, b.cols(),
      [&](Index i, Eigen::Index k) { return weights[i] * b(i, k) * b(i, k); }, this->OfB.data());
    double largest = 0.0;
    for (std::size_t k = 0; k < this->OfR.size(); ++k)
    {
      constexpr double small = 1e-250;
      const bool isSafe = this->OfR[k] > small && this->OfB[k] > small &&
        this->OfR[k] < 1.0 / small && this->OfB[k] < 1.0 / small;
      const double squared = isSafe ? this->OfR[k] / this->OfB[k]
                                    : this->ComputeScaledRatio(b, static_cast<Eigen::Index>(k));
      largest = std::max(largest, std::sqrt(squared));
    }
    return largest;
  }

  /// |R|^2 / |b|^2 of a column whose squares may overflow or underflow; |R|^2 if b is zero.
  double ComputeScaledRatio(const Values& b, Eigen::Index k)
  {
    const Vector& weights = this->Factor->InverseDiagonal;
    const Index n = static_cast<Index>(b.rows());
    const double unit = ScaleOf(b, this->R, k, this->Parallel);
    const auto sum = [&](const Values& values)
    {
      return Sum(this->Parallel, n,
        [&](Index i) { return weights[i] * (values(i, k) / unit) * (values(i, k) / unit); });
    };
    const double ofR = sum(this->R);
    const double ofB = sum(b);
    if (!std::isfinite(ofR))
    {
      throw std::runtime_error("the linear system has no finite solution");
    }
    return ofB > 0.0 ? ofR / ofB : ofR;
  }

  const ParallelFor& Parallel;
  const SparseMatrix* Matrix = nullptr;
  std::shared_ptr<SparseFactor> Factor;
  long Factorizations = 0;
  Values R, Correction;
  Values W; ///< in the order of the factor
  std::vector<double> OfR, OfB; ///< weighted squares of the columns of R and b
};

} // namespace

std::unique_ptr<LinearSolver> MakeCholeskySolver(const ParallelFor& parallel)
{
  return std::make_unique<CholeskySolver>(parallel);
}

} // namespace SurfaceDiffusion
