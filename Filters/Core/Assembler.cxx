// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Assembler.h"

#include <algorithm>

namespace SurfaceDiffusion
{

Assembler::Assembler(
  std::shared_ptr<const TriangleMesh> mesh, const ParallelFor& parallel, const Monitor& monitor)
  : Surface(std::move(mesh))
{
  const TriangleMesh& m = *this->Surface;
  const Index n = m.NumberOfVertices();
  const auto& begin = m.VertexCornersBegin();
  const auto& corners = m.VertexCorners();

  const auto listRow = [&](Index i, std::vector<Index>& row)
  {
    row.assign(1, i);
    for (Index c = begin[i]; c < begin[i + 1]; ++c)
    {
      const Index t = corners[c] / 3;
      const int a = corners[c] % 3;
      row.push_back(m.TriangleVertices()(t, (a + 1) % 3));
      row.push_back(m.TriangleVertices()(t, (a + 2) % 3));
    }
    std::sort(row.begin(), row.end());
    row.erase(std::unique(row.begin(), row.end()), row.end());
  };

  std::vector<Index> outer(n + 1, 0);
  ForEachBlock(parallel, n,
    [&](Index, Index first, Index last)
    {
      std::vector<Index> row;
      for (Index i = first; i < last; ++i)
      {
        listRow(i, row);
        outer[i + 1] = static_cast<Index>(row.size());
      }
    });
  monitor.Report(0.4);
  for (Index i = 0; i < n; ++i)
  {
    outer[i + 1] += outer[i];
  }

  this->Empty.resize(n, n);
  this->Empty.resizeNonZeros(outer[n]);
  std::copy(outer.begin(), outer.end(), this->Empty.outerIndexPtr());
  std::fill_n(this->Empty.valuePtr(), outer[n], 0.0);
  this->SlotMap.resize(corners.size());
  this->DiagonalSlot.resize(n);
  ForEachBlock(parallel, n,
    [&](Index, Index first, Index last)
    {
      std::vector<Index> row;
      for (Index i = first; i < last; ++i)
      {
        listRow(i, row);
        std::copy(row.begin(), row.end(), this->Empty.innerIndexPtr() + outer[i]);
        const auto slotOf = [&](Index j)
        {
          return outer[i] +
            static_cast<Index>(std::lower_bound(row.begin(), row.end(), j) - row.begin());
        };
        this->DiagonalSlot[i] = slotOf(i);
        for (Index c = begin[i]; c < begin[i + 1]; ++c)
        {
          const Index t = corners[c] / 3;
          const int a = corners[c] % 3;
          this->SlotMap[c] = { slotOf(m.TriangleVertices()(t, (a + 1) % 3)),
            slotOf(m.TriangleVertices()(t, (a + 2) % 3)) };
        }
      }
    });
  monitor.Report(1.0);
}

void Assembler::Fill(SparseMatrix& matrix, const Eigen::Ref<const Vector>& diagonal, double scale,
  const EdgeValues& coefficients, const double* weights, const ParallelFor& parallel,
  const EdgeValues* signs) const
{
  const auto& begin = this->Surface->VertexCornersBegin();
  const auto& corners = this->Surface->VertexCorners();
  const Index* outer = matrix.outerIndexPtr();
  double* values = matrix.valuePtr();
  ForEach(parallel, this->Surface->NumberOfVertices(),
    [&](Index i)
    {
      std::fill(values + outer[i], values + outer[i + 1], 0.0);
      double onDiagonal = 0.0;
      for (Index c = begin[i]; c < begin[i + 1]; ++c)
      {
        const Index t = corners[c] / 3;
        const int a = corners[c] % 3;
        const double factor = weights ? scale * weights[t] : scale;
        const double toNext = factor * coefficients(t, (a + 2) % 3); // edge opposite the last
        const double toLast = factor * coefficients(t, (a + 1) % 3);
        values[this->SlotMap[c].Next] -= signs ? (*signs)(t, (a + 2) % 3) * toNext : toNext;
        values[this->SlotMap[c].Last] -= signs ? (*signs)(t, (a + 1) % 3) * toLast : toLast;
        onDiagonal += toNext + toLast;
      }
      values[this->DiagonalSlot[i]] += diagonal[i] + onDiagonal; // edges from i to i cancel
    });
}

void Assembler::Constrain(SparseMatrix& matrix, const Flags& fixed, const Values& values,
  Values& load, const ParallelFor& parallel) const
{
  const Index* outer = matrix.outerIndexPtr();
  const Index* inner = matrix.innerIndexPtr();
  double* a = matrix.valuePtr();
  ForEach(parallel, this->Surface->NumberOfVertices(),
    [&](Index i)
    {
      load.row(i).setZero();
      if (fixed[i])
      {
        load.row(i) = a[this->DiagonalSlot[i]] * values.row(i);
      }
      for (Index slot = outer[i]; slot < outer[i + 1]; ++slot)
      {
        const Index j = inner[slot];
        if (j != i && (fixed[i] || fixed[j]))
        {
          if (!fixed[i])
          {
            load.row(i) -= a[slot] * values.row(j);
          }
          a[slot] = 0.0;
        }
      }
    });
}

namespace
{

/// Columns known to the compiler: the sums stay in registers.
template <int K>
void MultiplyColumns(
  const SparseMatrix& matrix, const Values& x, Values& y, const ParallelFor& parallel)
{
  const Index* outer = matrix.outerIndexPtr();
  const Index* inner = matrix.innerIndexPtr();
  const double* a = matrix.valuePtr();
  const double* in = x.data();
  double* out = y.data();
  ForEach(parallel, static_cast<Index>(matrix.rows()),
    [&](Index i)
    {
      double sum[K] = {};
      for (Index slot = outer[i]; slot < outer[i + 1]; ++slot)
      {
        const double* xj = in + static_cast<std::ptrdiff_t>(inner[slot]) * K;
        for (int k = 0; k < K; ++k)
        {
          sum[k] += a[slot] * xj[k];
        }
      }
      std::copy(sum, sum + K, out + static_cast<std::ptrdiff_t>(i) * K);
    });
}

} // namespace

void Multiply(const SparseMatrix& matrix, const Values& x, Values& y, const ParallelFor& parallel)
{
  switch (x.cols())
  {
    case 1:
      return MultiplyColumns<1>(matrix, x, y, parallel);
    case 2:
      return MultiplyColumns<2>(matrix, x, y, parallel);
    case 3:
      return MultiplyColumns<3>(matrix, x, y, parallel);
    default:
      break;
  }
  const Index* outer = matrix.outerIndexPtr();
  const Index* inner = matrix.innerIndexPtr();
  const double* a = matrix.valuePtr();
  ForEach(parallel, static_cast<Index>(matrix.rows()),
    [&](Index i)
    {
      y.row(i).setZero();
      for (Index slot = outer[i]; slot < outer[i + 1]; ++slot)
      {
        y.row(i) += a[slot] * x.row(inner[slot]);
      }
    });
}

} // namespace SurfaceDiffusion
