// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Core/Models/EdgeFunctions.h"
#include "Core/Models/LaggedDiffusion.h"

#include <memory>
#include <vector>

namespace SurfaceDiffusion
{

/// Nonlinear diffusion with fidelity: total variation (2), (3), the general anisotropic equation
/// (4), denoising (17) and inpainting (19),
///   u_t = div(g1 (grad u . e1) e1 + g2 (grad u . e2) e2) + lambda chi (f - u),
/// with edge-stopping functions g1 and g2 of |grad u| and the indicator chi of the known part of
/// the surface. In time the paper's semi-implicit scheme: each step takes g1 and g2 at the old
/// level, constant on each triangle, and solves one linear system (per channel, if channels have
/// their own |grad u|) with the lumped mass matrix M and the stiffness matrix K:
///   (11), (14)  (M + dt K(u_old) + dt lambda chi M) u_new = M (u_old + dt lambda chi f).
///
/// L1 fidelity is lagged likewise: lambda/sqrt((f - u_old)^2 + delta^2) in place of lambda.
class NonlinearDiffusion : public LaggedDiffusion
{
public:
  struct Settings
  {
    double TimeStep = 1.0;
    double Fidelity = 0.0; ///< lambda, in 1/time; value/time with L1
    EdgeFunction Along; ///< g1 is this times AlongDiffusivity
    EdgeFunction Across; ///< g2 is this times AcrossDiffusivity
    double AlongDiffusivity = 1.0;
    double AcrossDiffusivity = 1.0;
    ChannelCoupling Coupling = ChannelCoupling::Joint;
    FidelityNorm Norm = FidelityNorm::L2;
    double FidelityRounding = 1e-3; ///< delta of L1, in units of the values, > 0
    bool ConservesTotal = true; ///< whether states without fidelity keep the total of the start
    std::vector<double> ChannelWeights = {}; ///< of L2, see Fidelity
  };

  /// frames: e1 per triangle (see TangentVectors.h), without rows if g1 = g2; see IsotropicMean()
  /// for triangles without a direction. solver: kept by the caller, so that an ordering is reused.
  NonlinearDiffusion(std::shared_ptr<const Assembler> assembler, TangentVectors frames,
    PointData data, const Settings& settings, std::shared_ptr<LinearSolver> solver,
    const ParallelFor& parallel = SerialFor());

  /// int psi(|grad u|) with the potential psi of g, and the energy of Fidelity. If g1 and g2
  /// differ, psi1 cos^2 + psi2 sin^2 with the angle between grad u and e1.
  double Energy() const override;

private:
  void FillWeights(Eigen::Index first, Eigen::Index last, StepReport& report,
    const ProgressMonitor& progress) override;

  TangentVectors Frames;
  Settings Options;
  CornerWeights Directional; ///< (13) along e1, no rows if g1 = g2
  CornerWeights Perpendicular; ///< the same along e2
};

} // namespace SurfaceDiffusion
