// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Core/Foundation/Reduction.h"
#include "Core/Solvers/Aggregation.h"
#include "Core/Solvers/LinearSolver.h"
#include "Core/Solvers/SlicedRows.h"

#include <deque>
#include <memory>
#include <vector>

namespace SurfaceDiffusion
{

/// A symmetric positive definite approximation B of A^-1 by multigrid: a V-cycle of smoothed
/// aggregation (P. Vanek, J. Mandel, M. Brezina, Computing 56, 1996) over a hierarchy made from the
/// matrix. Neighbouring vertices with strong entries become one vertex of the next level, on which
/// constants, the kernel of the Laplace-Beltrami operator, are represented exactly. The smoother is
/// the Chebyshev polynomial of the fourth kind and degree 2 (J. Lottes, Numer. Linear Algebra Appl.
/// 30, 2023) in D^-1 A. D = diag(sum_j |a_ij|) bounds A on any mesh, so that no eigenvalue has to
/// be estimated.
///
/// The hierarchy is made in double precision from the matrix scaled to unit diagonal, and the cycle
/// runs in single precision. B is only the preconditioner of an iteration in double precision, and
/// half the memory traffic is nearly half the time.
///
/// Over processes, each level is decomposed as the surface is, and its matrix is accumulated:
/// aggregates do not cross interfaces. Every process solves the coarsest level.
///
/// Nothing is added to the matrix. The coarsest matrix is factorised as by any CholeskySolver,
/// which may regularise it (SparseFactor).
class Multigrid
{
public:
  /// overProcesses: over which the matrices are accumulated; r and z are consistent.
  explicit Multigrid(const ParallelFor& parallel,
    std::shared_ptr<const Reduction> overProcesses = Reduction::SharedSerial());

  /// Over processes: no levels, so that every process factorises the whole matrix. SetMatrix() then
  /// throws std::runtime_error if it has more than LargestReplicated rows.
  void UseNoLevels() { this->HasNoLevels = true; }

  /// On one process: the hierarchies of all later matrices, which have the pattern of `model`, take
  /// its aggregates: making them then takes a fraction of the time. Throws as SetMatrix().
  void KeepAggregates(const SparseMatrix& model);

  /// Make the hierarchy for `matrix`, which the caller need not keep. Throws Aborted, and
  /// std::runtime_error if the matrix is not positive definite.
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
    Matrix Prolongation; ///< column i: the weights of the vertices of the next level in vertex i
    Matrix Restriction; ///< its transpose
    Numbers B, X, R, D, E;
    SlicedRows RowsOfA, RowsOfProlongation, RowsOfRestriction; ///< for one column
    std::shared_ptr<const Reduction> OverProcesses;
    std::vector<char> IsOnInterface; ///< per vertex; empty on one process
  };

  void MakeLevels(SparseMatrix& current, Vector kernel, const ProgressMonitor& progress);
  void SetLevels(Vector kernel, const ProgressMonitor& progress);
  void SetLevel(const SparseMatrix& matrix, const SparseMatrix& restriction,
    const SparseMatrix& prolongation, Level& level);
  void SetCoarsest(SparseMatrix& matrix, std::shared_ptr<const Reduction> overProcesses,
    const ProgressMonitor& progress);
  void Resize(int columns);
  void SetSlices();
  template <int K>
  void TakeResiduals(const Values& r, const std::vector<double>& scale);
  template <int K>
  void GiveSolutions(const std::vector<double>& scale, Values& z) const;
  template <int K>
  void Cycle(std::size_t number, int columns);
  template <int K, typename Finish>
  void Subtract(
    Level& level, const Numbers& from, const Numbers& x, int columns, const Finish& finish);
  template <int K, typename Finish>
  void SubtractOwnPart(
    Level& level, const Numbers& from, const Numbers& x, int columns, const Finish& finish);
  template <int K, typename Finish>
  void SubtractRows(
    Level& level, const Numbers& from, const Numbers& x, int columns, const Finish& finish);
  void TakeInterface(const Reduction& overProcesses, const Numbers& numbers);
  void AccumulateInterface(const Reduction& overProcesses, Numbers& numbers);
  template <int K>
  void Product(const Matrix& matrix, const SlicedRows& rows, const Numbers& x, Numbers& y,
    int columns, bool add);

  void SolveCoarsest();

  const ParallelFor& Parallel;
  const std::shared_ptr<const Reduction> OverProcesses;
  Vector Scaling; ///< diag(A)^-1/2
  std::vector<Level> Levels;
  std::deque<Coarsening> Coarsenings; ///< of KeepAggregates()
  SparseMatrix Finest; ///< scaled, of KeepAggregates()
  std::shared_ptr<const Reduction> CoarsestOverProcesses;
  SparseMatrix CoarsestMatrix; ///< of all processes
  std::vector<Index> CoarsestRows; ///< in it, of the vertices of this process
  std::unique_ptr<LinearSolver> Coarsest;
  Values CoarsestB, CoarsestX;
  Numbers CoarsestNumbers;
  std::vector<double> InterfaceNumbers; ///< work
  int Columns = -1; ///< for which the vectors are allocated
  bool HasSlices = false; ///< the levels have them
  bool HasNoLevels = false;
};

} // namespace SurfaceDiffusion
