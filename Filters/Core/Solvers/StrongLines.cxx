// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Solvers/StrongLines.h"

#include <algorithm>
#include <cmath>

namespace SurfaceDiffusion
{

namespace
{

constexpr Index None = -1;
constexpr std::size_t LongestLine = 4096; // longer ones are cut, for the sake of threads
constexpr std::size_t TaskSize = 8192; // vertices of a task, at least
/// Of the diagonal: what is left of it without the two strongest entries. Where it is less, round-off
/// of single precision would be taken for the mean of a needle's ends.
constexpr double SmallestExcess = 1e-6;
constexpr double ClearRatio =
  1.37; // of entries that stand out to others; no ratio of regular meshes

} // namespace

/// The two strongest negative entries of a row, and the third.
struct StrongLines::StrongestEntries
{
  Pair Columns = { None, None };
  double First = 0.0, Second = 0.0, Third = 0.0;

  StrongestEntries(const SparseMatrix& matrix, Index i);

  double Size(int number) const { return number == 0 ? this->First : this->Second; }
  /// How many stand out from the others: which of equal ones came first would depend on the
  /// numbering of the vertices.
  int NumberOfDistinct() const
  {
    return this->Second > ClearRatio * this->Third
      ? 2
      : (this->First > ClearRatio * this->Second ? 1 : 0);
  }
};

StrongLines::StrongestEntries::StrongestEntries(const SparseMatrix& matrix, Index i)
{
  const Index* const inner = matrix.innerIndexPtr();
  const double* const values = matrix.valuePtr();
  double first = 0.0;
  double second = 0.0;
  double third = 0.0;
  Index ofFirst = None;
  Index ofSecond = None;
  for (Index slot = matrix.outerIndexPtr()[i]; slot < matrix.outerIndexPtr()[i + 1]; ++slot)
  {
    const Index j = inner[slot];
    const double entry = -values[slot]; // negative on the diagonal
    const bool isFirst = entry > first;
    const bool isSecond = entry > second;
    third = isSecond ? second : std::max(third, entry);
    ofSecond = isFirst ? ofFirst : (isSecond ? j : ofSecond);
    second = isFirst ? first : (isSecond ? entry : second);
    ofFirst = isFirst ? j : ofFirst;
    first = isFirst ? entry : first;
  }
  this->Columns = { ofFirst, ofSecond };
  this->First = first;
  this->Second = second;
  this->Third = third;
}

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
  const double largest = Max(this->Parallel, static_cast<Index>(matrix.rows()),
    [&](Index i)
    {
      const StrongestEntries strongest(matrix, i);
      return (strongest.First + strongest.Second) * inverseDiagonal[i];
    });
  if (largest > MinimumShare)
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

void StrongLines::NameNeighbors(
  const SparseMatrix& matrix, const Vector& inverseDiagonal, const Reduction& overProcesses)
{
  const auto n = static_cast<Index>(matrix.rows());
  const std::vector<char> isOnInterface = overProcesses.MarkInterfaces(n);
  const auto isInside = [&](Index i) { return isOnInterface.empty() || isOnInterface[i] == 0; };
  this->Named.resize(n);
  ForEach(this->Parallel, n,
    [&](Index i)
    {
      const StrongestEntries strongest(matrix, i);
      this->Named[i] = { None, None };
      const double share = (strongest.First + strongest.Second) * inverseDiagonal[i];
      if (!(share < 1.0 - SmallestExcess) || !isInside(i))
      {
        return;
      }
      for (int k = 0; k < strongest.NumberOfDistinct(); ++k)
      {
        const Index j = strongest.Columns[k];
        if (j != None && isInside(j) &&
          strongest.Size(k) * std::max(inverseDiagonal[i], inverseDiagonal[j]) > MinimumStrength)
        {
          this->Named[i][k] = j;
        }
      }
    });
  this->Pays.resize(n);
  ForEach(this->Parallel, n,
    [&](Index i)
    {
      this->Pays[i] = 0;
      if (this->AreMutual(i, 0) || this->AreMutual(i, 1))
      {
        const StrongestEntries strongest(matrix, i);
        const double sum = (this->AreMutual(i, 0) ? strongest.First : 0.0) +
          (this->AreMutual(i, 1) ? strongest.Second : 0.0);
        this->Pays[i] = sum * inverseDiagonal[i] > MinimumShare ? 1 : 0;
      }
    });
}

bool StrongLines::AreMutual(Index i, int side) const
{
  const Index j = this->Named[i][side];
  return j != None && (this->Named[j][0] == i || this->Named[j][1] == i);
}

/// The neighbours of vertex i along its line, or None.
StrongLines::Pair StrongLines::Neighbors(Index i) const
{
  Pair neighbors = { None, None };
  for (int side = 0; side < 2; ++side)
  {
    const Index j = this->Named[i][side];
    if (this->AreMutual(i, side) && (this->Pays[i] != 0 || this->Pays[j] != 0))
    {
      neighbors[side] = j;
    }
  }
  return neighbors;
}

/// In the order of their first vertices, first the lines and then the loops.
void StrongLines::FindLines(Index n)
{
  this->IsTaken.assign(n, 0);
  const auto follow = [&](Index first)
  {
    Index last = None;
    for (Index i = first; i != None && this->IsTaken[i] == 0;)
    {
      this->IsTaken[i] = 1;
      this->Row.push_back(i);
      const Pair neighbors = this->Neighbors(i);
      const Index next = neighbors[0] != last ? neighbors[0] : neighbors[1];
      last = i;
      i = next;
    }
    const Pair ofLast = this->Neighbors(last);
    const std::size_t length = this->Row.size() - this->Begin.back();
    const bool isLoop =
      length > 2 && length <= LongestLine && (ofLast[0] == first || ofLast[1] == first);
    while (this->Row.size() - this->Begin.back() > LongestLine)
    {
      this->Begin.push_back(this->Begin.back() + LongestLine);
      this->IsLoop.push_back(0);
    }
    this->Begin.push_back(this->Row.size());
    this->IsLoop.push_back(isLoop ? 1 : 0);
    if (this->Row.size() - this->Begin[this->Tasks.back()] >= TaskSize)
    {
      this->Tasks.push_back(this->IsLoop.size());
    }
  };
  for (const int degree : { 1, 2 })
  {
    for (Index i = 0; i < n; ++i)
    {
      if (this->IsTaken[i] == 0 && this->Named[i] != Pair{ None, None })
      {
        const Pair neighbors = this->Neighbors(i);
        if ((neighbors[0] != None) + (neighbors[1] != None) == degree)
        {
          follow(i);
        }
      }
    }
  }
  if (this->Tasks.back() != this->IsLoop.size())
  {
    this->Tasks.push_back(this->IsLoop.size());
  }
}

template <typename Act>
void StrongLines::ForTasks(const Act& act) const
{
  ForEachTask(this->Parallel, static_cast<Index>(this->Tasks.size()) - 1,
    [&](Index task)
    {
      for (std::size_t line = this->Tasks[task]; line < this->Tasks[task + 1]; ++line)
      {
        act(task, line);
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
  this->ForTasks(
    [&](Index, std::size_t line) { this->FactorizeLine(matrix, inverseDiagonal, line); });
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
  this->ForTasks(
    [&](Index, std::size_t line)
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
