// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Core/Models/LaggedDiffusion.h"
#include "Core/Operators/GradientTensor.h"

#include <memory>

namespace SurfaceDiffusion
{

/// The Beltrami flow with fidelity (N. Sochen, R. Kimmel, R. Malladi, IEEE Trans. Image Process.
/// 7(3), 1998): the data u, times b, are drawn over the surface as a surface in more dimensions,
/// whose area
///   E(u) = 1/b^2 int (sqrt(det G) - 1) + lambda/2 int chi |u - f|^2,
///   G = I + b^2 T,  T = sum over the channels k of grad u_k grad u_k^T,
/// is minimised by
///   m u_t = div(D grad u) + lambda chi (f - u),  D = sqrt(det G) G^-1 = adj(G) / sqrt(det G).
/// With the eigenvalues m1 >= m2 of T, D is sqrt((1 + b^2 m2)/(1 + b^2 m1)) along the steepest
/// direction and the inverse of that across it. The mass density m is sqrt(det G) in the metric of
/// the drawn surface (Induced: the flow of the paper) and 1 in that of the surface itself (Fixed),
/// in which the sum of A_i u_i is conserved. Both have the same steady states: minimal surfaces. As
/// b tends to 0, they become linear diffusion; for one channel E is the Charbonnier energy with
/// K = 1/b, and D along grad u its diffusivity.
///
/// Constant factors along and across given directions e1 and e2 replace grad by S grad, with
/// S = sqrt(along) e1 e1^T + sqrt(across) e2 e2^T.
///
/// Steps are those of LaggedDiffusion. E never rises, for any time step and on any mesh: sqrt(det
/// (I + Q)) is concave in Q >= 0 (Minkowski: det^(1/2) is concave on positive semi-definite 2 x 2
/// matrices), and its derivative is sqrt(det G) G^-1 / 2. So E is at most
/// the quadratic energy 1/2 int D grad u . grad u + lambda/2 int chi |u - f|^2 with the D of the
/// old level, up to a constant, and equal to it at the old level; a step lowers that quadratic,
/// since it minimises its sum with m |u - u_old|^2 / (2 dt). Conjugate gradients lower the sum in
/// every iteration, so that the tolerance of the solver does not matter.
class BeltramiFlow : public LaggedDiffusion
{
public:
  enum class Metric
  {
    Induced,
    Fixed
  };

  struct Settings
  {
    double TimeStep = 1.0; ///< in LengthUnit()^2
    double Fidelity = 0.0; ///< lambda, in 1/LengthUnit()^2
    double ColorScale = 1.0; ///< b, in LengthUnit()/value
    Metric MassMetric = Metric::Induced;
    double AlongDiffusivity = 1.0;
    double AcrossDiffusivity = 1.0;
  };

  /// frames: e1 per triangle, without rows if both factors are the same. solver: kept by the
  /// caller.
  BeltramiFlow(std::shared_ptr<const Assembler> assembler, TangentVectors frames, PointData data,
    const Settings& settings, std::shared_ptr<LinearSolver> solver,
    const ParallelFor& parallel = SerialFor());

  /// Gradients longer than 1e75 count as SumGradients() shortens them: a step may then raise it.
  double Energy() const override;

  TangentVectors Axes(const ProgressMonitor& progress = ProgressMonitor()) const override;

private:
  void FillWeights(Eigen::Index first, Eigen::Index last, StepReport& report,
    const ProgressMonitor& progress) override;
  double MassDensity(Index i) const override;
  struct Metrics
  {
    GradientTensor Gradients; ///< of S grad u
    double AreaRatio; ///< sqrt(det G)
  };
  Metrics Measure(Index t) const;
  PlaneTensor Diffusivity(Index t, const Metrics& metrics) const;
  Eigen::RowVector3d Weights(Index t, const Metrics& metrics) const; ///< of D

  Settings Options;
  GivenFactors Factors;
  Vector AreaRatios; ///< sqrt(det G) per triangle; no entry for the fixed metric
};

} // namespace SurfaceDiffusion
