// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Core/Foundation/Types.h"

#include <array>
#include <vector>

namespace SurfaceDiffusion
{

/// Three of the corners of a polygon, by their place in it.
using Corners = std::array<int, 3>;

/// The triangles of a polygon of any number of corners; none of less than 3. Quadrilaterals are cut
/// along the shorter diagonal that lies inside, regardless of the corner that comes first, larger
/// polygons by ear cutting in the plane of their mean normal, where the ear with the largest smallest
/// angle is cut first. The rest of a polygon without an ear, which intersects itself, becomes a fan.
std::vector<Corners> CutPolygon(const std::vector<Eigen::RowVector3d>& corners);

} // namespace SurfaceDiffusion
