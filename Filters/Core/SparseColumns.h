// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "IndexSet.h"
#include "Parallel.h"
#include "Types.h"

#include <algorithm>
#include <utility>
#include <vector>

namespace SurfaceDiffusion
{

/// A sparse vector to which numbers are added in any order.
class SparseColumn
{
public:
  void Clear()
  {
    this->Rows.Clear();
    this->Entries.clear();
  }

  void Add(Index row, double value)
  {
    const Index entry = this->Rows.Insert(row);
    if (entry == static_cast<Index>(this->Entries.size()))
    {
      this->Entries.emplace_back(row, value);
      return;
    }
    this->Entries[entry].second += value;
  }

  const std::vector<std::pair<Index, double>>& Numbers() const { return this->Entries; }

private:
  IndexSet Rows;
  std::vector<std::pair<Index, double>> Entries;
};

/// The matrix whose column j holds what collect(j, scratch, column) puts there. scratch, for work
/// on the way, is empty as column is.
template <typename Collect>
SparseMatrix CollectColumns(
  Index rows, Index columns, const ParallelFor& parallel, const Collect& collect)
{
  SparseMatrix matrix(rows, columns);
  Index* outer = matrix.outerIndexPtr();
  std::vector<std::vector<std::pair<Index, double>>> blocks(NumberOfBlocks(columns));
  ForEachBlock(parallel, columns,
    [&](Index block, Index begin, Index end)
    {
      SparseColumn column, scratch;
      std::vector<std::pair<Index, double>>& collected = blocks[block];
      for (Index j = begin; j < end; ++j)
      {
        column.Clear();
        scratch.Clear();
        collect(j, scratch, column);
        const auto first = static_cast<std::ptrdiff_t>(collected.size());
        collected.insert(collected.end(), column.Numbers().begin(), column.Numbers().end());
        std::sort(collected.begin() + first, collected.end(),
          [](const auto& a, const auto& b) { return a.first < b.first; });
        outer[j + 1] = static_cast<Index>(column.Numbers().size());
      }
    });
  for (Index j = 0; j < columns; ++j)
  {
    outer[j + 1] += outer[j];
  }
  matrix.resizeNonZeros(outer[columns]);
  ForEachBlock(parallel, columns,
    [&](Index block, Index begin, Index)
    {
      Index slot = outer[begin];
      for (const auto& [row, value] : blocks[block])
      {
        matrix.innerIndexPtr()[slot] = row;
        matrix.valuePtr()[slot] = value;
        ++slot;
      }
    });
  return matrix;
}

} // namespace SurfaceDiffusion
