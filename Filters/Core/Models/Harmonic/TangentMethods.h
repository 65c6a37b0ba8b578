// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Core/Models/ImplicitSystem.h"
#include "Core/Solvers/TangentSolver.h"

#include <memory>
#include <vector>

namespace SurfaceDiffusion
{

/// Solves the linear systems of HarmonicMap's steps by conjugate gradients in the tangent spaces,
/// with a preconditioner after the other until one converges.
class TangentMethods
{
public:
  /// Factor takes the solver of the ImplicitSystem with the matrix without the projections: a
  /// factorisation, or multigrid. Multigrid is a cycle for the same matrix. Both are good for
  /// smooth maps and large steps, while for noise Jacobi is fast.
  enum class Preconditioner
  {
    /// In one process as Factor around hubs and as Multigrid if diffusion dominates, else Jacobi,
    /// Factor
    Automatic,
    Factor, ///< Factor, Jacobi
    Multigrid, ///< Multigrid, Jacobi, Factor
    Jacobi
  };

  /// coefficients: of the stiffness matrix without the diffusivities of a step, not copied.
  /// lineField: whether the matrices have signs.
  TangentMethods(std::shared_ptr<const Assembler> assembler, const CornerWeights& coefficients,
    Preconditioner method, bool lineField, const IterationLimits& limits,
    const ParallelFor& parallel);

  /// tangent: the system with the matrix of `system`. If no method converges, the best answer is
  /// the step, and the report says so. Jacobi alone throws NotConverged unless it is within
  /// AnswerFactor of the tolerance.
  SolveReport Solve(ImplicitSystem& system, const TangentSystem& tangent, Values& step,
    const ProgressMonitor& progress);

private:
  bool PrefersMultigrid(const TangentSystem& tangent) const;
  const std::vector<Preconditioner>& Methods(const TangentSystem& tangent) const;
  SolveReport Try(Preconditioner method, ImplicitSystem& system, const TangentSystem& tangent,
    Values& step, const ProgressMonitor& progress);
  SolveReport TryMultigrid(
    const TangentSystem& tangent, Values& step, const ProgressMonitor& progress);
  std::unique_ptr<LinearSolver> MakeCycle() const;

  std::shared_ptr<const Assembler> Assembly;
  const CornerWeights& Coefficients;
  Preconditioner Method;
  bool LineField;
  IterationLimits Limits;
  const ParallelFor& Parallel;
  TangentSolver Tangent;
  std::unique_ptr<LinearSolver> Cycle; ///< with the aggregates of the surface
  std::unique_ptr<LinearSolver> AdaptedCycle; ///< with those of each matrix
  Values Other;
};

} // namespace SurfaceDiffusion
