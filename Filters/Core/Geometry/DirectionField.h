// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Core/Foundation/ProgressMonitor.h"
#include "Core/Operators/Assembler.h"
#include "Core/Solvers/LinearSolver.h"

namespace SurfaceDiffusion
{

/// The fields of directions that the filters offer, per triangle (see TangentVectors.h).
enum class DirectionMethod
{
  PrincipalCurvature, ///< the direction in which the surface bends least
  CurvatureAligned, ///< the same where it is distinct, joined by a smooth field
  Smooth, ///< the smoothest line field, among equals the one nearest to the first
  Hints ///< smooth, and near what is given
};

struct DirectionSettings
{
  DirectionMethod Method = DirectionMethod::PrincipalCurvature;
  bool Perpendicular = false; ///< the direction in which the surface bends most instead
  double SmoothingLength = 0.0; ///< full width at half maximum, in LengthUnit()
  double HintWeight = 1.0; ///< in 1/LengthUnit()^2
  double Angle = 0.0; ///< by which the field is turned at the end, in radians
};

/// hints: for DirectionMethod::Hints; zero rows: none. points, triangles: what the mesh was made
/// from.
TangentVectors MakeDirectionField(const Assembler& assembler,
  const Eigen::Ref<const Points>& points, const Eigen::Ref<const Triangles>& triangles,
  const Eigen::Ref<const TangentVectors>& hints, const DirectionSettings& settings,
  const ParallelFor& parallel = SerialFor(), const ProgressMonitor& progress = ProgressMonitor());

} // namespace SurfaceDiffusion
