// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Solvers/LinearSolver.h"

#include "Core/Operators/Assembler.h"
#include "Core/Solvers/SparseFactor.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <type_traits>
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

private:
  struct Factorization
  {
    static constexpr int WidestPanel = 4;

    /// Of a diagonal entry: a few units in its last place.
    static constexpr double Resolved = 1e-14;

    SparseMatrix Matrix;
    std::unique_ptr<SparseFactor> LDL = MakeSparseFactor();
    bool Analyzed = false;
    bool Pruned = false;
    bool Succeeded = false;
    Vector InverseDiagonal; ///< of the matrix
    Vector InverseD; ///< of the factor
    std::vector<Index> Panels; ///< first columns, and the end

    void Compute()
    {
      // Held vertices leave zeros behind (and right angles too): without them the factor is that of
      // the free vertices alone.
      SparseMatrix pruned;
      const double* values = this->Matrix.valuePtr();
      const auto zeros = std::count(values, values + this->Matrix.nonZeros(), 0.0);
      const bool prune = zeros > this->Matrix.nonZeros() / 20;
      if (prune)
      {
        pruned = this->Matrix;
        pruned.prune([](Index, Index, double value) { return value != 0.0; });
      }
      const SparseMatrix& matrix = prune ? pruned : this->Matrix;
      if (!this->Analyzed || prune || this->Pruned)
      {
        this->LDL->Analyze(matrix);
        this->Analyzed = true;
        this->Pruned = prune;
      }
      this->Succeeded = this->LDL->Factorize(matrix, 1.0);
      if (!this->PivotsAbove(Resolved))
      {
        // A mode is lost in the last digits of the diagonal (the mean, at a huge time step): round
        // the diagonal up in these digits, which are wrong by as much, so that its pivot is safe.
        this->Succeeded = this->LDL->Factorize(matrix, 1.0 + Resolved);
      }
      this->InverseDiagonal = this->Matrix.diagonal().cwiseInverse();
      if (this->Succeeded)
      {
        this->InverseD = this->LDL->D.cwiseInverse();
        this->DropNegligible();
        this->FindPanels();
      }
    }

    /// Columns that follow each other, each of which has the rows of the next one and the next one
    /// itself: substitution takes them together, so that it reads rows once and numbers of the
    /// right-hand side once.
    void FindPanels()
    {
      const SparseFactor& l = *this->LDL;
      const Index n = static_cast<Index>(l.D.size());
      const auto nested = [&](Index j) // the columns j and j + 1
      {
        const Index begin = l.Begin[j];
        const Index next = l.Begin[j + 1];
        return next > begin && l.Rows[begin] == j + 1 &&
          next - begin - 1 == l.Begin[j + 2] - next &&
          std::equal(l.Rows + begin + 1, l.Rows + next, l.Rows + next);
      };
      this->Panels.clear();
      for (Index j = 0; j < n;)
      {
        this->Panels.push_back(j);
        Index width = 1;
        while (width < WidestPanel && j + width < n && nested(j + width - 1))
        {
          ++width;
        }
        j += width;
      }
      this->Panels.push_back(n);
    }

    /// Leave out of L what is below the last place of its row. The smaller the time step, the
    /// faster the influence of vertices on each other falls off with distance: at steps of h^2/D
    /// and less, a third to two thirds of the entries go. The rest moves together in place.
    void DropNegligible()
    {
      constexpr double lastPlace = 1e-16;
      SparseFactor& l = *this->LDL;
      const Index n = static_cast<Index>(l.D.size());
      Index kept = 0;
      for (Index j = 0, begin = 0; j < n; ++j)
      {
        const Index end = l.Begin[j + 1];
        for (Index slot = begin; slot < end; ++slot)
        {
          const Index i = l.Rows[slot];
          const double value = l.Entries[slot];
          // |L_ij| sqrt(D_j), an entry of the Cholesky factor, against sqrt(D_i), its diagonal
          if (!(value * value * std::abs(l.D[j]) < lastPlace * lastPlace * std::abs(l.D[i])))
          {
            l.Rows[kept] = i;
            l.Entries[kept] = value;
            ++kept;
          }
        }
        begin = end;
        l.Begin[j + 1] = kept;
      }
    }

    /// A pivot of a nearly singular matrix may be negative by round-off.
    bool IsPositive() const { return this->PivotsAbove(-1e-10); }

    /// Whether every pivot is above `bound` times its diagonal entry.
    bool PivotsAbove(double bound) const
    {
      if (!this->Succeeded)
      {
        return false;
      }
      const Vector diagonal = this->Matrix.diagonal();
      for (Eigen::Index i = 0; i < diagonal.size(); ++i)
      {
        if (!(this->LDL->D[this->LDL->Place[i]] > bound * std::abs(diagonal[i])))
        {
          return false;
        }
      }
      return true;
    }
    bool HoldsPatternOf(const SparseMatrix& matrix) const
    {
      return this->Matrix.rows() == matrix.rows() && this->Matrix.nonZeros() == matrix.nonZeros() &&
        std::equal(matrix.outerIndexPtr(), matrix.outerIndexPtr() + matrix.rows(),
          this->Matrix.outerIndexPtr()) &&
        std::equal(matrix.innerIndexPtr(), matrix.innerIndexPtr() + matrix.nonZeros(),
          this->Matrix.innerIndexPtr());
    }
    bool Holds(const SparseMatrix& matrix) const
    {
      return this->HoldsPatternOf(matrix) &&
        std::equal(
          matrix.valuePtr(), matrix.valuePtr() + matrix.nonZeros(), this->Matrix.valuePtr());
    }
  };

  /// Columns j .. j + Width - 1 of L, as FindPanels() puts them together.
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
    /// Row j + b of column j + a.
    double Within(int a, int b) const { return this->Below[a][b - Width]; }

    const double* Below[Width]; ///< entries in the rows that all have
    const Index* Rows; ///< these rows
    Index Count; ///< and their number
  };

  /// work(width), with the width of a panel as a number known to the compiler.
  template <typename Work>
  static void WithWidth(Index width, const Work& work)
  {
    switch (width)
    {
      case 1:
        return work(std::integral_constant<int, 1>());
      case 2:
        return work(std::integral_constant<int, 2>());
      case 3:
        return work(std::integral_constant<int, 3>());
      default:
        return work(std::integral_constant<int, Factorization::WidestPanel>());
    }
  }

  /// x = P^T L^-T D^-1 L^-1 P b
  void Substitute(const Values& b, Values& x)
  {
    x.resize(b.rows(), b.cols());
    this->W.resize(b.rows(), b.cols());
    switch (b.cols())
    {
      case 1:
        return this->SubstituteColumns<1>(b, x);
      case 2:
        return this->SubstituteColumns<2>(b, x);
      case 3:
        return this->SubstituteColumns<3>(b, x);
      default:
        return this->SubstituteColumns<0>(b, x);
    }
  }

  /// K columns, or as many as b has where K is 0, in one pass over the factor.
  template <int K>
  void SubstituteColumns(const Values& b, Values& x)
  {
    const int k = K > 0 ? K : static_cast<int>(b.cols());
    const Index n = static_cast<Index>(b.rows());
    const Index* place = this->Factor->LDL->Place;
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
      WithWidth(panels[p + 1] - panels[p],
        [&](auto width) { this->Forward<K, decltype(width)::value>(panels[p], k); });
    }
    for (std::size_t p = panels.size() - 1; p > 0; --p)
    {
      WithWidth(panels[p] - panels[p - 1],
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

  /// W = L^-1 W, its part for the columns j .. j + Width - 1 of L.
  template <int K, int Width>
  void Forward(Index j, int columns)
  {
    const int k = K > 0 ? K : columns;
    const Panel<Width> panel(*this->Factor->LDL, j);
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
    double registers[K > 0 ? Width * K : 1];
    if (K > 0)
    {
      std::copy_n(w, Width * k, registers);
      w = registers;
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

  /// W = L^-T D^-1 W, its rows j .. j + Width - 1, of which D^-1 is applied here.
  template <int K, int Width>
  void Backward(Index j, int columns)
  {
    const int k = K > 0 ? K : columns;
    const Panel<Width> panel(*this->Factor->LDL, j);
    double* result = this->Row(j, k);
    double registers[K > 0 ? Width * K : 1];
    double* w = K > 0 ? registers : result;
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

  /// R = b - A x; largest over the columns of |R| / |b| in the norm of diag(A)^-1.
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
  std::shared_ptr<Factorization> Factor;
  Values R, Correction;
  Values W; ///< in the order of the factor
};

} // namespace

std::unique_ptr<LinearSolver> MakeCholeskySolver(const ParallelFor& parallel)
{
  return std::make_unique<CholeskySolver>(parallel);
}

} // namespace SurfaceDiffusion
