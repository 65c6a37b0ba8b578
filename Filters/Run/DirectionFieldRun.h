// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Core/Geometry/DirectionField.h"
#include "Run/SurfaceRun.h"
#include "Run/WarningLog.h"

namespace SurfaceDiffusion
{

/// Line fields on surfaces: principal curvature, the smoothest line field, or from hints.
struct DirectionFieldSettings : Settings
{
  DirectionMethod Method = DirectionMethod::PrincipalCurvature;
  int PrincipalDirection = 0; ///< 0: minimum, 1: maximum curvature
  double SmoothingLength = -1.0;
  double HintWeight = 0.1;
  double Angle = 0.0;
  bool MergeCoincidentPoints = false;
  double MergeTolerance = 0.0;
  int MaximumNumberOfSteps = 100; ///< of Smooth; no property

  void Visit(SettingVisitor& visitor) override;
  void Check(const FieldSummary* fields, Problems& problems) override;
};

/// The line field of one surface, kept as long as neither inputs nor settings change.
class DirectionFieldRun : public SurfaceRun
{
public:
  explicit DirectionFieldRun(const ParallelFor& parallel)
    : SurfaceRun(parallel, "get no direction", ", across which directions do not continue")
  {
  }

  /// Only Directions of the fields are read.
  void Update(const BlockInput& input, Settings& given, const ProgressMonitor& progress) override;

private:
  /// About the line field.
  std::vector<Warning> FindOwnWarnings() const override;
  void MakeField(const BlockInput& input, const DirectionFieldSettings& settings,
    const ProgressMonitor& progress);

  void RotateTurnedTriangles(double angle, TangentVectors& lines);

  TangentVectors Field; ///< before the rotation by Angle
  Index WithoutDirection = 0; ///< triangles where it is 0, but those of the parts below
  DirectionMethod Method = DirectionMethod::PrincipalCurvature; ///< of the field
  Index Parts = 0; ///< connected components
  Index PartsWithoutCurvature = 0; ///< whose field is 0 with the methods that follow it
  Index Turned = 0; ///< triangles with another orientation than most, if that matters
  LineFieldReport Report;
};

} // namespace SurfaceDiffusion
