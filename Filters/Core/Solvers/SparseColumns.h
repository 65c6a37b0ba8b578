// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Core/Foundation/IndexSet.h"
#include "Core/Foundation/Parallel.h"
#include "Core/Foundation/Types.h"

#include <algorithm>
#include <cstdint>
#include <type_traits>
#include <utility>
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

  /// Returns the number of the entry, in the order of first appearance.
  Index Add(Index row, double value)
  {
    const Index entry = this->Rows.Insert(row);
    if (entry == static_cast<Index>(this->Numbers.size()))
    {
      this->Numbers.push_back(value);
      return entry;
    }
    this->Numbers[entry] += value;
    return entry;
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

  /// Per entry, how many have a smaller row; after AppendTo().
  const std::vector<Index>& Ranks() const { return this->Places; }

private:
  IndexSet Rows;
  std::vector<double> Numbers;
  std::vector<Index> Places; ///< in the order of rows
};

/// For every Add() that made a matrix, the place of its entry in the column, in blocks of columns.
/// Other values of the same pattern are then collected without a search.
using CollectedPlaces = std::vector<std::vector<std::uint16_t>>;
constexpr std::size_t MostCollectedRows = 65536; ///< of a column whose places can be kept

/// A column that also notes the entry of every Add().
class NotedColumn
{
public:
  void Clear()
  {
    this->Column.Clear();
    this->Entries.clear();
  }

  void Add(Index row, double value) { this->Entries.push_back(this->Column.Add(row, value)); }

  Index AppendTo(std::vector<Index>& rows, std::vector<double>& values)
  {
    return this->Column.AppendTo(rows, values);
  }

  /// False if the column has too many rows.
  bool AppendTo(std::vector<std::uint16_t>& places) const
  {
    const std::vector<Index>& ranks = this->Column.Ranks();
    for (const Index entry : this->Entries)
    {
      places.push_back(static_cast<std::uint16_t>(ranks[entry]));
    }
    return ranks.size() <= MostCollectedRows;
  }

private:
  SparseColumn Column;
  std::vector<Index> Entries;
};

/// A column of known pattern, to which the same rows are added in the same order as before.
class KnownColumn
{
public:
  KnownColumn(double* values, const std::uint16_t* places)
    : Values(values)
    , Places(places)
  {
  }

  void Add(Index /*row*/, double value) { this->Values[*this->Places++] += value; }
  const std::uint16_t* Rest() const { return this->Places; }

private:
  double* Values;
  const std::uint16_t* Places;
};

/// The matrix whose column j holds what collect(j, column) adds to it. Column: SparseColumn, or
/// NotedColumn to keep the places, which are left empty if a column has too many rows.
template <typename Column, typename Collect>
SparseMatrix CollectColumns(Index rows, Index columns, const ParallelFor& parallel,
  const Collect& collect, CollectedPlaces& places)
{
  constexpr bool keepsPlaces = std::is_same<Column, NotedColumn>::value;
  SparseMatrix matrix(rows, columns);
  Index* outer = matrix.outerIndexPtr();
  struct Block
  {
    std::vector<Index> Rows;
    std::vector<double> Values;
    bool HasPlaces = true;
  };
  std::vector<Block> blocks(NumberOfBlocks(columns));
  places.assign(keepsPlaces ? blocks.size() : 0, {});
  ForEachBlock(parallel, columns,
    [&](Index block, Index begin, Index end)
    {
      Column column;
      Block& collected = blocks[block];
      for (Index j = begin; j < end; ++j)
      {
        column.Clear();
        collect(j, column);
        outer[j + 1] = column.AppendTo(collected.Rows, collected.Values);
        if constexpr (keepsPlaces)
        {
          collected.HasPlaces = column.AppendTo(places[block]) && collected.HasPlaces;
        }
      }
      if constexpr (keepsPlaces)
      {
        places[block].shrink_to_fit();
      }
    });
  if (!std::all_of(
        blocks.begin(), blocks.end(), [](const Block& block) { return block.HasPlaces; }))
  {
    places.clear();
  }
  for (Index j = 0; j < columns; ++j)
  {
    outer[j + 1] += outer[j];
  }
  matrix.resizeNonZeros(outer[columns]);
  ForEachBlock(parallel, columns,
    [&](Index block, Index begin, Index)
    {
      const Block collected = std::move(blocks[block]);
      std::copy(
        collected.Rows.begin(), collected.Rows.end(), matrix.innerIndexPtr() + outer[begin]);
      std::copy(collected.Values.begin(), collected.Values.end(), matrix.valuePtr() + outer[begin]);
    });
  return matrix;
}

template <typename Collect>
SparseMatrix CollectColumns(
  Index rows, Index columns, const ParallelFor& parallel, const Collect& collect)
{
  CollectedPlaces none;
  return CollectColumns<SparseColumn>(rows, columns, parallel, collect, none);
}

/// The values of a matrix that CollectColumns() has made with NotedColumn, from a collect() that
/// adds other numbers to the same rows in the same order.
template <typename Collect>
void CollectAgain(SparseMatrix& matrix, const CollectedPlaces& places, const ParallelFor& parallel,
  const Collect& collect)
{
  const Index* outer = matrix.outerIndexPtr();
  double* values = matrix.valuePtr();
  ForEachBlock(parallel, static_cast<Index>(matrix.cols()),
    [&](Index block, Index begin, Index end)
    {
      std::fill(values + outer[begin], values + outer[end], 0.0);
      const std::uint16_t* next = places[block].data();
      for (Index j = begin; j < end; ++j)
      {
        KnownColumn column(values + outer[j], next);
        collect(j, column);
        next = column.Rest();
      }
    });
}

} // namespace SurfaceDiffusion
