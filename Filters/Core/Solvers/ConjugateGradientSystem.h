// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Core/Foundation/ColumnSums.h"
#include "Core/Foundation/Resize.h"
#include "Core/Operators/SparseProduct.h"
#include "Core/Solvers/StrongLines.h"

#include <vector>

namespace SurfaceDiffusion
{

/// The defaults of a System, the linear system A x = b that ConjugateGradients solves. A System
/// derives from it, hides what differs, and has
///   `template <int K> void MultiplyRows(const Values& x, Values& y, Index begin, Index end) const`
///     rows [begin, end) of y = A x;
///   double Scale(Index i, int c, const double* r) const
///     entry c of D^-1 r in row i, given row i of r. D is block diagonal, symmetric and positive
///     definite. It is the preconditioner unless there is another, and the residual is measured in
///     the norm of D^-1.
struct SystemDefaults
{
  /// False: every column is a system of its own, with its own step lengths, so that its bits do not
  /// depend on the other columns. True: all columns together are one vector of one system.
  static constexpr bool IsCoupled = false;
  /// Whether Project() does anything.
  static constexpr bool IsProjected = false;

  const Reduction& OverProcesses = Reduction::Serial(); ///< over which A is accumulated

  /// Called before MultiplyRows() for the rows of A x, by systems whose product is not local.
  void PrepareProduct(const Values& /*x*/) const {}

  /// Whether Precondition() replaces D^-1 as preconditioner.
  bool HasPreconditioner() const { return false; }
  /// z = B r with B symmetric, linear and positive definite. squares: of the systems of r, in the
  /// norm of D^-1.
  void Precondition(
    const Values& /*r*/, const std::vector<double>& /*squares*/, Values& /*z*/) const
  {
  }

  /// Project row i onto the space of the unknowns, orthogonally.
  template <int K>
  void Project(Index /*i*/, double* /*row*/) const
  {
  }
};

/// A stored matrix, and its diagonal as preconditioner (Jacobi).
struct MatrixSystem : SystemDefaults
{
  MatrixSystem(const SparseMatrix& matrix, const Vector& inverseDiagonal,
    const Reduction& overProcesses = Reduction::Serial())
    : SystemDefaults{ overProcesses }
    , Matrix(matrix)
    , InverseDiagonal(inverseDiagonal)
  {
  }

  const SparseMatrix& Matrix;
  const Vector& InverseDiagonal; ///< consistent

  template <int K>
  void MultiplyRows(const Values& x, Values& y, Index begin, Index end) const
  {
    SurfaceDiffusion::MultiplyRows<K>(this->Matrix, x, y, begin, end);
  }
  double Scale(Index i, int c, const double* r) const { return this->InverseDiagonal[i] * r[c]; }
};

/// A stored matrix with the preconditioner StrongLines: its diagonal where there are no lines.
struct LineSystem : MatrixSystem
{
  LineSystem(const SparseMatrix& matrix, const Vector& inverseDiagonal, const StrongLines& lines,
    const ParallelFor& parallel, const Reduction& overProcesses = Reduction::Serial())
    : MatrixSystem(matrix, inverseDiagonal, overProcesses)
    , Lines(lines)
    , Parallel(parallel)
  {
  }

  const StrongLines& Lines; ///< of the matrix
  const ParallelFor& Parallel;

  bool HasPreconditioner() const { return !this->Lines.IsEmptyEverywhere(); }
  void Precondition(const Values& r, const std::vector<double>& /*squares*/, Values& z) const
  {
    this->Lines.Precondition(this->InverseDiagonal, r, z);
  }
};

/// Vectors and numbers of conjugate gradients, kept from solve to solve only so that time steps do
/// not allocate.
struct ConjugateGradientWork
{
  Values P; ///< direction
  Values Q; ///< A P, then B R
  ColumnSums Sums;
  // One number per system (SystemDefaults::IsCoupled):
  std::vector<double> Unit; ///< of the residual, in which it is of moderate size
  std::vector<double> Reference; ///< the square to which that of the residual is compared
  std::vector<double> Square; ///< R . D^-1 R
  std::vector<double> Rho; ///< R . B R
  std::vector<double> Length; ///< P . B^-1 P
  std::vector<double> Alpha, Beta, Step;
  Index Rows = 0;

  void Resize(Index rows, int columns, int systems)
  {
    SurfaceDiffusion::Resize(this->P, rows, columns);
    SurfaceDiffusion::Resize(this->Q, rows, columns);
    this->ResizeSums(rows, systems);
  }
  /// All but P and Q.
  void ResizeSums(Index rows, int systems)
  {
    if (this->Rows == rows && this->Unit.size() == static_cast<std::size_t>(systems))
    {
      return;
    }
    this->Rows = 0; // memory may run out
    this->Sums.Resize(rows, systems);
    this->Unit.assign(systems, 1.0);
    this->Reference.assign(systems, 1.0);
    for (std::vector<double>* numbers :
      { &this->Square, &this->Rho, &this->Length, &this->Alpha, &this->Beta, &this->Step })
    {
      numbers->assign(systems, 0.0);
    }
    this->Rows = rows;
  }
};

} // namespace SurfaceDiffusion
