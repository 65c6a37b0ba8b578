// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Geometry>

#include <algorithm>
#include <limits>

namespace SurfaceDiffusion
{

/// A half-line.
struct Ray
{
  /// way: of length 1.
  Ray(const Eigen::Vector3d& from, const Eigen::Vector3d& way)
    : From(from)
    , Way(way)
    , Inverse(way.cwiseInverse())
  {
  }

  /// Whether it passes the box at distances from `first` to `last`.
  bool Meets(const Eigen::AlignedBox3d& box, double first, double last) const
  {
    const Eigen::Vector3d low = (box.min() - this->From).cwiseProduct(this->Inverse);
    const Eigen::Vector3d high = (box.max() - this->From).cwiseProduct(this->Inverse);
    for (int k = 0; k < 3; ++k)
    {
      if (this->Way[k] == 0.0)
      {
        if (this->From[k] < box.min()[k] || this->From[k] > box.max()[k])
        {
          return false;
        }
        continue;
      }
      first = std::max(first, std::min(low[k], high[k]));
      last = std::min(last, std::max(low[k], high[k]));
    }
    return first <= last;
  }

  /// The distance to triangle abc, below 0 behind; NaN if the line does not meet it. normal:
  /// (b - a) x (c - a).
  double DistanceTo(const Eigen::Vector3d& a, const Eigen::Vector3d& b, const Eigen::Vector3d& c,
    const Eigen::Vector3d& normal) const
  {
    const double distance = normal.dot(a - this->From) / normal.dot(this->Way);
    const Eigen::Vector3d hit = this->From + distance * this->Way;
    const bool isWithin = (b - a).cross(hit - a).dot(normal) >= 0.0 &&
      (c - b).cross(hit - b).dot(normal) >= 0.0 && (a - c).cross(hit - c).dot(normal) >= 0.0;
    return isWithin ? distance : std::numeric_limits<double>::quiet_NaN();
  }

  Eigen::Vector3d From, Way, Inverse;
};

} // namespace SurfaceDiffusion
