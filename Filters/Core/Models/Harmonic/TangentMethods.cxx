// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Models/Harmonic/TangentMethods.h"

#include "Core/Operators/SparsePattern.h"
#include "Core/Solvers/NestedDissection.h"

#include <algorithm>
#include <cmath>
#include <exception>
#include <limits>
#include <stdexcept>

namespace SurfaceDiffusion
{

namespace
{

/// Aggregates that ignore the diffusivities of a step are good unless these differ by orders of
/// magnitude between neighbours: then this number of iterations is not enough.
constexpr int MostWithAggregatesOfSurface = 25;

} // namespace

TangentMethods::TangentMethods(std::shared_ptr<const Assembler> assembler,
  const CornerWeights& coefficients, Preconditioner method, bool lineField,
  const IterationLimits& limits, const ParallelFor& parallel)
  : Assembly(std::move(assembler))
  , Coefficients(coefficients)
  , Method(method)
  , LineField(lineField)
  , Limits(limits)
  , Parallel(parallel)
  , Tangent(parallel)
{
}

/// Whether a multigrid cycle is expected to need fewer seconds than Jacobi. The iterations with
/// Jacobi grow with the square root of the ratio between the entries of the diagonal and the part
/// that has no diffusion. At a ratio just below 100, on a noisy sphere of 65,538 vertices, Jacobi
/// needed 50 iterations to 1e-5 and twice the time of the cycle, which needed 5. Making the
/// aggregates takes as long as one or two solves more.
bool TangentMethods::PrefersMultigrid(const TangentSystem& tangent) const
{
  if (!tangent.Reduction.IsSerial())
  {
    return false;
  }
  constexpr double ratio = 50.0;
  const auto count = static_cast<Index>(tangent.Matrix.rows());
  const double stiff = Sum(this->Parallel, count,
    [&](Index i)
    { return DiagonalEntry(tangent.Matrix, i) > ratio * tangent.Inertia[i] ? 1.0 : 0.0; });
  return stiff > 0.5 * count;
}

/// The methods to try, in this order.
const std::vector<TangentMethods::Preconditioner>& TangentMethods::Methods(
  const TangentSystem& tangent) const
{
  static const std::vector<Preconditioner> multigrid{ Preconditioner::Multigrid,
    Preconditioner::Jacobi, Preconditioner::Factor };
  static const std::vector<Preconditioner> noise{ Preconditioner::Jacobi, Preconditioner::Factor };
  static const std::vector<Preconditioner> factor{ Preconditioner::Factor, Preconditioner::Jacobi };
  static const std::vector<Preconditioner> jacobi{ Preconditioner::Jacobi };
  switch (this->Method)
  {
    case Preconditioner::Factor:
      return factor;
    case Preconditioner::Jacobi:
      return jacobi;
    case Preconditioner::Multigrid:
      return multigrid;
    default:
      if (tangent.Reduction.IsSerial() && IsAroundHubs(tangent.Matrix))
      {
        return factor;
      }
      return this->PrefersMultigrid(tangent) ? multigrid : noise;
  }
}

SolveReport TangentMethods::Solve(ImplicitSystem& system, const TangentSystem& tangent,
  Values& step, const ProgressMonitor& progress)
{
  const std::vector<Preconditioner>& methods = this->Methods(tangent);
  // If triangles are so bad that none converges, the best of the answers is a step, too.
  SolveReport best;
  best.Residual = std::numeric_limits<double>::infinity();
  best.Converged = false;
  std::exception_ptr failure;
  double done = 0.0;
  for (const Preconditioner method : methods)
  {
    const double end = method == methods.back() ? 1.0 : 0.5 * (1.0 + done);
    try
    {
      SolveReport report =
        this->Try(method, system, tangent, this->Other, progress.Part(done, end));
      report.Iterations += best.Iterations;
      if (report.Residual < best.Residual)
      {
        best = report;
        step.swap(this->Other);
      }
      best.Iterations = report.Iterations;
    }
    catch (const std::runtime_error&)
    {
      const bool isTrial = method == Preconditioner::Multigrid ||
        (method == Preconditioner::Factor && this->Method == Preconditioner::Automatic);
      if (method == methods.front() && !isTrial)
      {
        throw;
      }
      failure = std::current_exception(); // of a factorisation, which the other methods do not need
    }
    if (best.Converged)
    {
      return best;
    }
    done = end;
  }
  if (failure && !std::isfinite(best.Residual))
  {
    std::rethrow_exception(failure);
  }
  best.IsFinal = methods.size() > 1 && std::isfinite(best.Residual);
  RequireAnswer(best, this->Limits);
  return best;
}

SolveReport TangentMethods::Try(Preconditioner method, ImplicitSystem& system,
  const TangentSystem& tangent, Values& step, const ProgressMonitor& progress)
{
  if (method == Preconditioner::Multigrid)
  {
    return this->TryMultigrid(tangent, step, progress);
  }
  if (method == Preconditioner::Jacobi)
  {
    return this->Tangent.Solve(tangent, step, nullptr, this->Limits, progress);
  }
  system.SetUpSolver(progress.Part(0.0, 0.5));
  return this->Tangent.Solve(
    tangent, step, &system.GetSolver(), this->Limits, progress.Part(0.5, 1.0));
}

SolveReport TangentMethods::TryMultigrid(
  const TangentSystem& tangent, Values& step, const ProgressMonitor& progress)
{
  SolveReport first;
  if (!this->LineField)
  {
    IterationLimits few = this->Limits;
    few.MaximumNumberOfIterations =
      std::min(few.MaximumNumberOfIterations, MostWithAggregatesOfSurface);
    if (!this->Cycle)
    {
      this->Cycle = this->MakeCycle();
    }
    this->Cycle->SetMatrix(tangent.Matrix, progress.Part(0.0, 0.2));
    first = this->Tangent.Solve(tangent, step, this->Cycle.get(), few, progress.Part(0.2, 0.4));
    if (first.Converged)
    {
      return first;
    }
  }
  if (!this->AdaptedCycle)
  {
    this->AdaptedCycle = MakeMultigridSolver(this->Parallel);
  }
  this->AdaptedCycle->SetMatrix(tangent.Matrix, progress.Part(0.4, 0.7));
  SolveReport report = this->Tangent.Solve(
    tangent, step, this->AdaptedCycle.get(), this->Limits, progress.Part(0.7, 1.0));
  report.Iterations += first.Iterations;
  return report;
}

/// The aggregates are those of the stiffness matrix, with as much inertia as keeps it regular. They
/// do not depend on the state, lest the bits of a step depend on the steps computed before it.
std::unique_ptr<LinearSolver> TangentMethods::MakeCycle() const
{
  constexpr double scale = 1000.0; // of the stiffness matrix to the mean control area
  const TriangleMesh& mesh = this->Assembly->Mesh();
  SparseMatrix matrix;
  this->Assembly->TakePattern(matrix, this->Parallel);
  this->Assembly->Fill(matrix, mesh.ControlAreas(), scale * mesh.ControlAreas().mean(),
    this->Coefficients, nullptr, this->Parallel);
  return MakeMultigridSolver(matrix, this->Parallel);
}

} // namespace SurfaceDiffusion
