// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Core/Models/EdgeFunctions.h"
#include "Core/Models/Fidelity.h"
#include "Run/BlurSettings.h"
#include "Run/ColorSettings.h"
#include "Run/RunSettings.h"

namespace SurfaceDiffusion
{

enum class TotalVariationMode
{
  TimeSteps,
  SteadyState ///< the minimiser of the energy
};

enum class Regularizer
{
  TV,
  TGV ///< total generalised variation
};

enum class Discretization
{
  Linear,
  CrouzeixRaviart
};

/// Nonlinear diffusion u_t = div(g(|grad u|) grad u) + lambda chi (f - u) with an edge-stopping
/// function g, and the minimiser of its energy: (2), (3), (17), (19).
struct TotalVariationSettings : DataSettings
{
  TotalVariationMode Mode = TotalVariationMode::TimeSteps;
  SurfaceDiffusion::TimeIntegrator TimeIntegrator = SurfaceDiffusion::TimeIntegrator::FirstOrder;
  SurfaceDiffusion::Regularizer Regularizer = SurfaceDiffusion::Regularizer::TV;
  double TGVLength = 2.0;
  EdgeFunctionKind EdgeFunction = EdgeFunctionKind::TotalVariation;
  int AcrossEdgeFunction = 0; ///< 0: the same; k: the edge function k - 1
  double Beta = 1e-6;
  double EdgeThreshold = 0.1;
  SurfaceDiffusion::ChannelCoupling ChannelCoupling = SurfaceDiffusion::ChannelCoupling::Joint;
  SurfaceDiffusion::FidelityNorm FidelityNorm = SurfaceDiffusion::FidelityNorm::L2;
  bool AutomaticFidelity = true; ///< the default weight stands for one that is found
  double NoiseLevel = 0.0;
  SurfaceDiffusion::Discretization Discretization = SurfaceDiffusion::Discretization::Linear;
  double StopTolerance = 1e-4;
  BlurSettings Blur;
  bool AutomaticBlurFidelity = true; ///< the same with a blur
  ColorSettings Color;

  static constexpr double DefaultFidelityWeight = 3.0;

  TotalVariationSettings()
  {
    this->FidelityWeight = DefaultFidelityWeight;
    this->Tolerance = 1e-3;
  }

  void Visit(SettingVisitor& visitor) override;
  ModelTraits DescribeModel() const override;
  std::unique_ptr<Model> Make(ModelInputs& inputs, RunResult& result) const override;
  std::vector<Output> Finish(const RunState& state, RunResult& result) const override;

  /// Whether steps minimise an energy, in place of the paper's lagged scheme.
  bool Minimizes() const
  {
    return this->Mode == TotalVariationMode::SteadyState ||
      this->TimeIntegrator == SurfaceDiffusion::TimeIntegrator::Implicit;
  }

protected:
  void CheckTogether(const FieldSummary* fields, Problems& problems) const override;

private:
  /// Whether lambda is found: of convex energies with FidelityNorm L2, at its default.
  bool FindsFidelity() const;
  std::vector<const char*> FindSettingsInRange() const;
  void CheckBlur(Problems& problems) const;
  void CheckRegularizer(Problems& problems) const;
  void CheckColorModel(const FieldSummary* fields, Problems& problems) const;
  void RequireConvexEnergy(const Sentence& purpose, Problems& problems) const;
  const char* NameOfResidual() const;
};

} // namespace SurfaceDiffusion
