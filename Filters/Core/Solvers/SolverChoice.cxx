// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Solvers/SolverChoice.h"

#include <algorithm>
#include <cmath>

namespace SurfaceDiffusion
{

namespace
{

/// Seconds on one core of an Intel Xeon (Sapphire Rapids class, 2.3 GHz, 2 virtual cores), fitted
/// on 2026-11-21 to scans with 11,000 to 711,000 vertices (Testing/Benchmarks/CompareSolvers). Only
/// their ratios matter. s: the number of vertices over Size; c: the diffusion number; digits: the
/// decimal digits of the tolerance over 10.
namespace Measured
{
constexpr double Size = 44000.0;

constexpr double Factor = 0.112; // x s^1.5
constexpr double Substitution = 0.0027; // x s^1.4
constexpr double LocalSubstitution = 0.004; // x c^0.2 s: in short steps the factor is sparser

constexpr double Iteration = 4.2e-4; // of conjugate gradients with Jacobi, x s
constexpr double Iterations = 67.0; // x digits c^0.4 s^0.1
constexpr double IterationsAcross = 6.5; // x digits sqrt(n), at most: across the whole surface

constexpr double Hierarchy = 0.036; // of multigrid, x s
constexpr double Cycle = 2.9e-3; // x s
constexpr double Cycles = 9.5; // x digits, at c = 1
constexpr double CyclesPerDecade = 2.7; // x digits log10(c)

constexpr double SmallestDiffusionNumber = 1e-2; // below, nothing changes
constexpr double SteadyState = 1e4; // the diffusion number that a steady state is as long as

// Iterations run on all threads, and a factorisation on one. This is their share of the time on one
// thread, between that of one thread and of two.
constexpr double Threads = 0.75;
// A factor takes 1 kB per vertex and, on regular meshes, up to ten times as long as on scans.
constexpr Index LargestFactor = 800000;
// Over several processes, with hypre: longer steps are cheaper with multigrid.
constexpr double LargestDistributedJacobi = 10.0;
} // namespace Measured

double DiffusionNumberOf(const SolverTask& task)
{
  return task.DiffusionNumber.value_or(Measured::SteadyState);
}

SolverMethod FindFastest(const SolverTask& task)
{
  using namespace Measured;
  const double n = task.NumberOfVertices;
  const double s = n / Size;
  const double c = std::max(DiffusionNumberOf(task), SmallestDiffusionNumber);
  const double digits = std::log(task.Tolerance) / std::log(1e-10);

  const double substitution =
    std::min(Substitution * std::pow(s, 1.4), LocalSubstitution * std::pow(c, 0.2) * s);
  const double factorization = Factor * std::pow(s, 1.5) + task.NumberOfSolves * substitution;

  const double iterations = digits *
    std::min(Iterations * std::pow(c, 0.4) * std::pow(s, 0.1), IterationsAcross * std::sqrt(n));
  const double conjugateGradient = Threads * task.NumberOfSolves * iterations * Iteration * s;

  const double cycles = digits * (Cycles + CyclesPerDecade * std::log10(c));
  const double multigrid = Threads * (Hierarchy * s + task.NumberOfSolves * cycles * Cycle * s);

  const double iterative =
    task.AllowMultigrid ? std::min(conjugateGradient, multigrid) : conjugateGradient;
  const bool hasRoom = task.NumberOfVertices <= LargestFactor || !task.AllowMultigrid;
  if (factorization < iterative && hasRoom)
  {
    return SolverMethod::Direct;
  }
  return iterative < conjugateGradient ? SolverMethod::Multigrid : SolverMethod::ConjugateGradient;
}

/// An iterative solver, and a factorisation for the systems on which it does not converge.
class FallBackSolver : public LinearSolver
{
public:
  FallBackSolver(std::unique_ptr<LinearSolver> iterative, const ParallelFor& parallel)
    : Iterative(std::move(iterative))
    , Cholesky(MakeCholeskySolver(parallel))
  {
  }

  void SetMatrix(const SparseMatrix& matrix, const ProgressMonitor& progress) override
  {
    this->Matrix = &matrix;
    this->Iterative->SetMatrix(matrix, progress);
  }

  SolveReport Solve(const Values& b, Values& x, const ProgressMonitor& progress) override
  {
    this->Iterative->SetLimits(this->Limits);
    const SolveReport report = this->Iterative->Solve(b, x, progress.Part(0.0, 0.5));
    if (report.Converged)
    {
      progress.Report(1.0);
      return report;
    }
    // The next solve tries the iteration again: if the failure were remembered, the bits of a step
    // would depend on the steps computed before it.
    this->Cholesky->SetLimits(this->Limits);
    this->Cholesky->SetMatrix(*this->Matrix, progress.Part(0.5, 0.9));
    return this->Cholesky->Solve(b, x, progress.Part(0.9, 1.0));
  }

  void Precondition(const Values& r, Values& z) override { this->Iterative->Precondition(r, z); }

private:
  std::unique_ptr<LinearSolver> Iterative, Cholesky;
  const SparseMatrix* Matrix = nullptr;
};

} // namespace

SolverChoice ChooseSolver(SolverMethod method, const SolverTask& task)
{
  SolverChoice choice;
  choice.Method = method;
  if (method == SolverMethod::Automatic)
  {
    choice.Method = task.IsPreconditioner ? SolverMethod::Direct : FindFastest(task);
    choice.FallsBack = choice.Method != SolverMethod::Direct;
  }
  return choice;
}

std::unique_ptr<LinearSolver> MakeSolver(const SolverChoice& choice, const ParallelFor& parallel)
{
  if (choice.Method == SolverMethod::Direct)
  {
    return MakeCholeskySolver(parallel);
  }
  std::unique_ptr<LinearSolver> iterative = choice.Method == SolverMethod::Multigrid
    ? MakeMultigridSolver(parallel)
    : MakeConjugateGradientSolver(parallel);
  if (!choice.FallsBack)
  {
    return iterative;
  }
  return std::make_unique<FallBackSolver>(std::move(iterative), parallel);
}

bool PreferDistributedMultigrid(SolverMethod method, const SolverTask& task)
{
  if (method != SolverMethod::Automatic)
  {
    return method == SolverMethod::Multigrid;
  }
  const bool isLong = DiffusionNumberOf(task) > Measured::LargestDistributedJacobi;
  return task.IsPreconditioner || (task.AllowMultigrid && isLong);
}

} // namespace SurfaceDiffusion
