// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Core/Foundation/Grouping.h"
#include "Core/Foundation/Parallel.h"
#include "Core/Foundation/Types.h"

#include <atomic>
#include <utility>
#include <vector>

namespace SurfaceDiffusion
{

/// Union-find: disjoint sets of the numbers 0 .. count - 1, each represented by its smallest
/// member. Several threads may join sets at the same time: the sets do not depend on the order.
class DisjointSets
{
public:
  explicit DisjointSets(Index count)
    : Parent(count)
  {
    for (Index i = 0; i < count; ++i)
    {
      this->Parent[i].store(i, std::memory_order_relaxed);
    }
  }

  /// The smallest member of the set of i, with path halving: what another thread writes in between
  /// is an ancestor, too.
  Index Find(Index i)
  {
    Index parent = this->ParentOf(i);
    while (parent != i)
    {
      const Index next = this->ParentOf(parent);
      this->Parent[i].store(next, std::memory_order_relaxed);
      i = next;
      parent = this->ParentOf(i);
    }
    return i;
  }

  void Join(Index i, Index j)
  {
    while (true)
    {
      i = this->Find(i);
      j = this->Find(j);
      if (i == j)
      {
        return;
      }
      if (i < j)
      {
        std::swap(i, j);
      }
      Index root = i; // unless another thread has joined it
      if (this->Parent[i].compare_exchange_strong(root, j, std::memory_order_relaxed))
      {
        return;
      }
    }
  }

  /// The number of the set of each member. Sets are numbered in the order of their smallest
  /// members.
  std::vector<Index> Labels(const ParallelFor& parallel = SerialFor())
  {
    const auto count = static_cast<Index>(this->Parent.size());
    std::vector<Index> label(count);
    const Buffer<Index> smallest =
      ListWhere(count, parallel, [&](Index i) { return this->ParentOf(i) == i; });
    ForEach(parallel, static_cast<Index>(smallest.size()),
      [&](Index set) { label[smallest[set]] = set; });
    ForEach(parallel, count,
      [&](Index i)
      {
        const Index root = this->Find(i);
        if (root != i)
        {
          label[i] = label[root];
        }
      });
    return label;
  }

private:
  Index ParentOf(Index i) const { return this->Parent[i].load(std::memory_order_relaxed); }

  std::vector<std::atomic<Index>> Parent;
};

} // namespace SurfaceDiffusion
