// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Core/Models/ChannelNorms.h"
#include "Core/Models/EdgeFunctions.h"
#include "Core/Models/Model.h"
#include "Core/Operators/Assembler.h"
#include "Core/Operators/MeanCorrection.h"
#include "Core/Solvers/LinearSolver.h"

#include <memory>

namespace SurfaceDiffusion
{

/// Nonlinear diffusion by the paper's semi-implicit scheme: (2), (3), the general (4), denoising
/// (17) and inpainting (19),
///   u_t = div(g1 (grad u . e1) e1 + g2 (grad u . e2) e2) + lambda 1_D (f - u),
/// g1 and g2 functions of |grad u|. Each step takes them at the old level, constant on each
/// triangle, and solves one linear system (per channel, where channels have their own |grad u|):
///   (11), (14)  (M + dt K(u_old) + dt lambda M 1_D) u_new = M (u_old + dt lambda 1_D f).
/// It is solved for u_new - u_old, so that round-off is relative to the change and a constant stays
/// constant to the last bit, however large g may be.
///
/// L1 fidelity is lagged likewise: lambda/sqrt((f - u_old)^2 + delta^2) in place of lambda.
class NonlinearDiffusion : public Model
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
  };

  /// frames: e1 per triangle (see TangentVectors.h), without rows where g1 = g2. Triangles without a
  /// direction have sqrt(g1 g2). solver: kept by the caller, so that an ordering is used again.
  NonlinearDiffusion(std::shared_ptr<const Assembler> assembler, TangentVectors frames,
    PointData data, const Settings& settings, std::shared_ptr<LinearSolver> solver,
    const ParallelFor& parallel = SerialFor());

  const Values& State() const override { return this->U; }
  StepReport Advance(const ProgressMonitor& progress) override;

  /// int psi(|grad u|) + lambda/2 int 1_D |u - f|^2, psi the potential of g; with L1 lambda int 1_D
  /// (sqrt(|u - f|^2 + delta^2) - delta). Where g1 and g2 differ, psi1 cos^2 + psi2 sin^2 with the
  /// angle between grad u and e1.
  double Energy() const override;

  void Restore(const double* checkpoint) override;

private:
  void AdvanceColumns(
    Eigen::Index first, Eigen::Index last, StepReport& report, const ProgressMonitor& progress);
  void FillWeights(Eigen::Index first, Eigen::Index last);
  void FillChange(Eigen::Index first, Eigen::Index last);
  double FidelityAt(Index i, Eigen::Index first, Eigen::Index last) const;

  std::shared_ptr<const Assembler> Operators;
  TangentVectors Frames;
  PointData Data;
  Settings Options;
  std::shared_ptr<LinearSolver> Solver;
  const ParallelFor& Parallel;
  TotalCorrection Conserved;
  CornerWeights Isotropic; ///< (10)
  CornerWeights Directional; ///< (13), no rows where g1 = g2
  SparseMatrix Matrix;
  CornerWeights Weighted; ///< g1 c1 + g2 c2 of (12)
  Vector Diagonal;
  Values NoValues, NoLoad; ///< fixed vertices do not change
  Values U, Change, RightHandSide;
};

} // namespace SurfaceDiffusion
