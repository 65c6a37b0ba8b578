// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "LinearSolver.h"

#include "Assembler.h"

#include <Eigen/SparseCholesky>

#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace SurfaceDiffusion
{

namespace
{

/// Largest over the columns of |r| / |b| in the norm of diag(A)^-1.
double RelativeResidual(
  const SparseMatrix& matrix, const Values& r, const Values& b, const ParallelFor& parallel)
{
  const Index* outer = matrix.outerIndexPtr();
  const auto diagonal = [&](Index i)
  {
    const Index* row = matrix.innerIndexPtr();
    return matrix
      .valuePtr()[std::lower_bound(row + outer[i], row + outer[i + 1], i) - row];
  };
  const Index n = static_cast<Index>(matrix.rows());
  double largest = 0.0;
  for (Eigen::Index k = 0; k < b.cols(); ++k)
  {
    const double ofR =
      Sum(parallel, n, [&](Index i) { return r(i, k) * r(i, k) / diagonal(i); });
    const double ofB =
      Sum(parallel, n, [&](Index i) { return b(i, k) * b(i, k) / diagonal(i); });
    if (!std::isfinite(ofR))
    {
      throw std::runtime_error("the linear system has no finite solution");
    }
    largest = std::max(largest, ofB > 0.0 ? std::sqrt(ofR / ofB) : std::sqrt(ofR));
  }
  return largest;
}

class CholeskySolver : public LinearSolver
{
public:
  explicit CholeskySolver(const ParallelFor& parallel)
    : Parallel(parallel)
  {
  }

  void SetMatrix(const SparseMatrix& matrix, const Monitor& monitor) override
  {
    this->Matrix = &matrix;
    if (this->Factor && this->Factor->Holds(matrix))
    {
      return;
    }
    // A factorisation cannot be stopped: it runs on data of its own, and is dropped after an abort.
    std::shared_ptr<Factorization> factor = std::move(this->Factor);
    if (!factor || !factor->HoldsPatternOf(matrix))
    {
      factor = std::make_shared<Factorization>();
    }
    factor->Matrix = matrix;
    constexpr Eigen::Index quick = 5000; // vertices: not worth a thread
    if (matrix.rows() < quick)
    {
      factor->Compute();
      monitor.Report(1.0);
    }
    else
    {
      RunInBackground([factor] { factor->Compute(); }, monitor);
    }
    if (factor->Decomposition.info() != Eigen::Success)
    {
      throw std::runtime_error("the matrix of the linear system is not positive definite");
    }
    this->Factor = std::move(factor);
  }

  SolveReport Solve(const Values& b, Values& x, const Monitor& monitor) override
  {
    x = this->Factor->Decomposition.solve(b);
    SolveReport report;
    report.Residual = this->ComputeResidual(b, x);
    if (report.Residual > this->Limits.Tolerance)
    {
      this->Correction = this->Factor->Decomposition.solve(this->R);
      this->Correction += x;
      const double refined = this->ComputeResidual(b, this->Correction);
      if (refined < report.Residual)
      {
        x.swap(this->Correction);
        report.Residual = refined;
      }
    }
    monitor.Report(1.0);
    return report;
  }

private:
  struct Factorization
  {
    SparseMatrix Matrix;
    Eigen::SimplicialLDLT<SparseMatrix, Eigen::Lower, Eigen::AMDOrdering<Index>> Decomposition;
    bool Analyzed = false;

    void Compute()
    {
      if (!this->Analyzed)
      {
        this->Decomposition.analyzePattern(this->Matrix);
        this->Analyzed = true;
      }
      this->Decomposition.factorize(this->Matrix);
    }
    bool HoldsPatternOf(const SparseMatrix& matrix) const
    {
      return this->Matrix.rows() == matrix.rows() &&
        this->Matrix.nonZeros() == matrix.nonZeros() &&
        std::equal(matrix.outerIndexPtr(), matrix.outerIndexPtr() + matrix.rows(),
          this->Matrix.outerIndexPtr()) &&
        std::equal(matrix.innerIndexPtr(), matrix.innerIndexPtr() + matrix.nonZeros(),
          this->Matrix.innerIndexPtr());
    }
    bool Holds(const SparseMatrix& matrix) const
    {
      return this->HoldsPatternOf(matrix) &&
        std::equal(matrix.valuePtr(), matrix.valuePtr() + matrix.nonZeros(),
          this->Matrix.valuePtr());
    }
  };

  double ComputeResidual(const Values& b, const Values& x)
  {
    this->R.resize(b.rows(), b.cols());
    Multiply(*this->Matrix, x, this->R, this->Parallel);
    this->R = b - this->R;
    return RelativeResidual(*this->Matrix, this->R, b, this->Parallel);
  }

  const ParallelFor& Parallel;
  const SparseMatrix* Matrix = nullptr;
  std::shared_ptr<Factorization> Factor;
  Values R, Correction;
};

} // namespace

std::unique_ptr<LinearSolver> MakeCholeskySolver(const ParallelFor& parallel)
{
  return std::make_unique<CholeskySolver>(parallel);
}

} // namespace SurfaceDiffusion
