// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Core/Foundation/Types.h"

#include <vector>

namespace SurfaceDiffusion
{

/// A surface with one point per place, and what was mended.
struct WeldedSurface
{
  Triangles Faces; ///< rows of the given points
  std::vector<Index> InputTriangle; ///< that each lies in
  std::vector<Index> PointOf; ///< per given point, the one that stands for it
  double Apart = 0.0; ///< the largest distance of a point from that
  Index Welded = 0; ///< points at another place than the one that stands for them
  Index Split = 0; ///< vertices that an edge was split at
  Index Duplicates = 0; ///< triangles left out that others stand for, or cancel
  Index Flat = 0; ///< triangles of no area that were left out
};

/// Join what a file of facets has apart, to a tolerance of at least 0:
///
/// - Points at one place become one, and so do the ends of open edges, see JoinOpenEdges().
/// - Triangles with the same corners count once. As many of one orientation as of the other are an
///   inner wall, of which none stays, if the edges around it have two other triangles, and otherwise
///   one sheet, of which one stays.
/// - Triangles of no area, to the tolerance and to 1e-6 of their longest side, are left out.
/// - An open edge with an end of another one on it, as meshes of CAD faces and results of boolean
///   operations have them, is split there, and its triangle with it (T-junctions).
///
/// With tolerance 0 the last two leave the surface as it is. points: finite.
WeldedSurface WeldSurface(const Points& points, const Triangles& triangles, double tolerance);

} // namespace SurfaceDiffusion
