// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Solvers/StrongLines.h"

#include "Core/Foundation/Buffer.h"

#include <algorithm>
#include <array>
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

} // namespace

/// Of each vertex, the neighbours along its line.
struct StrongLines::Links
{
  using Pair = std::array<Index, 2>;

  std::vector<Pair> Of;

  Index Degree(Index i) const { return (this->Of[i][0] != None) + (this->Of[i][1] != None); }
  bool Has(Index i, Index j) const { return this->Of[i][0] == j || this->Of[i][1] == j; }
  /// The neighbour of i that is not `last`, or None.
  Index After(Index i, Index last) const
  {
    return this->Of[i][0] != last ? this->Of[i][0] : this->Of[i][1];
  }

  /// Returns whether there are any.
  bool Find(const SparseMatrix& matrix, const Vector& inverseDiagonal,
    const Reduction& overProcesses, const ParallelFor& parallel);

private:
  /// The two strongest negative entries of a row.
  struct Strongest
  {
    Pair Neighbors = { None, None };
    std::array<double, 2> Sizes = { 0.0, 0.0 };

    Strongest(const SparseMatrix& matrix, Index i);
  };
  struct Named
  {
    Pair Neighbors;
    std::array<float, 2> Strengths; ///< of their entries: of the diagonal
  };

  static bool Names(const Named& vertex, Index neighbor)
  {
    return vertex.Neighbors[0] == neighbor || vertex.Neighbors[1] == neighbor;
  }
};

/// Of equal entries those of the vertices with smaller numbers.
StrongLines::Links::Strongest::Strongest(const SparseMatrix& matrix, Index i)
{
  const Index* const inner = matrix.innerIndexPtr();
  const double* const values = matrix.valuePtr();
  double first = 0.0;
  double second = 0.0;
  Index ofFirst = None;
  Index ofSecond = None;
  for (Index slot = matrix.outerIndexPtr()[i]; slot < matrix.outerIndexPtr()[i + 1]; ++slot)
  {
    const Index j = inner[slot];
    const double entry = -values[slot]; // negative on the diagonal
    const bool isFirst = entry > first;
    const bool isSecond = entry > second;
    ofSecond = isFirst ? ofFirst : (isSecond ? j : ofSecond);
    second = isFirst ? first : (isSecond ? entry : second);
    ofFirst = isFirst ? j : ofFirst;
    first = isFirst ? entry : first;
  }
  this->Neighbors = { ofFirst, ofSecond };
  this->Sizes = { first, second };
}

bool StrongLines::Links::Find(const SparseMatrix& matrix, const Vector& inverseDiagonal,
  const Reduction& overProcesses, const ParallelFor& parallel)
{
  const auto n = static_cast<Index>(matrix.rows());
  const double largest = Max(parallel, n,
    [&](Index i)
    {
      const Strongest strongest(matrix, i);
      return (strongest.Sizes[0] + strongest.Sizes[1]) * inverseDiagonal[i];
    });
  if (!(largest > MinimumShare))
  {
    return false;
  }
  const std::vector<char> isOnInterface = overProcesses.MarkInterfaces(n);
  const auto isInside = [&](Index i) { return isOnInterface.empty() || isOnInterface[i] == 0; };
  Buffer<Named> named(n);
  ForEach(parallel, n,
    [&](Index i)
    {
      const Strongest strongest(matrix, i);
      named[i] = { { None, None }, { 0.0F, 0.0F } };
      const double share = (strongest.Sizes[0] + strongest.Sizes[1]) * inverseDiagonal[i];
      for (int side = 0; side < 2; ++side)
      {
        const Index j = strongest.Neighbors[side];
        if (share < 1.0 - SmallestExcess && j != None && isInside(i) && isInside(j) &&
          strongest.Sizes[side] * std::max(inverseDiagonal[i], inverseDiagonal[j]) >
            MinimumStrength)
        {
          named[i].Neighbors[side] = j;
          named[i].Strengths[side] = static_cast<float>(strongest.Sizes[side] * inverseDiagonal[i]);
        }
      }
    });
  std::vector<char> pays(n); // whether the diagonal alone would be much worse
  ForEach(parallel, n,
    [&](Index i)
    {
      float sum = 0.0F;
      for (int side = 0; side < 2; ++side)
      {
        const Index j = named[i].Neighbors[side];
        sum += j != None && Names(named[j], i) ? named[i].Strengths[side] : 0.0F;
      }
      pays[i] = sum > MinimumShare ? 1 : 0;
    });
  this->Of.resize(n);
  const double any = Max(parallel, n,
    [&](Index i)
    {
      for (int side = 0; side < 2; ++side)
      {
        const Index j = named[i].Neighbors[side];
        const bool isLink = j != None && Names(named[j], i) && (pays[i] != 0 || pays[j] != 0);
        this->Of[i][side] = isLink ? j : None;
      }
      return static_cast<double>(this->Degree(i));
    });
  return any > 0.0;
}

void StrongLines::Clear()
{
  this->Row.clear();
  this->Begin.assign(1, 0);
  this->IsLoop.clear();
  this->Tasks.assign(1, 0);
  this->IsAnywhere = false;
}

void StrongLines::Set(
  const SparseMatrix& matrix, const Vector& inverseDiagonal, const Reduction& overProcesses)
{
  this->Clear();
  Links links;
  const bool hasLines = links.Find(matrix, inverseDiagonal, overProcesses, this->Parallel);
  this->IsAnywhere = overProcesses.Any(hasLines);
  if (!hasLines)
  {
    return;
  }
  try
  {
    this->FindLines(links);
    this->Factorize(matrix, inverseDiagonal);
  }
  catch (...) // an abort
  {
    this->Clear();
    throw;
  }
}

/// In the order of their first vertices, first the lines and then the loops.
void StrongLines::FindLines(const Links& links)
{
  const auto n = static_cast<Index>(links.Of.size());
  std::vector<char> isTaken(n, 0);
  const auto follow = [&](Index first)
  {
    Index last = None;
    for (Index i = first; i != None && !isTaken[i];)
    {
      isTaken[i] = 1;
      this->Row.push_back(i);
      const Index next = links.After(i, last);
      last = i;
      i = next;
    }
    const bool isLoop = this->Row.size() - this->Begin.back() > 2 && links.Has(last, first);
    const bool isLong = this->Row.size() - this->Begin.back() > LongestLine;
    while (this->Row.size() - this->Begin.back() > LongestLine)
    {
      this->Begin.push_back(this->Begin.back() + LongestLine);
      this->IsLoop.push_back(0);
    }
    this->Begin.push_back(this->Row.size());
    this->IsLoop.push_back(isLoop && !isLong ? 1 : 0);
    if (this->Row.size() - this->Begin[this->Tasks.back()] >= TaskSize)
    {
      this->Tasks.push_back(this->IsLoop.size());
    }
  };
  for (const Index degree : { 1, 2 })
  {
    for (Index i = 0; i < n; ++i)
    {
      if (!isTaken[i] && links.Degree(i) == degree)
      {
        follow(i);
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
  for (std::vector<float>* numbers : { &this->Next, &this->InverseD, &this->Last, &this->Shares })
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
