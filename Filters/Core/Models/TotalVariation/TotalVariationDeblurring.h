// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Core/Models/Fidelity.h"
#include "Core/Models/HeatBlur.h"
#include "Core/Models/TotalVariation/TotalVariationFlow.h"

#include <memory>

namespace SurfaceDiffusion
{

/// Deconvolution of data f = H u + noise that preserves edges: the minimiser of
///   E(u) = int psi(|grad u|) + lambda/2 int w chi |H u - f|^2
/// with the blur H of HeatBlur, the factors w of the data, and the indicator chi of the known part,
/// in one step, for the convex psi of TotalVariationFlow.
///
/// The method is the monotone fast iterative shrinkage-thresholding algorithm (MFISTA; A. Beck, M.
/// Teboulle, IEEE Trans. Image Process. 18, 2009): with L = lambda max(w),
///   z_k+1 = the minimiser of int psi(|grad u|) + L/2 int |u - (y_k - lambda/L H w chi (H y_k -
///   f))|^2,
/// which is an implicit step of TotalVariationFlow of the length 1/L, up to a duality gap that
/// falls like k^-4.5 (M. Schmidt, N. Le Roux, F. Bach, NIPS 2011), followed by an extrapolation of
/// z. u is the z of least energy so far. The iteration stops when z_k+1 differs from y_k by
/// StopTolerance times the range of the data in the root mean square. That is no bound of the
/// error: fine detail that the blur has removed almost entirely comes back slowly.
class TotalVariationDeblurring : public StateModel
{
public:
  struct Settings
  {
    TotalVariationFlow::Settings Regularization; ///< time, fidelity and tolerance are not used
    double Fidelity = 1.0; ///< lambda > 0, in 1/(length value)
    double StopTolerance = 1e-4;
    int MaximumNumberOfIterations = 2000;
  };

  /// frames: e1 per triangle (see TangentVectors.h), without rows if g1 = g2.
  TotalVariationDeblurring(std::shared_ptr<const Assembler> assembler, const TangentVectors& frames,
    PointData data, const Settings& settings, std::unique_ptr<HeatBlur> blur,
    const ParallelFor& parallel = SerialFor());

  /// Reports the iterations, and as the residual the root mean square of z - y over the range.
  StepReport Advance(const ProgressMonitor& progress) override;

  /// E(u).
  double Energy() const override;

  /// Those of E without the blur.
  DiffusionStep Diffusion() const override;
  const CornerWeights& DiffusionWeights(Eigen::Index column) override
  {
    this->Shrinkage->SetState(this->U);
    return this->Shrinkage->DiffusionWeights(column);
  }

private:
  /// A function on the surface with its blur and its energy.
  struct Point
  {
    Values U, Blurred;
    double Energy = 0.0;
  };

  double FidelityEnergy(const Values& blurred) const;
  void Measure(Point& point, StepReport& report) const;
  /// z_k+1 from y, whose blur is given.
  void Shrink(const Values& y, const Values& blurredY, Point& z, bool keepMultipliers,
    StepReport& report, const ProgressMonitor& progress);
  double RootMeanSquare(const Values& a, const Values& b) const;

  std::shared_ptr<const Assembler> Assembly;
  PointData Data;
  Fidelity Fit;
  Settings Options;
  const ParallelFor& Parallel;
  double Step; ///< 1/L
  double Range; ///< of the data
  std::unique_ptr<HeatBlur> Blur;
  std::unique_ptr<TotalVariationFlow> Shrinkage;
  TotalCorrection Conserved;
};

} // namespace SurfaceDiffusion
