// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Core/Foundation/Buffer.h"
#include "Core/Foundation/Parallel.h"
#include "Core/Foundation/Types.h"

#include <algorithm>
#include <vector>

namespace SurfaceDiffusion
{

/// The columns of the entries of a square matrix, row by row, without their values.
struct SparsePattern
{
  std::vector<Index> Outer = { 0 }; ///< the number of the first entry of each row, and their end
  Buffer<Index> Inner; ///< the column of each entry, sorted within each row

  Index NumberOfRows() const { return static_cast<Index>(this->Outer.size()) - 1; }
  Index NumberOfEntries() const { return this->Outer.back(); }
};

/// Give `matrix` the pattern and leave its values to be filled in. Unlike a copy this is a loop,
/// for which an abort need not wait: hundreds of MB for a few million unknowns.
inline void TakePattern(Index rows, const Index* outer, const Index* inner, SparseMatrix& matrix,
  const ParallelFor& parallel)
{
  matrix.resize(rows, rows);
  matrix.resizeNonZeros(outer[rows]);
  ForEachBlock(parallel, rows,
    [&](Index, Index begin, Index end)
    {
      std::copy(outer + begin, outer + end, matrix.outerIndexPtr() + begin);
      std::copy(inner + outer[begin], inner + outer[end], matrix.innerIndexPtr() + outer[begin]);
    });
  matrix.outerIndexPtr()[rows] = outer[rows];
}

inline void TakePattern(
  const SparseMatrix& pattern, SparseMatrix& matrix, const ParallelFor& parallel)
{
  TakePattern(static_cast<Index>(pattern.rows()), pattern.outerIndexPtr(), pattern.innerIndexPtr(),
    matrix, parallel);
}

/// A matrix of the pattern, all zero.
inline SparseMatrix ZeroMatrix(const SparsePattern& pattern)
{
  SparseMatrix matrix;
  TakePattern(
    pattern.NumberOfRows(), pattern.Outer.data(), pattern.Inner.data(), matrix, SerialFor());
  std::fill_n(matrix.valuePtr(), matrix.nonZeros(), 0.0);
  return matrix;
}

/// Entry (i, i) of a symmetric matrix that has it. Those before it are counted rather than
/// searched: in short rows branches that no one can predict cost more.
inline double DiagonalEntry(const SparseMatrix& matrix, Index i)
{
  const Index* inner = matrix.innerIndexPtr();
  const Index begin = matrix.outerIndexPtr()[i];
  Index below = 0;
  for (Index slot = begin; slot < matrix.outerIndexPtr()[i + 1]; ++slot)
  {
    below += inner[slot] < i;
  }
  return matrix.valuePtr()[begin + below];
}

} // namespace SurfaceDiffusion
