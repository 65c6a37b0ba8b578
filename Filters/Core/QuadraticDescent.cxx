// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "QuadraticDescent.h"

#include "LinearSolver.h"

#include <algorithm>

namespace SurfaceDiffusion
{

void QuadraticDescent::SetMatrix(const SparseMatrix& matrix)
{
  this->Matrix = &matrix;
  this->InverseDiagonal.resize(matrix.rows());
  const Index* outer = matrix.outerIndexPtr();
  const Index* inner = matrix.innerIndexPtr();
  ForEach(this->Parallel, static_cast<Index>(matrix.rows()),
    [&](Index i)
    {
      const auto slot = std::lower_bound(inner + outer[i], inner + outer[i + 1], i) - inner;
      this->InverseDiagonal[i] = 1.0 / matrix.valuePtr()[slot];
    });
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
  const Index* outer = this->Matrix->outerIndexPtr();
  const Index* inner = this->Matrix->innerIndexPtr();
  const double* a = this->Matrix->valuePtr();
  double* r = this->Residual.data();
  double* p = this->Direction.data();
  double* q = this->Product.data();
  double* u = x.data();

  // p = z = r / diag(A), rho = r . z
  this->SumBlocks(k,
    [&](Index i, double* sums)
    {
      for (int c = 0; c < k; ++c)
      {
        const double ri = r[i * k + c];
        p[i * k + c] = this->InverseDiagonal[i] * ri;
        sums[c] += ri * this->InverseDiagonal[i] * ri;
      }
    });
  this->Rho = this->Sums;
  this->Length = this->Sums;
  for (int iteration = 0; iteration < iterations; ++iteration)
  {
    // q = A p, alpha = rho / p . q
    this->SumBlocks(k,
      [&](Index i, double* sums)
      {
        double* qi = q + i * k;
        std::fill(qi, qi + k, 0.0);
        for (Index slot = outer[i]; slot < outer[i + 1]; ++slot)
        {
          const double* pj = p + inner[slot] * k;
          for (int c = 0; c < k; ++c)
          {
            qi[c] += a[slot] * pj[c];
          }
        }
        for (int c = 0; c < k; ++c)
        {
          sums[c] += p[i * k + c] * qi[c];
        }
      });
    for (int c = 0; c < k; ++c)
    {
      // No step where only round-off resists it: it has no bounds.
      const bool resolved = this->Sums[c] > ResolvedShare * this->Length[c];
      this->Factor[c] = resolved ? this->Rho[c] / this->Sums[c] : 0.0;
    }
    // x += alpha p, r -= alpha q
    this->SumBlocks(k,
      [&](Index i, double* sums)
      {
        for (int c = 0; c < k; ++c)
        {
          u[i * k + c] += this->Factor[c] * p[i * k + c];
          const double ri = r[i * k + c] - this->Factor[c] * q[i * k + c];
          r[i * k + c] = ri;
          sums[c] += ri * this->InverseDiagonal[i] * ri;
        }
      });
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
    ForEach(this->Parallel, static_cast<Index>(x.rows()),
      [&](Index i)
      {
        for (int c = 0; c < k; ++c)
        {
          p[i * k + c] = this->InverseDiagonal[i] * r[i * k + c] + this->Factor[c] * p[i * k + c];
        }
      });
  }
}

/// Sums = sum over the rows of what add(i, sums) adds.
template <typename Add>
void QuadraticDescent::SumBlocks(int columns, const Add& add)
{
  const Index n = static_cast<Index>(this->InverseDiagonal.size());
  ForEachBlock(this->Parallel, n,
    [&](Index block, Index begin, Index end)
    {
      double* sums = this->Partial.data() + static_cast<std::size_t>(block) * columns;
      std::fill(sums, sums + columns, 0.0);
      for (Index i = begin; i < end; ++i)
      {
        add(i, sums);
      }
    });
  std::fill(this->Sums.begin(), this->Sums.end(), 0.0);
  for (Index block = 0; block < NumberOfBlocks(n); ++block)
  {
    for (int c = 0; c < columns; ++c)
    {
      this->Sums[c] += this->Partial[static_cast<std::size_t>(block) * columns + c];
    }
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
    this->Sums.resize(columns);
    this->Partial.resize(NumberOfBlocks(static_cast<Index>(n)) * columns);
  }
}

} // namespace SurfaceDiffusion
