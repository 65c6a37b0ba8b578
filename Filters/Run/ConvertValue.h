// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Run/Sentence.h"

#include <algorithm>
#include <cmath>
#include <limits>

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
    Sentence text("the result has values that are larger than a ");
    if (sizeof(T) < sizeof(double))
    {
      text << "float can hold; set " << Word::Setting("OutputPrecision") << " to "
           << Word::Choice("OutputPrecision", 1, "Double");
    }
    else
    {
      text << "double can hold";
    }
    throw InputError(text);
  }
  return static_cast<T>(value);
}

} // namespace SurfaceDiffusion
