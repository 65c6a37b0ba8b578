// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Operators/ResidualSquares.h"

#include "Core/Foundation/Columns.h"

namespace SurfaceDiffusion
{

namespace
{

/// Row i of matrix x, K columns of it.
template <int K>
void MultiplyRow(const SparseMatrix& matrix, const double* x, Index i, double* sum)
{
  const Index* const inner = matrix.innerIndexPtr();
  const double* const a = matrix.valuePtr();
  for (int k = 0; k < K; ++k)
  {
    sum[k] = 0.0;
  }
  const Index last = matrix.outerIndexPtr()[i + 1];
  for (Index slot = matrix.outerIndexPtr()[i]; slot < last; ++slot)
  {
    const double* const xj = x + static_cast<std::ptrdiff_t>(inner[slot]) * K;
    for (int k = 0; k < K; ++k)
    {
      sum[k] += a[slot] * xj[k];
    }
  }
}

/// The squares of ResidualSquares() over rows [begin, end).
template <int K>
void AddSquares(const SparseMatrix& matrix, const double* b, const double* x, const double* w,
  Index begin, Index end, double* squares)
{
  double ofR[K] = {};
  double ofB[K] = {};
  for (Index i = begin; i < end; ++i)
  {
    double product[K];
    MultiplyRow<K>(matrix, x, i, product);
    const double* const bi = b + static_cast<std::ptrdiff_t>(i) * K;
    for (int k = 0; k < K; ++k)
    {
      const double r = bi[k] - product[k];
      ofR[k] += w[i] * r * r;
      ofB[k] += w[i] * bi[k] * bi[k];
    }
  }
  for (int k = 0; k < K; ++k)
  {
    squares[2 * k] = ofR[k];
    squares[2 * k + 1] = ofB[k];
  }
}

void AddSquaresOfAny(const SparseMatrix& matrix, const Values& b, const Values& x, const Vector& w,
  Index begin, Index end, double* squares)
{
  for (Index i = begin; i < end; ++i)
  {
    for (Eigen::Index k = 0; k < b.cols(); ++k)
    {
      double product = 0.0;
      for (SparseMatrix::InnerIterator a(matrix, i); a; ++a)
      {
        product += a.value() * x(a.index(), k);
      }
      const double r = b(i, k) - product;
      squares[2 * k] += w[i] * r * r;
      squares[2 * k + 1] += w[i] * b(i, k) * b(i, k);
    }
  }
}

// An attribute of a template is not portable: a function of its own.
SURFACEDIFFUSION_ANY_VECTORS void AddSquaresOfPanel(const SparseMatrix& matrix, const double* b,
  const double* x, const double* w, Index begin, Index end, double* squares)
{
  AddSquares<ColumnPanel>(matrix, b, x, w, begin, end, squares);
}

} // namespace

void ResidualSquares(const SparseMatrix& matrix, const Values& b, const Values& x, const Vector& w,
  std::vector<double>& squares, const ParallelFor& parallel)
{
  const auto rows = static_cast<Index>(b.rows());
  const std::size_t width = 2 * static_cast<std::size_t>(b.cols());
  squares.assign(width * static_cast<std::size_t>(1 + NumberOfBlocks(rows)), 0.0);
  ForEachBlock(parallel, rows,
    [&](Index block, Index begin, Index end)
    {
      double* const sums = squares.data() + static_cast<std::size_t>(1 + block) * width;
      ForColumns(b.cols(),
        [&](auto number)
        {
          constexpr int k = decltype(number)::value;
          if constexpr (k == ColumnPanel)
          {
            AddSquaresOfPanel(matrix, b.data(), x.data(), w.data(), begin, end, sums);
          }
          else if constexpr (k > 0)
          {
            AddSquares<k>(matrix, b.data(), x.data(), w.data(), begin, end, sums);
          }
          else
          {
            AddSquaresOfAny(matrix, b, x, w, begin, end, sums);
          }
        });
    });
  for (std::size_t s = width; s < squares.size(); ++s)
  {
    squares[s % width] += squares[s];
  }
}

} // namespace SurfaceDiffusion
