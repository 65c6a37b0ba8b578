// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Run/ModelInputs.h"

namespace SurfaceDiffusion
{

/// A warning for each number that programs write where they have no value, such as -9999 or the fill
/// value of netCDF, 9.969e36, that the known data have farther from all others than half of their range:
/// are they values? Collective.
std::vector<Sentence> AskForSentinels(
  const Surface& surface, const Fields& fields, const Reduction& processes);

} // namespace SurfaceDiffusion
