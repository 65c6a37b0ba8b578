// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Core/Surface/TriangleMesh.h"

#include <vector>

namespace SurfaceDiffusion
{

/// A part of a surface that is denoised by itself.
struct SurfacePart
{
  std::vector<Index> Vertices; ///< of the whole surface, per row of Places
  Points Places; ///< of the vertices, from a vertex of their component
  Triangles Faces; ///< rows of Places, oriented by OrientTriangles()
  Index Components = 0;
  bool IsCoarse = false; ///< each of them has too few vertices for statistics
};

/// Divide a surface into its connected components. Those with less than 200 vertices, too few for
/// statistics, are one part together.
///
/// The order of rows and triangles depends on the coordinates alone, not on the numbering of the
/// input, and so do all computations with them, to the last bit. Vertices at equal places are in
/// the order of their neighbours.
///
/// points: per vertex of the mesh.
std::vector<SurfacePart> DivideSurface(
  const TriangleMesh& mesh, const Points& points, const ParallelFor& parallel = SerialFor());

} // namespace SurfaceDiffusion
