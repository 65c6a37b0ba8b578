// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <utility>
#include <vector>

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

/// The grid of IdsOfPlaces() on a surface with mean edges of length h: a power of two near h / 4096,
/// which round-off of h does not change.
inline double NoiseGrid(double h)
{
  const double power = std::floor(std::log2(h) + 0.6180339887);
  return std::isfinite(power) ? std::exp2(power - 12.0) : 0.0;
}

/// A number for each of `count` points from its coordinates, place(i, x) with double x[3], and its
/// rank, in the order of the coordinates, among the points in the same cell of a grid: an id that
/// does not depend on the numbering of other points, nor on the pieces that a surface is divided
/// into, nor on round-off of the coordinates. grid: the size of the cells; 0: the coordinates
/// themselves. 52 bits, which a double holds.
template <typename Place>
std::vector<std::int64_t> IdsOfPlaces(std::size_t count, const Place& place, double grid = 0.0)
{
  using Coordinates = std::array<double, 3>;
  const auto placeOf = [&](std::size_t i)
  {
    Coordinates x;
    place(i, x.data());
    for (double& coordinate : x)
    {
      coordinate = std::isnan(coordinate) ? 0.0 : coordinate + 0.0; // -0 becomes 0
    }
    return x;
  };
  std::vector<std::pair<std::uint64_t, std::size_t>> hashes(count);
  for (std::size_t i = 0; i < count; ++i)
  {
    std::uint64_t hash = 0;
    for (const double coordinate : placeOf(i))
    {
      // The golden ratio keeps 0, 1, their midpoints and the like away from the ends of cells.
      const double number =
        grid > 0.0 ? std::floor(coordinate / grid + 0.6180339887) + 0.0 : coordinate;
      std::uint64_t bits = 0;
      std::memcpy(&bits, &number, sizeof(bits));
      hash = MixBits(hash ^ bits);
    }
    hashes[i] = { hash, i };
  }
  std::sort(hashes.begin(), hashes.end(),
    [&](const auto& a, const auto& b)
    {
      if (a.first != b.first || a.second == b.second)
      {
        return a.first < b.first;
      }
      const Coordinates ofA = placeOf(a.second);
      const Coordinates ofB = placeOf(b.second);
      return ofA != ofB ? ofA < ofB : a.second < b.second;
    });
  std::vector<std::int64_t> ids(count);
  std::uint64_t rank = 0;
  for (std::size_t k = 0; k < count; ++k)
  {
    rank = k > 0 && hashes[k].first == hashes[k - 1].first ? rank + 1 : 0;
    const std::uint64_t id = rank > 0 ? MixBits(hashes[k].first ^ rank) : hashes[k].first;
    ids[hashes[k].second] = static_cast<std::int64_t>(id >> 12);
  }
  return ids;
}

} // namespace SurfaceDiffusion
