// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Operators/SparseProduct.h"

#include "Core/Foundation/Columns.h"

namespace SurfaceDiffusion
{

template <int K>
void MultiplyRows(const SparseMatrix& matrix, const Values& x, Values& y, Index begin, Index end)
{
  const Index* outer = matrix.outerIndexPtr();
  const Index* inner = matrix.innerIndexPtr();
  const double* a = matrix.valuePtr();
  if constexpr (K == 0)
  {
    for (Index i = begin; i < end; ++i)
    {
      y.row(i).setZero();
      for (Index slot = outer[i]; slot < outer[i + 1]; ++slot)
      {
        y.row(i) += a[slot] * x.row(inner[slot]);
      }
    }
  }
  else
  {
    const double* in = x.data();
    double* out = y.data();
    for (Index i = begin; i < end; ++i)
    {
      double sum[K] = {};
      const Index last = outer[i + 1];
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
}

template void MultiplyRows<0>(const SparseMatrix&, const Values&, Values&, Index, Index);
template void MultiplyRows<1>(const SparseMatrix&, const Values&, Values&, Index, Index);
template void MultiplyRows<2>(const SparseMatrix&, const Values&, Values&, Index, Index);
template void MultiplyRows<3>(const SparseMatrix&, const Values&, Values&, Index, Index);
template void MultiplyRows<HalfPanel>(const SparseMatrix&, const Values&, Values&, Index, Index);
template void MultiplyRows<ColumnPanel>(const SparseMatrix&, const Values&, Values&, Index, Index);

} // namespace SurfaceDiffusion
