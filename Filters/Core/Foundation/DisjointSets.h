// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Core/Foundation/Types.h"

#include <algorithm>
#include <numeric>
#include <vector>

namespace SurfaceDiffusion
{

/// Union-find: disjoint sets of the numbers 0 .. count - 1, each represented by its smallest
/// member.
class DisjointSets
{
public:
  explicit DisjointSets(Index count)
    : Parent(count)
  {
    std::iota(this->Parent.begin(), this->Parent.end(), 0);
  }

  /// The smallest member of the set of i, with path halving.
  Index Find(Index i)
  {
    while (this->Parent[i] != i)
    {
      i = this->Parent[i] = this->Parent[this->Parent[i]];
    }
    return i;
  }

  void Join(Index i, Index j)
  {
    i = this->Find(i);
    j = this->Find(j);
    this->Parent[std::max(i, j)] = std::min(i, j);
  }

  /// The number of the set of each member. Sets are numbered in the order of their smallest
  /// members.
  std::vector<Index> Labels()
  {
    const auto count = static_cast<Index>(this->Parent.size());
    std::vector<Index> label(count);
    Index sets = 0;
    for (Index i = 0; i < count; ++i)
    {
      const Index smallest = this->Find(i);
      label[i] = smallest == i ? sets++ : label[smallest];
    }
    return label;
  }

private:
  std::vector<Index> Parent;
};

} // namespace SurfaceDiffusion
