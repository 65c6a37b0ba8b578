// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Core/Foundation/Types.h"

namespace SurfaceDiffusion
{

/// The eigenvalues of a dense symmetric matrix in increasing order, and its eigenvectors of length one
/// in columns, by the QR iterations of Eigen's SelfAdjointEigenSolver. Its templates take four seconds
/// to compile, so they are compiled here, and not in each file that needs them.
struct SymmetricModes
{
  /// The lower triangle of the matrix is read.
  explicit SymmetricModes(const Eigen::MatrixXd& matrix);
  /// Of a tridiagonal matrix. below: one entry fewer
  SymmetricModes(const Vector& diagonal, const Vector& below);

  Vector Eigenvalues;
  Eigen::MatrixXd Vectors;
  bool Converged = true;
};

/// The eigenvalues alone, in a third of the time.
Vector SymmetricEigenvalues(const Eigen::MatrixXd& matrix);

} // namespace SurfaceDiffusion
