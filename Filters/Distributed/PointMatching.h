// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Distributed/InterfacePoints.h"

#include <cstddef>
#include <vector>

namespace SurfaceDiffusion
{

/// Which of the points are one point of the surface, by the rules of PointIdentity: for each the
/// index of the point that owns it, itself if no other matches. Deterministic, so that all
/// processes get the same from the same points.
std::vector<std::size_t> MatchPoints(
  std::vector<InterfacePoint> points, bool byId, double tolerance);

} // namespace SurfaceDiffusion
