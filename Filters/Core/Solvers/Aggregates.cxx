// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Solvers/Aggregates.h"

#include "Core/Foundation/Grouping.h"
#include "Core/Operators/SparsePattern.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <map>
#include <utility>

namespace SurfaceDiffusion
{

namespace
{

constexpr Index None = Aggregates::None;

/// Per slot of the matrix, whether its entry is strong. Between vertices on interfaces it is about
/// half of the entry of all processes.
Buffer<char> FindStrong(const SparseMatrix& matrix, double strength, const Reduction& overProcesses,
  const std::vector<char>& isOnInterface, const ParallelFor& parallel)
{
  const Vector root = RootsOfDiagonal(matrix, overProcesses, parallel);
  Buffer<char> strong(matrix.nonZeros());
  const Index* outer = matrix.outerIndexPtr();
  const Index* inner = matrix.innerIndexPtr();
  ForEach(parallel, static_cast<Index>(matrix.rows()),
    [&](Index i)
    {
      const bool isInside = isOnInterface.empty() || !isOnInterface[i];
      for (Index slot = outer[i]; slot < outer[i + 1]; ++slot)
      {
        const Index j = inner[slot];
        const double share = isInside || !isOnInterface[j] ? 1.0 : 0.5;
        strong[slot] = j != i && -matrix.valuePtr()[slot] > share * strength * root[i] * root[j];
      }
    });
  return strong;
}

/// Finds the vertices that form aggregates with their neighbours, in the order of the numbering,
/// but first inside of chunks, which do not depend on each other, and then along their borders.
class RootSearch
{
public:
  RootSearch(const SparseMatrix& matrix, const Buffer<char>& strong, const ParallelFor& parallel)
    : Outer(matrix.outerIndexPtr())
    , Inner(matrix.innerIndexPtr())
    , Strong(strong)
    , Roots(matrix.rows(), None)
  {
    const auto n = static_cast<Index>(matrix.rows());
    constexpr Index chunkSize = 8 * BlockSize;
    const Index chunks = (n + chunkSize - 1) / chunkSize;
    std::vector<std::vector<Index>> borders(chunks);
    ForEachTask(parallel, chunks,
      [&](Index chunk)
      {
        const Index begin = chunk * chunkSize;
        const Index end = std::min(n, begin + chunkSize);
        for (Index i = begin; i < end; ++i)
        {
          if (!this->Gather(i, begin, end))
          {
            borders[chunk].push_back(i);
          }
        }
      });
    for (const std::vector<Index>& border : borders)
    {
      for (const Index i : border)
      {
        this->Gather(i, 0, n);
      }
    }
  }

  /// Per vertex, that which gathered it, or None.
  std::vector<Index> Take() { return std::move(this->Roots); }

private:
  /// Make i and its neighbours an aggregate if they are free. False if that depends on a neighbour
  /// outside of begin .. end - 1.
  bool Gather(Index i, Index begin, Index end)
  {
    bool any = false;
    bool isFree = this->Roots[i] == None;
    bool isInside = true;
    for (Index slot = this->Outer[i]; slot < this->Outer[i + 1] && isFree; ++slot)
    {
      if (this->Strong[slot])
      {
        const Index j = this->Inner[slot];
        any = true;
        isInside = isInside && j >= begin && j < end;
        isFree = j < begin || j >= end || this->Roots[j] == None;
      }
    }
    if (!isFree || !any)
    {
      return true;
    }
    if (isInside)
    {
      this->Roots[i] = i;
      for (Index slot = this->Outer[i]; slot < this->Outer[i + 1]; ++slot)
      {
        if (this->Strong[slot])
        {
          this->Roots[this->Inner[slot]] = i;
        }
      }
    }
    return isInside;
  }

  const Index* const Outer;
  const Index* const Inner;
  const Buffer<char>& Strong;
  std::vector<Index> Roots;
};

/// Sets Of and Count.
void Aggregate(const SparseMatrix& matrix, const Buffer<char>& strong, const ParallelFor& parallel,
  Aggregates& result)
{
  const Index n = static_cast<Index>(matrix.rows());
  const Index* outer = matrix.outerIndexPtr();
  const Index* inner = matrix.innerIndexPtr();
  const std::vector<Index> root = RootSearch(matrix, strong, parallel).Take();
  const Buffer<Index> roots = ListWhere(n, parallel, [&](Index i) { return root[i] == i; });
  Buffer<Index> number(n);
  ForEach(parallel, static_cast<Index>(roots.size()), [&](Index k) { number[roots[k]] = k; });
  result.Count = static_cast<Index>(roots.size());
  result.Of.resize(n);
  // A vertex that joins an aggregate here does not bring its own neighbours along.
  ForEach(parallel, n,
    [&](Index i)
    {
      Index joined = root[i];
      double strongest = 0.0;
      for (Index slot = outer[i]; slot < outer[i + 1] && root[i] == None; ++slot)
      {
        if (strong[slot] && root[inner[slot]] != None && -matrix.valuePtr()[slot] > strongest)
        {
          strongest = -matrix.valuePtr()[slot];
          joined = root[inner[slot]];
        }
      }
      result.Of[i] = joined == None ? None : number[joined];
    });
}

/// Aggregates of vertices that the same processes have. Their owner forms them along the
/// interfaces.
class InterfaceAggregation
{
public:
  InterfaceAggregation(
    const SparseMatrix& matrix, const Buffer<char>& strong, const Reduction& overProcesses)
    : Matrix(matrix)
    , Strong(strong)
    , OverProcesses(overProcesses)
    , Vertices(overProcesses.InterfaceVertices())
    , Numbers(matrix.rows(), None)
    , Of(this->Vertices.size(), None)
  {
    for (std::size_t k = 0; k < this->Vertices.size(); ++k)
    {
      this->Numbers[this->Vertices[k]] = static_cast<Index>(k);
    }
  }

  /// Append them to those of the vertices inside.
  void AppendTo(Aggregates& aggregates)
  {
    // Vertices without strong entries in any process are left out.
    const auto count = static_cast<Index>(this->Vertices.size());
    std::vector<double> isConnected(count);
    for (Index k = 0; k < count; ++k)
    {
      const Index* const outer = this->Matrix.outerIndexPtr() + this->Vertices[k];
      isConnected[k] = std::any_of(this->Strong.begin() + outer[0], this->Strong.begin() + outer[1],
        [](char strong) { return strong != 0; });
    }
    this->OverProcesses.AccumulateInterface(isConnected.data(), 1);

    this->FormOwn();
    std::vector<double> own(this->Of.begin(), this->Of.end());
    this->OverProcesses.UpdateInterface(own.data(), 1);
    std::map<std::pair<Index, double>, Index> numbers;
    for (Index k = 0; k < count; ++k)
    {
      if (isConnected[k] > 0.0)
      {
        const std::pair<Index, double> key(this->OverProcesses.InterfaceHolders()[k], own[k]);
        const auto inserted = numbers.emplace(key, aggregates.Count);
        aggregates.Count += inserted.second ? 1 : 0;
        aggregates.Of[this->Vertices[k]] = inserted.first->second;
      }
    }
  }

private:
  /// Of the vertices that this process owns.
  void FormOwn()
  {
    const auto count = static_cast<Index>(this->Vertices.size());
    Index number = 0;
    for (Index k = 0; k < count; ++k)
    {
      bool isFree = this->IsOwn(k) && this->Of[k] == None;
      this->ForNeighbors(k, [&](Index m, double) { isFree = isFree && this->Of[m] == None; });
      if (isFree)
      {
        this->Of[k] = number;
        this->ForNeighbors(k, [&](Index m, double) { this->Of[m] = number; });
        ++number;
      }
    }
    const std::vector<Index> formed = this->Of;
    for (Index k = 0; k < count; ++k)
    {
      if (this->IsOwn(k) && formed[k] == None)
      {
        double strongest = 0.0;
        this->ForNeighbors(k,
          [&](Index m, double entry)
          {
            if (formed[m] != None && entry > strongest)
            {
              strongest = entry;
              this->Of[k] = formed[m];
            }
          });
      }
    }
  }

  bool IsOwn(Index k) const { return this->OverProcesses.Owns(this->Vertices[k]); }

  /// visit(m, -a_km) for those neighbours on interfaces that the same processes have.
  template <typename Visit>
  void ForNeighbors(Index k, const Visit& visit) const
  {
    const std::vector<Index>& holders = this->OverProcesses.InterfaceHolders();
    const Index i = this->Vertices[k];
    for (Index slot = this->Matrix.outerIndexPtr()[i]; slot < this->Matrix.outerIndexPtr()[i + 1];
         ++slot)
    {
      const Index m = this->Numbers[this->Matrix.innerIndexPtr()[slot]];
      if (this->Strong[slot] && m != None && holders[m] == holders[k])
      {
        visit(m, -this->Matrix.valuePtr()[slot]);
      }
    }
  }

  const SparseMatrix& Matrix;
  const Buffer<char>& Strong;
  const Reduction& OverProcesses;
  const std::vector<Index>& Vertices;
  std::vector<Index> Numbers; ///< on the interfaces, per vertex, or None
  std::vector<Index> Of; ///< per vertex on an interface
};

} // namespace

Vector RootsOfDiagonal(
  const SparseMatrix& matrix, const Reduction& overProcesses, const ParallelFor& parallel)
{
  Vector roots(matrix.rows());
  const auto n = static_cast<Index>(matrix.rows());
  ForEach(parallel, n, [&](Index i) { roots[i] = DiagonalEntry(matrix, i); });
  overProcesses.Accumulate(roots);
  ForEach(parallel, n, [&](Index i) { roots[i] = std::sqrt(roots[i]); });
  return roots;
}

Aggregates::Aggregates(const SparseMatrix& matrix, double strength, const Reduction& overProcesses,
  const ParallelFor& parallel)
  : IsOnInterface(overProcesses.MarkInterfaces(static_cast<Index>(matrix.rows())))
  , Strong(FindStrong(matrix, strength, overProcesses, this->IsOnInterface, parallel))
{
  if (overProcesses.IsSerial())
  {
    Aggregate(matrix, this->Strong, parallel, *this);
    return;
  }
  const auto n = static_cast<Index>(matrix.rows());
  Buffer<char> inside(
    matrix.nonZeros()); // the strong entries between vertices of this process alone
  std::vector<char> isConnected(n, false);
  ForEach(parallel, n,
    [&](Index i)
    {
      for (Index slot = matrix.outerIndexPtr()[i]; slot < matrix.outerIndexPtr()[i + 1]; ++slot)
      {
        const bool isInside =
          !this->IsOnInterface[i] && !this->IsOnInterface[matrix.innerIndexPtr()[slot]];
        inside[slot] = this->Strong[slot] && isInside;
        isConnected[i] = isConnected[i] || this->Strong[slot];
      }
    });
  Aggregate(matrix, inside, parallel, *this);
  for (Index i = 0; i < n; ++i)
  {
    if (this->Of[i] == None && isConnected[i] && !this->IsOnInterface[i])
    {
      this->Of[i] = this->Count++; // all its neighbours are on interfaces
    }
  }
  InterfaceAggregation(matrix, this->Strong, overProcesses).AppendTo(*this);
}

} // namespace SurfaceDiffusion
