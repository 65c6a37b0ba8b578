// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Core/Solvers/LinearSolver.h"
#include "Core/Surface/TriangleMesh.h"

namespace SurfaceDiffusion
{

/// How far a surface was moved, in coordinate units.
struct VertexMotion
{
  double MeanDisplacement = 0.0; ///< area-weighted over the vertices
  double MaximumDisplacement = 0.0;
  double VolumeBefore = 0.0; ///< enclosed, signed by the orientation; 0 unless the surface is
  double VolumeAfter = 0.0; ///< closed and consistently oriented
};

/// Move the vertices of a surface so that its triangles stand upright on given normals, the second
/// half of denoising a mesh by its normals: x minimises
///   1/2 int |grad(N . x)|^2 + 1/(2 range^2) int |x - x_0|^2,
/// x linear on each triangle and N the triangle's normal, the main axis of the sum of u u^T over
/// its corners. On flat parts the first integral vanishes exactly where the triangles are
/// orthogonal to N. `range`, in coordinate units, is the length over which shapes may adapt: what
/// is wider keeps its place.
///
/// points: those the mesh was made from; normals: n x 3 unit vectors, per mesh vertex; points that
/// are no vertex stay. Throws Aborted, NotConverged.
Points UpdateVerticesFromNormals(const TriangleMesh& mesh, const Eigen::Ref<const Points>& points,
  const Values& normals, double range, VertexMotion& motion,
  const IterationLimits& limits = IterationLimits(), const ParallelFor& parallel = SerialFor(),
  const ProgressMonitor& progress = ProgressMonitor());

} // namespace SurfaceDiffusion
