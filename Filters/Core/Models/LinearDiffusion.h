// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Core/Models/Model.h"
#include "Core/Operators/Assembler.h"
#include "Core/Operators/MeanCorrection.h"
#include "Core/Solvers/LinearSolver.h"

#include <memory>

namespace SurfaceDiffusion
{

/// Linear diffusion with constant coefficients: (1), (4) with constant g1, g2, denoising (16) and
/// inpainting (18),
///   u_t = div(D grad u) + lambda 1_D (f - u),
/// discretised as M u' = -K u + lambda M 1_D (f - u); fixed vertices keep their start.
class LinearDiffusion : public Model
{
public:
  enum class Scheme
  {
    BackwardEuler, ///< (8), (14): first order, keeps bounds on Delaunay meshes
    SDIRK2, ///< second order, L-stable, two solves with one matrix; bounds not kept
    SteadyState ///< the limit t -> infinity in one step
  };

  struct Settings
  {
    double TimeStep = 1.0; ///< in LengthUnit()^2
    double Fidelity = 0.0; ///< lambda, in 1/LengthUnit()^2
    Scheme TimeScheme = Scheme::SDIRK2;

    /// What multiplies K in the matrix: both stages of SDIRK2 share M + gamma dt K with
    /// gamma = 1 - 1/sqrt(2) (R. Alexander, SIAM J. Numer. Anal. 14, 1977).
    double ImplicitStep() const
    {
      return this->TimeScheme == Scheme::SDIRK2 ? Gamma * this->TimeStep : this->TimeStep;
    }
  };
  static constexpr double Gamma = 0.2928932188134524;

  /// solver: kept by the caller from run to run, so that the same matrix is not factorised twice.
  LinearDiffusion(std::shared_ptr<const Assembler> assembler, CornerWeights coefficients,
    PointData data, const Settings& settings, std::shared_ptr<LinearSolver> solver,
    const ParallelFor& parallel = SerialFor());

  const Values& State() const override { return this->U; }
  StepReport Advance(const ProgressMonitor& progress) override;

  /// 1/2 int D grad u . grad u + lambda/2 int 1_D (u - f)^2, summed over the columns.
  double Energy() const override;

  void Restore(const double* checkpoint) override;

private:
  void Prepare(const ProgressMonitor& progress);
  void BackwardEulerStep(StepReport& report, const ProgressMonitor& progress);
  void SDIRK2Step(StepReport& report, const ProgressMonitor& progress);
  void Solve(StepReport& report, const ProgressMonitor& progress);
  double FidelityAt(Index i) const { return this->Data.Missing[i] ? 0.0 : this->Options.Fidelity; }

  std::shared_ptr<const Assembler> Operators;
  CornerWeights Coefficients;
  PointData Data;
  Settings Options;
  std::shared_ptr<LinearSolver> Solver;
  const ParallelFor& Parallel;
  TotalCorrection Conserved;
  MeanCorrection Balanced;
  SparseMatrix Matrix;
  bool Prepared = false;
  Values Load; ///< what fixed neighbours give to the right-hand side
  Values U, Previous, RightHandSide;
  Eigen::RowVectorXd Origin; ///< mean of the start, from which values are measured in a step
};

/// int over the surface of c-weighted |grad u|^2 / 2: sum over triangles and edges of
/// c_ij (u_i - u_j)^2 / 2.
double DirichletEnergy(const TriangleMesh& mesh, const CornerWeights& coefficients, const Values& u,
  const ParallelFor& parallel = SerialFor());

} // namespace SurfaceDiffusion
