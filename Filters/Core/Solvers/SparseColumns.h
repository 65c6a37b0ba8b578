// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Core/Foundation/IndexSet.h"
#include "Core/Foundation/Parallel.h"
#include "Core/Foundation/Types.h"

#include <algorithm>
#include <vector>

namespace SurfaceDiffusion
{

/// A sparse vector, to whose entries numbers are added in any order.
class SparseColumn
{
public:
  void Clear()
  {
    this->Rows.Clear();
    this->Numbers.clear();
  }

  void Add(Index row, double value)
  {
    const Index entry = this->Rows.Insert(row);
    if (entry == static_cast<Index>(this->Numbers.size()))
    {
      this->Numbers.push_back(value);
      return;
    }
    this->Numbers[entry] += value;
  }

  /// Append the entries to `rows` and `values`, sorted by row, and return their number.
  Index AppendTo(std::vector<Index>& rows, std::vector<double>& values)
  {
    this->Rows.Rank(this->Places);
    const std::size_t first = rows.size();
    rows.resize(first + this->Numbers.size());
    values.resize(first + this->Numbers.size());
    for (Index k = 0; k < this->Rows.Size(); ++k)
    {
      rows[first + this->Places[k]] = this->Rows[k];
      values[first + this->Places[k]] = this->Numbers[k];
    }
    return this->Rows.Size();
  }

private:
  IndexSet Rows;
  std::vector<double> Numbers;
  std::vector<Index> Places; ///< in the order of rows
};

/// The matrix whose column j holds what collect(j, column) adds to it.
template <typename Collect>
SparseMatrix CollectColumns(
  Index rows, Index columns, const ParallelFor& parallel, const Collect& collect)
{
  SparseMatrix matrix(rows, columns);
  Index* outer = matrix.outerIndexPtr();
  struct Block
  {
    std::vector<Index> Rows;
    std::vector<double> Values;
  };
  std::vector<Block> blocks(NumberOfBlocks(columns));
  ForEachBlock(parallel, columns,
    [&](Index block, Index begin, Index end)
    {
      SparseColumn column;
      Block& collected = blocks[block];
      for (Index j = begin; j < end; ++j)
      {
        column.Clear();
        collect(j, column);
        outer[j + 1] = column.AppendTo(collected.Rows, collected.Values);
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
      const Block& collected = blocks[block];
      std::copy(
        collected.Rows.begin(), collected.Rows.end(), matrix.innerIndexPtr() + outer[begin]);
      std::copy(collected.Values.begin(), collected.Values.end(), matrix.valuePtr() + outer[begin]);
    });
  return matrix;
}

} // namespace SurfaceDiffusion
