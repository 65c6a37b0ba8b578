// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Core/Models/LaggedDiffusion.h"
#include "Core/Models/StructureTensor.h"
#include "Core/Operators/GradientTensor.h"

#include <memory>

namespace SurfaceDiffusion
{

/// Anisotropic diffusion along the structures of the data,
///   u_t = div(D grad u) + lambda chi (f - u),
/// with the diffusion tensor D = g1 e1 e1^T + g2 e2 e2^T whose axes are those of the structure
/// tensor J of u with eigenvalues m1 >= m2, e1 across the structures. K is a contrast, in units of
/// the gradient.
/// - Coherence enhancing (J. Weickert, Int. J. Computer Vision 31, 1999): lines are smoothed along
///   themselves, and interrupted ones are closed,
///     g1 = alpha,  g2 = alpha + (1 - alpha) exp(-(K^2/(m1 - m2))^2).
/// - Edge enhancing (J. Weickert, Anisotropic Diffusion in Image Processing, Teubner 1998):
///   smoothing along edges everywhere, and across them where the gradient is below K,
///     g1 = 1 - exp(-3.31488 (K^2/m1)^4),  g2 = 1,
///   with J at the scale rho = 0.
/// Constant factors along and across given directions give S D S; see GivenFactors.
///
/// D does not derive from an energy. Without fidelity, the equation has a Lyapunov function
/// (Weickert 1998): the variance 1/2 int |u - mean|^2, which Energy() returns, never rises for any
/// positive semi-definite D, neither in time nor in a step with the exact solution. The sum of
/// A_i u_i is conserved. Steps are those of LaggedDiffusion.
class StructureDiffusion : public LaggedDiffusion
{
public:
  enum class Kind
  {
    CoherenceEnhancing,
    EdgeEnhancing
  };

  struct Settings
  {
    double TimeStep = 1.0; ///< in LengthUnit()^2
    double Fidelity = 0.0; ///< lambda, in 1/LengthUnit()^2
    Kind Model = Kind::CoherenceEnhancing;
    double Contrast = 1.0; ///< K, in value/LengthUnit()
    double Alpha = 1e-3; ///< in (0, 1]
    double AlongDiffusivity = 1.0;
    double AcrossDiffusivity = 1.0;
  };

  /// frames: e1 per triangle, without rows if both factors are the same. solver: kept by the
  /// caller.
  StructureDiffusion(std::shared_ptr<const Assembler> assembler, TangentVectors frames,
    PointData data, const Settings& settings, std::unique_ptr<StructureTensor> structure,
    std::shared_ptr<LinearSolver> solver, const ParallelFor& parallel = SerialFor());

  double Energy() const override;

  TangentVectors Axes(const ProgressMonitor& progress = ProgressMonitor()) const override;

private:
  /// S D S = g1 S^2 + (g2 - g1) S e2 (S e2)^T. As a sum of squares it stays positive semi-definite
  /// where the entries of D have lost g1.
  struct Tensor
  {
    double G1;
    double Excess; ///< g2 - g1 >= 0
    PlaneTensor Square; ///< S^2
    Eigen::RowVector2d E2 = Eigen::RowVector2d::Zero(); ///< S e2
  };

  void FillWeights(Eigen::Index first, Eigen::Index last, StepReport& report,
    const ProgressMonitor& progress) override;
  Tensor Diffusivity(Index t) const;

  Settings Options;
  GivenFactors Factors;
  std::unique_ptr<StructureTensor> Structure; ///< evaluated before every use
  mutable Eigen::RowVectorXd Mean; ///< work of Energy()
};

} // namespace SurfaceDiffusion
