// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Core/Models/Interpolation/SmoothInterpolation.h"
#include "Run/RunSettings.h"

namespace SurfaceDiffusion
{

/// Smooth functions through values at a few points, see SmoothInterpolation.
struct InterpolationSettings : RunSettings
{
  double CorrelationLength = 0.0;
  bool Exact = false;
  bool AutomaticSmoothing = true;
  double NoiseLevel = 0.0;
  double Smoothing = 1.0;
  bool KeepRange = false;
  bool ComputeError = false;
  bool Robust = false;
  bool LeaveOneOut = false;
  RimCondition Boundary = RimCondition::Automatic;
  double MaximumDistance = 0.0;
  std::vector<double> MissingValue;
  double AlongDiffusivity = 1.0;
  double AcrossDiffusivity = 1.0;
  bool ResultOnCells = true;

  void Visit(SettingVisitor& visitor) override;
  ModelTraits DescribeModel() const override;
  std::unique_ptr<Model> Make(ModelInputs& inputs, RunResult& result) const override;
  std::vector<Output> Finish(const RunState& state, RunResult& result) const override;

  bool IsDirected() const { return this->AlongDiffusivity != this->AcrossDiffusivity; }
  bool HasDiffusivities() const
  {
    return this->AlongDiffusivity != 1.0 || this->AcrossDiffusivity != 1.0;
  }

protected:
  void CheckTogether(const FieldSummary* fields, Problems& problems) const override;

private:
  SmoothInterpolation::Settings MakeCoreSettings(const UnitSystem& units) const;
};

} // namespace SurfaceDiffusion
