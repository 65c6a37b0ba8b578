// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Core/Foundation/Parallel.h"
#include "Core/Foundation/Types.h"

#include <vector>

namespace SurfaceDiffusion
{

/// For every point the index of the point that represents it: in the order of indices, a point
/// without a representative becomes its own and that of all later points within `tolerance` of it
/// (0: equal coordinates). Coordinates must be finite.
std::vector<Index> MergePoints(const Points& points, double tolerance);

/// For every point the smallest index of those that it is joined with by short edges; empty if there
/// are none. An edge is short in a triangle whose longest side is more than 1e10 times as long: its
/// ends are one place up to round-off, as at the seams of parametric surfaces. Without it the cotan
/// weights of the triangle would be larger than those of its neighbours by that factor, and without
/// the triangle the surface would be cut there.
std::vector<Index> JoinShortEdges(
  const Points& points, const Triangles& triangles, const ParallelFor& parallel);

} // namespace SurfaceDiffusion
