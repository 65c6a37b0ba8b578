// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Solvers/StrongLines.h"

#include <algorithm>

namespace SurfaceDiffusion
{

namespace
{

constexpr Index None = -1;
// Of entries that stand out to others; no ratio that regular meshes have.
constexpr double ClearRatio = 1.37;

} // namespace

/// The two strongest negative entries of a row, and the third.
struct StrongLines::StrongestEntries
{
  Pair Columns = { None, None };
  double First = 0.0, Second = 0.0, Third = 0.0;
  double Positive = 0.0; ///< the sum of the positive ones, with the diagonal

  StrongestEntries(const SparseMatrix& matrix, Index i);

  double Size(int number) const { return number == 0 ? this->First : this->Second; }
  /// How many stand out from the others: which of equal ones came first would depend on the
  /// numbering of the vertices.
  int NumberOfDistinct() const
  {
    if (this->Second > ClearRatio * this->Third)
    {
      return 2;
    }
    return this->First > ClearRatio * this->Second ? 1 : 0;
  }
};

StrongLines::StrongestEntries::StrongestEntries(const SparseMatrix& matrix, Index i)
{
  const Index* const inner = matrix.innerIndexPtr();
  const double* const values = matrix.valuePtr();
  double first = 0.0;
  double second = 0.0;
  double third = 0.0;
  double positive = 0.0;
  Index ofFirst = None;
  Index ofSecond = None;
  for (Index slot = matrix.outerIndexPtr()[i]; slot < matrix.outerIndexPtr()[i + 1]; ++slot)
  {
    const Index j = inner[slot];
    const double entry = -values[slot]; // negative on the diagonal
    positive += std::max(-entry, 0.0);
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
  this->Positive = positive;
}

/// False if no row has strong entries enough, as on even meshes.
bool StrongLines::MayHaveLines(const SparseMatrix& matrix, const Vector& inverseDiagonal) const
{
  const double largest = Max(this->Parallel, static_cast<Index>(matrix.rows()),
    [&](Index i)
    {
      const StrongestEntries strongest(matrix, i);
      return (strongest.First + strongest.Second) * inverseDiagonal[i];
    });
  return largest > MinimumShare;
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
      // Positive entries above the diagonal would make M another matrix than A.
      const bool isLikeM = strongest.Positive * inverseDiagonal[i] <= 2.0;
      if (!(share < 1.0 - SmallestExcess) || !isLikeM || !isInside(i))
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

} // namespace SurfaceDiffusion
