// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Foundation/RobustRange.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <numeric>
#include <tuple>

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

namespace
{

constexpr double ShareOfMost = 0.99; ///< of the area

/// Intervals that are shorter, as a part of the magnitude of their ends, are of round-off.
constexpr double RoundOff = 1e-6;

/// Whether an interval of a third of the range, 1/OutlierFactor, may have most of the area. Takes
/// linear time.
bool MayHaveOutliers(
  const std::vector<AreaOfValue>& values, const ValueBounds& all, double totalArea)
{
  constexpr int bins = 10;
  double areas[bins] = {};
  for (const AreaOfValue& value : values)
  {
    const double place = (value.Value - all.Low) / all.Width() * bins;
    areas[std::min(static_cast<int>(place), bins - 1)] += value.Area;
  }
  constexpr int third = 5; // bins that it touches, wherever it begins
  for (int first = 0; first + third <= bins; ++first)
  {
    if (std::accumulate(areas + first, areas + first + third, 0.0) >= ShareOfMost * totalArea)
    {
      return true;
    }
  }
  return false;
}

} // namespace

ValueBounds BoundsOfMost(std::vector<AreaOfValue>& values)
{
  ValueBounds all;
  double total = 0.0;
  for (const AreaOfValue& value : values)
  {
    all.Widen({ value.Value, value.Value });
    total += value.Area;
  }
  const bool isOrdered = std::isfinite(all.Width()) && all.Width() > 0.0 && total > 0.0;
  if (!isOrdered || !MayHaveOutliers(values, all, total))
  {
    return all;
  }
  std::sort(values.begin(), values.end(),
    [](const AreaOfValue& a, const AreaOfValue& b)
    { return std::tie(a.Value, a.Area) < std::tie(b.Value, b.Area); });
  ValueBounds most = all;
  double area = 0.0; // from low to high, both inclusive
  for (std::size_t low = 0, high = 0; high < values.size(); ++high)
  {
    area += values[high].Area;
    for (; area >= ShareOfMost * total; ++low)
    {
      if (values[high].Value - values[low].Value < most.Width())
      {
        most = { values[low].Value, values[high].Value };
      }
      area -= values[low].Area;
    }
  }
  const double margin = most.Width();
  if (!(margin > RoundOff * std::max(std::abs(most.Low), std::abs(most.High))))
  {
    return all;
  }
  ValueBounds found;
  for (const AreaOfValue& value : values)
  {
    if (value.Value >= most.Low - margin && value.Value <= most.High + margin)
    {
      found.Widen({ value.Value, value.Value });
    }
  }
  return found;
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
