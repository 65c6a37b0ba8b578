// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Core/Foundation/ColumnSums.h"
#include "Core/Foundation/Types.h"

#include <vector>

namespace SurfaceDiffusion
{

/// A few conjugate gradient iterations with Jacobi preconditioner on A x = b where b changes a
/// little from call to call and x is carried along, as inside an outer iteration. Unlike a solver
/// (LinearSolver.h) it keeps the residual between calls, so that no product is spent on finding out
/// where it stands, and takes as few passes over memory as the method allows.
class QuadraticDescent
{
public:
  explicit QuadraticDescent(const ParallelFor& parallel = SerialFor())
    : Parallel(parallel)
  {
  }

  /// matrix: symmetric positive (semi)definite, with a positive diagonal; must stay as it is.
  /// Over several processes it is accumulated.
  void SetMatrix(const SparseMatrix& matrix, const Reduction& reduction = Reduction::Serial());

  /// The residual b - A x, n x k: to be set before the first call of Improve, and to be changed by
  /// what b changes by before the next. It is consistent, as x is.
  Values Residual;

  /// `iterations` iterations, each column with its own step lengths.
  void Improve(Values& x, int iterations);

private:
  template <int K>
  void ImproveColumns(Values& x, int iterations);
  void Resize(Eigen::Index columns);

  const ParallelFor& Parallel;
  const SparseMatrix* Matrix = nullptr;
  const Reduction* OverProcesses = &Reduction::Serial();
  Vector InverseDiagonal;
  Vector OwnedInverse; ///< see Reduction::OwnedPart
  const double* Weight = nullptr; ///< of products of residuals
  Values Direction, Product;
  std::vector<double> Rho, Factor; // one per column
  std::vector<double> Length; ///< per column, p . diag(A) p
  ColumnSums Sums;
};

} // namespace SurfaceDiffusion
