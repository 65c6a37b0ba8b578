// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Core/Foundation/Parallel.h"
#include "Core/Foundation/Types.h"

#include <vector>

namespace SurfaceDiffusion
{

/// For each column k of x and b, squares[2 k] = sum_i w_i r_i^2 of the residual r = b - A x, and
/// squares[2 k + 1] = sum_i w_i b_i^2, in one pass over the matrix A. Every column has the bits
/// that it has alone, on any processor. The rest of `squares` is of no meaning.
void ResidualSquares(const SparseMatrix& matrix, const Values& b, const Values& x, const Vector& w,
  std::vector<double>& squares, const ParallelFor& parallel);

} // namespace SurfaceDiffusion
