// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Solvers/Aggregation.h"

#include "Core/Foundation/Grouping.h"
#include "Core/Operators/SparsePattern.h"
#include "Core/Solvers/SparseColumns.h"

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

namespace SurfaceDiffusion
{

namespace
{

constexpr Index None = -1;

/// 4/3 over the largest eigenvalue of D^-1 A, which is 3/2 on a regular triangulation.
constexpr double Omega = 8.0 / 9.0;

/// Per slot of the matrix, whether its entry is strong.
Buffer<char> FindStrong(const SparseMatrix& matrix, double strength, const ParallelFor& parallel)
{
  Vector root(matrix.rows());
  ForEach(parallel, static_cast<Index>(matrix.rows()),
    [&](Index i) { root[i] = std::sqrt(DiagonalEntry(matrix, i)); });
  Buffer<char> strong(matrix.nonZeros());
  const Index* outer = matrix.outerIndexPtr();
  const Index* inner = matrix.innerIndexPtr();
  ForEach(parallel, static_cast<Index>(matrix.rows()),
    [&](Index i)
    {
      for (Index slot = outer[i]; slot < outer[i + 1]; ++slot)
      {
        const Index j = inner[slot];
        strong[slot] = j != i && -matrix.valuePtr()[slot] > strength * root[i] * root[j];
      }
    });
  return strong;
}

struct Aggregates
{
  std::vector<Index> Of; ///< per vertex, or None
  Index Count = 0;
};

/// Finds the vertices that form aggregates with their neighbours, in the order of the numbering, but
/// first inside of chunks, which do not depend on each other, and then along their borders.
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

Aggregates Aggregate(
  const SparseMatrix& matrix, const Buffer<char>& strong, const ParallelFor& parallel)
{
  const Index n = static_cast<Index>(matrix.rows());
  const Index* outer = matrix.outerIndexPtr();
  const Index* inner = matrix.innerIndexPtr();
  const std::vector<Index> root = RootSearch(matrix, strong, parallel).Take();
  const Buffer<Index> roots = ListWhere(n, parallel, [&](Index i) { return root[i] == i; });
  Buffer<Index> number(n);
  ForEach(parallel, static_cast<Index>(roots.size()), [&](Index k) { number[roots[k]] = k; });
  Aggregates result;
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
  return result;
}

/// Of every aggregate, the norm of the kernel on it.
Vector CoarseKernel(const std::vector<Index>& of, Index count, const Vector& kernel)
{
  Vector coarse = Vector::Zero(count);
  for (Index i = 0; i < static_cast<Index>(kernel.size()); ++i)
  {
    if (of[i] != None)
    {
      coarse[of[i]] += kernel[i] * kernel[i];
    }
  }
  return coarse.cwiseSqrt();
}

/// What CollectColumns() calls for column i of the restriction.
auto RestrictionColumn(const SparseMatrix& matrix, const Buffer<char>& strong,
  const std::vector<Index>& of, const Vector& kernel, const Vector& coarse)
{
  return [&](Index i, auto& column)
  {
    if (of[i] == None)
    {
      return;
    }
    const Index* inner = matrix.innerIndexPtr();
    const double* a = matrix.valuePtr();
    const Index begin = matrix.outerIndexPtr()[i];
    const Index end = matrix.outerIndexPtr()[i + 1];
    const auto tentative = [&](Index j) { return kernel[j] / coarse[of[j]]; };
    double diagonal = 0.0;
    for (Index slot = begin; slot < end; ++slot)
    {
      diagonal += strong[slot] ? 0.0 : a[slot] * kernel[inner[slot]] / kernel[i];
    }
    column.Add(of[i], (1.0 - Omega) * tentative(i));
    for (Index slot = begin; slot < end; ++slot)
    {
      if (strong[slot])
      {
        column.Add(of[inner[slot]], -Omega * a[slot] / diagonal * tentative(inner[slot]));
      }
    }
  };
}

// Two products with short columns are faster than one with long columns: in a short column a row is
// found by comparing with all of them (IndexSet).

/// Column i of `rows` matrix.
auto ProductColumn(const SparseMatrix& rows, const SparseMatrix& matrix)
{
  return [&](Index i, auto& column)
  {
    for (SparseMatrix::InnerIterator a(matrix, i); a; ++a)
    {
      for (SparseMatrix::InnerIterator r(rows, a.index()); r; ++r)
      {
        column.Add(r.index(), a.value() * r.value());
      }
    }
  };
}

} // namespace

SparseMatrix SmoothedAggregation(
  const SparseMatrix& matrix, double strength, Vector& kernel, const ParallelFor& parallel)
{
  const Buffer<char> strong = FindStrong(matrix, strength, parallel);
  const Aggregates aggregates = Aggregate(matrix, strong, parallel);
  Vector coarse = CoarseKernel(aggregates.Of, aggregates.Count, kernel);
  SparseMatrix restriction = CollectColumns(aggregates.Count, static_cast<Index>(matrix.rows()),
    parallel, RestrictionColumn(matrix, strong, aggregates.Of, kernel, coarse));
  kernel = std::move(coarse);
  return restriction;
}

SparseMatrix Transposed(
  const SparseMatrix& matrix, const ParallelFor& parallel, Buffer<Index>* slots)
{
  const auto columns = static_cast<Index>(matrix.cols());
  const Index* const outer = matrix.outerIndexPtr();
  Buffer<Index> columnOf(matrix.nonZeros());
  ForEach(parallel, columns,
    [&](Index j) { std::fill(columnOf.begin() + outer[j], columnOf.begin() + outer[j + 1], j); });
  Groups rows = GroupByKey(static_cast<Index>(matrix.nonZeros()), static_cast<Index>(matrix.rows()),
    parallel, [&](Index slot) { return matrix.innerIndexPtr()[slot]; });
  SparseMatrix transposed(matrix.cols(), matrix.rows());
  std::copy(rows.Begin.begin(), rows.Begin.end(), transposed.outerIndexPtr());
  transposed.resizeNonZeros(matrix.nonZeros());
  ForEach(parallel, static_cast<Index>(matrix.nonZeros()),
    [&](Index k)
    {
      transposed.innerIndexPtr()[k] = columnOf[rows.Items[k]];
      transposed.valuePtr()[k] = matrix.valuePtr()[rows.Items[k]];
    });
  if (slots)
  {
    *slots = std::move(rows.Items);
  }
  return transposed;
}

SparseMatrix GalerkinProduct(const SparseMatrix& matrix, const SparseMatrix& restriction,
  const SparseMatrix& prolongation, const ParallelFor& parallel)
{
  const Index coarse = static_cast<Index>(restriction.rows());
  const SparseMatrix half = CollectColumns(
    coarse, static_cast<Index>(matrix.rows()), parallel, ProductColumn(restriction, matrix));
  return CollectColumns(coarse, coarse, parallel, ProductColumn(half, prolongation));
}

Coarsening::Coarsening(const SparseMatrix& matrix, double strength, const ParallelFor& parallel)
  : Parallel(parallel)
  , Strong(FindStrong(matrix, strength, parallel))
{
  Aggregates aggregates = Aggregate(matrix, this->Strong, parallel);
  this->Of = std::move(aggregates.Of);
  this->Count = aggregates.Count;
}

template <typename Collect>
void Coarsening::Collected::Set(
  Index rows, Index columns, const ParallelFor& parallel, const Collect& collect)
{
  if (this->Places.empty())
  {
    SparseMatrix matrix =
      CollectColumns<NotedColumn>(rows, columns, parallel, collect, this->Places);
    this->Matrix.swap(matrix); // not moved: Eigen 3.4 would copy it
    return;
  }
  CollectAgain(this->Matrix, this->Places, parallel, collect);
}

void Coarsening::SetMatrix(const SparseMatrix& matrix, Vector& kernel)
{
  const auto rows = static_cast<Index>(matrix.rows());
  Vector coarse = CoarseKernel(this->Of, this->Count, kernel);
  this->Restricting.Set(this->Count, rows, this->Parallel,
    RestrictionColumn(matrix, this->Strong, this->Of, kernel, coarse));
  kernel = std::move(coarse);
  this->Transpose();
  this->Half.Set(
    this->Count, rows, this->Parallel, ProductColumn(this->Restricting.Matrix, matrix));
  this->Coarse.Set(
    this->Count, this->Count, this->Parallel, ProductColumn(this->Half.Matrix, this->Prolonging));
}

void Coarsening::Transpose()
{
  const SparseMatrix& restriction = this->Restricting.Matrix;
  if (this->Slots.size() == 0)
  {
    SparseMatrix transposed = Transposed(restriction, this->Parallel, &this->Slots);
    this->Prolonging.swap(transposed);
    return;
  }
  ForEach(this->Parallel, static_cast<Index>(this->Slots.size()),
    [&](Index slot)
    { this->Prolonging.valuePtr()[slot] = restriction.valuePtr()[this->Slots[slot]]; });
}

} // namespace SurfaceDiffusion
