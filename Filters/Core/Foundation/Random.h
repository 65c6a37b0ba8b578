// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>

namespace SurfaceDiffusion
{

/// The output function of SplitMix64 (Steele, Lea, Flood, OOPSLA 2014), a hash of 64 bits.
inline std::uint64_t MixBits(std::uint64_t z)
{
  z += 0x9e3779b97f4a7c15ULL;
  z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9ULL;
  z = (z ^ (z >> 27)) * 0x94d049bb133111ebULL;
  return z ^ (z >> 31);
}

/// A uniform random number in [0, 1) that is a function of its arguments alone. It is the same on
/// every platform and on any number of threads or processes.
inline double UniformRandom(std::int64_t seed, std::int64_t component, std::int64_t id)
{
  const std::uint64_t bits = MixBits(
    MixBits(MixBits(static_cast<std::uint64_t>(seed)) ^ static_cast<std::uint64_t>(component)) ^
    static_cast<std::uint64_t>(id));
  constexpr double unit = 0x1.0p-53; // the 53 high bits fill the mantissa of a double
  return static_cast<double>(bits >> 11) * unit;
}

} // namespace SurfaceDiffusion
