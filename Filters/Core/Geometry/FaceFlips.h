// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Core/Foundation/Parallel.h"
#include "Core/Surface/TriangleMesh.h"

#include <vector>

namespace SurfaceDiffusion
{

/// The number of triangles whose normal at these points makes more than a right angle with the
/// given one.
Index CountFlippedFaces(const TriangleMesh& mesh, const Points& normals, const Points& points);

/// Move vertices of flipped triangles (see CountFlippedFaces()) toward the middle of their
/// neighbours, mainly along the surface: vertex i approaches the minimum of
///
///   sum_f 1/3 sum_{edges (i, j) of f} (n_f . (x_i - x_j))^2 + t mean_j |x_i - x_j|^2
///
/// over x_i, by at most the whole step and the median length of the edges at the vertex, and by the
/// largest of the steps 1, 1/2, 1/4, 1/8 of that which raises the least height of the triangles
/// around it, flips no more of them, and leaves the median length of the edges at the vertex above a
/// thousandth of that in the mesh: where orientations contradict each other, surfaces would shrink
/// to points. Vertices that no such step helps stay. Hence the number of flipped triangles never grows.
/// The order is that of the vertices.
///
/// fixed: per vertex, nonzero for vertices that stay; may be empty.
void TurnFlippedFaces(const TriangleMesh& mesh, const Points& normals,
  const std::vector<char>& fixed, Points& points, const ParallelFor& parallel = SerialFor());

} // namespace SurfaceDiffusion
