// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Solvers/QuadraticDescent.h"

#include "Core/Operators/SparsePattern.h"
#include "Core/Operators/SparseProduct.h"
#include "Core/Solvers/LinearSolver.h"

#include <algorithm>

namespace SurfaceDiffusion
{

void QuadraticDescent::SetMatrix(const SparseMatrix& matrix, const Reduction& reduction)
{
  this->Matrix = &matrix;
  this->OverProcesses = &reduction;
  this->InverseDiagonal.resize(matrix.rows());
  ForEach(this->Parallel, static_cast<Index>(matrix.rows()),
    [&](Index i) { this->InverseDiagonal[i] = DiagonalEntry(matrix, i); });
  reduction.Accumulate(this->InverseDiagonal);
  ForEach(this->Parallel, static_cast<Index>(matrix.rows()),
    [&](Index i) { this->InverseDiagonal[i] = 1.0 / this->InverseDiagonal[i]; });
  this->Weight = reduction.OwnedPart(this->InverseDiagonal, this->OwnedInverse).data();
}

void QuadraticDescent::Improve(Values& x, int iterations)
{
  this->Resize(x.cols());
  switch (x.cols())
  {
    case 1:
      return this->ImproveColumns<1>(x, iterations);
    case 2:
      return this->ImproveColumns<2>(x, iterations);
    case 3:
      return this->ImproveColumns<3>(x, iterations);
    default:
      return this->ImproveColumns<0>(x, iterations);
  }
}

/// K columns, or as many as x has where K is 0.
template <int K>
void QuadraticDescent::ImproveColumns(Values& x, int iterations)
{
  const int k = K > 0 ? K : static_cast<int>(x.cols());
  const auto n = static_cast<Index>(x.rows());
  double* r = this->Residual.data();
  double* p = this->Direction.data();
  double* q = this->Product.data();
  double* u = x.data();
  const double* const weight = this->Weight;

  // p = z = r / diag(A), rho = r . z
  this->Sums.Run<K>(this->Parallel, n, k, 1,
    [&](Index i, double* sums)
    {
      for (int c = 0; c < k; ++c)
      {
        const double ri = r[i * k + c];
        p[i * k + c] = this->InverseDiagonal[i] * ri;
        sums[c] += ri * weight[i] * ri;
      }
    });
  this->Sums.Reduce(*this->OverProcesses);
  this->Rho = this->Sums.Totals();
  this->Length = this->Rho;
  for (int iteration = 0; iteration < iterations; ++iteration)
  {
    // q = A p, alpha = rho / p . q
    this->Sums.Run<K>(
      this->Parallel, n, k, 1,
      [&](Index begin, Index end)
      { MultiplyRows<K>(*this->Matrix, this->Direction, this->Product, begin, end); },
      [&](Index i, double* sums)
      {
        for (int c = 0; c < k; ++c)
        {
          sums[c] += p[i * k + c] * q[i * k + c];
        }
      });
    this->Sums.Reduce(*this->OverProcesses);
    this->OverProcesses->Accumulate(this->Product);
    for (int c = 0; c < k; ++c)
    {
      // No step where only round-off resists it: it has no bounds.
      const bool resolved = this->Sums[c] > ResolvedShare * this->Length[c];
      this->Factor[c] = resolved ? this->Rho[c] / this->Sums[c] : 0.0;
    }
    // x += alpha p, r -= alpha q
    this->Sums.Run<K>(this->Parallel, n, k, 1,
      [&](Index i, double* sums)
      {
        for (int c = 0; c < k; ++c)
        {
          u[i * k + c] += this->Factor[c] * p[i * k + c];
          const double ri = r[i * k + c] - this->Factor[c] * q[i * k + c];
          r[i * k + c] = ri;
          sums[c] += ri * weight[i] * ri;
        }
      });
    this->Sums.Reduce(*this->OverProcesses);
    if (iteration + 1 == iterations)
    {
      break;
    }
    // p = z + beta p
    for (int c = 0; c < k; ++c)
    {
      const double beta = this->Rho[c] > 0.0 ? this->Sums[c] / this->Rho[c] : 0.0;
      this->Factor[c] = beta;
      this->Rho[c] = this->Sums[c];
      this->Length[c] = this->Sums[c] + beta * beta * this->Length[c]; // z and p are orthogonal
    }
    ForEach(this->Parallel, n,
      [&](Index i)
      {
        for (int c = 0; c < k; ++c)
        {
          p[i * k + c] = this->InverseDiagonal[i] * r[i * k + c] + this->Factor[c] * p[i * k + c];
        }
      });
  }
}

void QuadraticDescent::Resize(Eigen::Index columns)
{
  if (this->Direction.cols() != columns)
  {
    const Eigen::Index n = this->InverseDiagonal.size();
    this->Direction.resize(n, columns);
    this->Product.resize(n, columns);
    this->Factor.resize(columns);
    this->Rho.resize(columns);
    this->Length.resize(columns);
    this->Sums.Resize(static_cast<Index>(n), static_cast<int>(columns));
  }
}

} // namespace SurfaceDiffusion
