// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Core/Models/ChannelNorms.h"
#include "Core/Models/Model.h"
#include "Core/Models/TotalVariationMinimizer.h"
#include "Core/Operators/MeanCorrection.h"

#include <memory>

namespace SurfaceDiffusion
{

/// (2) with fidelity, (17), (19), for edge functions with a convex energy (TotalVariation without
/// beta, Charbonnier, Constant), by minimising that energy:
///
/// - a time step is backward Euler with the weights at the new level, the minimiser of
///   E(u) + int |u - u_old|^2/(2 dt). It has no error from lagged weights and may be of any size.
/// - the steady state is the minimiser of E itself, in one step:
///   E(u) = int psi(|grad u|) + lambda/2 int 1_D |u - f|^2, or lambda int 1_D |u - f| with L1.
///
/// With diffusivities g1 along and g2 across a direction, E has
///   total variation: sqrt((g1 grad u . e1)^2 + (g2 grad u . e2)^2);
///   others: g psi(sqrt((g1/g) (grad u . e1)^2 + (g2/g) (grad u . e2)^2)), g the larger of the two:
/// for gradients along e1 or e2, and always where g1 = g2, the flux then is that of (4).
class TotalVariationFlow : public Model
{
public:
  struct Settings
  {
    bool SteadyState = false;
    double TimeStep = 1.0;
    double Fidelity = 0.0; ///< lambda, in 1/time; value/time with L1
    EdgeFunction Function; ///< TotalVariation, Charbonnier or Constant
    double AlongDiffusivity = 1.0;
    double AcrossDiffusivity = 1.0;
    ChannelCoupling Coupling = ChannelCoupling::Joint;
    FidelityNorm Norm = FidelityNorm::L2;
    double StopTolerance = 1e-4; ///< relative duality gap, see TotalVariationMinimizer
    int MaximumNumberOfIterations = 10000;
  };

  /// frames: e1 per triangle (see TangentVectors.h), without rows where g1 = g2.
  TotalVariationFlow(std::shared_ptr<const Assembler> assembler, const TangentVectors& frames,
    PointData data, const Settings& settings, const ParallelFor& parallel = SerialFor());

  const Values& State() const override { return this->U; }

  /// Iterations are those of the minimiser, the residual is its duality gap; where the most
  /// iterations end it, the gap is above the tolerance.
  StepReport Advance(const ProgressMonitor& progress) override;

  /// E(u).
  double Energy() const override;

  void Restore(const double* checkpoint) override;

private:
  double FidelityAt(Index i) const { return this->Data.Missing[i] ? 0.0 : this->Options.Fidelity; }

  std::shared_ptr<const Assembler> Operators;
  PointData Data;
  Settings Options;
  const ParallelFor& Parallel;
  TotalCorrection Conserved;
  double Diffusivity; ///< the larger of the two, in front of E's first integral
  std::unique_ptr<TotalVariationMinimizer> Minimizer;
  Values U, Target;
};

} // namespace SurfaceDiffusion
