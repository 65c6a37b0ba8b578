// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>

namespace SurfaceDiffusion
{

/// The output function of SplitMix64 (Steele, Lea, Flood, OOPSLA 2014): mixes all bits.
inline std::uint64_t MixBits(std::uint64_t z)
{
  z += 0x9e3779b97f4a7c15ULL;
  z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9ULL;
  z = (z ^ (z >> 27)) * 0x94d049bb133111ebULL;
  return z ^ (z >> 31);
}

/// A number in [0, 1) that depends on these three alone, not on the order of the calls: the same
/// everywhere, on any number of threads or processes.
inline double UniformRandom(std::int64_t seed, std::int64_t component, std::int64_t id)
{
  const std::uint64_t bits = MixBits(
    MixBits(MixBits(static_cast<std::uint64_t>(seed)) ^ static_cast<std::uint64_t>(component)) ^
    static_cast<std::uint64_t>(id));
  return static_cast<double>(bits >> 11) * 0x1.0p-53;
}

} // namespace SurfaceDiffusion
