// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Core/Foundation/Buffer.h"
#include "Core/Foundation/Parallel.h"
#include "Core/Foundation/Types.h"
#include "Core/Solvers/DenseTiles.h"

#include <vector>

namespace SurfaceDiffusion
{

/// An orthonormal basis of many columns of n rows, which grows by blocks of BlockColumns columns.
/// Its products with a block run on dense tiles, and no bit depends on the number of threads.
class KrylovBasis
{
public:
  static constexpr Index BlockColumns = 2 * TileRows;
  using Coefficients =
    Eigen::Matrix<double, Eigen::Dynamic, BlockColumns, Eigen::RowMajor>; ///< of a block
  using Square = Eigen::Matrix<double, BlockColumns, BlockColumns, Eigen::RowMajor>;

  KrylovBasis(Index rows, const ParallelFor& parallel)
    : Rows(rows)
    , Parallel(parallel)
  {
  }

  Index NumberOfColumns() const { return static_cast<Index>(this->Blocks.size()) * BlockColumns; }

  /// W -= V C with C = V^T W for the columns of the basis from `first` on, a multiple of
  /// BlockColumns. w: n x BlockColumns. Returns C.
  Coefficients Project(Values& w, Index first = 0) const;

  /// Append the columns of a block, which are orthonormal and orthogonal to the basis.
  void Append(const Values& w);

  /// V C for any number of columns: n x columns of `c`.
  Values Combine(const Eigen::Ref<const Eigen::MatrixXd>& c) const;

private:
  /// Rows of a task: a block of W of as many rows stays in the first cache.
  static constexpr Index ChunkRows = 128;

  Index NumberOfTasks() const;
  template <typename Work>
  void ForEachChunk(const Work& work) const;

  Index Rows;
  const ParallelFor& Parallel;
  std::vector<Buffer<double>> Blocks; ///< in tiles: see DenseTiles.h
};

} // namespace SurfaceDiffusion
