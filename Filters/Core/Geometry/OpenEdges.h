// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Core/Geometry/TriangleSides.h"

#include <vector>

namespace SurfaceDiffusion
{

/// The sides of edges of one triangle; triangles with the same corners are one here.
TriangleSides OpenSides(const Triangles& triangles);

/// The vertices of sides, ascending, each once.
std::vector<Index> EndsOf(const TriangleSides& sides);

/// The distance to which welding joins points by default: 1e-5 of the diagonal of the surface, and
/// at most 1 % of the median length of open edges (of all, if none is open). A facet far away makes the
/// diagonal long, but not the edges.
double DefaultWeldTolerance(const Points& points, const Triangles& triangles);

/// Programs round the corners of neighbouring facets apart. Ends of open edges that are no more than
/// `tolerance` apart are one: per point, that of the least number. Points that no triangle could do
/// without stay: none loses a corner. Triangles with the same corners are one here. points: finite.
std::vector<Index> JoinOpenEdges(
  const Points& points, const Triangles& triangles, double tolerance);

} // namespace SurfaceDiffusion
