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

/// 4/3 over the largest eigenvalue of D^-1 A, which is 3/2 on a regular triangulation.
constexpr double Omega = 8.0 / 9.0;

/// Of every aggregate, the norm of the kernel on it.
Vector CoarseKernel(const Aggregates& aggregates, const Vector& kernel)
{
  const std::vector<Index>& of = aggregates.Of;
  Vector coarse = Vector::Zero(aggregates.Count);
  for (Index i = 0; i < static_cast<Index>(kernel.size()); ++i)
  {
    if (of[i] != Aggregates::None)
    {
      coarse[of[i]] += kernel[i] * kernel[i];
    }
  }
  return coarse.cwiseSqrt();
}

/// What CollectColumns() calls for column i of the restriction.
auto RestrictionColumn(const SparseMatrix& matrix, const Aggregates& aggregates,
  const Vector& kernel, const Vector& coarse)
{
  return [&](Index i, auto& column)
  {
    const std::vector<Index>& of = aggregates.Of;
    const Buffer<char>& strong = aggregates.Strong;
    if (of[i] == Aggregates::None)
    {
      return;
    }
    const Index* inner = matrix.innerIndexPtr();
    const double* a = matrix.valuePtr();
    const Index begin = matrix.outerIndexPtr()[i];
    const Index end = matrix.outerIndexPtr()[i + 1];
    const auto tentative = [&](Index j) { return kernel[j] / coarse[of[j]]; };
    if (!aggregates.IsOnInterface.empty() && aggregates.IsOnInterface[i])
    {
      column.Add(of[i], tentative(i));
      return;
    }
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

SparseMatrix SmoothedAggregation(const SparseMatrix& matrix, double strength, Vector& kernel,
  std::shared_ptr<const Reduction>& overProcesses, const ParallelFor& parallel)
{
  const Aggregates aggregates(matrix, strength, *overProcesses, parallel);
  overProcesses = overProcesses->Coarsened(aggregates.Of, aggregates.Count);
  Vector coarse = CoarseKernel(aggregates, kernel);
  overProcesses->UpdateFromOwners(coarse); // to the same bits
  SparseMatrix restriction = CollectColumns(aggregates.Count, static_cast<Index>(matrix.rows()),
    parallel, RestrictionColumn(matrix, aggregates, kernel, coarse));
  kernel = std::move(coarse);
  return restriction;
}

SparseMatrix SmoothedAggregation(
  const SparseMatrix& matrix, double strength, Vector& kernel, const ParallelFor& parallel)
{
  std::shared_ptr<const Reduction> serial = Reduction::SharedSerial();
  return SmoothedAggregation(matrix, strength, kernel, serial, parallel);
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
  , Sets(matrix, strength, Reduction::Serial(), parallel)
{
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
  Vector coarse = CoarseKernel(this->Sets, kernel);
  this->Restricting.Set(
    this->Sets.Count, rows, this->Parallel, RestrictionColumn(matrix, this->Sets, kernel, coarse));
  kernel = std::move(coarse);
  this->Transpose();
  this->Half.Set(
    this->Sets.Count, rows, this->Parallel, ProductColumn(this->Restricting.Matrix, matrix));
  this->Coarse.Set(this->Sets.Count, this->Sets.Count, this->Parallel,
    ProductColumn(this->Half.Matrix, this->Prolonging));
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
