// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <cstring>

namespace SurfaceDiffusion
{

/// The smallest double of which isReached(double) is true, as it is of all larger ones. Takes 64
/// calls, which may be collective.
template <typename F>
double SmallestReached(const F& isReached)
{
  constexpr std::uint64_t sign = std::uint64_t(1) << 63;
  const auto withOrder = [](std::uint64_t order) // the doubles in the order of integers
  {
    const std::uint64_t bits = (order & sign) != 0 ? order & ~sign : ~order;
    double x = 0.0;
    std::memcpy(&x, &bits, sizeof(x));
    return x;
  };
  constexpr std::uint64_t infinity = std::uint64_t(0x7FF) << 52;
  std::uint64_t low = ~(sign | infinity);
  std::uint64_t high = sign | infinity;
  while (low < high)
  {
    const std::uint64_t middle = low + (high - low) / 2;
    const bool reached = isReached(withOrder(middle));
    (reached ? high : low) = reached ? middle : middle + 1;
  }
  return withOrder(low) + 0.0; // never -0
}

} // namespace SurfaceDiffusion
