// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Core/Surface/TriangleMesh.h"

#include <vector>

namespace SurfaceDiffusion
{

/// Normals of a surface whose triangles may have any orientation: see OrientTriangles().
struct OrientedNormals
{
  Points OfTriangles; ///< unit vectors, with one orientation where the surface has two sides
  Points OfVertices; ///< the directions of their means weighted by area; 0 if that is 0
  Index TurnedTriangles = 0; ///< those with an orientation that is the opposite one
  /// Per corner 3 t + a, on surfaces with one side, such as a Moebius strip: -1 where the normal of
  /// triangle t counts with the opposite sign at corner a, so that those around a vertex have one
  /// orientation. No entries if there are no such surfaces.
  std::vector<signed char> SidesOfCorners;
  std::vector<char> OnOneSide; ///< per vertex: nonzero on surfaces with one side; or no entries

  double SideOf(Index corner) const
  {
    return this->SidesOfCorners.empty() ? 1.0 : this->SidesOfCorners[corner];
  }
  bool IsOnOneSide(Index vertex) const
  {
    return !this->OnOneSide.empty() && this->OnOneSide[vertex] != 0;
  }
};

/// positions: per vertex of the mesh, in LengthUnit().
OrientedNormals FindOrientedNormals(
  const TriangleMesh& mesh, const Points& positions, const ParallelFor& parallel = SerialFor());

/// The directions of the sums of e x f/(|e|^2 |f|^2) over the triangles around each vertex with the
/// edges e and f there, which are the normals of spheres where the vertices lie on one (N. Max, J.
/// Graphics Tools 4(2), 1999); 0 if that is 0.
Points SphericalNormals(const TriangleMesh& mesh, const OrientedNormals& normals,
  const ParallelFor& parallel = SerialFor());

} // namespace SurfaceDiffusion
