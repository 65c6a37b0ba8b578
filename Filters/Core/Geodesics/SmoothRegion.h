// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Core/Surface/TriangleMesh.h"

#include <vector>

namespace SurfaceDiffusion
{

/// The smoothest function that is not above 0 at the vertices within a region nor below it outside, near its
/// boundary, where it is 0: the minimum of
///   |L u|^2 + 0.02 |u - d|^2
/// with the difference L u from the mean of the neighbours and the distance d in edges, 1/2 at the ends of those
/// that leave the region and at most 6, by accelerated projected gradients (A. Beck, M. Teboulle, SIAM J.
/// Imaging Sci. 2, 2009). The middle of each edge that leaves the region is 2 % of the largest distance off on a
/// sphere of 642 vertices, and this boundary 0.7 %. At open ends u may have any slope.
std::vector<double> SmoothRegion(const TriangleMesh& mesh, const std::vector<char>& inside);

} // namespace SurfaceDiffusion
