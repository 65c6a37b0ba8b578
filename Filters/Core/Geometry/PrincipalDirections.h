// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Core/Operators/Assembler.h"
#include "Core/Solvers/LinearSolver.h"

namespace SurfaceDiffusion
{

/// Directions of principal curvature per triangle, with what tells how much they mean.
struct PrincipalDirections
{
  /// Along which the surface bends least, (0, 0) where it bends alike in all directions; the
  /// direction in which it bends most is perpendicular.
  TangentVectors LeastBent;
  /// ||k1| - |k2||, the difference of the principal curvatures' sizes, in 1/LengthUnit().
  Vector Strength;
};

/// From the derivative of the surface normal on each triangle. The normal at a vertex is the main
/// axis of the mean of n n^T around it, which needs no orientation; smoothed beforehand by the heat
/// equation (8) on n n^T over `fwhm`, the full width at half maximum of the Gaussian in
/// LengthUnit(), 0: not at all. points, triangles: what the mesh was made from.
PrincipalDirections FindPrincipalDirections(const Assembler& assembler,
  const Eigen::Ref<const Points>& points, const Eigen::Ref<const Triangles>& triangles, double fwhm,
  LinearSolver& solver, const ParallelFor& parallel = SerialFor(),
  const ProgressMonitor& progress = ProgressMonitor());

} // namespace SurfaceDiffusion
