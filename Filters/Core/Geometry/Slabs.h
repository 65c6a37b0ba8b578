// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Geometry>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace SurfaceDiffusion
{

/// Slabs between parallel planes around a triangle, or around the directions in which it is seen
/// from a place: tighter than its box, of which a needle fills next to nothing.
class Slabs
{
public:
  using Vector3 = Eigen::Vector3d;
  using Corners = std::array<Vector3, 3>;

  /// Of a triangle with the rounding of its coordinates.
  static Slabs Around(const Corners& corners, double rounding)
  {
    Slabs slabs;
    const Vector3 normal = (corners[1] - corners[0]).cross(corners[2] - corners[0]);
    slabs.Margin = rounding;
    slabs.AddRange(normal, corners);
    for (int a = 0; a < 3; ++a)
    {
      slabs.AddRange(normal.cross(corners[(a + 1) % 3] - corners[a]), corners);
    }
    return slabs;
  }

  /// Of unit vectors from `centre` to a triangle; no slabs if it is too near for rounding.
  static Slabs Seen(const Corners& corners, const Vector3& centre, double rounding)
  {
    constexpr double least = 1e-9; // of directions that rounding has left
    Slabs slabs;
    Corners to;
    double nearest = std::numeric_limits<double>::infinity();
    for (int a = 0; a < 3; ++a)
    {
      to[a] = corners[a] - centre;
      nearest = std::min(nearest, to[a].norm());
    }
    if (!(nearest * least > rounding))
    {
      return slabs;
    }
    Vector3 largest = Vector3::Zero();
    std::array<Vector3, 3> normals;
    for (int a = 0; a < 3; ++a)
    {
      to[a].normalize();
    }
    for (int a = 0; a < 3; ++a)
    {
      normals[a] = to[a].cross(to[(a + 1) % 3]);
      largest = normals[a].squaredNorm() > largest.squaredNorm() ? normals[a] : largest;
    }
    slabs.Margin = least;
    for (int a = 0; a < 3; ++a)
    {
      slabs.AddHalfSpace(normals[a], to, rounding / nearest);
      slabs.AddHalfSpace(largest.cross(to[a]), to, rounding / nearest);
    }
    return slabs;
  }

  bool Meet(const Eigen::AlignedBox3d& box) const
  {
    const Vector3 middle = 0.5 * (box.min() + box.max());
    const Vector3 half = 0.5 * (box.max() - box.min());
    for (int k = 0; k < this->Count; ++k)
    {
      const double at = this->Normals[k].dot(middle);
      const double reach = this->Normals[k].cwiseAbs().dot(half) + this->Margin;
      if (at + reach < this->Low[k] || at - reach > this->High[k])
      {
        return false;
      }
    }
    return true;
  }

private:
  void Add(const Vector3& normal, double low, double high)
  {
    this->Normals[this->Count] = normal;
    this->Low[this->Count] = low;
    this->High[this->Count++] = high;
  }

  void AddRange(const Vector3& across, const Corners& corners)
  {
    const Vector3 normal = across.stableNormalized();
    const auto [low, high] =
      std::minmax({ normal.dot(corners[0]), normal.dot(corners[1]), normal.dot(corners[2]) });
    this->Add(normal, low, high);
  }

  /// If all directions are on one side.
  void AddHalfSpace(const Vector3& across, const Corners& to, double rounding)
  {
    constexpr double infinity = std::numeric_limits<double>::infinity();
    const Vector3 normal = across.stableNormalized();
    const auto [low, high] =
      std::minmax({ normal.dot(to[0]), normal.dot(to[1]), normal.dot(to[2]) });
    if (low >= -rounding)
    {
      this->Add(normal, 0.0, infinity);
    }
    else if (high <= rounding)
    {
      this->Add(normal, -infinity, 0.0);
    }
  }

  std::array<Vector3, 6> Normals;
  std::array<double, 6> Low, High;
  int Count = 0;
  double Margin = 0.0;
};

} // namespace SurfaceDiffusion
