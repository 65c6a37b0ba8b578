// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Core/Foundation/Types.h"

#include <memory>
#include <vector>

namespace SurfaceDiffusion
{

/// P A P^T = L D L^T with unit lower triangular L, by a library: Eigen, or CHOLMOD where the build
/// has SURFACEDIFFUSION_USE_CHOLMOD. What is done with a factor is CholeskySolver's.
class SparseFactor
{
public:
  virtual ~SparseFactor() = default;

  /// Find an ordering for matrices of this pattern.
  virtual void Analyze(const SparseMatrix& matrix) = 0;

  /// Factorise the matrix with its diagonal times `diagonal`; false where that broke down.
  virtual bool Factorize(const SparseMatrix& matrix, double diagonal) = 0;

  const Index* Place = nullptr; ///< where vertex i stands in the order of L
  Vector D;
  /// Column j of L below the diagonal is Rows[slot], Entries[slot] for slot in Begin[j] .. [j + 1].
  /// May be changed: the next factorisation writes all of it anew.
  std::vector<Index> Begin;
  Index* Rows = nullptr;
  double* Entries = nullptr;
};

std::unique_ptr<SparseFactor> MakeSparseFactor();

} // namespace SurfaceDiffusion
