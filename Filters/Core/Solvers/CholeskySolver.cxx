// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Solvers/LinearSolver.h"

#include "Core/Foundation/Columns.h"
#include "Core/Operators/Assembler.h"
#include "Core/Solvers/SparseFactor.h"

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
  /// Columns j .. j + Width - 1 of L, a panel of the factor.
  template <int Width>
  struct Panel
  {
    Panel(const SparseFactor& l, Index j)
    {
      for (int a = 0; a < Width; ++a)
      {
        this->Below[a] = l.Entries + l.Begin[j + a] + (Width - 1 - a);
      }
      const Index last = j + Width - 1;
      this->Rows = l.Rows + l.Begin[last];
      this->Count = l.Begin[last + 1] - l.Begin[last];
    }
    /// The entry in row j + b of column j + a.
    double Within(int a, int b) const { return this->Below[a][b - Width]; }

    const double* Below[Width]; ///< per column, the entries in the rows below the panel
    const Index* Rows; ///< below the panel, the same for all columns
    Index Count; ///< of these rows
  };

  /// Call work(width) with the width of a panel as a number known to the compiler.
  template <typename Work>
  static void ForWidth(Index width, const Work& work)
  {
    ForNumber<SparseFactor::WidestPanel>(width,
      [&](auto number)
      {
        if constexpr (decltype(number)::value > 0)
        {
          work(number);
        }
      });
  }

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
    const std::vector<Index>& panels = this->Factor->Panels;
    for (std::size_t p = 0; p + 1 < panels.size(); ++p)
    {
      ForWidth(panels[p + 1] - panels[p],
        [&](auto width) { this->Forward<K, decltype(width)::value>(panels[p], k); });
    }
    for (std::size_t p = panels.size() - 1; p > 0; --p)
    {
      ForWidth(panels[p] - panels[p - 1],
        [&](auto width) { this->Backward<K, decltype(width)::value>(panels[p - 1], k); });
    }
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

  /// The part of W = L^-1 W that belongs to the columns j .. j + Width - 1 of L.
  template <int K, int Width>
  void Forward(Index j, int columns)
  {
    const ColumnCount<K> k(columns);
    const Panel<Width> panel(*this->Factor, j);
    double* w = this->Row(j, k);
    for (int a = 0; a < Width; ++a)
    {
      for (int b = a + 1; b < Width; ++b)
      {
        for (int c = 0; c < k; ++c)
        {
          w[b * k + c] -= panel.Within(a, b) * w[a * k + c];
        }
      }
    }
    ColumnRegisters<double, K, Width> registers;
    if (K > 0)
    {
      double* const fast = registers.Or(w);
      std::copy_n(w, Width * k, fast);
      w = fast;
    }
    for (Index s = 0; s < panel.Count; ++s)
    {
      double* wi = this->Row(panel.Rows[s], k);
      for (int c = 0; c < k; ++c)
      {
        double sum = wi[c];
        for (int a = 0; a < Width; ++a)
        {
          sum -= panel.Below[a][s] * w[a * k + c];
        }
        wi[c] = sum;
      }
    }
  }

  /// The rows j .. j + Width - 1 of W = L^-T D^-1 W.
  template <int K, int Width>
  void Backward(Index j, int columns)
  {
    const ColumnCount<K> k(columns);
    const Panel<Width> panel(*this->Factor, j);
    double* result = this->Row(j, k);
    ColumnRegisters<double, K, Width> registers;
    double* w = registers.Or(result);
    for (int a = 0; a < Width; ++a)
    {
      for (int c = 0; c < k; ++c)
      {
        w[a * k + c] = this->Factor->InverseD[j + a] * result[a * k + c];
      }
    }
    for (Index s = 0; s < panel.Count; ++s)
    {
      const double* wi = this->Row(panel.Rows[s], k);
      for (int a = 0; a < Width; ++a)
      {
        for (int c = 0; c < k; ++c)
        {
          w[a * k + c] -= panel.Below[a][s] * wi[c];
        }
      }
    }
    for (int a = Width - 1; a >= 0; --a)
    {
      for (int b = a + 1; b < Width; ++b)
      {
        for (int c = 0; c < k; ++c)
        {
          w[a * k + c] -= panel.Within(a, b) * w[b * k + c];
        }
      }
      for (int c = 0; c < k; ++c)
      {
        result[a * k + c] = w[a * k + c];
      }
    }
  }

  /// R = b - A x. Returns SolveReport::Residual.
  double ComputeResidual(const Values& b, const Values& x)
  {
    const Vector& weights = this->Factor->InverseDiagonal;
    const Index n = static_cast<Index>(b.rows());
    this->R.resize(b.rows(), b.cols());
    Multiply(*this->Matrix, x, this->R, this->Parallel);
    double largest = 0.0;
    for (Eigen::Index k = 0; k < b.cols(); ++k)
    {
      const double unit = ScaleOf(b, this->R, k, this->Parallel);
      const double ofR = Sum(this->Parallel, n,
        [&](Index i)
        {
          const double r = b(i, k) - this->R(i, k);
          this->R(i, k) = r;
          return weights[i] * (r / unit) * (r / unit);
        });
      const double ofB = Sum(this->Parallel, n,
        [&](Index i) { return weights[i] * (b(i, k) / unit) * (b(i, k) / unit); });
      if (!std::isfinite(ofR))
      {
        throw std::runtime_error("the linear system has no finite solution");
      }
      largest = std::max(largest, ofB > 0.0 ? std::sqrt(ofR / ofB) : std::sqrt(ofR));
    }
    return largest;
  }

  const ParallelFor& Parallel;
  const SparseMatrix* Matrix = nullptr;
  std::shared_ptr<SparseFactor> Factor;
  long Factorizations = 0;
  Values R, Correction;
  Values W; ///< in the order of the factor
};

} // namespace

std::unique_ptr<LinearSolver> MakeCholeskySolver(const ParallelFor& parallel)
{
  return std::make_unique<CholeskySolver>(parallel);
}

} // namespace SurfaceDiffusion
