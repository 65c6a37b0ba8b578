// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Distributed/InterfacePoints.h"

#include <cstddef>
#include <vector>

namespace SurfaceDiffusion
{

/// Which of the points are one point of the surface, by the rules of PointIdentity: for each the
/// index of the point that owns it, itself if no other matches. points: ordered by label.
///
/// What a point matches depends only on points within ReachOfMatching tolerances: those with which
/// it may share the first point within the tolerance are two tolerances away, and their first
/// points one more. Processes that know these points therefore agree.
constexpr double ReachOfMatching = 3.0;
std::vector<std::size_t> MatchPoints(
  std::vector<InterfacePoint> points, bool byId, double tolerance);

} // namespace SurfaceDiffusion
