// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <cstddef>
#include <vector>

namespace SurfaceDiffusion
{

/// The value below which this fraction of them, below 1, is; 0 without values. Reorders them.
inline double QuantileOf(std::vector<double>& values, double fraction)
{
  if (values.empty())
  {
    return 0.0;
  }
  const double place = fraction * static_cast<double>(values.size());
  const auto quantile = values.begin() + static_cast<std::ptrdiff_t>(place);
  std::nth_element(values.begin(), quantile, values.end());
  return *quantile;
}

} // namespace SurfaceDiffusion
