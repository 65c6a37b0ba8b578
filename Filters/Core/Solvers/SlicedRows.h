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

/// A matrix in single precision for products with one vector, in the format SELL-16 (see
/// SlicedMatrix) with the rows in their own order: slices of 16 rows are stored entry by entry, so
/// that the lanes of a vector register belong to 16 rows. Bits depend neither on the number of
/// threads nor on the processor.
class SlicedRows
{
public:
  static constexpr Index Lanes = 16;

  /// Row i is column i of `columns`. Allocates only for a new pattern.
  void Set(
    const Eigen::SparseMatrix<float, Eigen::ColMajor, Index>& columns, const ParallelFor& parallel);

  Index Size() const { return this->Count; }

  /// y = rows x of the rows [begin, end), where begin is a multiple of Lanes.
  void Multiply(Index begin, Index end, const float* x, float* y) const;
  /// y = b - rows x, likewise.
  void Subtract(Index begin, Index end, const float* b, const float* x, float* y) const;
  /// y += rows x, likewise.
  void Add(Index begin, Index end, const float* x, float* y) const;

private:
  Index Count = 0;
  std::vector<std::size_t> Begin; ///< of the entries of each slice, and their end
  Buffer<Index> Columns;
  Buffer<float> Entries;
};

} // namespace SurfaceDiffusion
