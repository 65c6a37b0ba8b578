// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Core/Foundation/Parallel.h"
#include "Core/Foundation/RobustRange.h"
#include "Run/Settings.h"

namespace SurfaceDiffusion
{

// Data f with a period P, such as angles, phases and cyclic times, are taken as the unit vectors
// (cos, sin)(2 pi f/P), which have no jump where f has one.

/// The setting Period.
void VisitPeriod(SettingVisitor& visitor, double& period);

/// n x k values become n x 2k vectors; NaN and infinite ones NaN.
void EncodeAngles(Values& values, double period, const ParallelFor& parallel);

/// The inverse: values from `begin` up to begin + period.
Values DecodeAngles(
  const Values& vectors, double period, double begin, const ParallelFor& parallel);

/// The lengths of the vectors, n x k: 1 where all angles that went into one are equal, 0 where they
/// cancel.
Values CoherenceOfAngles(const Values& vectors);

/// The start of the interval of the length of the period that holds the data: 0, or -period/2, or
/// otherwise their minimum.
double BeginOfAngles(const ValueBounds& bounds, double period);

} // namespace SurfaceDiffusion
