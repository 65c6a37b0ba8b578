// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Run/RunSettings.h"

#include <vector>

namespace SurfaceDiffusion
{

/// Regions by the convex Chan-Vese and Potts models, see Segmentation: the steady state.
struct SegmentationSettings : RunSettings
{
  int NumberOfRegions = 2;
  bool AutomaticFidelity = true;
  double FidelityWeight = 0.3;
  bool AutomaticMeans = true;
  /// c_1, then c_2, ... with all components of each; NaN: not set.
  std::vector<double> Means;
  double StopTolerance = 1e-3;
  bool ResultOnCells = true;

  void Visit(SettingVisitor& visitor) override;
  ModelTraits DescribeModel() const override;
  std::unique_ptr<Model> Make(ModelInputs& inputs, RunResult& result) const override;
  std::vector<Output> Finish(const RunState& state, RunResult& result) const override;

protected:
  void CheckTogether(const FieldSummary* fields, Problems& problems) const override;
};

} // namespace SurfaceDiffusion
