// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Core/Surface/TriangleMesh.h"

namespace SurfaceDiffusion
{

/// e1 of (4) on each triangle, as a unit vector in the triangle's own axes (see TriangleMesh);
/// e2 is e1 turned by 90 degrees. (0, 0) where there is no direction: isotropic there. The sign
/// does not matter anywhere.
///
/// All that take points and triangles take those that the mesh was made from.

/// Main axis of the symmetric tensor (xx xy; xy yy), such as a sum of d d^T; zero where there is
/// none.
Eigen::RowVector2d MainAxis(double xx, double xy, double yy);

/// From one vector per input triangle: its projection into the triangle, normalised.
TangentVectors FramesFromTriangleVectors(const TriangleMesh& mesh,
  const Eigen::Ref<const Points>& points, const Eigen::Ref<const Triangles>& triangles,
  const Eigen::Ref<const Points>& vectors, const ParallelFor& parallel = SerialFor());

/// From one vector per input point: the main axis of the sum of d d^T over the corners, so that
/// opposite vectors agree instead of cancelling.
TangentVectors FramesFromPointVectors(const TriangleMesh& mesh,
  const Eigen::Ref<const Points>& points, const Eigen::Ref<const Triangles>& triangles,
  const Eigen::Ref<const Points>& vectors, const ParallelFor& parallel = SerialFor());

/// The way back: one vector in space per input triangle, zero for those that are not in the mesh.
Points VectorsFromFrames(const TriangleMesh& mesh, const Eigen::Ref<const Points>& points,
  const Eigen::Ref<const Triangles>& triangles, const Eigen::Ref<const TangentVectors>& frames,
  const ParallelFor& parallel = SerialFor());

/// The axes of triangle t in space, as the columns of a 3 x 2 matrix.
Eigen::Matrix<double, 3, 2> TriangleAxes(const TriangleMesh& mesh,
  const Eigen::Ref<const Points>& points, const Eigen::Ref<const Triangles>& triangles, Index t);

} // namespace SurfaceDiffusion
