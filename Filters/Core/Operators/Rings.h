// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Core/Operators/SparsePattern.h"

#include <cstddef>
#include <vector>

namespace SurfaceDiffusion
{

/// A range of vertices: begin .. end - 1, for instance those of a connected component.
struct VertexRange
{
  Index Begin = 0;
  Index End = 0;

  Index Size() const { return this->End - this->Begin; }
};

/// The vertices near a vertex, by the number of edges between them. Ways do not lead through another
/// vertex with more than 64 neighbours, such as the middle of a disc that is cut into slices, which
/// would make all of them near to each other. The pattern, of the stiffness matrix, must outlive it;
/// no edge leaves the range.
class Rings
{
public:
  Rings(const SparsePattern& pattern, VertexRange range)
    : Outer(pattern.Outer.data())
    , Inner(pattern.Inner.data())
    , First(range.Begin)
    , SeenIn(static_cast<std::size_t>(range.Size()), -1)
  {
  }

  /// The vertices at a distance of `edges` edges from the centre.
  const std::vector<Index>& FindRing(Index centre, int edges)
  {
    this->Disk.assign(1, centre);
    this->RingBegin = 0;
    this->SeenIn[static_cast<std::size_t>(centre - this->First)] = ++this->Search;
    for (int edge = 0; edge < edges; ++edge)
    {
      const std::size_t end = this->Disk.size();
      for (; this->RingBegin < end; ++this->RingBegin)
      {
        const Index i = this->Disk[this->RingBegin];
        if (i != centre && this->Outer[i + 1] - this->Outer[i] > LargestStar)
        {
          continue;
        }
        for (Index slot = this->Outer[i]; slot < this->Outer[i + 1]; ++slot)
        {
          Index& seen = this->SeenIn[static_cast<std::size_t>(this->Inner[slot] - this->First)];
          if (seen != this->Search)
          {
            seen = this->Search;
            this->Disk.push_back(this->Inner[slot]);
          }
        }
      }
    }
    this->Ring.assign(
      this->Disk.begin() + static_cast<std::ptrdiff_t>(this->RingBegin), this->Disk.end());
    return this->Ring;
  }

  /// The vertices at most `edges` edges from the centre, which is the first one.
  const std::vector<Index>& FindDisk(Index centre, int edges)
  {
    this->FindRing(centre, edges);
    return this->Disk;
  }

private:
  static constexpr Index LargestStar = 64;

  const Index* Outer;
  const Index* Inner;
  Index First;
  Index Search = -1;
  std::size_t RingBegin = 0;
  std::vector<Index> SeenIn, Disk, Ring;
};

} // namespace SurfaceDiffusion
