// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Core/Foundation/Types.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace SurfaceDiffusion
{

/// The largest error of a coordinate by rounding: half a unit in the last place of the largest one, of
/// single precision if all coordinates are such numbers, as files and VTK mostly have them, otherwise of
/// double precision. What a surface has below it is no shape.
inline double RoundingOfCoordinates(const Eigen::Ref<const Points>& points)
{
  bool areSingle = true;
  double largest = 0.0;
  for (Eigen::Index i = 0; i < points.rows(); ++i)
  {
    for (const double x : { points(i, 0), points(i, 1), points(i, 2) })
    {
      areSingle = areSingle && std::abs(x) <= std::numeric_limits<float>::max() &&
        static_cast<double>(static_cast<float>(x)) == x;
      largest = std::max(largest, std::abs(x));
    }
  }
  const double epsilon =
    areSingle ? std::numeric_limits<float>::epsilon() : std::numeric_limits<double>::epsilon();
  return 0.5 * epsilon * largest;
}

} // namespace SurfaceDiffusion
