// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Run/SolverStore.h"

#include <cstddef>

namespace SurfaceDiffusion
{

void SolverStore::Configure(const RunSettings& settings, const ParallelFor& parallel)
{
  this->Method = settings.Solver;
  this->Limits.Tolerance = settings.Tolerance;
  this->Limits.MaximumNumberOfIterations = settings.MaximumNumberOfIterations;
  this->Parallel = &parallel;
}

std::shared_ptr<LinearSolver> SolverStore::Find(SolverPurpose purpose, SolverTask task)
{
  task.Tolerance = this->Limits.Tolerance;
  Kept& kept = this->Solvers[static_cast<std::size_t>(purpose)];
  if (this->Distributed)
  {
    kept.Solver = this->Distributed(PreferDistributedMultigrid(this->Method, task));
  }
  else
  {
    const SolverChoice choice = ChooseSolver(this->Method, task);
    if (!kept.Solver || kept.Choice != choice)
    {
      kept.Solver.reset(); // before another one takes memory
      kept.Solver = MakeSolver(choice, *this->Parallel);
      kept.Choice = choice;
    }
  }
  kept.Solver->SetLimits(this->Limits);
  return kept.Solver;
}

} // namespace SurfaceDiffusion
