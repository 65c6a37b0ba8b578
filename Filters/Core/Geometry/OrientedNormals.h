// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Core/Surface/TriangleMesh.h"

namespace SurfaceDiffusion
{

/// Normals of a surface whose triangles may have any orientation: see OrientTriangles().
struct OrientedNormals
{
  Points OfTriangles; ///< unit vectors, with one orientation where the surface has two sides
  Points OfVertices; ///< the directions of their means weighted by area; 0 if that is 0
  Index TurnedTriangles = 0; ///< those with an orientation that is the opposite one
};

/// positions: per vertex of the mesh, in LengthUnit().
OrientedNormals FindOrientedNormals(
  const TriangleMesh& mesh, const Points& positions, const ParallelFor& parallel = SerialFor());

} // namespace SurfaceDiffusion
