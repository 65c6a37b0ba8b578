// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Core/Foundation/Parallel.h"
#include "Core/Foundation/Types.h"
#include "Core/Geometry/TriangleSides.h"

#include <vector>

namespace SurfaceDiffusion
{

/// A solid: a shell, and the shells of its cavities.
struct Body
{
  Index Triangles = 0;
  double Area = 0.0;
  double Volume = 0.0; ///< by the divergence theorem, without that of its cavities
  bool IsClosed = true; ///< it has no open edge
};

struct Bodies
{
  std::vector<Body> Table; ///< in the order of their first triangles
  std::vector<Index> OfTriangle; ///< rows of Table; -1 for collapsed triangles
  EdgeDefects Edges;
  /// Per vertex, whether it is inside another body that is closed, by more than a millionth of the
  /// size of the surface.
  std::vector<char> IsInside;
  Index Overlaps = 0; ///< pairs of closed bodies that have a part of space in common
};

/// The bodies of a surface as it is oriented. Shells are sets of triangles that edges connect. A
/// closed one with a negative volume, whose normals point inwards, is a cavity if the smallest
/// closed shell around it has a positive one, and belongs to that body. Bodies that touch do not
/// overlap.
Bodies FindBodies(
  const Points& points, const Triangles& triangles, const ParallelFor& parallel = SerialFor());

/// Orient the triangles alike across edges of two, see OrientTriangles(), and the closed shells
/// outwards of the solid: those that are in no other have a positive volume. One that has not is
/// turned, with all that are in it, so that cavities stay cavities.
void TurnOutwards(const Points& points, Triangles& triangles);

} // namespace SurfaceDiffusion
