// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Core/Foundation/Buffer.h"
#include "Core/Foundation/Parallel.h"
#include "Core/Foundation/Types.h"

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace SurfaceDiffusion
{

/// Sort the items 0 .. count - 1 by digit(item) in 0 .. digits - 1, items of the same digit in
/// their order: calls move(item, place) for each. Returns the first place of every digit, and
/// count. Chunks of the items are counted and moved independently of each other.
template <typename Digit, typename Move>
std::vector<Index> DistributeByDigit(
  Index count, Index digits, const ParallelFor& parallel, const Digit& digit, const Move& move)
{
  constexpr Index smallestChunk = 32768;
  constexpr Index mostChunks = 64;
  const Index chunks = std::max(Index(1), std::min(count / smallestChunk, mostChunks));
  const auto chunkBegin = [&](Index chunk)
  { return static_cast<Index>(static_cast<std::int64_t>(count) * chunk / chunks); };
  std::vector<Index> places(static_cast<std::size_t>(chunks) * digits, 0);
  const auto placesOf = [&](Index chunk)
  { return places.data() + static_cast<std::size_t>(chunk) * digits; };

  ForEachTask(parallel, chunks,
    [&](Index chunk)
    {
      Index* const counts = placesOf(chunk);
      for (Index i = chunkBegin(chunk); i < chunkBegin(chunk + 1); ++i)
      {
        ++counts[digit(i)];
      }
    });
  std::vector<Index> begin(digits + 1);
  Index sum = 0;
  for (Index d = 0; d < digits; ++d)
  {
    begin[d] = sum;
    for (Index chunk = 0; chunk < chunks; ++chunk)
    {
      Index& place = placesOf(chunk)[d];
      const Index next = sum + place;
      place = sum;
      sum = next;
    }
  }
  begin[digits] = sum;
  ForEachTask(parallel, chunks,
    [&](Index chunk)
    {
      Index* const place = placesOf(chunk);
      for (Index i = chunkBegin(chunk); i < chunkBegin(chunk + 1); ++i)
      {
        move(i, place[digit(i)]++);
      }
    });
  return begin;
}

/// Items sorted by a key: those of key k are Items[Begin[k]] .. Items[Begin[k + 1] - 1], ascending.
struct Groups
{
  std::vector<Index> Begin;
  Buffer<Index> Items;
};

/// The items 0 .. count - 1 sorted by key(item) in 0 .. keys - 1: first by ranges of keys, and then
/// each range by itself, which fits into the cache.
template <typename KeyOf>
Groups GroupByKey(Index count, Index keys, const ParallelFor& parallel, const KeyOf& key)
{
  constexpr Index mostRanges = 1024;
  int shift = 0;
  while ((keys - 1) >> shift >= mostRanges)
  {
    ++shift;
  }
  const Index ranges = keys > 0 ? ((keys - 1) >> shift) + 1 : 0;
  struct Entry
  {
    Index Key, Item;
  };
  Buffer<Entry> sorted(count);
  const std::vector<Index> rangeBegin = DistributeByDigit(
    count, ranges, parallel, [&](Index i) { return key(i) >> shift; },
    [&](Index i, Index place) {
      sorted[place] = { key(i), i };
    });

  Groups groups{ std::vector<Index>(keys + 1), Buffer<Index>(count) };
  groups.Begin[keys] = count;
  ForEachTask(parallel, ranges,
    [&](Index range)
    {
      const Index firstKey = range << shift;
      const Index endKey = std::min(keys, (range + 1) << shift);
      std::vector<Index> next(endKey - firstKey, 0);
      for (Index e = rangeBegin[range]; e < rangeBegin[range + 1]; ++e)
      {
        ++next[sorted[e].Key - firstKey];
      }
      Index sum = rangeBegin[range];
      for (Index k = firstKey; k < endKey; ++k)
      {
        groups.Begin[k] = sum;
        sum += next[k - firstKey];
        next[k - firstKey] = groups.Begin[k];
      }
      for (Index e = rangeBegin[range]; e < rangeBegin[range + 1]; ++e)
      {
        groups.Items[next[sorted[e].Key - firstKey]++] = sorted[e].Item;
      }
    });
  return groups;
}

/// The items of 0 .. count - 1 for which holds(item), ascending. It is called twice for each.
template <typename Holds>
Buffer<Index> ListWhere(Index count, const ParallelFor& parallel, const Holds& holds)
{
  std::vector<Index> begin(NumberOfBlocks(count) + 1, 0);
  ForEachBlock(parallel, count,
    [&](Index block, Index first, Index last)
    {
      Index number = 0;
      for (Index i = first; i < last; ++i)
      {
        number += holds(i) ? 1 : 0;
      }
      begin[block + 1] = number;
    });
  for (std::size_t block = 1; block < begin.size(); ++block)
  {
    begin[block] += begin[block - 1];
  }
  Buffer<Index> items(begin.back());
  ForEachBlock(parallel, count,
    [&](Index block, Index first, Index last)
    {
      Index place = begin[block];
      for (Index i = first; i < last; ++i)
      {
        if (holds(i))
        {
          items[place++] = i;
        }
      }
    });
  return items;
}

} // namespace SurfaceDiffusion
