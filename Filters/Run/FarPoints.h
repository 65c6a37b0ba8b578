// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Run/ModelInputs.h"

namespace SurfaceDiffusion
{

/// Report the median and the largest distance of the samples from the surface and, without a
/// maximumDistance, warn of those that are farther than five mean edge lengths, but at least 2 % and at
/// most 10 % of its size. The warning names the shift that brings most of them there, if there is one:
/// coordinates from another origin.
void ReportDistances(
  const Surface& surface, const KnownValues& known, double maximumDistance, RunResult& result);

} // namespace SurfaceDiffusion
