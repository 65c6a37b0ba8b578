// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Core/Foundation/Types.h"

#include <vector>

namespace SurfaceDiffusion
{

/// For every point the index of the point that represents it: in the order of indices, a point
/// without a representative becomes its own and that of all later points within `tolerance` of it
/// (0: equal coordinates). Coordinates must be finite.
std::vector<Index> MergePoints(const Points& points, double tolerance);

} // namespace SurfaceDiffusion
