// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Solvers/ConjugateGradients.h"

#include "Core/Operators/Assembler.h"
#include "Core/Operators/SparsePattern.h"
#include "Core/Solvers/Multigrid.h"

namespace SurfaceDiffusion
{

namespace
{

/// Independent columns, preconditioned with the diagonal or with multigrid.
struct ColumnSystem : MatrixSystem
{
  Multigrid* Hierarchy; ///< null: the diagonal
  std::vector<double>& Scales; ///< work, one number per column

  bool HasPreconditioner() const { return this->Hierarchy != nullptr; }
  void Precondition(const Values& r, const std::vector<double>& squares, Values& z) const
  {
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
    return ForColumns(
      b.cols(), [&](auto k) { return this->SolveColumns<decltype(k)::value>(b, x, progress); });
  }

  void Precondition(const Values& r, Values& z) override
  {
    const Index n = static_cast<Index>(r.rows());
    z.resize(r.rows(), r.cols());
    if (!this->Hierarchy)
    {
      ForEach(this->Parallel, n, [&](Index i) { z.row(i) = this->InverseDiagonal[i] * r.row(i); });
      return;
    }
    std::vector<double> squares(r.cols());
    for (Eigen::Index c = 0; c < r.cols(); ++c)
    {
      squares[c] = Sum(
        this->Parallel, n, [&](Index i) { return r(i, c) * this->InverseDiagonal[i] * r(i, c); });
    }
    this->Scales.resize(r.cols());
    this->System().Precondition(r, squares, z);
  }

private:
  ColumnSystem System()
  {
    return { { *this->Matrix, this->InverseDiagonal }, this->Hierarchy.get(), this->Scales };
  }

  template <int K>
  SolveReport SolveColumns(const Values& b, Values& x, const ProgressMonitor& progress)
  {
    const ColumnCount<K> k(b.cols());
    const Index n = static_cast<Index>(b.rows());
    this->Residual.resize(n, k);
    this->Scales.resize(k);
    this->Work.Resize(n, k, k);
    const ColumnSystem system = this->System();

    // b - A x in units of each column's own
    Values& product = this->Work.Q;
    Multiply(*this->Matrix, x, product, this->Parallel);
    std::vector<double>& unit = this->Work.Unit;
    for (int c = 0; c < k; ++c)
    {
      unit[c] = ScaleOf(b, product, c, this->Parallel);
    }
    this->Work.Sums.Run<K>(this->Parallel, n, k,
      [&](Index i, double* sums)
      {
        for (int c = 0; c < k; ++c)
        {
          const double bi = b(i, c) / unit[c];
          this->Residual(i, c) = bi - product(i, c) / unit[c];
          sums[c] += bi * this->InverseDiagonal[i] * bi;
        }
      });
    for (int c = 0; c < k; ++c)
    {
      this->Work.Reference[c] = this->Work.Sums[c] > 0.0 ? this->Work.Sums[c] : 1.0;
    }
    return ConjugateGradients<K, ColumnSystem>(system, this->Residual, this->Work, this->Parallel)
      .Solve(x, this->Limits, progress);
  }

  const ParallelFor& Parallel;
  std::unique_ptr<Multigrid> Hierarchy;
  const SparseMatrix* Matrix = nullptr;
  Vector InverseDiagonal;
  Values Residual;
  std::vector<double> Scales;
  ConjugateGradientWork Work;
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
