// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Core/Solvers/LinearSolver.h"

#include <memory>
#include <optional>

namespace SurfaceDiffusion
{

enum class SolverMethod
{
  Automatic, ///< the one expected to be fastest
  Direct, ///< a factorisation
  ConjugateGradient,
  Multigrid
};

/// The largest number of vertices for which a factorisation is chosen: it takes 0.5 kB per vertex,
/// 1.2 kB while it is computed, and its time grows as the number of vertices to the power 1.35.
constexpr Index LargestFactor = 800000;

/// The linear systems a solver is made for, as far as the choice of the method depends on them.
struct SolverTask
{
  Index NumberOfVertices = 0;
  /// (largest diffusivity) x (time step) / h^2 of one step. Empty for a steady state, in which no
  /// time step bounds the distance over which values diffuse.
  std::optional<double> DiffusionNumber = 1.0;
  double Anisotropy =
    1.0; ///< the larger diffusivity of a triangle over the smaller, may be infinite
  double NumberOfSolves = 1.0; ///< with one matrix
  int NumberOfColumns = 1; ///< of each solve
  double Tolerance = 1e-10;
  /// False where multigrid was measured to be slower: connection Laplacians of direction fields,
  /// which do not map constants to zero, and diffusivities that change in every step and by orders
  /// of magnitude from triangle to triangle.
  bool AllowMultigrid = true;
  /// Several processes have a part of the surface each. They factorise a matrix only around hubs or
  /// if all else fails, and not with more than LargestReplicated vertices.
  bool IsDistributed = false;
  /// The solver is the preconditioner of another iteration (LinearSolver::Precondition), which has
  /// tried the diagonal already and needs a method that knows the whole matrix.
  bool IsPreconditioner = false;
};

/// A method, and whether others follow if it fails: Next, a factorisation unless it has no room,
/// then conjugate gradients. Solvers of equal choices can stand in for each other.
struct SolverChoice
{
  SolverMethod Method = SolverMethod::Direct; ///< not Automatic
  bool FallsBack = false;
  bool MayFactorize = true;
  SolverMethod Next = SolverMethod::Direct;
  /// The number of iterations of the first solve with a matrix from which on Next is expected to be
  /// faster. That solve decides the method for the matrix: see ConvergenceForecast. 0: any number.
  int Patience = 0;
  /// Of conjugate gradients as the first method: the iterations of a solve on even meshes with this
  /// diffusion number. Those with the matrix are forecast from them. 0: unknown.
  double ExpectedIterations = 0.0;
  double DiffusionNumber = 0.0;

  bool operator==(const SolverChoice& other) const
  {
    return this->Method == other.Method && this->FallsBack == other.FallsBack &&
      this->MayFactorize == other.MayFactorize && this->Next == other.Next &&
      this->Patience == other.Patience && this->ExpectedIterations == other.ExpectedIterations &&
      this->DiffusionNumber == other.DiffusionNumber;
  }
  bool operator!=(const SolverChoice& other) const { return !(*this == other); }
};

/// The method asked for, or instead of Automatic the one that is expected to be fastest by a model
/// of measured times on even meshes. Automatic and Multigrid fall back on the other methods, and if
/// none converges take the answer that is closest. Where triangles are needles, conjugate gradients
/// need many more iterations than the model expects. Automatic then begins with another method if
/// the matrix shows it, and otherwise goes on with one.
SolverChoice ChooseSolver(SolverMethod method, const SolverTask& task);

/// Whether the solves so far of a solver that was made for the choice `made` would have been the
/// same, to the last bit, for `other`.
bool WouldSolveAlike(
  const LinearSolver& solver, const SolverChoice& made, const SolverChoice& other);

/// overProcesses: over which the matrices are accumulated.
std::unique_ptr<LinearSolver> MakeSolver(const SolverChoice& choice,
  const ParallelFor& parallel = SerialFor(),
  const std::shared_ptr<const Reduction>& overProcesses = Reduction::SharedSerial());

inline std::unique_ptr<LinearSolver> MakeSolver(SolverMethod method,
  const SolverTask& task = SolverTask(), const ParallelFor& parallel = SerialFor())
{
  return MakeSolver(ChooseSolver(method, task), parallel);
}

} // namespace SurfaceDiffusion
