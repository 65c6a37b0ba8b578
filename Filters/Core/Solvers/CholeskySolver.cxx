// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Solvers/LinearSolver.h"

#include "Core/Foundation/Columns.h"
#include "Core/Foundation/Resize.h"
#include "Core/Operators/Assembler.h"
#include "Core/Operators/ResidualSquares.h"
#include "Core/Solvers/NotPositiveDefinite.h"
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
    std::unique_ptr<SparseFactor> factor = std::move(this->Factor); // an abort drops it
    if (!factor)
    {
      factor = std::make_unique<SparseFactor>();
    }
    factor->SetMatrix(matrix);
    ++this->Factorizations;
    factor->Compute(this->Parallel, progress);
    if (!factor->IsPositive())
    {
      throw NotPositiveDefinite();
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
    this->MeasureResiduals(b, x, this->Residuals);
    if (LargestOf(this->Residuals) > this->Limits.Tolerance)
    {
      this->Refine(b, x);
    }
    report.Residual = LargestOf(this->Residuals);
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
    Resize(x, b.rows(), b.cols());
    const auto columns = static_cast<int>(b.cols());
    for (int first = 0; first < columns; first += ColumnPanel)
    {
      const int count = std::min(ColumnPanel, columns - first);
      ForColumns(WidthFor(count),
        [&](auto number)
        {
          constexpr int width = decltype(number)::value;
          if constexpr (width > 0)
          {
            this->SubstituteColumns<width>(b, x, first, count);
          }
        });
    }
  }

  /// The smallest number of columns, known to the compiler, that `count` columns fit in.
  static int WidthFor(int count)
  {
    constexpr int alone = 3;
    return count <= alone ? count : count <= HalfPanel ? HalfPanel : ColumnPanel;
  }

  /// `count` columns from `first` on, and zeros up to K.
  template <int K>
  void SubstituteColumns(const Values& b, Values& x, int first, int count)
  {
    const Index n = static_cast<Index>(b.rows());
    const Index* const place = this->Factor->Place();
    Resize(this->W, n, K);
    double* const w = this->W.data();
    for (Index i = 0; i < n; ++i)
    {
      double* const to = w + static_cast<std::ptrdiff_t>(place[i]) * K;
      const double* const from = &b(i, first);
      if (count == K)
      {
        CopyColumns<K>(from, to, K);
        continue;
      }
      std::fill(std::copy_n(from, count, to), to + K, 0.0);
    }
    SubstituteRows<K>(*this->Factor, w);
    for (Index i = 0; i < n; ++i)
    {
      const double* const from = w + static_cast<std::ptrdiff_t>(place[i]) * K;
      double* const to = &x(i, first);
      if (count == K)
      {
        CopyColumns<K>(from, to, K);
        continue;
      }
      std::copy_n(from, count, to);
    }
  }

  /// One step of iterative refinement for the columns that missed the tolerance, as far as it
  /// improves them. Each column has the bits that it has alone.
  void Refine(const Values& b, Values& x)
  {
    Resize(this->R, b.rows(), b.cols());
    Multiply(*this->Matrix, x, this->R, this->Parallel);
    this->R = b - this->R;
    this->Substitute(this->R, this->Correction);
    this->Correction += x;
    this->MeasureResiduals(b, this->Correction, this->Refined);
    for (std::size_t k = 0; k < this->Residuals.size(); ++k)
    {
      const double before = this->Residuals[k];
      if (before > this->Limits.Tolerance && this->Refined[k] < before)
      {
        const auto column = static_cast<Eigen::Index>(k);
        x.col(column) = this->Correction.col(column);
        this->Residuals[k] = this->Refined[k];
      }
    }
  }

  /// 0 without columns.
  static double LargestOf(const std::vector<double>& residuals)
  {
    const auto largest = std::max_element(residuals.begin(), residuals.end());
    return largest == residuals.end() ? 0.0 : *largest;
  }

  /// SolveReport::Residual of each column of x.
  void MeasureResiduals(const Values& b, const Values& x, std::vector<double>& residuals)
  {
    const auto columns = static_cast<std::size_t>(b.cols());
    ResidualSquares(
      *this->Matrix, b, x, this->Factor->InverseDiagonal, this->Squares, this->Parallel);
    residuals.resize(columns);
    for (std::size_t k = 0; k < columns; ++k)
    {
      const double ofR = this->Squares[2 * k];
      const double ofB = this->Squares[2 * k + 1];
      constexpr double small = 1e-250;
      const bool isSafe = ofR > small && ofB > small && ofR < 1.0 / small && ofB < 1.0 / small;
      residuals[k] = std::sqrt(
        isSafe ? ofR / ofB : this->ComputeScaledRatio(b, x, static_cast<Eigen::Index>(k)));
    }
  }

  /// |b - A x|^2 / |b|^2 of a column whose squares may overflow or underflow; |b - A x|^2 if b is
  /// zero.
  double ComputeScaledRatio(const Values& b, const Values& x, Eigen::Index k)
  {
    const Vector& weights = this->Factor->InverseDiagonal;
    const Index n = static_cast<Index>(b.rows());
    Values r = b.col(k) - *this->Matrix * x.col(k);
    const Values ofColumn = b.col(k);
    const double unit = ScaleOf(ofColumn, r, 0, this->Parallel);
    const auto sum = [&](const Values& values)
    {
      return Sum(this->Parallel, n,
        [&](Index i) { return weights[i] * (values(i, 0) / unit) * (values(i, 0) / unit); });
    };
    const double ofR = sum(r);
    const double ofB = sum(ofColumn);
    if (!std::isfinite(ofR))
    {
      throw std::runtime_error("the linear system has no finite solution");
    }
    return ofB > 0.0 ? ofR / ofB : ofR;
  }

  const ParallelFor& Parallel;
  const SparseMatrix* Matrix = nullptr;
  std::unique_ptr<SparseFactor> Factor;
  long Factorizations = 0;
  Values R, Correction;
  Values W; ///< in the order of the factor
  std::vector<double> Squares; ///< of ResidualSquares()
  std::vector<double> Residuals, Refined; ///< per column
};

} // namespace

std::unique_ptr<LinearSolver> MakeCholeskySolver(const ParallelFor& parallel)
{
  return std::make_unique<CholeskySolver>(parallel);
}

} // namespace SurfaceDiffusion
