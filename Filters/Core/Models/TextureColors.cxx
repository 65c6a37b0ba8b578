// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Models/TextureColors.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstring>

namespace SurfaceDiffusion
{

namespace
{

double Percentile(Vector& values, double fraction)
{
  double* const begin = values.data();
  double* const end = begin + values.size();
  double* const at = begin + std::lround(fraction * static_cast<double>(values.size() - 1));
  std::nth_element(begin, at, end);
  return *at;
}

/// Integers in the order of the doubles.
std::uint64_t OrderOf(double x)
{
  constexpr std::uint64_t sign = std::uint64_t(1) << 63;
  std::uint64_t bits = 0;
  std::memcpy(&bits, &x, sizeof(bits));
  return (bits & sign) != 0 ? ~bits : bits | sign;
}

double WithOrder(std::uint64_t order)
{
  constexpr std::uint64_t sign = std::uint64_t(1) << 63;
  const std::uint64_t bits = (order & sign) != 0 ? order & ~sign : ~order;
  double x = 0.0;
  std::memcpy(&x, &bits, sizeof(x));
  return x;
}

/// By bisection: no process need hold the values of the others.
double WholePercentile(
  const Eigen::Ref<const Vector>& u, double fraction, const Partition& partition)
{
  const auto count = [&](const auto& counts)
  {
    return SumOverVertices(&partition, SerialFor(), static_cast<Index>(u.size()),
      [&](Index i) { return counts(u[i]) ? 1.0 : 0.0; });
  };
  const double last = count([](double) { return true; }) - 1.0;
  const auto rank = static_cast<double>(std::lround(fraction * last));
  std::uint64_t low = 0;
  std::uint64_t high = ~low;
  while (low < high)
  {
    const std::uint64_t middle = low + (high - low) / 2;
    const bool reached = count([&](double x) { return OrderOf(x) <= middle; }) > rank;
    (reached ? high : low) = reached ? middle : middle + 1;
  }
  return WithOrder(low);
}

} // namespace

std::array<double, 2> ContrastLimits(const Eigen::Ref<const Vector>& u, const Partition* partition)
{
  if (partition)
  {
    return { WholePercentile(u, 0.01, *partition), WholePercentile(u, 0.99, *partition) };
  }
  if (u.size() == 0)
  {
    return { 0.0, 0.0 };
  }
  Vector sorted = u;
  const double low = Percentile(sorted, 0.01);
  return { low, Percentile(sorted, 0.99) };
}

Vector StretchContrast(const Eigen::Ref<const Vector>& u, const std::array<double, 2>& limits)
{
  const double low = limits[0];
  const double high = limits[1];
  if (!(high > low))
  {
    return Vector::Constant(u.size(), 0.5);
  }
  return ((u.array() - low) / (high - low)).max(0.0).min(1.0);
}

Colors MixColors(const Eigen::Ref<const Vector>& shares, const std::array<double, 3>& low,
  const std::array<double, 3>& high)
{
  Colors colors(shares.size(), 3);
  for (Eigen::Index i = 0; i < shares.size(); ++i)
  {
    for (int k = 0; k < 3; ++k)
    {
      const double mixed = (1.0 - shares[i]) * low[k] + shares[i] * high[k];
      colors(i, k) = static_cast<unsigned char>(std::lround(255.0 * mixed));
    }
  }
  return colors;
}

} // namespace SurfaceDiffusion
