// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Core/Foundation/Parallel.h"
#include "Core/Foundation/ProgressMonitor.h"
#include "Core/Foundation/Types.h"

#include <vector>

namespace SurfaceDiffusion
{

/// Per triangle, whether it crosses another one: they have a line in common, of more than 1e-12 of
/// the size of the surface, and the surface passes through itself there. Where that line is along
/// the side of a triangle, its neighbour there is on the other side. Triangles that only touch, that
/// lie in one plane, or that have an edge in common do not cross. Throws Aborted.
std::vector<char> FindSelfIntersections(const Points& points, const Triangles& triangles,
  const ParallelFor& parallel = SerialFor(), const ProgressMonitor& progress = ProgressMonitor());

} // namespace SurfaceDiffusion
