// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Solvers/QuadraticDescent.h"

#include "Core/Operators/SparsePattern.h"
#include "Core/Solvers/ConjugateGradients.h"
#include "Core/Solvers/NestedDissection.h"
#include "Core/Solvers/NotPositiveDefinite.h"
#include "Core/Solvers/SolverChoice.h"

#include <algorithm>
#include <cmath>

namespace SurfaceDiffusion
{

namespace
{

/// A matrix with another diagonal for each column.
struct ShiftedSystem : SystemDefaults
{
  ShiftedSystem(const SparseMatrix& matrix, const Values& shifts, const Values& inverseDiagonals,
    const Reduction& overProcesses)
    : SystemDefaults{ overProcesses }
    , Matrix(matrix)
    , Shifts(shifts)
    , InverseDiagonals(inverseDiagonals)
  {
  }

  const SparseMatrix& Matrix;
  const Values& Shifts;
  const Values& InverseDiagonals; ///< consistent

  template <int K>
  void MultiplyRows(const Values& x, Values& y, Index begin, Index end) const
  {
    SurfaceDiffusion::MultiplyRows<K>(this->Matrix, x, y, begin, end);
    const Index count = end - begin;
    y.middleRows(begin, count) +=
      this->Shifts.middleRows(begin, count).cwiseProduct(x.middleRows(begin, count));
  }
  double Scale(Index i, int c, const double* r) const
  {
    return this->InverseDiagonals(i, c) * r[c];
  }
};

} // namespace

void QuadraticDescent::SetMatrix(
  const SparseMatrix& matrix, const Values& shifts, const Reduction& reduction)
{
  this->Matrix = &matrix;
  this->Shifts = &shifts;
  this->OverProcesses = &reduction;
  this->InverseDiagonal.resize(matrix.rows());
  const auto n = static_cast<Index>(matrix.rows());
  ForEach(this->Parallel, n, [&](Index i) { this->InverseDiagonal[i] = DiagonalEntry(matrix, i); });
  if (shifts.cols() > 0)
  {
    this->InverseDiagonals = shifts.colwise() + this->InverseDiagonal;
    reduction.Accumulate(this->InverseDiagonals);
    this->InverseDiagonals = this->InverseDiagonals.cwiseInverse();
    this->HasSingle = false;
    this->HasFactor = false;
    return;
  }
  this->HasFactor =
    reduction.IsSerial() && n <= LargestFactor && IsAroundHubs(matrix) && this->Factorize(matrix);
  if (this->HasFactor)
  {
    return;
  }
  reduction.Accumulate(this->InverseDiagonal);
  ForEach(
    this->Parallel, n, [&](Index i) { this->InverseDiagonal[i] = 1.0 / this->InverseDiagonal[i]; });
  this->Lines.Set(matrix, this->InverseDiagonal, reduction);
  this->HasSingle = this->IsSingle && reduction.IsSerial();
  if (this->HasSingle)
  {
    this->Single.SetMatrix(matrix, this->InverseDiagonal, this->Lines);
  }
}

/// False if it cannot.
bool QuadraticDescent::Factorize(const SparseMatrix& matrix)
{
  if (!this->Factor)
  {
    this->Factor = MakeCholeskySolver(this->Parallel);
  }
  try
  {
    this->Factor->SetMatrix(matrix);
    return true;
  }
  catch (const NotPositiveDefinite&)
  {
    return false;
  }
}

/// False if it cannot.
bool QuadraticDescent::ImproveInSinglePrecision(
  Values& x, double reduction, int maximumNumberOfIterations)
{
  const auto n = static_cast<Index>(x.rows());
  const auto columns = static_cast<int>(x.cols());
  this->Squares.Resize(n, columns);
  ForColumns(columns,
    [&](auto k)
    {
      const ColumnCount<decltype(k)::value> count(columns);
      this->Squares.Run<decltype(k)::value>(this->Parallel, n, count,
        [&](Index i, double* sums)
        {
          for (int c = 0; c < count; ++c)
          {
            const double r = this->Residual(i, c);
            sums[c] += r * this->InverseDiagonal[i] * r;
          }
        });
    });
  this->Lengths.resize(columns);
  for (int c = 0; c < columns; ++c)
  {
    this->Lengths[c] = std::sqrt(this->Squares[c]);
  }
  return this->Single.Descend(
    this->Residual, this->Lengths, reduction, maximumNumberOfIterations, x);
}

void QuadraticDescent::Improve(Values& x, double reduction, int maximumNumberOfIterations)
{
  if (this->HasFactor)
  {
    this->Factor->Precondition(this->Residual, this->Change);
    x += this->Change;
    this->Residual.setZero();
    return;
  }
  if (this->HasSingle && this->ImproveInSinglePrecision(x, reduction, maximumNumberOfIterations))
  {
    return;
  }
  if (this->Shifts->cols() > 0)
  {
    this->Improve(
      ShiftedSystem(*this->Matrix, *this->Shifts, this->InverseDiagonals, *this->OverProcesses), x,
      reduction, maximumNumberOfIterations);
    return;
  }
  this->Improve(LineSystem(*this->Matrix, this->InverseDiagonal, this->Lines, this->Parallel,
                  *this->OverProcesses),
    x, reduction, maximumNumberOfIterations);
}

template <typename System>
void QuadraticDescent::Improve(
  const System& system, Values& x, double reduction, int maximumNumberOfIterations)
{
  ForColumns(x.cols(),
    [&](auto k)
    {
      ConjugateGradients<decltype(k)::value, System> method(
        system, this->Residual, this->Work, this->Parallel);
      std::fill(this->Work.Reference.begin(), this->Work.Reference.end(), 1.0);
      method.Start(0.0);
      for (std::size_t c = 0; c < this->Work.Square.size(); ++c)
      {
        this->Work.Reference[c] = this->Work.Square[c] > 0.0 ? this->Work.Square[c] : 1.0;
      }
      method.SetTolerance(reduction);
      for (int iteration = 1; iteration <= maximumNumberOfIterations && !method.IsFinished();
           ++iteration)
      {
        method.Multiply(); // a step that only round-off bounds has the length 0
        method.Advance(x, iteration == maximumNumberOfIterations);
      }
    });
}

} // namespace SurfaceDiffusion
