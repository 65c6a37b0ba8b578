// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Core/Models/Fidelity.h"
#include "Core/Models/Model.h"
#include "Core/Models/TotalVariationMinimizer.h"
#include "Core/Operators/MeanCorrection.h"

#include <memory>

namespace SurfaceDiffusion
{

/// The gradient flow of a convex energy, total variation (2) and others, with fidelity (17), (19),
/// for edge-stopping functions with a convex energy (TotalVariation without beta, Charbonnier,
/// Constant), by minimising that energy:
///
/// - a time step is backward Euler with the weights at the new level, the minimiser of
///   E(u) + int |u - u_old|^2/(2 dt). It has no error from lagged weights and may be of any size.
/// - the steady state is the minimiser of E itself, in one step:
///   E(u) = int psi(|grad u|) + lambda/2 int chi |u - f|^2, or lambda int chi |u - f| with L1,
///   with the indicator chi of the known part of the surface.
///
/// With diffusivities g1 along and g2 across a direction, E has
///   total variation: sqrt((g1 grad u . e1)^2 + (g2 grad u . e2)^2);
///   others: g psi(sqrt((g1/g) (grad u . e1)^2 + (g2/g) (grad u . e2)^2)), g the larger of the two:
/// for gradients along e1 or e2, and always if g1 = g2, the flux is that of (4).
class TotalVariationFlow : public StateModel
{
public:
  struct Settings
  {
    bool SteadyState = false;
    double TimeStep = 1.0;
    double Fidelity = 0.0; ///< lambda, in 1/time; value/time with L1
    EdgeFunction Function; ///< of a convex energy
    double AlongDiffusivity = 1.0;
    double AcrossDiffusivity = 1.0;
    ChannelCoupling Coupling = ChannelCoupling::Joint;
    FidelityNorm Norm = FidelityNorm::L2;
    double StopTolerance = 1e-4; ///< relative duality gap, see TotalVariationMinimizer
    int MaximumNumberOfIterations = 10000;
  };

  /// frames: e1 per triangle (see TangentVectors.h), without rows if g1 = g2.
  TotalVariationFlow(std::shared_ptr<const Assembler> assembler, const TangentVectors& frames,
    PointData data, const Settings& settings, const ParallelFor& parallel = SerialFor());

  /// Reports the iterations of the minimiser and, as the residual, its duality gap, which is above
  /// the tolerance if the largest number of iterations was reached.
  StepReport Advance(const ProgressMonitor& progress) override;

  /// E(u).
  double Energy() const override;

private:
  std::shared_ptr<const Assembler> Assembly;
  PointData Data;
  Fidelity Fit;
  Settings Options;
  const ParallelFor& Parallel;
  TotalCorrection Conserved;
  double Diffusivity; ///< the larger of the two, the factor of the first integral of E
  std::unique_ptr<TotalVariationMinimizer> Minimizer;
  Values Target;
};

} // namespace SurfaceDiffusion
