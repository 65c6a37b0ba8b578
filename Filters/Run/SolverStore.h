// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Core/Solvers/LinearSolver.h"
#include "Core/Solvers/SolverChoice.h"
#include "Run/RunSettings.h"

#include <array>
#include <cstddef>
#include <memory>

namespace SurfaceDiffusion
{

/// The purpose of a linear solver. Each purpose keeps its own solver from run to run.
enum class SolverPurpose
{
  Step, ///< the time steps
  SecondChemical, ///< those of a texture's second chemical
  NormalPart, ///< those of the part of vectors along the normal
  Search, ///< the search for a fidelity weight
  Fill, ///< the harmonic start on missing vertices
  Blur, ///< the blur that is removed
  Edges, ///< v of the Mumford-Shah model
  Structure, ///< the integration of structure tensors
  Chromaticity, ///< C of the chromaticity-brightness model
  Detail, ///< of data on cells
  Count ///< the number of purposes
};

/// The linear solvers of the runs on one surface. An ordering or a factor that is still valid is
/// used again; a solver that is no longer used is freed.
class SolverStore
{
public:
  void Configure(const ModelTraits& traits, const ParallelFor& parallel);
  /// Solve over processes. vertices: of this one. Collective.
  void SetProcesses(std::shared_ptr<const Reduction> overProcesses, Index vertices);

  /// The solver that the traits ask for. task.Tolerance is set here. solvesPerStep: the number of
  /// solves with one matrix in each step of the run, or 0 if task.NumberOfSolves does not depend on
  /// the number of steps.
  std::shared_ptr<LinearSolver> Find(
    SolverPurpose purpose, SolverTask task, double solvesPerStep = 0.0);
  /// A solver over the processes of a reduction of other unknowns than the vertices.
  std::shared_ptr<LinearSolver> Make(std::shared_ptr<const Reduction> overProcesses) const;
  /// Free the solver of a purpose that ends here.
  void Release(SolverPurpose purpose) { this->Solvers[static_cast<std::size_t>(purpose)] = Kept(); }

  /// Whether the solvers that Find() gave since Configure() are also those of a run of another
  /// length, which then has the same states.
  bool ServesRunOf(int numberOfSteps) const;

  /// The solver that is kept for a purpose; null if there is none.
  const LinearSolver* Get(SolverPurpose purpose) const
  {
    return this->Solvers[static_cast<std::size_t>(purpose)].Solver.get();
  }

private:
  struct Kept
  {
    std::shared_ptr<LinearSolver> Solver;
    SolverChoice Choice;
    SolverTask Task;
    double SolvesPerStep = 0.0;
    bool IsUsed = false; ///< since Configure()
  };

  SolverChoice Choose(const SolverTask& task, double solvesPerStep, int numberOfSteps) const;

  SolverMethod Method = SolverMethod::Automatic;
  int NumberOfSteps = 0;
  IterationLimits Limits;
  const ParallelFor* Parallel = nullptr;
  std::shared_ptr<const Reduction> OverProcesses = Reduction::SharedSerial();
  Index AllVertices = 0; ///< of all processes, if there are several
  std::array<Kept, static_cast<std::size_t>(SolverPurpose::Count)> Solvers;
};

} // namespace SurfaceDiffusion
