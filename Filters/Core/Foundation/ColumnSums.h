// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Core/Foundation/Columns.h"
#include "Core/Foundation/Reduction.h"

#include <algorithm>
#include <vector>

namespace SurfaceDiffusion
{

/// totals[k] = the sum of f(i, k) over the rows i, for every column k: the bits of Sum(), in one
/// pass over the rows of each panel of columns.
template <typename F>
void SumColumns(
  const ParallelFor& parallel, Index rows, Eigen::Index columns, const F& f, double* totals)
{
  std::fill_n(totals, columns, 0.0);
  constexpr Index blocks = 256; // partial sums on the stack, so that time steps do not allocate
  for (Eigen::Index panel = 0; panel < columns; panel += ColumnPanel)
  {
    const Eigen::Index width = std::min<Eigen::Index>(ColumnPanel, columns - panel);
    for (Index first = 0; first < rows; first += blocks * BlockSize)
    {
      double partial[blocks * ColumnPanel];
      const Index chunk = std::min(rows - first, blocks * BlockSize);
      ForEachBlock(parallel, chunk,
        [&](Index block, Index begin, Index end)
        {
          ForColumns(width,
            [&](auto number)
            {
              const ColumnCount<decltype(number)::value> k(width);
              double sums[ColumnPanel] = {};
              for (Index i = first + begin; i < first + end; ++i)
              {
                for (int c = 0; c < k; ++c)
                {
                  sums[c] += f(i, panel + c);
                }
              }
              std::copy_n(sums, width, partial + static_cast<std::ptrdiff_t>(block) * ColumnPanel);
            });
        });
      for (Index block = 0; block < NumberOfBlocks(chunk); ++block)
      {
        for (Eigen::Index c = 0; c < width; ++c)
        {
          totals[panel + c] += partial[static_cast<std::ptrdiff_t>(block) * ColumnPanel + c];
        }
      }
    }
  }
}

/// Sums over the rows of several columns, in the fixed order of blocks, without allocations.
class ColumnSums
{
public:
  /// Make room for `width` sums over `rows` rows.
  void Resize(Index rows, int width)
  {
    this->Total.assign(width, 0.0);
    this->Partial.assign(static_cast<std::size_t>(NumberOfBlocks(rows)) * width, 0.0);
  }

  /// For every row i, add(i, sums) adds to K sums, or to `columns` of them if K is 0. Before,
  /// first(begin, end) runs on all rows of a block, whose results are then in the cache.
  template <int K, typename First, typename Add>
  void Run(const ParallelFor& parallel, Index rows, int columns, const First& first, const Add& add)
  {
    const ColumnCount<K> width(columns);
    ForEachBlock(parallel, rows,
      [&](Index block, Index begin, Index end)
      {
        first(begin, end);
        double* partial = this->Partial.data() + static_cast<std::size_t>(block) * width;
        ColumnRegisters<double, K> registers;
        double* sums = registers.Or(partial);
        std::fill(sums, sums + width, 0.0);
        for (Index i = begin; i < end; ++i)
        {
          add(i, sums);
        }
        std::copy(sums, sums + width, partial);
      });
    std::fill(this->Total.begin(), this->Total.end(), 0.0);
    for (Index block = 0; block < NumberOfBlocks(rows); ++block)
    {
      for (int s = 0; s < width; ++s)
      {
        this->Total[s] += this->Partial[static_cast<std::size_t>(block) * width + s];
      }
    }
  }

  template <int K, typename Add>
  void Run(const ParallelFor& parallel, Index rows, int columns, const Add& add)
  {
    this->Run<K>(
      parallel, rows, columns, [](Index, Index) {}, add);
  }

  /// The totals become those over the processes.
  void Reduce(const Reduction& reduction)
  {
    reduction.Sum(this->Total.data(), static_cast<Index>(this->Total.size()));
  }

  double operator[](std::size_t sum) const { return this->Total[sum]; }
  const std::vector<double>& Totals() const { return this->Total; }

private:
  std::vector<double> Total, Partial;
};

} // namespace SurfaceDiffusion
