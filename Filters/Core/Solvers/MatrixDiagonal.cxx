// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Solvers/MatrixDiagonal.h"

#include "Core/Operators/SparsePattern.h"

#include <algorithm>
#include <cmath>

namespace SurfaceDiffusion
{

void MatrixDiagonal::Invert(const SparseMatrix& matrix)
{
  this->Inverses.resize(matrix.rows());
  ForEach(this->Parallel, static_cast<Index>(matrix.rows()),
    [&](Index i) { this->Inverses[i] = DiagonalEntry(matrix, i); });
  this->TakeInverse();
}

void MatrixDiagonal::InvertAndMeasure(const SparseMatrix& matrix)
{
  const Index n = static_cast<Index>(matrix.rows());
  const Index* const outer = matrix.outerIndexPtr();
  const Index* const inner = matrix.innerIndexPtr();
  const double* const values = matrix.valuePtr();
  this->Inverses.resize(n);
  this->Blocks.resize(NumberOfBlocks(n));
  ForEachBlock(this->Parallel, n,
    [&](Index block, Index begin, Index end)
    {
      Measures measures;
      for (Index i = begin; i < end; ++i)
      {
        double sum = 0.0; // of a row first: large entries cancel
        double absolute = 0.0;
        Index below = 0; // entries before the diagonal, see DiagonalEntry()
        for (Index slot = outer[i]; slot < outer[i + 1]; ++slot)
        {
          sum += values[slot];
          absolute += std::abs(values[slot]);
          below += inner[slot] < i;
        }
        const double diagonal = values[outer[i] + below];
        this->Inverses[i] = diagonal;
        measures.OfRows += sum;
        measures.OfDiagonal += diagonal;
        const double excess = 2.0 * diagonal - absolute;
        measures.LeastExcess =
          std::min(measures.LeastExcess, excess > 0.0 ? excess / diagonal : 0.0);
      }
      this->Blocks[block] = measures;
    });
  Measures all;
  for (const Measures& measures : this->Blocks)
  {
    all.OfRows += measures.OfRows;
    all.OfDiagonal += measures.OfDiagonal;
    all.LeastExcess = std::min(all.LeastExcess, measures.LeastExcess);
  }
  double sums[] = { all.OfRows, all.OfDiagonal };
  this->OverProcesses.Sum(sums, 2);
  this->OfRows = sums[0];
  this->OfDiagonal = sums[1];
  this->Least = this->OverProcesses.IsSerial() ? all.LeastExcess : 0.0;
  this->TakeInverse();
}

/// From the diagonal of this process.
void MatrixDiagonal::TakeInverse()
{
  this->OverProcesses.Accumulate(this->Inverses);
  ForEach(this->Parallel, static_cast<Index>(this->Inverses.size()),
    [&](Index i) { this->Inverses[i] = 1.0 / this->Inverses[i]; });
}

} // namespace SurfaceDiffusion
