// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Core/Models/Textures/ReactionDiffusion.h"
#include "Run/RunSettings.h"

#include <array>
#include <vector>

namespace SurfaceDiffusion
{

struct TextureRates;

/// Reaction-diffusion of two chemicals, u_t = div(D grad u) + F(u): (22) to (24).
struct TextureSettings : TimeSettings
{
  SurfaceDiffusion::TimeIntegrator TimeIntegrator = SurfaceDiffusion::TimeIntegrator::SecondOrder;
  KineticsName Kinetics = KineticsName::Turing;
  double ReactionRate = 1.0;
  double DiffusionRate1 = 21.0;
  double DiffusionRate2 = 2.6;
  double DiffusionRateAcross1 = -1.0;
  double DiffusionRateAcross2 = -1.0;
  double FeatureSize = 0.0;
  double InitialNoise = 0.1;
  bool ClampToNonNegative = true;
  bool AutomaticTimeStep = false;
  double StopTolerance = 0.02; ///< measured: the pattern stands
  int CoarseStartSize = 50000; ///< the largest surface whose first run takes about 10 s
  /// Those of each kinetics, in the order of its list of parameters.
  std::array<KineticsParameters, NumberOfKinetics> Parameters;
  int TextureChemical = 0; ///< 0: u1, 1: u2
  bool ColorOutput = false;
  std::vector<double> LowColor = { 0.16, 0.09, 0.05 }; ///< dark brown
  std::vector<double> HighColor = { 0.93, 0.80, 0.58 }; ///< sand

  TextureSettings();

  void Visit(SettingVisitor& visitor) override;
  ModelTraits DescribeModel() const override;
  std::unique_ptr<Model> Make(ModelInputs& inputs, RunResult& result) const override;
  std::vector<Output> Finish(const RunState& state, RunResult& result) const override;

  /// The length of edges with which FeatureSize has eight of them, if the mesh with these mean edges
  /// is too coarse for FeatureSize, and otherwise 0.
  double EdgeLengthForFeatures(double meanEdgeLength) const;

  /// The time step taken: TimeStep, or that of AutomaticTimeStep.
  double EffectiveTimeStep() const;

protected:
  void CheckTogether(const FieldSummary* fields, Problems& problems) const override;

private:
  bool HasKnownKinetics() const;
  const KineticsParameters& ChosenParameters() const;
  Eigen::Matrix2d JacobianAtRest() const;
  /// Whether a rate across differs from the rate along.
  bool HasDirectedRates() const;
  /// FeatureSize, or the wavelength that suits the surface with 0; 0 if the rates stay.
  double EffectiveFeatureSize(const ModelInputs& inputs) const;
  TextureRates MakeRates(const ModelInputs& inputs, RunResult& result) const;
  Reaction MakeStart(ModelInputs& inputs, bool fromNoise) const;
  bool MayStartCoarse(const ModelInputs& inputs) const;
  static std::array<CornerWeights, 2> MakeCoefficients(
    const ModelInputs& inputs, const TextureRates& rates);
  IterationLimits CoarseLimits() const;
  std::array<ReactionDiffusion::Chemical, 2> MakeChemicals(ModelInputs& inputs,
    const TextureRates& rates, std::array<CornerWeights, 2> coefficients,
    const ReactionDiffusion::Settings& settings, bool startsCoarse) const;
};

} // namespace SurfaceDiffusion
