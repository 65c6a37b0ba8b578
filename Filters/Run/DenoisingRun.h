// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Core/Geometry/SurfaceDenoising.h"
#include "Run/SurfaceRun.h"
#include "Run/WarningLog.h"

namespace SurfaceDiffusion
{

/// Mesh denoising in the user's terms.
struct DenoisingRunSettings : Settings
{
  double NoiseLevel = 0.0;
  double NoiseLength = 0.0;
  SurfaceDiffusion::SurfaceType SurfaceType = SurfaceDiffusion::SurfaceType::Automatic;
  double CreaseAngle = 0.0;
  double DisplacementLimit = 0.0;
  bool MergeCoincidentPoints = false;
  double MergeTolerance = 0.0;

  void Visit(SettingVisitor& visitor) override;
};

/// The denoised points of one surface, kept as long as neither inputs nor settings change.
class DenoisingRun : public SurfaceRun
{
public:
  explicit DenoisingRun(const ParallelFor& parallel)
    : SurfaceRun(parallel, "have no normal", " and may come apart")
  {
  }

  /// Only Fixed and Seeds of the fields are read; these are CreaseArray.
  void Update(const BlockInput& input, Settings& given, const ProgressMonitor& progress) override;

private:
  /// About coincident points that may come apart, correlated noise, and points that moved far.
  std::vector<Warning> FindOwnWarnings() const override;
  void ListResults(const Points& moved);

  DenoisingReport Found;
};

} // namespace SurfaceDiffusion
