// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Core/Surface/TriangleMesh.h"

#include <vector>

namespace SurfaceDiffusion
{

/// The mean of the areas of the connected components of some surfaces, of all processes, with these
/// areas as weights, in coordinate units: copies of a surface do not change it, and neither does a
/// division of the components into surfaces. 0 without area.
double MeanPartArea(const std::vector<const TriangleMesh*>& surfaces);

} // namespace SurfaceDiffusion
