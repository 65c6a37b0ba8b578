// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Core/Foundation/Buffer.h"
#include "Core/Foundation/Parallel.h"
#include "Core/Foundation/ProgressMonitor.h"
#include "Core/Solvers/DenseTiles.h"
#include "Core/Solvers/Supernodes.h"

#include <memory>
#include <vector>

namespace SurfaceDiffusion
{

/// An entry of the inverse of a matrix.
struct InverseEntry
{
  Index Row = 0;
  Index Column = 0;
  double Value = 0.0;
};

/// P A P^T = L L^T for a symmetric positive definite matrix A by the multifrontal method (I. Duff,
/// J. Reid, ACM Trans. Math. Softw. 9, 1983) in dense tiles. All threads take part, and no bit
/// depends on their number. SparseFactor has the same numbers in the order in which substitution of
/// few columns reads them.
class SupernodalFactor
{
public:
  /// isRegular: of the mesh, see OrderedSupernodes(). The order is kept while the pattern is.
  /// Throws Aborted. Returns the number of rows whose pivot was not above `resolved` times the
  /// diagonal entry: L has a huge one in its place, and solutions are zero there.
  PivotCounts Compute(const SparseMatrix& matrix, bool isRegular, double resolved,
    const ParallelFor& parallel, const ProgressMonitor& progress = ProgressMonitor());

  /// x becomes A^-1 x, n x k.
  void Solve(Values& x, const ParallelFor& parallel) const { this->Solve(x, {}, parallel); }

  /// The same for the rows that are asked for; the others are not defined. With few of these, and
  /// few rows of x that are not zero in every TileRows columns, most of L is not read.
  /// needed: of Needed(); empty: all rows.
  void Solve(Values& x, const std::vector<char>& needed, const ParallelFor& parallel) const;

  /// Per supernode, whether solutions in these rows depend on it.
  std::vector<char> Needed(const std::vector<Index>& rows) const;

  /// Diagonal entries of A^-1 by selected inversion (K. Takahashi, J. Fagan, M. Chin, PICA 1973):
  /// the entries of the inverse in the pattern of L follow from each other, from the last row on.
  /// others: entries off the diagonal where A has one, which are set.
  Vector InverseDiagonal(const ParallelFor& parallel,
    const ProgressMonitor& progress = ProgressMonitor(),
    std::vector<InverseEntry>* others = nullptr) const;

  const Supernodes& Structure() const { return this->Nodes; }
  /// The diagonal entry of L of pivot p of supernode s.
  double Pivot(Index s, Index p) const
  {
    return this->Panel(s)[p / TileRows * this->TileStride(s) + p * TileRows + p % TileRows];
  }
  /// The entries of the column of L of pivot p of supernode s: its pivots' rows, of which those
  /// before p are not defined, and the rows below.
  void CopyColumn(Index s, Index p, double* entries) const;
  /// Keep the order alone.
  void DropEntries() { this->Entries = Buffer<double>(); }
  /// Bytes of L.
  std::size_t Memory() const { return this->Entries.size() * sizeof(double); }

private:
  using Update = std::unique_ptr<double[]>;

  void FactorizeNode(const SparseMatrix& matrix, const Vector& smallest, Index s,
    std::vector<Update>& updates, PivotCounts& pivots, const ParallelFor& parallel);
  void AddChild(Index s, Index child, const double* update, double* own) const;
  PivotCounts EliminatePivots(Index s, const double* smallest, const ParallelFor& parallel);

  /// From a tile of the panel of s to the next one.
  std::ptrdiff_t TileStride(Index s) const
  {
    return static_cast<std::ptrdiff_t>(TileRows) * this->Nodes.Pivots(s);
  }
  Index DiagonalTiles(Index s) const { return NumberOfTiles(this->Nodes.Pivots(s)); }
  Index TilesBelow(Index s) const { return NumberOfTiles(this->Nodes.RowsBelow(s)); }
  double* Panel(Index s) { return this->Entries.data() + this->Begin[s]; }
  const double* Panel(Index s) const { return this->Entries.data() + this->Begin[s]; }

  void SolvePanel(Values& x, Index first, Index count, const std::vector<char>& needed) const;

  std::vector<Index> Outer, Inner; ///< the pattern that the order is for
  Supernodes Nodes;
  /// The panel of supernode s, pivots + rows below by pivots, begins at Entries + Begin[s]: the
  /// tiles of the pivots' rows, then those of the rows below.
  std::vector<std::size_t> Begin;
  Buffer<double> Entries;
};

} // namespace SurfaceDiffusion
