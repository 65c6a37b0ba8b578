// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Core/Foundation/Parallel.h"
#include "Core/Foundation/Types.h"

#include <algorithm>

namespace SurfaceDiffusion
{

/// Give `matrix` the pattern and leave its values to be filled in. Unlike a copy this is a loop,
/// for which an abort need not wait: hundreds of MB for a few million unknowns.
inline void TakePattern(
  const SparseMatrix& pattern, SparseMatrix& matrix, const ParallelFor& parallel)
{
  matrix.resize(pattern.rows(), pattern.cols());
  matrix.resizeNonZeros(pattern.nonZeros());
  const Index* outer = pattern.outerIndexPtr();
  const Index* inner = pattern.innerIndexPtr();
  ForEachBlock(parallel, static_cast<Index>(pattern.rows()),
    [&](Index, Index begin, Index end)
    {
      std::copy(outer + begin, outer + end, matrix.outerIndexPtr() + begin);
      std::copy(inner + outer[begin], inner + outer[end], matrix.innerIndexPtr() + outer[begin]);
    });
  matrix.outerIndexPtr()[pattern.rows()] = outer[pattern.rows()];
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
