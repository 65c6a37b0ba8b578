// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Run/BlurSettings.h"
#include "Run/RunSettings.h"
#include "Run/VectorSettings.h"

#include <functional>

namespace SurfaceDiffusion
{

enum class HeatMode
{
  TimeSteps,
  SteadyState ///< the limit of infinite time, in one solve
};

enum class MassMatrix
{
  Automatic, ///< Mixed for a width, Lumped for time steps
  Lumped,
  Mixed ///< see MixedMass.h
};

/// Linear diffusion with fidelity, u_t = div(D grad u) + lambda chi (f - u): (1), (4), (16), (18).
struct HeatSettings : DataSettings
{
  HeatMode Mode = HeatMode::TimeSteps;
  SurfaceDiffusion::TimeIntegrator TimeIntegrator = SurfaceDiffusion::TimeIntegrator::Automatic;
  SurfaceDiffusion::MassMatrix MassMatrix = SurfaceDiffusion::MassMatrix::Automatic;
  double FWHM = 0.0; ///< in coordinate units; 0: TimeStep is used
  bool AutomaticFidelity = false;
  double NoiseLevel = 0.0;
  BlurSettings Blur;
  VectorSettings Vectors;
  double Period = 0.0;

  HeatSettings()
  {
    this->Tolerance = 1e-6;
    this->InitialFill = SurfaceDiffusion::InitialFill::Harmonic;
  }

  void Visit(SettingVisitor& visitor) override;
  ModelTraits DescribeModel() const override;
  std::unique_ptr<Model> Make(ModelInputs& inputs, RunResult& result) const override;
  std::vector<Output> Finish(const RunState& state, RunResult& result) const override;

protected:
  void CheckTogether(const FieldSummary* fields, Problems& problems) const override;

private:
  /// Whether lambda is found; with a blur that is the default.
  bool FindsFidelity() const
  {
    return this->AutomaticFidelity || (this->Blur.IsOn() && this->FidelityWeight == 0.0);
  }
  std::unique_ptr<Model> MakeDeblurring(ModelInputs& inputs, RunResult& result) const;
  using Maker = std::function<std::unique_ptr<Model>(PointData data,
    const LinearDiffusion::Settings& settings, std::shared_ptr<LinearSolver> solver)>;
  /// Makes models of scalars or, with planes, of tangent vectors. It and they must not outlive
  /// `inputs`.
  Maker DiffusionMaker(const ModelInputs& inputs, std::shared_ptr<const TangentPlanes> planes,
    CornerWeights weights, const SolverTask& task) const;
  void WarnOfWidth(const ModelInputs& inputs, RunResult& result) const;
};

} // namespace SurfaceDiffusion
