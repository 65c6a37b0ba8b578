// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Run/Sentence.h"

namespace SurfaceDiffusion
{

class Surface;
struct ScatteredValues;

/// The warning that data which show no white noise may have correlated noise. width: see
/// WidthOfCorrelation(). estimate, deviation: of the noise, and of the data, in array units. next: what
/// to do.
Sentence DescribeSmoothData(double width, double estimate, double deviation, const Sentence& next);

/// The same of a column of values at points, in array units 1/unit, whose smooth fit leaves a deviation
/// `estimate`. Empty if they are fewer than 200, or grow apart as a smooth function does.
Sentence DescribeSmoothValues(
  const ScatteredValues& data, int column, double estimate, double unit, const Surface& surface);

} // namespace SurfaceDiffusion
