// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

/// Triangles that are given by the lengths of their sides; side a is opposite corner a. Corner 0 is
/// the origin, and corner 1 on the first axis.
namespace SurfaceDiffusion
{

/// The corners, and the sides opposite to them, after and before a.
constexpr int Next(int a)
{
  return (a + 1) % 3;
}
constexpr int Last(int a)
{
  return (a + 2) % 3;
}

/// Of a triangle with sides a, b, c, the corner opposite c, with c from the origin to (c, 0).
inline Eigen::Vector2d Apex(double a, double b, double c)
{
  const double x = (c * c + (b - a) * (b + a)) / (2.0 * c);
  // Kahan's stable product for needles: 16 area^2 from sorted lengths.
  std::array<double, 3> s{ a, b, c };
  std::sort(s.begin(), s.end());
  const double squared = (s[2] + (s[1] + s[0])) * (s[0] - (s[2] - s[1])) * (s[0] + (s[2] - s[1])) *
    (s[2] + (s[1] - s[0]));
  return { x, 0.5 * std::sqrt(std::max(squared, 0.0)) / c };
}

inline Eigen::Vector2d Apex(const std::array<double, 3>& lengths)
{
  return Apex(lengths[0], lengths[1], lengths[2]);
}

inline double Area(const std::array<double, 3>& lengths)
{
  return 0.5 * lengths[2] * Apex(lengths)[1];
}

/// The angle of side a in the triangle's own axes.
inline double AngleOfSide(const std::array<double, 3>& lengths, int a)
{
  const std::array<Eigen::Vector2d, 3> corners{ Eigen::Vector2d(0.0, 0.0),
    Eigen::Vector2d(lengths[2], 0.0), Apex(lengths) };
  const Eigen::Vector2d direction = corners[Last(a)] - corners[Next(a)];
  return std::atan2(direction[1], direction[0]);
}

/// False for a triangle that is degenerate in floating point: its weights would not be finite.
inline bool IsProper(const std::array<double, 3>& lengths)
{
  constexpr double flat = 4.0 * std::numeric_limits<double>::epsilon(); // as in TriangleMesh
  const double longest = std::max({ lengths[0], lengths[1], lengths[2] });
  return lengths[2] * Apex(lengths)[1] > flat * longest * longest;
}

} // namespace SurfaceDiffusion
