// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Core/Models/Fidelity.h"
#include "Core/Models/Fields/ResolventSpace.h"
#include "Core/Models/HeatBlur.h"
#include "Core/Models/Model.h"
#include "Core/Operators/MeanCorrection.h"

#include <memory>
#include <optional>

namespace SurfaceDiffusion
{

/// The Krylov space of data, in which models of all weights find their minimisers.
struct DeblurringSpace
{
  double Diffusivity = 1.0; ///< D, a number
  Values Data; ///< that the space is of
  std::optional<ResolventSpace> Space;
};

/// Deconvolution of data f = H u + noise with Tikhonov regularisation: the minimiser of
///   E(u) = 1/2 int D grad u . grad u + lambda/2 int w chi (H u - f)^2
/// with the blur H of HeatBlur, the factors w of the data, and the indicator chi of the known part,
/// in one step. Its linear system
///   (K + lambda M H w chi H) u = lambda M H w chi f
/// is solved by conjugate gradients with the preconditioner (K + lambda w' M)^-1, where w' is the
/// mean of w chi. Where w chi is 1 everywhere and D a number, u is a function of L = M^-1 K,
///   u = lambda h / (D L + lambda h^2) f,  h = (1 + tau/N L)^-N,
/// and is found in the Krylov space of a step of the blur, unless that needs many steps.
class TikhonovDeblurring : public StateModel
{
public:
  /// coefficients: of K, as in CotanWeights.h. fidelity: lambda > 0, in 1/length^2. solver: of the
  /// preconditioner; limits: of the conjugate gradients. space: for models of one blur, none where D is
  /// no number; it must not outlive the mesh.
  TikhonovDeblurring(std::shared_ptr<const Assembler> assembler, CornerWeights coefficients,
    PointData data, double fidelity, std::unique_ptr<HeatBlur> blur,
    std::shared_ptr<LinearSolver> solver, const IterationLimits& limits,
    const ParallelFor& parallel = SerialFor(), std::shared_ptr<DeblurringSpace> space = nullptr);

  StepReport Advance(const ProgressMonitor& progress) override;

  /// E(u).
  double Energy() const override;

  /// Those of E without the blur.
  DiffusionStep Diffusion() const override;
  const CornerWeights& DiffusionWeights(Eigen::Index /*column*/) override
  {
    return this->Coefficients;
  }

private:
  void Prepare(const ProgressMonitor& progress);
  bool IsFunction() const;
  SolveReport ApplyFunction(
    const Values& f, Values& x, StepReport& blurs, const ProgressMonitor& progress);
  SolveReport Iterate(const Eigen::RowVectorXd& origin, Values& x, StepReport& blurs,
    const ProgressMonitor& progress);
  /// v becomes lambda M H w chi v.
  void ApplyAdjoint(Values& v, StepReport& report) const;
  SolveReport Solve(Values f, Values& x, StepReport& blurs, const ProgressMonitor& progress);
  template <int K>
  SolveReport SolveColumns(
    Values residual, Values& x, StepReport& blurs, const ProgressMonitor& progress);

  std::shared_ptr<const Assembler> Assembly;
  CornerWeights Coefficients;
  PointData Data;
  Fidelity Fit;
  double FidelityWeight;
  std::unique_ptr<HeatBlur> Blur;
  std::shared_ptr<LinearSolver> Solver;
  IterationLimits Limits;
  const ParallelFor& Parallel;
  TotalCorrection Conserved;
  SparseMatrix Stiffness, Preconditioner;
  Vector InverseDiagonal; ///< of the preconditioner's matrix
  std::shared_ptr<DeblurringSpace> Shared;
  bool Prepared = false;
};

} // namespace SurfaceDiffusion
