// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Core/Operators/Assembler.h"
#include "Core/Solvers/LinearSolver.h"

namespace SurfaceDiffusion
{

/// Directions of principal curvature per triangle, and how distinct they are.
struct PrincipalDirections
{
  /// The minimum-curvature direction, of the smaller |kappa|, or (0, 0) if both are alike, up to
  /// what the rounding of the coordinates may cause. The maximum-curvature direction is perpendicular to it.
  TangentVectors MinimumCurvature;
  /// ||kappa_1| - |kappa_2||, in 1/LengthUnit().
  Vector Difference;
  /// The largest relative residual of the solves that missed the tolerance, otherwise 0.
  double MissedResidual = 0.0;
};

/// From the shape operator, the derivative of the surface normal, on each triangle. The normal at a
/// vertex is the main axis of the area-weighted mean of n n^T around it, which needs no
/// orientation. Before, n n^T is smoothed by the heat equation (8) over `fwhm`, the full width at
/// half maximum of the Gaussian in LengthUnit(); 0: no smoothing. points, triangles: the input of
/// the mesh. Throws Aborted, NotConverged.
PrincipalDirections FindPrincipalDirections(const Assembler& assembler,
  const Eigen::Ref<const Points>& points, const Eigen::Ref<const Triangles>& triangles, double fwhm,
  LinearSolver& solver, const ParallelFor& parallel = SerialFor(),
  const ProgressMonitor& progress = ProgressMonitor());

} // namespace SurfaceDiffusion
