// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Core/Foundation/Types.h"

#include <algorithm>
#include <numeric>
#include <vector>

namespace SurfaceDiffusion
{

/// Assigns consecutive numbers to distinct indices >= 0 in the order of first appearance. Made to
/// be reused for every row of a matrix or vertex of a mesh: small sets are searched linearly,
/// without a branch that could be mispredicted, and large ones are hashed.
class IndexSet
{
public:
  void Clear()
  {
    std::fill_n(this->Distinct.begin(), SmallSetSize, None);
    this->Count = 0;
  }

  /// The number of `index`, which is Size() - 1 if it is new.
  Index Insert(Index index)
  {
    if (this->Count <= SmallSetSize)
    {
      const Index known = this->FindLinearly(index);
      return known != None ? known : this->Append(index);
    }
    const std::size_t place = this->Find(index);
    if (this->Places[place] != None)
    {
      return this->Places[place];
    }
    this->Places[place] = this->Count;
    return this->Append(index);
  }

  Index Size() const { return this->Count; }
  Index operator[](Index number) const { return this->Distinct[number]; }

  /// rank[k]: how many of the indices are smaller than (*this)[k].
  void Rank(std::vector<Index>& rank)
  {
    rank.assign(this->Count, 0);
    if (this->Count > SmallSetSize)
    {
      this->Order.resize(this->Count);
      std::iota(this->Order.begin(), this->Order.end(), 0);
      std::sort(this->Order.begin(), this->Order.end(),
        [&](Index k, Index l) { return this->Distinct[k] < this->Distinct[l]; });
      for (Index r = 0; r < this->Count; ++r)
      {
        rank[this->Order[r]] = r;
      }
      return;
    }
    for (Index k = 0; k < this->Count; ++k)
    {
      for (Index l = 0; l < this->Count; ++l)
      {
        rank[k] += this->Distinct[l] < this->Distinct[k];
      }
    }
  }

private:
  static constexpr Index None = -1;
  static constexpr Index SmallSetSize = 16;
  static constexpr Index Lane = 8; ///< indices compared at once; divides SmallSetSize

  Index FindLinearly(Index index) const
  {
    const Index* entry = this->Distinct.data();
    for (Index first = 0; first < this->Count; first += Lane, entry += Lane)
    {
      Index found = 0; // the place + 1; compilers vectorise this loop
      for (Index k = 0; k < Lane; ++k)
      {
        found |= entry[k] == index ? k + 1 : 0;
      }
      if (found > 0)
      {
        return first + found - 1;
      }
    }
    return None;
  }

  Index Append(Index index)
  {
    if (this->Count == static_cast<Index>(this->Distinct.size()))
    {
      this->Distinct.resize(2 * this->Distinct.size(), None);
    }
    this->Distinct[this->Count] = index;
    ++this->Count;
    if (this->Count == SmallSetSize + 1 ||
      2 * this->Count > static_cast<Index>(this->Places.size()))
    {
      this->Hash();
    }
    return this->Count - 1;
  }

  /// The place of `index` in the table, or the free place for it.
  std::size_t Find(Index index) const
  {
    const std::size_t mask = this->Places.size() - 1;
    std::size_t place = static_cast<std::size_t>(index) & mask;
    while (this->Places[place] != None && this->Distinct[this->Places[place]] != index)
    {
      place = (place + 1) & mask;
    }
    return place;
  }

  /// Make the table, which small sets do not keep, of twice the size if it is half full.
  void Hash()
  {
    const bool full = 2 * this->Count > static_cast<Index>(this->Places.size());
    this->Places.assign((full ? 2 : 1) * this->Places.size(), None);
    for (Index e = 0; e < this->Count; ++e)
    {
      this->Places[this->Find(this->Distinct[e])] = e;
    }
  }

  std::vector<Index> Distinct = std::vector<Index>(std::size_t(2) * SmallSetSize, None);
  std::vector<Index> Places =
    std::vector<Index>(std::size_t(4) * SmallSetSize, None); ///< hash table: places in Distinct
  std::vector<Index> Order; ///< by value, for large sets
  Index Count = 0;
};

} // namespace SurfaceDiffusion
