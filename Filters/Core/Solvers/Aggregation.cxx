// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Solvers/Aggregation.h"

#include "Core/Solvers/SparseColumns.h"

#include <algorithm>
#include <cmath>
#include <vector>

namespace SurfaceDiffusion
{

namespace
{

constexpr Index None = -1;

/// 4/3 over the largest eigenvalue of D^-1 A, which is 3/2 on a regular triangulation.
constexpr double Omega = 8.0 / 9.0;

/// Per slot of the matrix, whether its entry is strong.
std::vector<char> FindStrong(
  const SparseMatrix& matrix, double strength, const ParallelFor& parallel)
{
  const Vector root = matrix.diagonal().cwiseSqrt();
  std::vector<char> strong(matrix.nonZeros());
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

Aggregates Aggregate(const SparseMatrix& matrix, const std::vector<char>& strong)
{
  const Index n = static_cast<Index>(matrix.rows());
  const Index* outer = matrix.outerIndexPtr();
  const Index* inner = matrix.innerIndexPtr();
  Aggregates result;
  std::vector<Index>& of = result.Of;
  of.assign(n, None);

  for (Index i = 0; i < n; ++i)
  {
    bool any = false;
    bool free = of[i] == None;
    for (Index slot = outer[i]; slot < outer[i + 1] && free; ++slot)
    {
      any = any || strong[slot];
      free = !strong[slot] || of[inner[slot]] == None;
    }
    if (free && any)
    {
      of[i] = result.Count;
      for (Index slot = outer[i]; slot < outer[i + 1]; ++slot)
      {
        if (strong[slot])
        {
          of[inner[slot]] = result.Count;
        }
      }
      ++result.Count;
    }
  }

  // A vertex that joins an aggregate here does not bring its own neighbours along.
  std::vector<Index> joins(n, None);
  for (Index i = 0; i < n; ++i)
  {
    double strongest = 0.0;
    for (Index slot = outer[i]; slot < outer[i + 1] && of[i] == None; ++slot)
    {
      if (strong[slot] && of[inner[slot]] != None && -matrix.valuePtr()[slot] > strongest)
      {
        strongest = -matrix.valuePtr()[slot];
        joins[i] = of[inner[slot]];
      }
    }
  }
  for (Index i = 0; i < n; ++i)
  {
    of[i] = of[i] == None ? joins[i] : of[i];
  }
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
auto RestrictionColumn(const SparseMatrix& matrix, const std::vector<char>& strong,
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
  const std::vector<char> strong = FindStrong(matrix, strength, parallel);
  const Aggregates aggregates = Aggregate(matrix, strong);
  Vector coarse = CoarseKernel(aggregates.Of, aggregates.Count, kernel);
  SparseMatrix restriction = CollectColumns(aggregates.Count, static_cast<Index>(matrix.rows()),
    parallel, RestrictionColumn(matrix, strong, aggregates.Of, kernel, coarse));
  kernel = std::move(coarse);
  return restriction;
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
  Aggregates aggregates = Aggregate(matrix, this->Strong);
  this->Of = std::move(aggregates.Of);
  this->Count = aggregates.Count;
}

template <typename Collect>
void Coarsening::Collected::Set(
  Index rows, Index columns, const ParallelFor& parallel, const Collect& collect)
{
  if (this->Places.empty())
  {
    this->Matrix = CollectColumns<NotedColumn>(rows, columns, parallel, collect, this->Places);
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
  SparseMatrix& restriction = this->Restricting.Matrix;
  if (this->Slots.empty())
  {
    // The slot of every entry is found by transposing the slots.
    SparseMatrix slots = restriction;
    for (Eigen::Index slot = 0; slot < slots.nonZeros(); ++slot)
    {
      slots.valuePtr()[slot] = static_cast<double>(slot);
    }
    this->Prolonging = slots.transpose();
    this->Slots.resize(static_cast<std::size_t>(slots.nonZeros()));
    std::transform(this->Prolonging.valuePtr(), this->Prolonging.valuePtr() + slots.nonZeros(),
      this->Slots.begin(), [](double slot) { return static_cast<Index>(slot); });
  }
  ForEach(this->Parallel, static_cast<Index>(this->Slots.size()),
    [&](Index slot)
    { this->Prolonging.valuePtr()[slot] = restriction.valuePtr()[this->Slots[slot]]; });
}

} // namespace SurfaceDiffusion
