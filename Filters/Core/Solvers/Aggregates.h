// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Core/Foundation/Buffer.h"
#include "Core/Foundation/Parallel.h"
#include "Core/Foundation/Reduction.h"
#include "Core/Foundation/Types.h"

#include <vector>

namespace SurfaceDiffusion
{

/// The vertices of the next level of multigrid, as sets of vertices of this one
/// (SmoothedAggregation defines them).
struct Aggregates
{
  static constexpr Index None = -1;

  Aggregates(const SparseMatrix& matrix, double strength, const Reduction& overProcesses,
    const ParallelFor& parallel);

  std::vector<char> IsOnInterface; ///< per vertex; empty on one process
  Buffer<char> Strong; ///< per slot of the matrix, whether its entry is strong
  std::vector<Index> Of; ///< per vertex, or None
  Index Count = 0;
};

/// diag(A)^1/2 of a matrix that is accumulated over processes.
Vector RootsOfDiagonal(
  const SparseMatrix& matrix, const Reduction& overProcesses, const ParallelFor& parallel);

} // namespace SurfaceDiffusion
