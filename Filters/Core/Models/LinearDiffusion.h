// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Core/Models/DiffusionPanel.h"
#include "Core/Models/Fidelity.h"
#include "Core/Models/ImplicitSystem.h"
#include "Core/Models/Model.h"
#include "Core/Operators/Assembler.h"
#include "Core/Operators/MeanCorrection.h"

#include <memory>

namespace SurfaceDiffusion
{

/// The heat equation of the Laplace-Beltrami operator, and linear diffusion with a constant
/// diffusion tensor D = g1 e1 e1^T + g2 e2 e2^T, with fidelity:
///   u_t = div(D grad u) + lambda chi (f - u)
/// with the indicator chi of the known part of the surface; (1), (4), denoising (16), inpainting
/// (18). In space M u' = -K u + lambda M chi (f - u) with the lumped mass matrix M and the
/// stiffness matrix K, or B u' in place of M u' with the mixed one (MixedMass); in time backward
/// Euler, an SDIRK method or an ExponentialSeries. Fixed vertices have Dirichlet
/// conditions, the boundary has homogeneous Neumann conditions.
class LinearDiffusion : public StateModel
{
public:
  enum class Scheme
  {
    BackwardEuler, ///< (8), (14): first order, keeps bounds on Delaunay meshes
    SDIRK2, ///< second order, L-stable, two solves with one matrix; does not keep bounds
    Exponential, ///< see ExponentialSeries: six solves with one matrix for a step of any length
    SteadyState ///< the limit t -> infinity in one step
  };

  struct Settings
  {
    double TimeStep = 1.0; ///< in LengthUnit()^2
    double Fidelity = 0.0; ///< lambda, in 1/LengthUnit()^2
    Scheme TimeScheme = Scheme::SDIRK2;
    bool HasMixedMass = false;
    /// Up to here a residual above the tolerance of the solver is not reported as missed.
    double SufficientResidual = 0.0;
    bool SharesSolver = false; ///< with other models: each step sets its matrix

    /// The factor of K in the matrix: both stages of SDIRK2 share M + gamma dt K with
    /// gamma = 1 - 1/sqrt(2) (R. Alexander, SIAM J. Numer. Anal. 14, 1977).
    double ImplicitStep() const;
    /// The solves of a step.
    int NumberOfSolves() const;
    DiffusionStep Diffusion() const;
  };
  static constexpr double Gamma = 0.2928932188134524;

  /// coefficients: of D, see CotanWeights.h; no row: D = 1. solver: kept by the caller from run to
  /// run, so that the same matrix is not factorised twice.
  LinearDiffusion(std::shared_ptr<const Assembler> assembler, CornerWeights coefficients,
    PointData data, const Settings& settings, std::shared_ptr<LinearSolver> solver,
    const ParallelFor& parallel = SerialFor());

  StepReport Advance(const ProgressMonitor& progress) override;

  /// 1/2 int D grad u . grad u + lambda/2 int chi |u - f|^2
  double Energy() const override;

  DiffusionStep Diffusion() const override { return this->Options.Diffusion(); }
  const CornerWeights& DiffusionWeights(Eigen::Index /*column*/) override
  {
    return this->Coefficients;
  }

private:
  void Prepare(const ProgressMonitor& progress);
  /// A step of `count` columns from `first` on, up to Panel.Finish().
  void StepBackwardEuler(
    Eigen::Index first, Eigen::Index count, StepReport& report, const ProgressMonitor& progress);
  void StepSDIRK2(
    Eigen::Index first, Eigen::Index count, StepReport& report, const ProgressMonitor& progress);
  void StepExponential(
    Eigen::Index first, Eigen::Index count, StepReport& report, const ProgressMonitor& progress);
  void StepToSteadyState(
    Eigen::Index first, Eigen::Index count, StepReport& report, const ProgressMonitor& progress);
  void Solve(StepReport& report, const ProgressMonitor& progress);

  std::shared_ptr<const Assembler> Assembly;
  CornerWeights Coefficients;
  PointData Data;
  Fidelity Fit;
  Settings Options;
  const ParallelFor& Parallel;
  ImplicitSystem System;
  TotalCorrection Conserved;
  MeanCorrection Balanced;
  DiffusionPanel Panel;
  SparseMatrix MassDifference; ///< B - M; no rows with the lumped mass matrix
  bool Prepared = false;
};

} // namespace SurfaceDiffusion
