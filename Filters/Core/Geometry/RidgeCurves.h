// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Core/Foundation/Parallel.h"
#include "Core/Surface/TriangleMesh.h"

#include <vector>

namespace SurfaceDiffusion
{

/// Polylines on a surface.
struct Polylines
{
  SurfaceDiffusion::Points Points; ///< of all lines, one after another
  /// Line l has the points Begin[l] .. Begin[l + 1]; a closed line repeats its first point.
  std::vector<Index> Begin = { 0 };
  std::vector<Index> Vertices; ///< per point, the vertex of the mesh that it is next to

  Index NumberOfLines() const { return static_cast<Index>(this->Begin.size()) - 1; }
  /// The length of line l.
  double Length(Index l) const;
};

/// The ridges of a function in [0, 1] that is near 1 along curves and falls off on both sides, such
/// as 1 - v of MumfordShah: one line per piece of a curve between its ends and junctions.
///
/// The vertices with values of a half and above are thinned to curves; see VertexCurves. Side
/// branches shorter than `shortest` are removed, and so are lines that are shorter as a whole. Each
/// point moves to the ridge of a quadratic function, fitted to the values around its vertex, by at
/// most the mean length of its edges.
///
/// points: coordinates per input point of the mesh; values: per vertex; shortest: in units of the
/// coordinates. The mesh must be one in space, not an intrinsic triangulation.
Polylines FindRidges(const TriangleMesh& mesh, const Eigen::Ref<const Points>& points,
  const Vector& values, double shortest, const ParallelFor& parallel = SerialFor());

} // namespace SurfaceDiffusion
