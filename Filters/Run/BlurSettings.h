// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Core/Models/HeatBlur.h"
#include "Run/ModelInputs.h"
#include "Run/RunSettings.h"

#include <memory>

namespace SurfaceDiffusion
{

/// The settings BlurFWHM and BlurSteps of models that restore blurred data; see HeatBlur.
struct BlurSettings
{
  double FWHM = 0.0; ///< in coordinate units; 0: the data are not blurred
  int Steps = 4;

  bool IsOn() const { return this->FWHM > 0.0; }

  void Visit(SettingVisitor& visitor);

  /// Warn in `result` of a width for which the restoration is not reliable.
  void Warn(const ModelInputs& inputs, RunResult& result) const;

  /// H. limits: of the model's linear solver, below which those of H stay.
  std::unique_ptr<HeatBlur> Make(ModelInputs& inputs, const IterationLimits& limits) const;
};

} // namespace SurfaceDiffusion
