// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Core/Foundation/Grouping.h"
#include "Core/Foundation/Types.h"

#include <array>
#include <cstdint>

namespace SurfaceDiffusion
{

/// Moves bits 0, 1, 2, ... 20 to 0, 3, 6, ... 60.
inline std::uint64_t SpreadBits(std::uint64_t x)
{
  x = (x | x << 32) & 0x001F00000000FFFF;
  x = (x | x << 16) & 0x001F0000FF0000FF;
  x = (x | x << 8) & 0x100F00F00F00F00F;
  x = (x | x << 4) & 0x10C30C30C30C30C3;
  return (x | x << 2) & 0x1249249249249249;
}

/// Bits per axis of the unit cube: fine enough for neighbours in memory to be near on the surface.
constexpr int HilbertBits = 12;
constexpr double HilbertCells = 1 << HilbertBits;

/// The position of a cell along the three-dimensional Hilbert curve, < 2^36 (J. Skilling,
/// Programming the Hilbert curve, AIP Conf. Proc. 707, 2004).
inline std::uint64_t HilbertPosition(std::array<std::uint32_t, 3> x)
{
  for (std::uint32_t q = 1U << (HilbertBits - 1); q > 1; q >>= 1)
  {
    const std::uint32_t p = q - 1;
    for (auto& xi : x)
    {
      // If the bit is set, invert the low bits of the first axis; otherwise exchange them with
      // those of this axis. Masks instead of branches, since these bits cannot be predicted.
      const std::uint32_t set = xi & q ? ~0U : 0U;
      const std::uint32_t t = (x[0] ^ xi) & p & ~set;
      x[0] ^= t | (p & set);
      xi ^= t;
    }
  }
  // Gray encode.
  x[1] ^= x[0];
  x[2] ^= x[1];
  // Bit k of t: parity of the bits of the last axis above k.
  std::uint32_t t = x[2] >> 1;
  for (const int shift : { 1, 2, 4, 8, 16 })
  {
    t ^= t >> shift;
  }
  return SpreadBits(x[0] ^ t) << 2 | SpreadBits(x[1] ^ t) << 1 | SpreadBits(x[2] ^ t);
}

struct HilbertPlace
{
  std::uint64_t Position;
  Index Vertex;
};

/// Stable radix sort by position.
inline void SortAlongCurve(Buffer<HilbertPlace>& places, const ParallelFor& parallel)
{
  constexpr Index digits = 1 << HilbertBits;
  Buffer<HilbertPlace> sorted(places.size());
  for (int shift = 0; shift < 3 * HilbertBits; shift += HilbertBits)
  {
    DistributeByDigit(
      static_cast<Index>(places.size()), digits, parallel,
      [&](Index i) { return static_cast<Index>(places[i].Position >> shift & (digits - 1)); },
      [&](Index i, Index place) { sorted[place] = places[i]; });
    places.swap(sorted);
  }
}

} // namespace SurfaceDiffusion
