// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Core/Surface/TriangleMesh.h"

namespace SurfaceDiffusion
{

/// The diffusion tensor (4) has a principal direction e1 on each triangle, a line: its sign does
/// not matter. TangentVectors hold it as a unit vector in the triangle's own axes (see
/// TriangleMesh), or (0, 0) where there is no direction and diffusion is isotropic. e2 is e1 turned
/// by 90 degrees.
///
/// Points and triangles are those that the mesh was made from.

/// Main axis of the symmetric tensor (xx xy; xy yy), such as a sum of d d^T, or zero if both of its
/// eigenvalues are alike.
Eigen::RowVector2d MainAxis(double xx, double xy, double yy);

/// From one vector per input triangle: its projection into the triangle, normalised.
TangentVectors TangentVectorsFromTriangleVectors(const TriangleMesh& mesh,
  const Eigen::Ref<const Points>& points, const Eigen::Ref<const Triangles>& triangles,
  const Eigen::Ref<const Points>& vectors, const ParallelFor& parallel = SerialFor());

/// From one vector per input point: the main axis of the sum of d d^T over the corners, so that
/// opposite vectors agree instead of cancelling.
TangentVectors TangentVectorsFromPointVectors(const TriangleMesh& mesh,
  const Eigen::Ref<const Points>& points, const Eigen::Ref<const Triangles>& triangles,
  const Eigen::Ref<const Points>& vectors, const ParallelFor& parallel = SerialFor());

/// The inverse: one vector in space per input triangle, zero for triangles that are not in the
/// mesh.
Points VectorsInSpace(const TriangleMesh& mesh, const Eigen::Ref<const Points>& points,
  const Eigen::Ref<const Triangles>& triangles, const Eigen::Ref<const TangentVectors>& vectors,
  const ParallelFor& parallel = SerialFor());

/// The axes of triangle t in space, as the columns of a 3 x 2 matrix.
Eigen::Matrix<double, 3, 2> TriangleAxes(const TriangleMesh& mesh,
  const Eigen::Ref<const Points>& points, const Eigen::Ref<const Triangles>& triangles, Index t);

} // namespace SurfaceDiffusion
