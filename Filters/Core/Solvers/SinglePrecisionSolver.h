// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Core/Foundation/ProgressMonitor.h"
#include "Core/Foundation/Reduction.h"
#include "Core/Solvers/ConvergenceForecast.h"
#include "Core/Solvers/SlicedMatrix.h"
#include "Core/Solvers/StrongLines.h"

#include <vector>

namespace SurfaceDiffusion
{

/// Conjugate gradients with the preconditioner StrongLines in single precision, for A x = b with a
/// symmetric positive definite matrix A: they need half the memory traffic of double precision. Now
/// and then the caller measures the residual in double precision, and the iterations continue from
/// it along their last direction, so that they converge as in double precision (M. Clark, R.
/// Babich, K. Barros, R. Brower, C. Rebbi, Comput. Phys. Commun. 181, 2010: reliable updates).
class SinglePrecisionSolver
{
public:
  /// overProcesses: A is accumulated over them, D, r and x are consistent.
  explicit SinglePrecisionSolver(
    const ParallelFor& parallel, const Reduction& overProcesses = Reduction::Serial())
    : Parallel(parallel)
    , OverProcesses(overProcesses)
    , Matrix(parallel)
  {
  }

  /// inverseDiagonal: that of the matrix, D^-1. lines: of the matrix, kept by the caller.
  void SetMatrix(const SparseMatrix& matrix, const Vector& inverseDiagonal, StrongLines& lines);

  /// A column of x and its iteration.
  struct Column
  {
    double Unit = 1.0; ///< of its residual
    double Length = 0.0; ///< of its residual, in this unit and the norm of D^-1
    double ReferenceLength = 1.0; ///< that of the relative residual 1, likewise
    double Reduction = 1.0; ///< the factor by which to reduce this length; 1: leave the column
    double Reached = 0.0; ///< the length after the iterations, by their recurrence
    /// Of the first residual of the iteration, the unit of single precision; 0: it begins.
    double FirstLength = 0.0;
    // Before the last step, in the unit of single precision:
    double Square = 0.0; ///< r . r of the residual
    double Rho = 0.0; ///< r . B r with the preconditioner B; without lines it is Square
    double DirectionSquare = 0.0; ///< p . B^-1 p of the direction
  };

  /// Add to x what reduces the residuals, r = b - A x in double precision. The bits of a column do
  /// not depend on the others. A column of a matrix that is not positive definite in single
  /// precision is left. forecast: may stop the iterations; or null. Returns the largest number of
  /// iterations.
  int Correct(const Values& r, std::vector<Column>& columns, int maximumNumberOfIterations,
    Values& x, const ProgressMonitor& progress, ConvergenceForecast* forecast = nullptr);

  /// Add to x what reduces each column of the residual r by the factor `reduction`, if the
  /// iterations suffice, and update r. lengths: of its columns in the norm of D^-1. Returns false
  /// if the steps of a column are bounded by nothing but round-off; it is left.
  bool Descend(Values& r, const std::vector<double>& lengths, double reduction,
    int maximumNumberOfIterations, Values& x);

private:
  /// Columns that share each pass over the matrix.
  struct Group
  {
    static constexpr int Most = 4;

    Column* Columns;
    int First; ///< of all columns
    int Count;
  };

  template <typename Act>
  void ForGroups(std::vector<Column>& columns, const Act& act);
  void Take(const Values& r, const Group& group);
  int Iterate(const Group& group, int maximumNumberOfIterations, bool* solved,
    const ProgressMonitor& progress, ConvergenceForecast* forecast);
  void Add(const Group& group, const bool* solved, Values& x, Values* r);

  void CorrectByLines(const Group& group, const bool* solved, double* products);
  void AddCorrections(const Group& group, const bool* goesOn);
  void Accumulate(int columns, const float* p, double* sums, double* onLines);
  void SumBoth(int columns, double* sums, double* others);
  void CountOnce(int columns, const float* r, double* sums, double* products);

  const ParallelFor& Parallel;
  const Reduction& OverProcesses;
  SlicedMatrix Matrix;
  StrongLines* Lines = nullptr; ///< null if there are none
  std::vector<Index> PlacesOnLines; ///< in the order of Matrix, of the vertices on lines
  std::vector<float> Corrections; ///< B r - r there, of the columns of a group
  std::vector<double> SquaresOnLines; ///< p . p there, of each
  Vector Roots; ///< D^-1/2
  std::vector<float> R, Q, Y; ///< of a few columns, in the order of Matrix
  std::vector<Column> Descents; ///< work
  std::vector<float> P; ///< the directions of all columns
  std::vector<double> OnInterfaces; ///< work
};

} // namespace SurfaceDiffusion
