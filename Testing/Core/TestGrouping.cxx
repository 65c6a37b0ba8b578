// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Foundation/DisjointSets.h"
#include "Core/Foundation/Grouping.h"
#include "Core/Foundation/ThreadPool.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdint>
#include <numeric>
#include <vector>

using namespace SurfaceDiffusion;

namespace
{

/// Between 0 and keys - 1, without an order.
Index KeyOf(Index item, Index keys)
{
  return static_cast<Index>(static_cast<std::uint64_t>(item) * 2654435761U % 4294967291U %
    static_cast<std::uint64_t>(keys));
}

std::vector<Index> StablySorted(Index count, Index keys)
{
  std::vector<Index> items(static_cast<std::size_t>(count));
  std::iota(items.begin(), items.end(), 0);
  std::stable_sort(
    items.begin(), items.end(), [&](Index i, Index j) { return KeyOf(i, keys) < KeyOf(j, keys); });
  return items;
}

} // namespace

TEST(Grouping, SortsItemsByKeyLikeAStableSort)
{
  const ThreadPool pool(4);
  for (const Index count : { 0, 1, 1000, 200000 })
  {
    for (const Index keys : { 1, 7, 1024, 1025, 300000 })
    {
      const auto key = [&](Index item) { return KeyOf(item, keys); };
      const Groups groups = GroupByKey(count, keys, pool, key);
      EXPECT_EQ(
        std::vector<Index>(groups.Items.begin(), groups.Items.end()), StablySorted(count, keys));
      std::vector<Index> begin(static_cast<std::size_t>(keys) + 1, 0);
      for (Index i = 0; i < count; ++i)
      {
        ++begin[static_cast<std::size_t>(key(i)) + 1];
      }
      std::partial_sum(begin.begin(), begin.end(), begin.begin());
      EXPECT_EQ(groups.Begin, begin);
    }
  }
}

TEST(Grouping, ListsWhatHoldsInItsOrder)
{
  const ThreadPool pool(4);
  for (const Index count : { 0, 1, 50000 })
  {
    const auto holds = [](Index i) { return KeyOf(i, 3) == 1; };
    const Buffer<Index> listed = ListWhere(count, pool, holds);
    std::vector<Index> expected;
    for (Index i = 0; i < count; ++i)
    {
      if (holds(i))
      {
        expected.push_back(i);
      }
    }
    EXPECT_EQ(std::vector<Index>(listed.begin(), listed.end()), expected);
  }
}

/// Chains whose links are joined in no order, on four threads.
TEST(DisjointSets, DoNotDependOnTheOrderInWhichThreadsJoinThem)
{
  const ThreadPool pool(4);
  constexpr Index count = 100000;
  constexpr Index chains = 7; // member i is in chain i % chains
  std::vector<Index> expected(count);
  for (Index i = 0; i < count; ++i)
  {
    expected[i] = i % chains;
  }
  for (int repetition = 0; repetition < 10; ++repetition)
  {
    DisjointSets sets(count);
    ForEach(pool, count,
      [&](Index k)
      {
        const auto i = static_cast<Index>(7919LL * k % count);
        if (i >= chains)
        {
          sets.Join(i, i - chains);
        }
      });
    EXPECT_EQ(sets.Labels(pool), expected);
    EXPECT_EQ(sets.Find(chains), 0);
  }
}
