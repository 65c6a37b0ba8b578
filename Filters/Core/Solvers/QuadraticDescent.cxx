// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Solvers/QuadraticDescent.h"

#include "Core/Operators/SparsePattern.h"
#include "Core/Solvers/ConjugateGradients.h"

namespace SurfaceDiffusion
{

void QuadraticDescent::SetMatrix(const SparseMatrix& matrix, const Reduction& reduction)
{
  this->Matrix = &matrix;
  this->OverProcesses = &reduction;
  this->InverseDiagonal.resize(matrix.rows());
  const auto n = static_cast<Index>(matrix.rows());
  ForEach(this->Parallel, n, [&](Index i) { this->InverseDiagonal[i] = DiagonalEntry(matrix, i); });
  reduction.Accumulate(this->InverseDiagonal);
  ForEach(
    this->Parallel, n, [&](Index i) { this->InverseDiagonal[i] = 1.0 / this->InverseDiagonal[i]; });
}

void QuadraticDescent::Improve(Values& x, int iterations)
{
  const MatrixSystem system{ *this->Matrix, this->InverseDiagonal, *this->OverProcesses };
  ForColumns(x.cols(),
    [&](auto k)
    {
      ConjugateGradients<decltype(k)::value, MatrixSystem> method(
        system, this->Residual, this->Work, this->Parallel);
      method.Start(0.0);
      for (int iteration = 1; iteration <= iterations && !method.IsFinished(); ++iteration)
      {
        method.Multiply(); // a step that only round-off bounds has the length 0
        method.Advance(x, iteration == iterations);
      }
    });
}

} // namespace SurfaceDiffusion
