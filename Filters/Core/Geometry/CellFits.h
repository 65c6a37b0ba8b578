// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Core/Operators/CellTransfer.h"

namespace SurfaceDiffusion
{

/// Values at the vertices, one row each, of functions that are known by their means over the cells,
/// one row of `ofCells` each. The value at a vertex is that of the linear function of the position in
/// its tangent plane that fits the means at the centroids of the cells around it, by least squares
/// with the areas of the cells as weights; at the boundary, where these lie on one side, also the
/// cells around their vertices. On planes linear functions are exact, which means of the cells
/// around a vertex are only if their centroid is the vertex. Where the centroids lie on a line, the
/// function is constant across it.
///
/// positions, normals: per vertex of `mesh`, which `transfer` was made for.
Values FitCells(const TriangleMesh& mesh, const CellTransfer& transfer, const Points& positions,
  const Points& normals, const Values& ofCells, const ParallelFor& parallel);

} // namespace SurfaceDiffusion
