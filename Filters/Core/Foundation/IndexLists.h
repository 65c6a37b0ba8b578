// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Core/Foundation/Offsets.h"
#include "Core/Foundation/Parallel.h"

#include <algorithm>
#include <cstddef>
#include <vector>

namespace SurfaceDiffusion
{

/// Lists of numbers, one list per row.
struct IndexLists
{
  std::vector<Offset> Begin; ///< list i is Entries[Begin[i]] .. Entries[Begin[i + 1]]
  std::vector<Index> Entries;
};

/// The lists 0 .. count - 1, of which append(i, entries) appends list i to `entries`.
template <typename Append>
IndexLists MakeLists(Index count, const ParallelFor& parallel, const Append& append)
{
  IndexLists lists;
  lists.Begin.assign(static_cast<std::size_t>(count) + 1, 0);
  std::vector<std::vector<Index>> blocks(NumberOfBlocks(count));
  ForEachBlock(parallel, count,
    [&](Index block, Index begin, Index end)
    {
      std::vector<Index>& entries = blocks[block];
      for (Index i = begin; i < end; ++i)
      {
        const std::size_t before = entries.size();
        append(i, entries);
        lists.Begin[i] = static_cast<Offset>(entries.size() - before);
      }
    });
  CountsToOffsets(lists.Begin);
  lists.Entries.resize(static_cast<std::size_t>(lists.Begin.back()));
  ForEachBlock(parallel, count,
    [&](Index block, Index begin, Index)
    {
      std::copy(
        blocks[block].begin(), blocks[block].end(), lists.Entries.begin() + lists.Begin[begin]);
    });
  return lists;
}

/// Sort the entries from `first` on, and keep one of those that are equal.
inline void SortUnique(std::vector<Index>& entries, std::size_t first)
{
  const auto begin = entries.begin() + static_cast<std::ptrdiff_t>(first);
  std::sort(begin, entries.end());
  entries.erase(std::unique(begin, entries.end()), entries.end());
}

} // namespace SurfaceDiffusion
