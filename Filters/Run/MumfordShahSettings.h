// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Run/RunSettings.h"

namespace SurfaceDiffusion
{

/// Piecewise smooth data and their edges: the Mumford-Shah functional in the approximation of
/// Ambrosio and Tortorelli; see MumfordShah. Its coefficients follow from lengths and values, with
/// the smoothing term as the unit of energy:
///   lambda = FidelityWeight / SmoothingLength^2,
///   beta = EdgeThreshold^2 / (4 SmoothingLength) / (1 + h / (4 EdgeWidth)).
/// A jump j that is smoothed away has the energy j^2 / (4 SmoothingLength) per length, and an edge
/// of the discrete model beta (1 + h / (4 EdgeWidth)): two vertices have v = 0 across it.
struct MumfordShahSettings : DataSettings
{
  double SmoothingLength = 8.0;
  double EdgeThreshold = 0.2;
  double EdgeWidth = 2.0;
  double StopTolerance = 1e-5;
  bool EdgeCurves = true;

  MumfordShahSettings()
  {
    this->FidelityWeight = 1.0;
    this->NumberOfTimeSteps = 1000;
    this->Tolerance = 0.1;
    this->InitialFill = SurfaceDiffusion::InitialFill::Harmonic; // edges would form at others
  }

  void Visit(SettingVisitor& visitor) override;
  ModelTraits DescribeModel() const override;
  std::unique_ptr<Model> Make(ModelInputs& inputs, RunResult& result) const override;
  void Finish(const RunState& state, RunResult& result) const override;

protected:
  std::vector<bool> AllowedIntegrators() const override { return { true, false, false }; }
};

} // namespace SurfaceDiffusion
