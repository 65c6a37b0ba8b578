// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Core/Foundation/Parallel.h"
#include "Core/Foundation/ProgressMonitor.h"
#include "Core/Solvers/FactorPanels.h"
#include "Core/Solvers/SupernodalFactor.h"

namespace SurfaceDiffusion
{

/// P A P^T = L D L^T for a symmetric positive definite matrix A, with a unit lower triangular
/// matrix L, a diagonal matrix D and a permutation P. The numbers are those of SupernodalFactor,
/// with three differences:
/// - Zeros that A stores are left out if they are more than 5 %: Dirichlet conditions leave them
///   behind. The factor is then that of the free vertices alone.
/// - Regularisation: if a pivot is not above 1e-14 of its diagonal entry, the numbers are those of
///   Eigen::SimplicialLDLT in the same order: of A, or, if a pivot is too small there as well, of A
///   with its diagonal times 1 + 1e-14. At huge time steps the mean is lost in the last digits of
///   the diagonal, and this rounds the diagonal up in these digits.
/// - Entries of L are left out if |L_ij| sqrt(D_j) < 1e-16 sqrt(D_i), which is below the last place
///   of row i of the Cholesky factor.
class SparseFactor
{
public:
  /// Take a copy of the matrix. The ordering is kept from the matrix before, if that had the same
  /// pattern without the zeros that are left out.
  void SetMatrix(const SparseMatrix& matrix) { this->Matrix = matrix; }
  bool HasValuesOf(const SparseMatrix& matrix) const;

  /// Throws Aborted, after which Compute() has to be called again.
  void Compute(const ParallelFor& parallel, const ProgressMonitor& progress = ProgressMonitor());

  /// Whether Compute() succeeded with all pivots above -1e-10 of their diagonal entries: a pivot of
  /// a nearly singular matrix may be negative by round-off.
  bool IsPositive() const { return this->HasPivotsAbove(-1e-10); }

  /// Per row of A, its row of L.
  const Index* Place() const { return this->Numbers.Structure().Place.data(); }

  Vector InverseDiagonal; ///< of A
  Vector InverseD;
  FactorPanels L;

private:
  bool HasPivotsAbove(double bound) const;
  void TakeNumbers(const ParallelFor& parallel, const ProgressMonitor& progress);
  void CopyColumn(Index s, Index p, FactorPanels::Column& column) const;
  void TakeColumns(const SparseMatrix& l);

  SparseMatrix Matrix;
  SupernodalFactor Numbers;
  Vector D;
  bool Succeeded = false;
};

} // namespace SurfaceDiffusion
