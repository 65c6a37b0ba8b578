// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Core/Geometry/Curvature.h"
#include "Run/SurfaceRun.h"
#include "Run/WarningLog.h"

namespace SurfaceDiffusion
{

/// Curvature in the user's terms.
struct CurvatureSettings : Settings
{
  double FWHM = 0.0;
  bool MergeCoincidentPoints = false;
  double MergeTolerance = 0.0;

  void Visit(SettingVisitor& visitor) override;
};

/// The curvatures of one surface, kept as long as neither inputs nor settings change.
class CurvatureRun : public SurfaceRun
{
public:
  explicit CurvatureRun(const ParallelFor& parallel)
    : SurfaceRun(parallel, "have no curvature", " and are not their neighbours")
  {
  }

  /// No field is read.
  void Update(const BlockInput& input, Settings& given, const ProgressMonitor& progress) override;
  bool ExcludesMasked() const override { return true; }

private:
  /// About turned triangles, and about solves that missed their tolerance.
  std::vector<Warning> FindOwnWarnings() const override;

  Curvatures Found;
};

} // namespace SurfaceDiffusion
