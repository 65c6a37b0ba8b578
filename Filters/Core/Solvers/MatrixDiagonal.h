// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Core/Foundation/Parallel.h"
#include "Core/Foundation/Reduction.h"
#include "Core/Foundation/Types.h"

#include <vector>

namespace SurfaceDiffusion
{

/// The diagonal of a matrix that is accumulated over processes, and how the rows compare with it.
class MatrixDiagonal
{
public:
  MatrixDiagonal(const ParallelFor& parallel, const Reduction& overProcesses)
    : Parallel(parallel)
    , OverProcesses(overProcesses)
  {
  }

  /// Set the inverse alone.
  void Invert(const SparseMatrix& matrix);
  /// Set the inverse and the sums, in one pass over the matrix.
  void InvertAndMeasure(const SparseMatrix& matrix);

  const Vector& Inverse() const { return this->Inverses; } ///< consistent

  // Of the last InvertAndMeasure():
  double SumOfRows() const { return this->OfRows; } ///< of all entries of the matrix
  double SumOfDiagonal() const { return this->OfDiagonal; }
  /// The least of (a_ii - sum of the other |a_ij|) / a_ii over the rows i, or 0 if it is negative
  /// or if the rows are accumulated over several processes. No eigenvalue of D^-1 A is below it
  /// (Gershgorin).
  double LeastExcess() const { return this->Least; }

private:
  /// Of the rows of a block.
  struct Measures
  {
    double OfRows = 0.0, OfDiagonal = 0.0;
    double LeastExcess = 1.0;
  };

  void TakeInverse();

  const ParallelFor& Parallel;
  const Reduction& OverProcesses;
  Vector Inverses;
  std::vector<Measures> Blocks;
  double OfRows = 0.0, OfDiagonal = 0.0, Least = 0.0;
};

} // namespace SurfaceDiffusion
