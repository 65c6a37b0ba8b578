// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Core/Foundation/Types.h"

#include <vector>

namespace SurfaceDiffusion
{

/// Turn triangles so that the two of each manifold edge have the same orientation. Of a set of
/// triangles that such edges connect, the larger part of the area keeps the orientation that it
/// has. On surfaces with one side only, such as a Moebius strip, edges with opposite orientations
/// remain. A triangle is turned by an exchange of its second and third corner.
///
/// Triangles without orientation, whose corners are on a line up to round-off of single precision,
/// connect no others, and follow their neighbours: such triangles join the seams of many parametric
/// surfaces, with orientations at random.
///
/// points: rows that the triangles refer to. onOneSide: not null: per triangle, nonzero on surfaces
/// with one side; no entries if there are none.
void OrientTriangles(
  const Points& points, Triangles& triangles, std::vector<char>* onOneSide = nullptr);

/// Whether the height of triangle t over its longest side is more than 1e-6 of that.
bool HasOrientation(const Points& points, const Triangles& triangles, Index t);

} // namespace SurfaceDiffusion
