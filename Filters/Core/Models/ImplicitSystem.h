// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Core/Models/Model.h"
#include "Core/Operators/Assembler.h"
#include "Core/Solvers/LinearSolver.h"

#include <memory>
#include <vector>

namespace SurfaceDiffusion
{

/// The linear system of an implicit step in time,
///   (diag(d) + s K) u = b,  u given at fixed vertices (Dirichlet conditions),
/// with the stiffness matrix K of Assembler. The calls are Assemble(), Constrain() if vertices are
/// fixed, SetUpSolver(), and Solve() once or, with the same matrix, again and again.
class ImplicitSystem
{
public:
  /// solver: kept by the caller from run to run, so that the same matrix is not factorised twice.
  ImplicitSystem(std::shared_ptr<const Assembler> assembler, std::shared_ptr<LinearSolver> solver,
    const ParallelFor& parallel)
    : Assembly(std::move(assembler))
    , Solver(std::move(solver))
    , Parallel(parallel)
  {
  }

  /// The matrix diag(diagonal) + scale K without Dirichlet conditions; see Assembler::Fill().
  void Assemble(const Eigen::Ref<const Vector>& diagonal, double scale,
    const CornerWeights& coefficients, const double* weights = nullptr,
    const CornerWeights* signs = nullptr);

  /// The matrix diag(diagonal) + scale K with a given stiffness matrix K, whose pattern has all
  /// diagonal entries. Dirichlet conditions are not available.
  void Assemble(
    const Eigen::Ref<const Vector>& diagonal, double scale, const SparseMatrix& stiffness);

  /// Add factor x to the diagonal of the matrix.
  void AddToDiagonal(double factor, const Vector& x);

  /// Replace the diagonal of the matrix, which has no Dirichlet conditions.
  void SetDiagonal(const Vector& diagonal)
  {
    this->Assembly->SetDiagonal(this->Matrix, diagonal, this->Parallel);
  }

  /// Impose u = values at fixed vertices; see Assembler::Constrain().
  void Constrain(const Flags& fixed, const Values& values);

  /// Hand the matrix to the solver.
  void SetUpSolver(const ProgressMonitor& progress);

  /// u: the start of an iterative method on entry, the solution on return, with the given values at
  /// fixed vertices. b: the right-hand side without Dirichlet conditions, which are put in here.
  /// b and u may be a part of the columns of Constrain(), from `first` on. Throws NotConverged.
  void Solve(Values& b, Values& u, StepReport& report,
    const ProgressMonitor& progress = ProgressMonitor(), Eigen::Index first = 0);

  /// Row i of diag(d) u + s K u for a free vertex i and a single column u with the given values at
  /// fixed vertices.
  double Product(Index i, const Values& u) const;

  const SparseMatrix& GetMatrix() const { return this->Matrix; }
  LinearSolver& GetSolver() const { return *this->Solver; }

private:
  std::shared_ptr<const Assembler> Assembly;
  std::shared_ptr<LinearSolver> Solver;
  const ParallelFor& Parallel;
  SparseMatrix Matrix;
  bool HasPattern = false; ///< the matrix has that of the assembler
  Values Load; ///< of Constrain(); no rows without Dirichlet conditions
  std::vector<Index> FixedRows;
  std::vector<Index> CoupledRows; ///< free vertices whose Load is not zero
  Values FixedValues; ///< per entry of FixedRows
};

} // namespace SurfaceDiffusion
