// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Core/Foundation/Types.h"

#include <cstddef>

namespace SurfaceDiffusion
{

/// Dense matrices in tiles of TileRows rows. A tile of `depth` columns has its entry (i, p) at
/// p * TileRows + i, so that neighbouring columns are contiguous and a part of the columns of a
/// tile is a tile. Rows that fill up the last tile of a matrix are zero.
constexpr Index TileRows = 8;
constexpr std::ptrdiff_t TileSize = static_cast<std::ptrdiff_t>(TileRows) * TileRows;

inline Index NumberOfTiles(Index rows)
{
  return (rows + TileRows - 1) / TileRows;
}

/// C_i -= A_i B^T for `count` tiles A_i, strideA numbers apart, and C_i, strideC numbers apart.
/// depth: the number of columns of A and B. C has min(width, TileRows) columns.
void SubtractTileProducts(const double* a, std::ptrdiff_t strideA, const double* b, Index depth,
  double* c, std::ptrdiff_t strideC, Index count, Index width = TileRows);

/// C becomes X with X L^T = C for `count` tiles of `width` columns. l: the lower triangular tile L.
void SolveTiles(const double* l, Index width, double* c, std::ptrdiff_t stride, Index count);

/// C -= A^T B for the tile A of `depth` columns: row p of C, depth x TileRows, minus the sum of
/// A(i, p) times row i of B, TileRows x TileRows. Both have their rows one after another.
void SubtractTransposedProduct(const double* a, Index depth, const double* b, double* c);

/// w becomes L^-1 w, or with `transposed` L^-T w: `width` rows of TileRows numbers.
void SolveTriangle(const double* l, Index width, bool transposed, double* w);

/// Pivots of a factorisation that are no positive numbers.
struct PivotCounts
{
  Index Open = 0; ///< not above the smallest one that is resolved, negative or not
  Index Negative = 0; ///< below minus that: the matrix is indefinite

  void Add(const PivotCounts& other)
  {
    this->Open += other.Open;
    this->Negative += other.Negative;
  }
};

/// The Cholesky factor of the leading `width` rows and columns of a tile, in place. A pivot that is
/// not above smallest[i] is replaced by a huge one, which makes the solution zero in its row.
PivotCounts FactorizeTile(double* l, Index width, const double* smallest);

} // namespace SurfaceDiffusion
