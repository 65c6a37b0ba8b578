// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Foundation/RobustRange.h"

#include "Core/Foundation/Bisection.h"

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

constexpr double ShareOfMost = 0.99 - 1e-9; ///< of the area, less round-off

/// Intervals that are shorter, as a part of the magnitude of their ends, are of round-off.
constexpr double RoundOff = 1e-6;

/// Whether an interval of a third of the range, 1/OutlierFactor, may have most of the area. Takes
/// linear time.
bool MayHaveOutliers(const std::vector<AreaOfValue>& values, const ValueBounds& all,
  double totalArea, const Reduction& processes)
{
  constexpr int bins = 10;
  double areas[bins] = {};
  for (const AreaOfValue& value : values)
  {
    const double place = (value.Value - all.Low) / all.Width() * bins;
    areas[std::min(static_cast<int>(place), bins - 1)] += value.Area;
  }
  processes.Sum(areas, bins);
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

/// In ascending order the values of all processes at which an interval with most of the area may
/// begin or end, with the areas of equal ones together, and beside the lowest of them in the middle
/// the area between them. values: those of this process, which get into ascending order.
std::vector<AreaOfValue> FindEnds(
  std::vector<AreaOfValue>& values, double totalArea, const Reduction& processes)
{
  const auto ascends = [](const AreaOfValue& a, const AreaOfValue& b)
  { return std::tie(a.Value, a.Area) < std::tie(b.Value, b.Area); };
  std::sort(values.begin(), values.end(), ascends);
  std::vector<double> below = { 0.0 }; // per value, the area of those before it
  for (const AreaOfValue& value : values)
  {
    below.push_back(below.back() + value.Area);
  }
  const auto countUpTo = [&](double bound)
  {
    return std::upper_bound(values.begin(), values.end(), bound,
             [](double x, const AreaOfValue& value) { return x < value.Value; }) -
      values.begin();
  };
  const auto areaUpTo = [&](double bound)
  { return processes.Sum(below[static_cast<std::size_t>(countUpTo(bound))]); };
  const double low = SmallestReached(
    [&](double bound) { return areaUpTo(bound) > (1.0 - ShareOfMost) * totalArea; });
  const double high =
    SmallestReached([&](double bound) { return areaUpTo(bound) >= ShareOfMost * totalArea; });

  std::vector<double> ends;
  for (std::size_t i = 0; i < values.size(); ++i)
  {
    const double place = values[i].Value > low && values[i].Value < high ? low : values[i].Value;
    if (ends.empty() || ends[ends.size() - 2] != place)
    {
      ends.insert(ends.end(), { place, 0.0 });
    }
    ends.back() += values[i].Area;
  }
  ends = processes.Gather(ends);
  std::vector<AreaOfValue> all;
  for (std::size_t i = 0; i < ends.size(); i += 2)
  {
    all.push_back({ ends[i], ends[i + 1] });
  }
  std::sort(all.begin(), all.end(), ascends);
  return all;
}

} // namespace

ValueBounds OfAllProcesses(const ValueBounds& here, const Reduction& processes)
{
  double bounds[2] = { -here.Low, here.High };
  processes.Max(bounds, 2);
  return { -bounds[0], bounds[1] };
}

ValueBounds BoundsOfMost(
  std::vector<AreaOfValue>& values, const ValueBounds& all, const Reduction& processes)
{
  double total = 0.0;
  for (const AreaOfValue& value : values)
  {
    total += value.Area;
  }
  total = processes.Sum(total);
  const bool isOrdered = std::isfinite(all.Width()) && all.Width() > 0.0 && total > 0.0;
  if (!isOrdered || !MayHaveOutliers(values, all, total, processes))
  {
    return all;
  }
  const std::vector<AreaOfValue> ends = FindEnds(values, total, processes);
  ValueBounds most = all;
  double area = 0.0; // from low to high, both inclusive
  for (std::size_t low = 0, high = 0; high < ends.size(); ++high)
  {
    area += ends[high].Area;
    for (; area >= ShareOfMost * total; ++low)
    {
      if (ends[high].Value - ends[low].Value < most.Width())
      {
        most = { ends[low].Value, ends[high].Value };
      }
      area -= ends[low].Area;
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
  return OfAllProcesses(found, processes);
}

double Median(std::vector<double>& values, const Reduction& processes)
{
  if (!processes.IsSerial())
  {
    const double all = processes.Sum(static_cast<double>(values.size()));
    const auto isHalfBelow = [&](double bound)
    {
      const auto here = std::count_if(
        values.begin(), values.end(), [bound](double value) { return value <= bound; });
      return processes.Sum(static_cast<double>(here)) > std::floor(0.5 * all);
    };
    return all > 0.0 ? SmallestReached(isHalfBelow) : 0.0;
  }
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return values.empty() ? 0.0 : *middle;
}

} // namespace SurfaceDiffusion
