// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Core/Foundation/Reduction.h"
#include "Core/Foundation/Types.h"

#include <limits>
#include <vector>

namespace SurfaceDiffusion
{

/// A lower and an upper bound; Low > High if there are no values.
struct ValueBounds
{
  double Low = std::numeric_limits<double>::infinity();
  double High = -std::numeric_limits<double>::infinity();

  void Widen(const ValueBounds& other);
  double Width() const { return this->High > this->Low ? this->High - this->Low : 0.0; }
};

/// A range counts as that of outliers if it is so many times as wide as the robust one.
constexpr double OutlierFactor = 3.0;

/// The extremes of finite values without the outliers: the smallest 0.1 % and the largest 0.1 % are
/// left out, from 100 values on at least one of each. Takes linear time, and reorders the values.
ValueBounds RobustBounds(std::vector<double>& values);

/// A value, and the area that it stands for.
struct AreaOfValue
{
  double Value, Area;
};

/// The extremes of finite values without the outliers, which have at most 1 % of the area: those
/// that are farther from the shortest interval with 99 % of it than this is long. With no such
/// interval of positive length all values count. all: their extremes, over the processes that have
/// the values together. Reorders the values.
ValueBounds BoundsOfMost(std::vector<AreaOfValue>& values, const ValueBounds& all,
  const Reduction& processes = Reduction::Serial());

/// The extremes of those of all processes.
ValueBounds OfAllProcesses(const ValueBounds& here, const Reduction& processes);

/// The upper median of the values of all processes, 0 of none. In one process it takes linear time,
/// and reorders the values.
double Median(std::vector<double>& values, const Reduction& processes = Reduction::Serial());

} // namespace SurfaceDiffusion
