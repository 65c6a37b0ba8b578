// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Operators/SparseProduct.h"

#include "Core/Foundation/Columns.h"
#include "Core/Foundation/Prefetch.h"

namespace SurfaceDiffusion
{

namespace
{

/// Of one column: x stays in the cache, and asking for its entries takes longer than it saves.
constexpr Index LargestCached = 200000;

template <int K, bool AsksAhead>
void MultiplyRowsOf(const SparseMatrix& matrix, const Values& x, Values& y, Index begin, Index end)
{
  const Index* const outer = matrix.outerIndexPtr();
  const Index* const inner = matrix.innerIndexPtr();
  const double* const a = matrix.valuePtr();
  const Index size = outer[matrix.rows()];
  const double* const in = x.data();
  double* const out = y.data();
  for (Index i = begin; i < end; ++i)
  {
    double sum[K] = {};
    const Index last = outer[i + 1];
    if constexpr (AsksAhead)
    {
      PrefetchRow(in, inner, last, size, K);
    }
    for (Index slot = outer[i]; slot < last; ++slot)
    {
      const double* xj = in + static_cast<std::ptrdiff_t>(inner[slot]) * K;
      for (int k = 0; k < K; ++k)
      {
        sum[k] += a[slot] * xj[k];
      }
    }
    for (int k = 0; k < K; ++k)
    {
      out[static_cast<std::ptrdiff_t>(i) * K + k] = sum[k];
    }
  }
}

} // namespace

template <int K>
void MultiplyRows(const SparseMatrix& matrix, const Values& x, Values& y, Index begin, Index end)
{
  if constexpr (K == 0)
  {
    const Index* const outer = matrix.outerIndexPtr();
    const Index* const inner = matrix.innerIndexPtr();
    const double* const a = matrix.valuePtr();
    for (Index i = begin; i < end; ++i)
    {
      y.row(i).setZero();
      for (Index slot = outer[i]; slot < outer[i + 1]; ++slot)
      {
        y.row(i) += a[slot] * x.row(inner[slot]);
      }
    }
  }
  else if (K > 1 || x.rows() > LargestCached)
  {
    MultiplyRowsOf<K, true>(matrix, x, y, begin, end);
  }
  else
  {
    MultiplyRowsOf<K, false>(matrix, x, y, begin, end);
  }
}

template void MultiplyRows<0>(const SparseMatrix&, const Values&, Values&, Index, Index);
template void MultiplyRows<1>(const SparseMatrix&, const Values&, Values&, Index, Index);
template void MultiplyRows<2>(const SparseMatrix&, const Values&, Values&, Index, Index);
template void MultiplyRows<3>(const SparseMatrix&, const Values&, Values&, Index, Index);
template void MultiplyRows<HalfPanel>(const SparseMatrix&, const Values&, Values&, Index, Index);
template void MultiplyRows<ColumnPanel>(const SparseMatrix&, const Values&, Values&, Index, Index);

} // namespace SurfaceDiffusion
