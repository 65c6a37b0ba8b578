// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Core/Models/Interpolation/SmoothInterpolation.h"
#include "Core/Models/Model.h"

#include <memory>

namespace SurfaceDiffusion
{

/// SmoothInterpolation as a model: one step from the weighted mean of the values to the fit.
class InterpolationModel : public StateModel
{
public:
  /// data: at least one value. isRobust: values that others contradict are left out, see FindOutliers().
  InterpolationModel(std::shared_ptr<const Assembler> assembler, CornerWeights coefficients,
    ScatteredValues data, const SmoothInterpolation::Settings& settings,
    const ParallelFor& parallel = SerialFor(), bool isRobust = false);

  /// Throws as SmoothInterpolation::Fit().
  StepReport Advance(const ProgressMonitor& progress) override;
  /// E(u) with the mu that was found; with exact values, its limit as mu tends to 0.
  double Energy() const override
  {
    return this->IsFitted ? this->EnergyOfFit : this->EnergyOfStart;
  }
  std::size_t CheckpointSize() const override;
  void Save(double* checkpoint) const override;
  void Restore(const double* checkpoint) override;

  /// What the step found; nothing at the start.
  const SmoothInterpolation::Result& Found() const
  {
    return this->IsFitted ? this->Last : this->None;
  }
  const ScatteredValues& Given() const { return this->Data; }
  /// d x k, 1 for values that were left out.
  const Values& Outliers() const { return this->LeftOut; }

private:
  void FitWithoutOutliers(const ProgressMonitor& progress);

  SmoothInterpolation Method;
  std::unique_ptr<const SmoothInterpolation> Search; ///< of outliers; null: all values count
  ScatteredValues Data;
  Values LeftOut;
  SmoothInterpolation::Result Last, None;
  bool IsFitted = false; ///< the state is that of Last
  double EnergyOfStart = 0.0;
  double EnergyOfFit = 0.0;
};

} // namespace SurfaceDiffusion
