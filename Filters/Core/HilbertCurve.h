// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstdint>

namespace SurfaceDiffusion
{

/// Position along the three-dimensional Hilbert curve of a point of the unit cube's 2^21 grid.
/// J. Skilling, Programming the Hilbert curve, AIP Conf. Proc. 707 (2004).
inline std::uint64_t HilbertPosition(std::array<std::uint32_t, 3> x)
{
  constexpr int bits = 21;
  for (std::uint32_t q = 1U << (bits - 1); q > 1; q >>= 1)
  {
    const std::uint32_t p = q - 1;
    for (auto& xi : x)
    {
      if (xi & q)
      {
        x[0] ^= p; // invert the low bits of the first axis
      }
      else
      {
        const std::uint32_t t = (x[0] ^ xi) & p; // exchange the low bits with the first axis
        x[0] ^= t;
        xi ^= t;
      }
    }
  }
  // Gray encode.
  x[1] ^= x[0];
  x[2] ^= x[1];
  std::uint32_t t = 0;
  for (std::uint32_t q = 1U << (bits - 1); q > 1; q >>= 1)
  {
    if (x[2] & q)
    {
      t ^= q - 1;
    }
  }
  std::uint64_t position = 0;
  for (int bit = bits - 1; bit >= 0; --bit)
  {
    for (const auto xi : x)
    {
      position = (position << 1) | (((xi ^ t) >> bit) & 1U);
    }
  }
  return position;
}

} // namespace SurfaceDiffusion
