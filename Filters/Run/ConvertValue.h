// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>

namespace SurfaceDiffusion
{

/// The value as a T, rounded to the nearest and clamped if T is an integer type. NaN stays NaN.
/// Throws if T cannot hold the value.
template <typename T>
T ConvertValue(double value)
{
  if (std::numeric_limits<T>::is_integer)
  {
    const double low = static_cast<double>(std::numeric_limits<T>::lowest());
    const double high = static_cast<double>(std::numeric_limits<T>::max());
    return static_cast<T>(std::min(high, std::max(low, std::round(value))));
  }
  if (std::abs(value) > static_cast<double>(std::numeric_limits<T>::max()))
  {
    throw std::runtime_error(sizeof(T) < sizeof(double)
        ? "the result has values that are larger than a float can hold; set OutputPrecision to "
          "Double"
        : "the result has values that are larger than a double can hold");
  }
  return static_cast<T>(value);
}

} // namespace SurfaceDiffusion
