// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Core/Foundation/Parallel.h"
#include "Core/Foundation/Types.h"

#include <vector>

namespace SurfaceDiffusion
{

/// The distance from each vertex of a moved surface, against its direction, to a triangle that faced
/// away, within 30 degrees, before the move; infinite if there is none.
///
/// before, after: the vertices; normals: of the triangles before, of length 1 or 0; directions:
/// those in which the vertices moved, of length 1 except at edges, which have no wall opposite.
std::vector<double> FindWalls(const Points& before, const Points& after, const Triangles& faces,
  const Points& normals, const Points& directions, const ParallelFor& parallel);

} // namespace SurfaceDiffusion
