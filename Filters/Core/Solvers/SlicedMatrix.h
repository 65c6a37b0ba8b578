// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Core/Foundation/Buffer.h"
#include "Core/Foundation/Parallel.h"
#include "Core/Foundation/Types.h"

#include <cstddef>
#include <vector>

namespace SurfaceDiffusion
{

/// The matrix D^-1/2 A D^-1/2 in single precision, where D is the diagonal of A, and the passes of
/// conjugate gradients over it. The format is SELL-16-2048 (M. Kreutzer, G. Hager, G. Wellein,
/// H. Fehske, A. Bishop, SIAM J. Sci. Comput. 36, 2014): slices of 16 rows are stored entry by
/// entry, so that the lanes of a vector register belong to 16 rows, and the rows of each block are
/// sorted by their lengths, so that little is filled up with zeros. The unit diagonal is not
/// stored.
///
/// Vectors have one array of PaddedRows() numbers per column, in the order of the slices. Every sum
/// has one order, and products and sums are rounded one by one, so that bits depend neither on the
/// number of threads nor on the processor.
class SlicedMatrix
{
public:
  static constexpr Index Lanes = 16;

  explicit SlicedMatrix(const ParallelFor& parallel)
    : Parallel(parallel)
  {
  }

  /// roots: D^-1/2. Allocates only for a new pattern.
  void Set(const SparseMatrix& matrix, const Vector& roots);

  std::size_t PaddedRows() const { return this->Rows.size(); }
  /// The row of the matrix at each place in the order of the slices, or -1 at the end.
  const std::vector<Index>& RowsInOrder() const { return this->Rows; }
  /// The place of each row.
  const std::vector<Index>& PlacesOfRows() const { return this->Places; }

  /// q = A p; sums[c] = p . q.
  void Multiply(int columns, const float* p, float* q, double* sums);
  /// r -= alpha q; sums[c] = r . r.
  void Subtract(int columns, const float* alpha, const float* q, float* r, double* sums);
  /// y += alpha p, and p = r + beta p in the columns that go on.
  void Turn(int columns, const float* alpha, const float* beta, const bool* goesOn, const float* r,
    float* y, float* p);

private:
  void SortRows(const SparseMatrix& matrix);
  template <typename Part>
  void Sum(int columns, const Part& part, double* sums);

  const ParallelFor& Parallel;
  std::vector<Index> Outer; ///< of the matrix for which the rows were sorted
  std::vector<Index> Rows, Places; ///< the order and its inverse
  std::vector<std::size_t> Begin; ///< of the entries of each slice, and their end
  Buffer<Index> Columns; ///< places
  Buffer<float> Entries;
  std::vector<double> Partial;
};

} // namespace SurfaceDiffusion
