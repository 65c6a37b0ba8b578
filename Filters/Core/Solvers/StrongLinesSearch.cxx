// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Solvers/StrongLines.h"

#include <algorithm>

namespace SurfaceDiffusion
{

namespace
{

// Of entries that stand out to others; no ratio that regular meshes have.
constexpr double ClearRatio = 1.37;

} // namespace

/// The three strongest negative entries of a row, or zeros.
struct StrongLines::StrongestEntries
{
  double First = 0.0, Second = 0.0, Third = 0.0;
  double Positive = 0.0; ///< the sum of the positive ones, with the diagonal

  /// Without branches, since the order of the entries is that of chance.
  StrongestEntries(const SparseMatrix& matrix, Index i)
  {
    const double* const values = matrix.valuePtr();
    const Index* const outer = matrix.outerIndexPtr();
    for (Index slot = outer[i]; slot < outer[i + 1]; ++slot)
    {
      const double a = values[slot];
      const double entry = std::max(0.0, -a); // 0 if a is not a number
      const double behindFirst = std::min(this->First, entry);
      const double behindSecond = std::min(this->Second, behindFirst);
      this->First = std::max(this->First, entry);
      this->Second = std::max(this->Second, behindFirst);
      this->Third = std::max(this->Third, behindSecond);
      this->Positive += std::max(a, 0.0);
    }
  }

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
  Pair FindColumns(const SparseMatrix& matrix, Index i) const
  {
    const double* const values = matrix.valuePtr();
    const Index* const outer = matrix.outerIndexPtr();
    Pair columns = { None, None };
    for (Index slot = outer[i]; slot < outer[i + 1]; ++slot)
    {
      const double entry = -values[slot];
      if (entry >= this->Second && entry > 0.0)
      {
        const bool isFirst = entry == this->First && columns[0] == None;
        columns[isFirst ? 0 : 1] = matrix.innerIndexPtr()[slot];
      }
    }
    return columns;
  }
};

/// Mark the vertices whose two strongest entries are enough. False if there are none, as on even
/// meshes.
bool StrongLines::MayHaveLines(const SparseMatrix& matrix, const Vector& inverseDiagonal)
{
  const auto n = static_cast<Index>(matrix.rows());
  this->Pays.resize(n);
  const double largest = Max(this->Parallel, n,
    [&](Index i)
    {
      const StrongestEntries strongest(matrix, i);
      const double share = (strongest.First + strongest.Second) * inverseDiagonal[i];
      this->Pays[i] = share > MinimumShare ? 1 : 0;
      return share;
    });
  return largest > MinimumShare;
}

/// Whether a line may pass through vertex i, by the marks of MayHaveLines().
bool StrongLines::MayBeOnLine(const SparseMatrix& matrix, Index i) const
{
  char pays = 0;
  for (SparseMatrix::InnerIterator a(matrix, i); a; ++a)
  {
    pays |= this->Pays[a.index()];
  }
  return pays != 0;
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
      this->Named[i] = { None, None };
      if (!this->MayBeOnLine(matrix, i))
      {
        return;
      }
      const StrongestEntries strongest(matrix, i);
      const double share = (strongest.First + strongest.Second) * inverseDiagonal[i];
      // Positive entries above the diagonal would make M another matrix than A.
      const bool isLikeM = strongest.Positive * inverseDiagonal[i] <= 2.0;
      if (!(share < 1.0 - SmallestExcess) || !isLikeM || !isInside(i))
      {
        return;
      }
      const Pair columns = strongest.FindColumns(matrix, i);
      for (int k = 0; k < strongest.NumberOfDistinct(); ++k)
      {
        const Index j = columns[k];
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
