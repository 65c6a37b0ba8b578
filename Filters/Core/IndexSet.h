// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Types.h"

#include <algorithm>
#include <vector>

namespace SurfaceDiffusion
{

/// Numbers the distinct ones of a few indices in the order in which they come: a small hash table,
/// made to be used again for every row of a matrix or vertex of a mesh.
class IndexSet
{
public:
  void Clear()
  {
    std::fill(this->Places.begin(), this->Places.end(), Free);
    this->Distinct.clear();
  }

  /// The number of `index`, which is Entries().size() - 1 for one not seen before.
  Index Insert(Index index)
  {
    const std::size_t place = this->Find(index);
    const Index known = this->Places[place];
    if (known != Free)
    {
      return known;
    }
    const auto number = static_cast<Index>(this->Distinct.size());
    this->Places[place] = number;
    this->Distinct.push_back(index);
    if (2 * this->Distinct.size() > this->Places.size())
    {
      this->Grow();
    }
    return number;
  }

  const std::vector<Index>& Entries() const { return this->Distinct; }

private:
  static constexpr Index Free = -1;

  /// Where `index` is, or belongs.
  std::size_t Find(Index index) const
  {
    const std::size_t mask = this->Places.size() - 1;
    std::size_t place = static_cast<std::size_t>(index) & mask;
    while (this->Places[place] != Free && this->Distinct[this->Places[place]] != index)
    {
      place = (place + 1) & mask;
    }
    return place;
  }

  void Grow()
  {
    this->Places.assign(2 * this->Places.size(), Free);
    for (std::size_t e = 0; e < this->Distinct.size(); ++e)
    {
      this->Places[this->Find(this->Distinct[e])] = static_cast<Index>(e);
    }
  }

  std::vector<Index> Places = std::vector<Index>(32, Free); ///< in Distinct
  std::vector<Index> Distinct;
};

} // namespace SurfaceDiffusion
