// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Run/SolverStore.h"

#include <cstddef>

namespace SurfaceDiffusion
{

namespace
{

/// Steps up to this many h^2 are solved fastest over processes by conjugate gradients with Jacobi
/// preconditioner, longer ones by multigrid.
constexpr double MaxJacobiDiffusionNumber = 10.0;

SolverMethod MethodOf(SolverChoice choice, const SolverTask& task)
{
  switch (choice)
  {
    case SolverChoice::Direct:
      return SolverMethod::Factorization;
    case SolverChoice::ConjugateGradient:
      return SolverMethod::ConjugateGradient;
    case SolverChoice::Multigrid:
      return SolverMethod::Multigrid;
    case SolverChoice::Automatic:
      break;
  }
  return ChooseMethod(task);
}

} // namespace

void SolverStore::Configure(const RunSettings& settings, const ParallelFor& parallel)
{
  this->Choice = settings.Solver;
  this->Limits.Tolerance = settings.Tolerance;
  this->Limits.MaximumNumberOfIterations = settings.MaximumNumberOfIterations;
  this->Parallel = &parallel;
}

std::shared_ptr<LinearSolver> SolverStore::Find(SolverPurpose purpose, SolverTask task)
{
  task.Tolerance = this->Limits.Tolerance;
  Kept& kept = this->Solvers[static_cast<std::size_t>(purpose)];
  const bool automatic = this->Choice == SolverChoice::Automatic;
  if (this->Distributed)
  {
    const bool multigrid = this->Choice == SolverChoice::Multigrid ||
      (automatic && task.AllowMultigrid && task.DiffusionNumber > MaxJacobiDiffusionNumber);
    kept.Solver = this->Distributed(multigrid);
  }
  else
  {
    const SolverMethod method = MethodOf(this->Choice, task);
    const bool fallsBack = automatic && method != SolverMethod::Factorization;
    if (!kept.Solver || kept.Method != method || kept.Automatic != fallsBack)
    {
      kept.Solver.reset(); // before another one takes memory
      kept.Solver = fallsBack ? MakeAutomaticSolver(task, *this->Parallel)
                              : MakeSolver(method, *this->Parallel);
      kept.Method = method;
      kept.Automatic = fallsBack;
    }
  }
  kept.Solver->SetLimits(this->Limits);
  return kept.Solver;
}

} // namespace SurfaceDiffusion
