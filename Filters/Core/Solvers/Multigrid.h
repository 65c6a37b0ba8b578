// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Core/Solvers/LinearSolver.h"

#include <memory>
#include <vector>

namespace SurfaceDiffusion
{

/// A symmetric positive definite approximation B of A^-1 by multigrid: a V-cycle of smoothed
/// aggregation (P. Vanek, J. Mandel, M. Brezina, Computing 56, 1996) over a hierarchy made from the
/// matrix. Neighbouring vertices with strong coefficients become one vertex of the next level;
/// constants, which diffusion leaves alone, are represented exactly. The smoother is the Chebyshev
/// polynomial of the fourth kind and degree 2 (J. Lottes, Numer. Linear Algebra Appl. 30, 2023) in
/// D^-1 A, where D = diag(sum_j |a_ij|) bounds A on any mesh: nothing has to be estimated.
///
/// The hierarchy is made in double precision from the matrix scaled to unit diagonal, and the cycle
/// runs on it in single precision: B only steers an iteration in double precision, and half the
/// memory is most of the time.
class Multigrid
{
public:
  explicit Multigrid(const ParallelFor& parallel);

  /// Make the hierarchy for `matrix`, which need not be kept. Throws Aborted, std::runtime_error
  /// for a matrix that is not positive definite.
  void SetMatrix(const SparseMatrix& matrix, const ProgressMonitor& progress = ProgressMonitor());

  /// z = B r, all columns at once. scale: per column the factor that makes the norm of r in
  /// diag(A)^-1 about 1, which single precision holds.
  void Apply(const Values& r, const std::vector<double>& scale, Values& z);

private:
  using Numbers = Eigen::Matrix<float, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;
  using Matrix = Eigen::SparseMatrix<float, Eigen::ColMajor, Index>;

  struct Level
  {
    Matrix A;
    Eigen::VectorXf InverseD;
    Matrix Prolongation; ///< column i: what vertex i takes from the vertices of the next level
    Matrix Restriction; ///< its transpose
    Numbers B, X, R, D, E;
  };

  Level MakeLevel(const SparseMatrix& matrix, const SparseMatrix& restriction,
    const SparseMatrix& prolongation) const;
  void Resize(int columns);
  template <int K>
  void Cycle(std::size_t number, int columns);
  template <int K, typename Finish>
  void Subtract(
    Level& level, const Numbers& from, const Numbers& x, int columns, const Finish& finish);
  template <int K>
  void Product(const Matrix& rows, const Numbers& x, Numbers& y, int columns, bool add);

  const ParallelFor& Parallel;
  Vector Scaling; ///< diag(A)^-1/2
  std::vector<Level> Levels;
  SparseMatrix CoarsestMatrix;
  std::unique_ptr<LinearSolver> Coarsest;
  Values CoarsestB, CoarsestX;
  Numbers CoarsestNumbers;
  int Columns = -1; ///< that there is room for
};

} // namespace SurfaceDiffusion
