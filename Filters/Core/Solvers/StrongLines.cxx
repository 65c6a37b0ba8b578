// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Solvers/StrongLines.h"

#include <algorithm>
#include <cmath>

namespace SurfaceDiffusion
{

void StrongLines::Clear()
{
  this->Row.clear();
  this->Begin.assign(1, 0);
  this->IsLoop.clear();
  this->Tasks.assign(1, 0);
  this->IsAnywhere = false;
}

/// Room for n vertices on lines. Pages that are not used take no memory.
void StrongLines::Reserve(std::size_t n)
{
  if (this->Row.capacity() >= n)
  {
    return;
  }
  this->Begin.reserve(n / 2 + 2);
  this->IsLoop.reserve(n / 2 + 1);
  this->Tasks.reserve(n / TaskSize + 2);
  this->Sums.reserve(n / TaskSize + 2);
  for (std::vector<float>* numbers : { &this->InverseD, &this->Next, &this->Last, &this->Shares })
  {
    numbers->reserve(n);
  }
  this->Named.reserve(n);
  this->Pays.reserve(n);
  this->IsTaken.reserve(n);
  this->Row.reserve(n);
}

void StrongLines::Set(
  const SparseMatrix& matrix, const Vector& inverseDiagonal, const Reduction& overProcesses)
{
  this->Clear();
  this->Reserve(static_cast<std::size_t>(matrix.rows()));
  if (this->MayHaveLines(matrix, inverseDiagonal))
  {
    try
    {
      this->NameNeighbors(matrix, inverseDiagonal, overProcesses);
      this->FindLines(static_cast<Index>(matrix.rows()));
      this->Factorize(matrix, inverseDiagonal);
    }
    catch (...) // an abort
    {
      this->Clear();
      throw;
    }
  }
  this->IsAnywhere = overProcesses.Any(!this->IsEmpty());
}

template <typename Act>
void StrongLines::ForEachLine(const Act& act) const
{
  ForEachTask(this->Parallel, static_cast<Index>(this->Tasks.size()) - 1,
    [&](Index task)
    {
      for (std::size_t line = this->Tasks[task]; line < this->Tasks[task + 1]; ++line)
      {
        act(line);
      }
    });
}

void StrongLines::Factorize(const SparseMatrix& matrix, const Vector& inverseDiagonal)
{
  for (std::vector<float>* numbers : { &this->InverseD, &this->Next, &this->Last, &this->Shares })
  {
    numbers->resize(this->Row.size());
  }
  this->Sums.resize(this->Tasks.size());
  this->ForEachLine([&](std::size_t line) { this->FactorizeLine(matrix, inverseDiagonal, line); });
}

/// A row of M.
struct StrongLines::LineRow
{
  double Previous = 0.0, Next = 0.0; ///< minus its entries along the line
  double Excess = 0.0; ///< of its diagonal entry over these

  /// previous, next: the neighbours along the line, or None.
  LineRow(const SparseMatrix& matrix, Index i, Index previous, Index next)
  {
    double sum = 0.0;
    double diagonal = 0.0;
    for (SparseMatrix::InnerIterator a(matrix, i); a; ++a)
    {
      const Index j = a.index();
      sum += a.value();
      if (j == previous || j == next)
      {
        (j == next ? this->Next : this->Previous) = -a.value();
      }
      else if (j == i)
      {
        diagonal = a.value();
      }
      else
      {
        this->Excess += std::max(-a.value(), 0.0);
      }
    }
    this->Excess = std::max(this->Excess + std::max(sum, 0.0), SmallestExcess * diagonal);
  }
};

/// From positive numbers by sums only, which lose no digit where the entries along the line are
/// nearly the whole diagonal (W. Grassmann, M. Taksar, D. Heyman, Oper. Res. 33, 1985). Of a loop
/// the last vertex is eliminated last, and has entries in all columns of L.
void StrongLines::FactorizeLine(
  const SparseMatrix& matrix, const Vector& inverseDiagonal, std::size_t line)
{
  const std::size_t begin = this->Begin[line];
  const std::size_t last = this->Begin[line + 1] - 1;
  const Index around = this->IsLoop[line] != 0 ? 0 : None;
  const auto scale = [&](std::size_t k) { return std::sqrt(inverseDiagonal[this->Row[k]]); };
  const double scaleOfLast = scale(last);
  double scaleOfNext = scale(begin);
  double excess = 0.0; // what eliminated vertices add to that of the next, and of the last one
  double excessOfLast = 0.0;
  double fill = 0.0; // minus the entry of the present column in the last row
  for (std::size_t k = begin; k <= last; ++k)
  {
    const Index i = this->Row[k];
    const Index before = k > begin ? this->Row[k - 1] : (around == None ? None : this->Row[last]);
    const Index after = k < last ? this->Row[k + 1] : (around == None ? None : this->Row[begin]);
    const LineRow row(matrix, i, before, after);
    this->Shares[k] = static_cast<float>((row.Previous + row.Next) * inverseDiagonal[i]);
    excess += row.Excess;
    const bool isLast = k == last;
    double next = isLast ? 0.0 : row.Next;
    if (k == begin && !isLast)
    {
      fill = row.Previous;
    }
    if (k + 1 == last && around != None)
    {
      fill += next;
      next = 0.0;
    }
    const double pivot = isLast ? excess + excessOfLast : excess + next + fill;
    const double ofNext = next / pivot;
    const double ofLast = isLast ? 0.0 : fill / pivot;
    const double scaleOfThis = scaleOfNext;
    scaleOfNext = isLast ? 1.0 : scale(k + 1);
    this->InverseD[k] = static_cast<float>(1.0 / (pivot * inverseDiagonal[i]));
    this->Next[k] = static_cast<float>(ofNext * scaleOfNext / scaleOfThis);
    this->Last[k] = static_cast<float>(ofLast * scaleOfLast / scaleOfThis);
    excessOfLast += ofLast * excess;
    fill *= ofNext;
    excess *= ofNext;
  }
}

/// x = (L D L^T)^-1 x, of the vertices on the line
template <typename Number>
void StrongLines::SolveLine(std::size_t line, Number* x) const
{
  const std::size_t begin = this->Begin[line];
  const std::size_t last = this->Begin[line + 1] - 1 - begin;
  const float* const next = this->Next.data() + begin;
  const float* const inverse = this->InverseD.data() + begin;
  if (this->IsLoop[line] == 0)
  {
    for (std::size_t k = 0; k < last; ++k)
    {
      x[k + 1] += next[k] * x[k];
    }
    x[last] *= inverse[last];
    for (std::size_t k = last; k-- > 0;)
    {
      x[k] = inverse[k] * x[k] + next[k] * x[k + 1];
    }
    return;
  }
  const float* const toLast = this->Last.data() + begin;
  Number ofLast = x[last];
  for (std::size_t k = 0; k < last; ++k)
  {
    ofLast += toLast[k] * x[k];
    x[k + 1] += next[k] * x[k];
  }
  x[last] = inverse[last] * ofLast;
  for (std::size_t k = last; k-- > 0;)
  {
    x[k] = inverse[k] * x[k] + toLast[k] * x[last] + next[k] * x[k + 1];
  }
}

double StrongLines::Correct(const std::vector<Index>& rows, const float* r, float* c)
{
  ForEachTask(this->Parallel, static_cast<Index>(this->Tasks.size()) - 1,
    [&](Index task)
    {
      double sum = 0.0;
      for (std::size_t line = this->Tasks[task]; line < this->Tasks[task + 1]; ++line)
      {
        const std::size_t begin = this->Begin[line];
        const std::size_t end = this->Begin[line + 1];
        for (std::size_t k = begin; k < end; ++k)
        {
          c[k] = r[rows[k]];
        }
        this->SolveLine(line, c + begin);
        for (std::size_t k = begin; k < end; ++k)
        {
          const float entry = r[rows[k]];
          c[k] -= entry;
          sum += static_cast<double>(entry) * c[k];
        }
      }
      this->Sums[task] = sum;
    });
  double sum = 0.0;
  for (std::size_t task = 0; task + 1 < this->Tasks.size(); ++task)
  {
    sum += this->Sums[task];
  }
  return sum;
}

void StrongLines::Precondition(const Vector& inverseDiagonal, const Values& r, Values& z) const
{
  ForEach(this->Parallel, static_cast<Index>(r.rows()),
    [&](Index i) { z.row(i) = inverseDiagonal[i] * r.row(i); });
  this->ForEachLine(
    [&](std::size_t line)
    {
      const std::size_t begin = this->Begin[line];
      const std::size_t end = this->Begin[line + 1];
      double x[LongestLine];
      for (Eigen::Index column = 0; column < r.cols(); ++column)
      {
        for (std::size_t k = begin; k < end; ++k)
        {
          const Index i = this->Row[k];
          x[k - begin] = std::sqrt(inverseDiagonal[i]) * r(i, column);
        }
        this->SolveLine(line, x);
        for (std::size_t k = begin; k < end; ++k)
        {
          const Index i = this->Row[k];
          z(i, column) = std::sqrt(inverseDiagonal[i]) * x[k - begin];
        }
      }
    });
}

} // namespace SurfaceDiffusion
