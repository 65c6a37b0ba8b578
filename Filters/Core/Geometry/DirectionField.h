// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Core/Foundation/ProgressMonitor.h"
#include "Core/Geometry/SmoothLineField.h"
#include "Core/Operators/Assembler.h"
#include "Core/Solvers/LinearSolver.h"

namespace SurfaceDiffusion
{

/// The direction fields that the filters offer, tangent vectors per triangle.
enum class DirectionMethod
{
  PrincipalCurvature, ///< the minimum-curvature direction
  CurvatureAligned, ///< the minimum-curvature direction where it is distinct, smooth elsewhere
  Smooth, ///< of the smoothest line fields the one nearest to the minimum-curvature direction
  Hints ///< smooth, and near given directions
};

struct DirectionSettings
{
  DirectionMethod Method = DirectionMethod::PrincipalCurvature;
  bool Perpendicular = false; ///< the maximum-curvature direction instead
  double SmoothingLength = 0.0; ///< of the normals: full width at half maximum, in LengthUnit()
  double HintWeight = 1.0; ///< in 1/LengthUnit()^2
  int MaximumNumberOfSteps = 100; ///< of SmoothestLineField()
};

/// hints: tangent vectors for DirectionMethod::Hints, a zero row for a triangle without hint.
/// points, triangles: the input of the mesh. Throws Aborted, NotConverged.
TangentVectors MakeDirectionField(const Assembler& assembler,
  const Eigen::Ref<const Points>& points, const Eigen::Ref<const Triangles>& triangles,
  const Eigen::Ref<const TangentVectors>& hints, const DirectionSettings& settings,
  const ParallelFor& parallel = SerialFor(), const ProgressMonitor& progress = ProgressMonitor(),
  LineFieldReport* report = nullptr);

/// Rotate all lines by an angle in radians, each in its triangle.
void RotateLines(TangentVectors& lines, double angle, const ParallelFor& parallel = SerialFor());

} // namespace SurfaceDiffusion
