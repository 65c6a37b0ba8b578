// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>

namespace SurfaceDiffusion
{

/// matrix.resize(rows, columns). If memory runs out, the matrix is empty; Eigen 3.4 alone would
/// leave it a pointer to what it has freed, which its destructor frees again.
template <typename Matrix>
void Resize(Matrix& matrix, Eigen::Index rows, Eigen::Index columns)
{
  if (matrix.size() != rows * columns)
  {
    matrix.resize(0, columns);
  }
  matrix.resize(rows, columns);
}

} // namespace SurfaceDiffusion
