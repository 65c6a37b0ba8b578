// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Core/Solvers/LinearSolver.h"
#include "Core/Surface/PointData.h"
#include "Core/Surface/TriangleMesh.h"

namespace SurfaceDiffusion
{

/// The relative change of the volume above which a warning says that shape was taken for noise.
constexpr double LargestVolumeChange = 0.02;

/// How far a surface was moved, in coordinate units.
struct VertexMotion
{
  double MeanDisplacement = 0.0; ///< area-weighted over the vertices
  double MaximumDisplacement = 0.0;
  /// See EnclosedVolume().
  double VolumeBefore = 0.0;
  double VolumeAfter = 0.0;
  /// The relative residual of the fit if it missed the tolerance, otherwise 0.
  double MissedResidual = 0.0;
};

/// The enclosed volume, signed by the orientation; 0 unless the surface is closed and consistently
/// oriented. points: of the input, in any unit.
double EnclosedVolume(
  const TriangleMesh& mesh, const Eigen::Ref<const Points>& points, const ParallelFor& parallel);

/// Vertex updating: move the vertices of a surface so that its triangles turn as vectors at the
/// vertices have turned, the second half of denoising a mesh by its normals. x minimises
///   1/2 int |grad(N . x)|^2 + 1/(2 range^2) int |x - x_0|^2,
/// for x linear on each triangle and N constant on it. The first integral vanishes if every triangle
/// is orthogonal to its N. `range`, in coordinate units, is the length over which shapes may adapt:
/// features wider than `range` are preserved.
///
/// N has the direction of m + r R (n - m_0), with the normal n of the triangle, the directions m_0 and
/// m of the means of the vectors at its corners before and after, the smallest rotation R from m_0 to
/// m, and r = max(0, 1 - 1000 s)^2 with the sum s of the squared changes of the vectors. So vectors that
/// have not changed move no point, and where they have, triangles lose what they have beside the mean
/// of their corners, noise among it. Where vectors before are missing, r = 0.
///
/// points: those that the mesh was made from; before: unit vectors in Start, Missing where they are
/// not known, per mesh vertex; after: n x 3 unit vectors. Signs of vectors and the orientation of
/// triangles do not matter. Points that are not vertices of the mesh stay. The linear system is
/// solved by conjugate gradients; factorize: whether a factorisation follows if they do not
/// converge. Throws Aborted, NotConverged.
Points UpdateVerticesFromNormals(const TriangleMesh& mesh, const Eigen::Ref<const Points>& points,
  const PointData& before, const Values& after, double range, VertexMotion& motion,
  const IterationLimits& limits = IterationLimits(), bool factorize = true,
  const ParallelFor& parallel = SerialFor(), const ProgressMonitor& progress = ProgressMonitor());

} // namespace SurfaceDiffusion
