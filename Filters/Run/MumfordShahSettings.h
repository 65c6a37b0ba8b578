// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Core/Models/MumfordShah.h"
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
///
/// With AutomaticThreshold each connected component has the EdgeThreshold and the SmoothingLength
/// of FindEdgeScales(). Its edges then form with eps = EdgeWidth, without the continuation in eps:
/// near the edges of a large eps noise is not smoothed, and makes edges that stay when eps falls.
struct MumfordShahSettings : DataSettings
{
  bool AutomaticThreshold = true;
  double NoiseLevel = 0.0;
  double EdgeThreshold = 0.2;
  double SmoothingLength = 8.0;
  double EdgeWidth = 2.0;
  double StopTolerance = 1e-5;
  bool EdgeCurves = true;

  MumfordShahSettings();

  void Visit(SettingVisitor& visitor) override;
  ModelTraits DescribeModel() const override;
  std::unique_ptr<Model> Make(ModelInputs& inputs, RunResult& result) const override;
  std::vector<Output> Finish(const RunState& state, RunResult& result) const override;

protected:
private:
  double EdgeCost(const UnitSystem& units, double jump, double length) const;
  /// Set lambda and beta. Both return the longest SmoothingLength, in the unit of the mesh.
  double UseGivenScales(
    const ModelInputs& inputs, MumfordShah::Settings& settings, RunResult& result) const;
  double UseFoundScales(
    ModelInputs& inputs, MumfordShah::Settings& settings, RunResult& result) const;
  void WarnOfManyEdges(const RunState& state, double share, RunResult& result) const;
};

} // namespace SurfaceDiffusion
