// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Core/Foundation/Types.h"

#include <memory>
#include <vector>

namespace SurfaceDiffusion
{

/// P A P^T = L D L^T for a symmetric positive definite matrix A, with a unit lower triangular
/// matrix L, a diagonal matrix D and a permutation P, by Eigen::SimplicialLDLT. P is that of the
/// approximate minimum degree ordering, or on regular triangulations of NestedDissection() if that
/// takes fewer operations. It differs from the plain factorisation in three ways:
/// - Zeros that A stores are left out if they are more than 5 %: Dirichlet conditions leave them
///   behind. The factor is then that of the free vertices alone.
/// - Regularisation: if a pivot is not above 1e-14 of its diagonal entry, A is factorised again
///   with its diagonal times 1 + 1e-14. At huge time steps the mean is lost in the last digits of
///   the diagonal, and this rounds the diagonal up in these digits.
/// - Entries of L are left out if |L_ij| sqrt(D_j) < 1e-16 sqrt(D_i), which is below the last place
///   of row i of the Cholesky factor.
class SparseFactor
{
public:
  static constexpr int WidestPanel = 4;

  SparseFactor();
  ~SparseFactor();
  SparseFactor(const SparseFactor&) = delete;
  SparseFactor& operator=(const SparseFactor&) = delete;

  /// Take a copy of the matrix. The ordering is kept from the matrix before, which must have had
  /// the same pattern.
  void SetMatrix(const SparseMatrix& matrix) { this->Matrix = matrix; }
  bool HasPatternOf(const SparseMatrix& matrix) const;
  bool HasValuesOf(const SparseMatrix& matrix) const;

  void Compute();

  /// Whether Compute() succeeded with all pivots above -1e-10 of their diagonal entries: a pivot of
  /// a nearly singular matrix may be negative by round-off.
  bool IsPositive() const { return this->HasPivotsAbove(-1e-10); }

  const Index* Place = nullptr; ///< per row of A, its row of L
  Vector InverseDiagonal; ///< of A
  Vector InverseD;
  /// First columns of panels, and the number of columns at the end. A panel is up to WidestPanel
  /// columns of L that follow each other, each of which has the rows of the next one and the next
  /// one itself below its diagonal: substitution reads the rows, and the right-hand side in them,
  /// once for all columns.
  std::vector<Index> Panels;
  /// The entries of the columns of L from j to next - 1, a panel, are at Entries + Begin[j], in the
  /// order in which substitution needs them: first those in the panel's own rows below the
  /// diagonal, row by row, then those in the rows below the panel, row by row, whose numbers are at
  /// Rows + Begin[next - 1], up to Rows + Begin[next].
  std::vector<Index> Begin;
  const Index* Rows = nullptr;
  const double* Entries = nullptr;

private:
  struct Decomposition;

  bool Factorize(const SparseMatrix& matrix, double diagonalFactor);
  bool HasPivotsAbove(double bound) const;
  void DropNegligible();
  void FindPanels();
  void OrderPanels();

  SparseMatrix Matrix;
  std::unique_ptr<Decomposition> LDL;
  Vector D;
  bool IsAnalyzed = false;
  bool IsPruned = false;
  bool Succeeded = false;
};

} // namespace SurfaceDiffusion
