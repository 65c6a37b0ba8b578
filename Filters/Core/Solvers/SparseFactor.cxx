// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Solvers/SparseFactor.h"

#include "Core/Solvers/NestedDissection.h"

#include <Eigen/SparseCholesky>

#include <algorithm>
#include <cmath>

namespace SurfaceDiffusion
{

namespace
{

/// The smaller the time step, the faster the influence of vertices on each other falls off with
/// distance: at steps of h^2/D and less, a third to two thirds of the entries are negligible.
bool IsNegligible(double squaredEntry, double squaredDiagonal)
{
  constexpr double lastPlace = 1e-16;
  return squaredEntry < lastPlace * lastPlace * squaredDiagonal;
}

/// Eigen's decomposition, in an order that is given.
struct Decomposition : Eigen::SimplicialLDLT<SparseMatrix, Eigen::Lower>
{
  Decomposition(const SparseMatrix& matrix, const std::vector<Index>& places)
  {
    using Order = Eigen::Matrix<Index, Eigen::Dynamic, 1>;
    this->m_P.indices() = Eigen::Map<const Order>(places.data(), matrix.rows());
    this->m_Pinv = this->m_P.inverse();
    SparseMatrix ordered(matrix.rows(), matrix.cols());
    ordered.selfadjointView<Eigen::Upper>() =
      matrix.selfadjointView<Eigen::Lower>().twistedBy(this->m_P);
    this->analyzePattern_preordered(ordered, true);
  }

  const SparseMatrix& L() const { return this->m_matrix; }
};

} // namespace

bool SparseFactor::HasValuesOf(const SparseMatrix& matrix) const
{
  return this->Matrix.rows() == matrix.rows() && this->Matrix.nonZeros() == matrix.nonZeros() &&
    std::equal(matrix.outerIndexPtr(), matrix.outerIndexPtr() + matrix.rows(),
      this->Matrix.outerIndexPtr()) &&
    std::equal(matrix.innerIndexPtr(), matrix.innerIndexPtr() + matrix.nonZeros(),
      this->Matrix.innerIndexPtr()) &&
    std::equal(matrix.valuePtr(), matrix.valuePtr() + matrix.nonZeros(), this->Matrix.valuePtr());
}

void SparseFactor::Compute(const ParallelFor& parallel, const ProgressMonitor& progress)
{
  constexpr double resolved = 1e-14;
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
  this->Succeeded = false;
  this->InverseDiagonal = this->Matrix.diagonal().cwiseInverse();
  this->D.resize(matrix.rows());
  const PivotCounts pivots =
    this->Numbers.Compute(matrix, IsRegular(matrix), resolved, parallel, progress.Part(0.0, 0.8));
  if (pivots.Open == 0)
  {
    this->TakeNumbers(parallel, progress.Part(0.8, 1.0));
  }
  this->Numbers.DropEntries();
  if (pivots.Open > 0)
  {
    Decomposition decomposition(matrix, this->Numbers.Structure().Place);
    for (const double diagonalFactor : { 1.0, 1.0 + resolved })
    {
      progress.Report(0.8);
      decomposition.setShift(0.0, diagonalFactor);
      decomposition.factorize(matrix);
      this->Succeeded = decomposition.info() == Eigen::Success;
      this->D = decomposition.vectorD();
      if (this->HasPivotsAbove(resolved))
      {
        break;
      }
    }
    if (this->Succeeded)
    {
      this->TakeColumns(decomposition.L());
    }
  }
  this->InverseD = this->D.cwiseInverse();
  progress.Report(1.0);
}

/// Whether every pivot is above `bound` times its diagonal entry.
bool SparseFactor::HasPivotsAbove(double bound) const
{
  if (!this->Succeeded)
  {
    return false;
  }
  const Vector diagonal = this->Matrix.diagonal();
  for (Eigen::Index i = 0; i < diagonal.size(); ++i)
  {
    if (!(this->D[this->Place()[i]] > bound * std::abs(diagonal[i])))
    {
      return false;
    }
  }
  return true;
}

/// D and L from the Cholesky factor.
void SparseFactor::TakeNumbers(const ParallelFor& parallel, const ProgressMonitor& progress)
{
  constexpr Index reportInterval = 4096;
  const Supernodes& nodes = this->Numbers.Structure();
  for (Index s = 0; s < nodes.Count(); ++s)
  {
    for (Index p = 0; p < nodes.Pivots(s); ++p)
    {
      const double pivot = this->Numbers.Pivot(s, p);
      this->D[nodes.First[s] + p] = pivot * pivot;
    }
  }
  // Entries are counted first: they are about half of the numbers, and a list that grows would take
  // up to twice its memory.
  this->L.Clear(static_cast<std::size_t>(Sum(parallel, nodes.Count(),
    [&](Index s)
    {
      FactorPanels::Column column;
      double kept = 0.0;
      for (Index p = 0; p < nodes.Pivots(s); ++p)
      {
        this->CopyColumn(s, p, column);
        kept += static_cast<double>(column.Rows.size());
      }
      return kept;
    })));
  FactorPanels::Column column;
  for (Index s = 0; s < nodes.Count(); ++s)
  {
    if (s % reportInterval == 0)
    {
      progress.Report(static_cast<double>(s) / nodes.Count());
    }
    for (Index p = 0; p < nodes.Pivots(s); ++p)
    {
      this->CopyColumn(s, p, column);
      this->L.Append(column);
    }
  }
  this->L.Finish();
  this->Succeeded = true;
}

/// Of L, pivot p of supernode s, without negligible entries.
void SparseFactor::CopyColumn(Index s, Index p, FactorPanels::Column& column) const
{
  const Supernodes& nodes = this->Numbers.Structure();
  const Index first = nodes.First[s];
  const Index k = nodes.Pivots(s);
  const Index height = k + nodes.RowsBelow(s);
  const Index* const below = nodes.Below(s);
  column.Rows.resize(static_cast<std::size_t>(height));
  column.Entries.resize(static_cast<std::size_t>(height));
  this->Numbers.CopyColumn(s, p, column.Entries.data());
  const double inversePivot = 1.0 / column.Entries[p];
  std::size_t kept = 0; // never more than the entries that were read
  for (Index i = p + 1; i < height; ++i)
  {
    const double entry = column.Entries[i];
    const Index row = i < k ? first + i : below[i - k];
    column.Rows[kept] = row;
    column.Entries[kept] = entry * inversePivot;
    kept += !IsNegligible(entry * entry, this->D[row]);
  }
  column.Rows.resize(kept);
  column.Entries.resize(kept);
}

/// L from the columns of a matrix.
void SparseFactor::TakeColumns(const SparseMatrix& l)
{
  this->L.Clear(static_cast<std::size_t>(l.nonZeros()));
  FactorPanels::Column column;
  for (Eigen::Index j = 0; j < l.cols(); ++j)
  {
    column.Rows.clear();
    column.Entries.clear();
    for (SparseMatrix::InnerIterator entry(l, j); entry; ++entry)
    {
      const double value = entry.value();
      if (!IsNegligible(value * value * std::abs(this->D[j]), std::abs(this->D[entry.row()])))
      {
        column.Rows.push_back(static_cast<Index>(entry.row()));
        column.Entries.push_back(value);
      }
    }
    this->L.Append(column);
  }
  this->L.Finish();
}

} // namespace SurfaceDiffusion
