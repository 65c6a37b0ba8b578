// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Core/Foundation/Columns.h"
#include "Core/Foundation/Resize.h"
#include "Core/Operators/Assembler.h"
#include "Core/Solvers/ConjugateGradientSystem.h"
#include "Core/Solvers/LinearSolver.h"
#include "Core/Solvers/MatrixDiagonal.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <utility>
#include <vector>

namespace SurfaceDiffusion
{

/// The residuals b - A x of several columns, each in a unit of its own, in which it is of moderate
/// size, and their squares in the norm of D^-1. A is accumulated over the processes; b, x and the
/// residuals are consistent. K: the number of columns, or 0 for any.
class ScaledResidual
{
public:
  ScaledResidual(
    const MatrixDiagonal& diagonal, const ParallelFor& parallel, const Reduction& overProcesses)
    : Diagonal(diagonal)
    , Parallel(parallel)
    , OverProcesses(overProcesses)
  {
  }

  // Start() exchanges both for those of another number of columns.
  Values Entries;
  ConjugateGradientWork Work; ///< Unit, Sums (the squares) and Reference (those of b) are set

  /// The residual of a first x, which sets the units.
  template <int K>
  void Start(const SparseMatrix& matrix, const Values& b, const Values& x)
  {
    const ColumnCount<K> k(b.cols());
    const Index n = static_cast<Index>(b.rows());
    if (this->Entries.cols() != k)
    {
      std::swap(this->Entries, this->OtherEntries);
      std::swap(this->Work, this->OtherWork);
    }
    Resize(this->Entries, n, k);
    this->Work.ResizeSums(n, k);
    double startsElsewhere = Max(this->Parallel, n,
      [&](Index i)
      {
        bool isZero = true;
        for (int c = 0; c < k; ++c)
        {
          isZero = isZero && x(i, c) == 0.0;
        }
        return isZero ? 0.0 : 1.0;
      });
    this->OverProcesses.Max(&startsElsewhere, 1);
    if (startsElsewhere > 0.0)
    {
      this->Multiply(matrix, x);
    }
    else
    {
      this->Entries.setZero();
    }
    std::vector<double>& unit = this->Work.Unit;
    for (int c = 0; c < k; ++c)
    {
      unit[c] = ScaleOf(b, this->Entries, c, this->Parallel, this->OverProcesses);
    }
    const Vector& inverse = this->Diagonal.Inverse();
    this->Work.Sums.Run<K>(this->Parallel, n, k,
      [&](Index i, double* sums)
      {
        const bool counts = this->OverProcesses.Owns(i);
        for (int c = 0; c < k; ++c)
        {
          const double bi = b(i, c) / unit[c];
          sums[c] += counts ? bi * inverse[i] * bi : 0.0;
        }
      });
    this->Work.Sums.Reduce(this->OverProcesses);
    for (int c = 0; c < k; ++c)
    {
      this->Work.Reference[c] = this->Work.Sums[c] > 0.0 ? this->Work.Sums[c] : 1.0;
    }
    this->SubtractProduct<K>(b);
  }

  /// The residual of another x, in the units of the first one.
  template <int K>
  void Update(const SparseMatrix& matrix, const Values& b, const Values& x)
  {
    this->Multiply(matrix, x);
    this->SubtractProduct<K>(b);
  }

  /// The largest over the columns, relative to b. Throws std::runtime_error if it is not finite.
  double Largest() const
  {
    double largest = 0.0;
    for (std::size_t c = 0; c < this->Work.Reference.size(); ++c)
    {
      const double residual = std::sqrt(this->Work.Sums[c] / this->Work.Reference[c]);
      if (!std::isfinite(residual))
      {
        throw std::runtime_error("the linear system has no finite solution");
      }
      largest = std::max(largest, residual);
    }
    return largest;
  }

private:
  /// Entries = A x.
  void Multiply(const SparseMatrix& matrix, const Values& x)
  {
    SurfaceDiffusion::Multiply(matrix, x, this->Entries, this->Parallel);
    this->OverProcesses.Accumulate(this->Entries);
  }

  /// The residual from A x, and its squares.
  template <int K>
  void SubtractProduct(const Values& b)
  {
    const ColumnCount<K> k(b.cols());
    const std::vector<double>& unit = this->Work.Unit;
    const Vector& inverse = this->Diagonal.Inverse();
    this->Work.Sums.Run<K>(this->Parallel, static_cast<Index>(b.rows()), k,
      [&](Index i, double* sums)
      {
        const bool counts = this->OverProcesses.Owns(i);
        for (int c = 0; c < k; ++c)
        {
          const double r = b(i, c) / unit[c] - this->Entries(i, c) / unit[c];
          this->Entries(i, c) = r;
          sums[c] += counts ? r * inverse[i] * r : 0.0;
        }
      });
    this->Work.Sums.Reduce(this->OverProcesses);
  }

  // Of another number of columns, for which the solver may be used in turn
  Values OtherEntries;
  ConjugateGradientWork OtherWork;
  const MatrixDiagonal& Diagonal;
  const ParallelFor& Parallel;
  const Reduction& OverProcesses;
};

} // namespace SurfaceDiffusion
