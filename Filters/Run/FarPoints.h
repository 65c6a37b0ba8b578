// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Run/ModelInputs.h"

namespace SurfaceDiffusion
{

/// The warning of points, which are called "points `kind`", that are farther from the surface than five
/// mean edge lengths, but at least 2 % and at most 10 % of its size; empty if none is. distances: one
/// per place, in coordinate units. The warning names the shift that brings most of them there, if there
/// is one: coordinates from another origin. canLeaveOut: whether MaximumDistance leaves far ones out.
Sentence DescribeFarPoints(const char* kind, const Points& places,
  const std::vector<double>& distances, const Surface& surface, bool canLeaveOut = true);

/// Report the median and the largest distance of the samples from the surface and, without a
/// maximumDistance, warn of far ones.
void ReportDistances(
  const Surface& surface, const KnownValues& known, double maximumDistance, RunResult& result);

} // namespace SurfaceDiffusion
