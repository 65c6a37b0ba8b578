// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Run/SolverStore.h"

#include <algorithm>
#include <cstddef>
#include <numeric>
#include <utility>
#include <vector>

namespace SurfaceDiffusion
{

void SolverStore::Configure(const ModelTraits& traits, const ParallelFor& parallel)
{
  this->Method = traits.Solver;
  this->NumberOfSteps = traits.NumberOfSteps;
  this->Limits = traits.Limits;
  this->Parallel = &parallel;
  for (Kept& kept : this->Solvers)
  {
    kept.IsUsed = false;
  }
}

void SolverStore::SetProcesses(std::shared_ptr<const Reduction> overProcesses, Index vertices)
{
  this->OverProcesses = std::move(overProcesses);
  this->Solvers = {};
  double owned = 0.0;
  for (Index i = 0; i < vertices; ++i)
  {
    owned += this->OverProcesses->Owns(i) ? 1.0 : 0.0;
  }
  // An abort would end a sum, but the surface is kept.
  const std::vector<double> counts = this->OverProcesses->Gather({ owned });
  this->AllVertices = static_cast<Index>(std::accumulate(counts.begin(), counts.end(), 0.0));
}

SolverChoice SolverStore::Choose(
  const SolverTask& task, double solvesPerStep, int numberOfSteps) const
{
  SolverTask whole = task;
  if (solvesPerStep > 0.0)
  {
    whole.NumberOfSolves = solvesPerStep * numberOfSteps;
  }
  return ChooseSolver(this->Method, whole);
}

bool SolverStore::ServesRunOf(int numberOfSteps) const
{
  return std::all_of(this->Solvers.begin(), this->Solvers.end(),
    [&](const Kept& kept)
    {
      return !kept.IsUsed ||
        WouldSolveAlike(
          *kept.Solver, kept.Choice, this->Choose(kept.Task, kept.SolvesPerStep, numberOfSteps));
    });
}

std::shared_ptr<LinearSolver> SolverStore::Find(
  SolverPurpose purpose, SolverTask task, double solvesPerStep)
{
  const IterationLimits limits =
    purpose == SolverPurpose::Fill ? WithoutInertia(this->Limits) : this->Limits;
  task.Tolerance = limits.Tolerance;
  Kept& kept = this->Solvers[static_cast<std::size_t>(purpose)];
  if (!this->OverProcesses->IsSerial())
  {
    task.IsDistributed = true;
    task.NumberOfVertices = this->AllVertices;
  }
  const SolverChoice choice = this->Choose(task, solvesPerStep, this->NumberOfSteps);
  if (!kept.Solver || kept.Choice != choice)
  {
    kept.Solver.reset(); // before another one takes memory
    kept.Solver = MakeSolver(choice, *this->Parallel, this->OverProcesses);
    kept.Choice = choice;
  }
  kept.Task = task;
  kept.SolvesPerStep = solvesPerStep;
  kept.IsUsed = true;
  kept.Solver->SetLimits(limits);
  return kept.Solver;
}

std::shared_ptr<LinearSolver> SolverStore::Make(
  std::shared_ptr<const Reduction> overProcesses) const
{
  std::shared_ptr<LinearSolver> solver =
    MakeConjugateGradientSolver(std::move(overProcesses), *this->Parallel);
  solver->SetLimits(this->Limits);
  return solver;
}

} // namespace SurfaceDiffusion
