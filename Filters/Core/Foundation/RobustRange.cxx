// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Foundation/RobustRange.h"

#include <algorithm>
#include <cmath>
#include <cstddef>

namespace SurfaceDiffusion
{

namespace
{

constexpr double ShareOfOutliers = 0.001; ///< at either end

/// With fewer values, one that differs is as likely a part of the data as an outlier.
constexpr std::size_t FewestValues = 100;

} // namespace

void ValueBounds::Widen(const ValueBounds& other)
{
  this->Low = std::min(this->Low, other.Low);
  this->High = std::max(this->High, other.High);
}

ValueBounds RobustBounds(std::vector<double>& values)
{
  if (values.empty())
  {
    return {};
  }
  const auto count = static_cast<double>(values.size());
  const auto outliers = values.size() < FewestValues
    ? std::ptrdiff_t{ 0 }
    : static_cast<std::ptrdiff_t>(std::ceil(ShareOfOutliers * count));
  const auto low = values.begin() + outliers;
  const auto high = values.end() - 1 - outliers;
  std::nth_element(values.begin(), low, values.end());
  const double lowest = *low;
  std::nth_element(low, high, values.end());
  return { lowest, *high };
}

double RobustRange(const Values& values, const Flags& missing, const Reduction& reduction)
{
  double range = 0.0;
  std::vector<double> known;
  for (Eigen::Index k = 0; k < values.cols(); ++k)
  {
    known.clear();
    for (Eigen::Index i = 0; i < values.rows(); ++i)
    {
      if (!missing[i])
      {
        known.push_back(values(i, k));
      }
    }
    const ValueBounds here = RobustBounds(known);
    double bounds[2] = { -here.Low, here.High };
    reduction.Max(bounds, 2);
    range = std::max(range, ValueBounds{ -bounds[0], bounds[1] }.Width());
  }
  return range;
}

double Median(std::vector<double>& values)
{
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return values.empty() ? 0.0 : *middle;
}

} // namespace SurfaceDiffusion
