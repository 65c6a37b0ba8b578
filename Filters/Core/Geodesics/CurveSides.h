// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Core/Geodesics/GeodesicPath.h"

#include <vector>

namespace SurfaceDiffusion
{

/// Which vertices are on the smaller side, by area, of closed curves on a surface: nonzero on it, per
/// component with a curve. Empty if the curves divide their components into no two sides, as a curve
/// around the tube of a torus. Each curve is a list of segments one after the other, the last of which ends where
/// the first begins. Vertices on a curve count to one of the sides.
std::vector<char> FindSmallerSide(
  const TriangleMesh& mesh, const std::vector<std::vector<PathSegment>>& curves);

} // namespace SurfaceDiffusion
