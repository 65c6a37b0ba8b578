// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Models/Textures/ReactionDiffusion.h"

#include "Core/Operators/DirichletEnergy.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace SurfaceDiffusion
{

namespace
{

// ARS(2,2,2).
const double Gamma = 1.0 - std::sqrt(0.5);
const double Delta = 1.0 - 0.5 / Gamma;

/// Root mean square of f(i), a value per vertex, over the surface; not divided by the area.
template <typename F>
double Norm(const TriangleMesh& mesh, const ParallelFor& parallel, const F& f)
{
  return std::sqrt(mesh.GetReduction().Sum(Sum(parallel, mesh.NumberOfVertices(),
    [&](Index i)
    {
      const double value = f(i);
      return mesh.ControlAreas()[i] * value * value;
    })));
}

} // namespace

ReactionDiffusion::ReactionDiffusion(std::shared_ptr<const Assembler> assembler,
  const Reaction& reaction, std::array<Chemical, 2> chemicals, PointData data,
  const Settings& settings, const ParallelFor& parallel)
  : StateModel(data.Start)
  , Assembly(std::move(assembler))
  , Terms(reaction)
  , Coefficients{ std::move(chemicals[0].Coefficients), std::move(chemicals[1].Coefficients) }
  , Stiffness{ std::move(chemicals[0].Stiffness), std::move(chemicals[1].Stiffness) }
  , Data(std::move(data))
  , Options(settings)
  , Parallel(parallel)
  , ImplicitTime(settings.TimeStep * (settings.TimeScheme == Scheme::SecondOrder ? Gamma : 1.0))
  , Systems{ ImplicitSystem(this->Assembly, std::move(chemicals[0].Solver), parallel),
    ImplicitSystem(this->Assembly, std::move(chemicals[1].Solver), parallel) }
  , Areas(this->Assembly->Mesh().GetReduction().Accumulated(
      this->Assembly->Mesh().ControlAreas(), this->AccumulatedAreas))
{
  for (int c = 0; c < 2; ++c)
  {
    this->New[c] = this->U.col(c);
    for (Pair* pair :
      { &this->Old, &this->Rates, &this->Force, &this->Explicit, &this->RightHandSide })
    {
      (*pair)[c] = Values::Zero(this->U.rows(), 1);
    }
  }
}

std::size_t ReactionDiffusion::CheckpointSize() const
{
  return static_cast<std::size_t>(this->U.size()) + 1;
}

void ReactionDiffusion::Save(double* checkpoint) const
{
  StateModel::Save(checkpoint);
  checkpoint[this->U.size()] = this->Done ? 1.0 : 0.0;
}

void ReactionDiffusion::Restore(const double* checkpoint)
{
  StateModel::Restore(checkpoint);
  this->Done = checkpoint[this->U.size()] != 0.0;
  for (int c = 0; c < 2; ++c)
  {
    this->New[c] = this->U.col(c);
  }
}

void ReactionDiffusion::Prepare(const ProgressMonitor& progress)
{
  const Vector& areas = this->Assembly->Mesh().ControlAreas();
  for (int c = 0; c < 2; ++c)
  {
    ImplicitSystem& system = this->Systems[c];
    if (this->Stiffness[c].rows() > 0)
    {
      system.Assemble(areas, this->ImplicitTime, this->Stiffness[c]);
    }
    else
    {
      system.Assemble(areas, this->ImplicitTime, this->Coefficients[c]);
    }
    if (this->Data.Fixed.any())
    {
      system.Constrain(this->Data.Fixed, this->Data.Start.col(c));
    }
    system.SetUpSolver(progress.Part(0.5 * c, 0.5 * c + 0.5));
  }
  this->Means = MeanCorrection(this->Assembly->Mesh(), areas, this->Data.Fixed, this->Parallel);
  this->Prepared = true;
}

StepReport ReactionDiffusion::Advance(const ProgressMonitor& progress)
{
  StepReport report;
  if (this->Done)
  {
    return report;
  }
  const double setup = this->Prepared ? 0.0 : 0.5;
  if (!this->Prepared)
  {
    this->Prepare(progress.Part(0.0, setup));
  }
  for (int c = 0; c < 2; ++c)
  {
    this->Old[c] = this->New[c];
  }
  if (this->Options.TimeScheme == Scheme::SecondOrder)
  {
    this->SecondOrderStep(report, progress.Part(setup, 1.0));
  }
  else
  {
    this->FirstOrderStep(report, progress.Part(setup, 1.0));
  }
  this->FinishStep();
  return report;
}

/// (22) with (8), (23) with (14), both chemicals from the old level:
/// (M + dt K_k) u_k,new = M (u_k + dt F_k(u1, u2)).
void ReactionDiffusion::FirstOrderStep(StepReport& report, const ProgressMonitor& progress)
{
  const Vector& areas = this->Assembly->Mesh().ControlAreas();
  const double dt = this->Options.TimeStep;
  this->React(this->Old, this->Rates);
  ForEach(this->Parallel, this->Assembly->Mesh().NumberOfVertices(),
    [&](Index i)
    {
      const double area = areas[i];
      for (int c = 0; c < 2; ++c)
      {
        this->RightHandSide[c](i) = area * (this->Old[c](i) + dt * this->Rates[c](i));
      }
    });
  this->Solve(report, progress);
  this->Project(0.0, report);
}

/// With f = F + l, per chemical,
///   (M + g dt K) y = M (u + g dt f(u)),   g = gamma,
///   (M + g dt K) u_new = M (u + dt (d f(u) + (1 - d) f(y))) - (1 - g) dt K y,   d = delta,
/// and the first stage gives dt K y = M ((u - y)/g + dt f(u)): no product with K is needed.
void ReactionDiffusion::SecondOrderStep(StepReport& report, const ProgressMonitor& progress)
{
  const Vector& areas = this->Assembly->Mesh().ControlAreas();
  const Index n = this->Assembly->Mesh().NumberOfVertices();
  const double dt = this->Options.TimeStep;

  this->React(this->Old, this->Rates);
  this->AddHoldingForce(this->Old, this->Rates);
  ForEach(this->Parallel, n,
    [&](Index i)
    {
      const double area = areas[i];
      for (int c = 0; c < 2; ++c)
      {
        this->RightHandSide[c](i) = area * (this->Old[c](i) + Gamma * dt * this->Rates[c](i));
      }
    });
  this->Solve(report, progress.Part(0.0, 0.5));
  ForEach(this->Parallel, n,
    [&](Index i)
    {
      for (int c = 0; c < 2; ++c)
      {
        const double u = this->Old[c](i);
        this->Explicit[c](i) = u + (1.0 - Gamma) / Gamma * (this->New[c](i) - u) +
          dt * (Delta - 1.0 + Gamma) * this->Rates[c](i);
      }
    });
  StepReport stage;
  this->Project(Gamma * dt, stage);

  this->React(this->New, this->Rates);
  this->AddHoldingForce(this->New, this->Rates);
  ForEach(this->Parallel, n,
    [&](Index i)
    {
      const double area = areas[i];
      for (int c = 0; c < 2; ++c)
      {
        this->RightHandSide[c](i) =
          area * (this->Explicit[c](i) + (1.0 - Delta) * dt * this->Rates[c](i));
        // The start of an iterative solver, on the straight line through u and y.
        this->New[c](i) = this->Old[c](i) + (this->New[c](i) - this->Old[c](i)) / Gamma;
      }
    });
  this->Solve(report, progress.Part(0.5, 1.0));
  this->Project(dt, report);
}

/// f = (F, G) at u.
void ReactionDiffusion::React(const Pair& u, Pair& f) const
{
  ForEachBlock(this->Parallel, this->Assembly->Mesh().NumberOfVertices(),
    [&](Index, Index begin, Index end)
    {
      this->Terms.Terms->React(this->Terms.Parameters, end - begin, u[0].data() + begin,
        u[1].data() + begin, f[0].data() + begin, f[1].data() + begin);
      for (Values& rates : f)
      {
        rates.middleRows(begin, end - begin) *= this->Terms.Rate;
      }
    });
}

/// f += l, with Force = l >= 0 at vertices with u = 0, else 0: l balances f and the diffusion
/// -(K u)_i / A_i there. Between values >= 0 the diffusion is >= 0, except through the negative
/// weights of obtuse triangles, which without the inner maximum would make slivers oscillate.
void ReactionDiffusion::AddHoldingForce(const Pair& u, Pair& f)
{
  if (!this->Options.KeepNonNegative)
  {
    return;
  }
  const Reduction& reduction = this->Assembly->Mesh().GetReduction();
  for (int c = 0; c < 2; ++c)
  {
    reduction.AccumulateEach(
      this->Parallel, this->Force[c],
      [&](Index i)
      { this->Force[c](i) = u[c](i) <= 0.0 ? this->IntegrateDiffusion(c, u[c], i) : 0.0; },
      [&](Index i)
      {
        double force = 0.0;
        if (u[c](i) <= 0.0 && !this->Data.Fixed[i])
        {
          const double diffusion = this->Force[c](i) / (this->ImplicitTime * this->Areas[i]);
          force = std::max(0.0, -std::max(0.0, diffusion) - f[c](i));
        }
        this->Force[c](i) = force;
        f[c](i) += force;
      });
  }
}

/// -ImplicitTime (K u)_i, from the matrix M + ImplicitTime K. Accumulated.
double ReactionDiffusion::IntegrateDiffusion(int chemical, const Values& u, Index i) const
{
  return this->Assembly->Mesh().ControlAreas()[i] * u(i) - this->Systems[chemical].Product(i, u);
}

/// New = the solutions for the right-hand sides.
void ReactionDiffusion::Solve(StepReport& report, const ProgressMonitor& progress)
{
  if (this->CanSolveSideBySide())
  {
    // Without progress, which only the thread of the caller may report.
    ForEachTask(this->Parallel, 2, [this](Index c) { this->SolveFor(c, ProgressMonitor()); });
    progress.Report(1.0);
  }
  else
  {
    this->SolveFor(0, progress.Part(0.0, 0.5));
    if (!this->Solutions[0].Failure)
    {
      this->SolveFor(1, progress.Part(0.5, 1.0));
    }
  }
  for (int c = 0; c < 2; ++c)
  {
    const Solution& solution = this->Solutions[c];
    constexpr double boundless = 1e100;
    if (this->Assembly->Mesh().GetReduction().Any(
          !(this->RightHandSide[c].array().abs() < boundless).all()))
    {
      throw UnboundedGrowth();
    }
    if (solution.Failure)
    {
      std::rethrow_exception(solution.Failure);
    }
    this->Means.Restore(
      this->Assembly->Mesh(), this->RightHandSide[c], this->New[c], this->Parallel);
    report.Iterations += solution.Report.Iterations;
    report.Residual = std::max(report.Residual, solution.Report.Residual);
    report.MissedResidual = std::max(report.MissedResidual, solution.Report.MissedResidual);
  }
}

/// Whether the two solves run as two parallel tasks, with the same bits. Solvers that run on all
/// threads, or communicate with other processes, follow each other.
bool ReactionDiffusion::CanSolveSideBySide() const
{
  return this->Systems[0].GetSolver().RunsOnOneThread() &&
    this->Systems[1].GetSolver().RunsOnOneThread() &&
    this->Assembly->Mesh().GetReduction().IsSerial();
}

void ReactionDiffusion::SolveFor(int c, const ProgressMonitor& progress)
{
  this->Solutions[c] = Solution();
  try
  {
    this->Systems[c].Solve(
      this->RightHandSide[c], this->New[c], this->Solutions[c].Report, progress);
  }
  catch (...)
  {
    this->Solutions[c].Failure = std::current_exception();
  }
}

/// The right-hand side of the solve contained dt l. Subtract it, u - dt l, and clamp negative
/// values to zero.
void ReactionDiffusion::Project(double dt, StepReport& report)
{
  if (!this->Options.KeepNonNegative)
  {
    return;
  }
  const TriangleMesh& mesh = this->Assembly->Mesh();
  const double held = mesh.GetReduction().SumOverVertices(this->Parallel, mesh.NumberOfVertices(),
    [&](Index i)
    {
      int count = 0;
      for (int c = 0; c < 2; ++c)
      {
        const double u = this->New[c](i) - dt * this->Force[c](i);
        const bool below = u < 0.0 && !this->Data.Fixed[i];
        this->New[c](i) = below ? 0.0 : u;
        count += below;
      }
      return static_cast<double>(count);
    });
  report.Clamped += static_cast<Index>(held);
}

void ReactionDiffusion::FinishStep()
{
  const TriangleMesh& mesh = this->Assembly->Mesh();
  ForEach(this->Parallel, mesh.NumberOfVertices(),
    [&](Index i)
    {
      for (int c = 0; c < 2; ++c)
      {
        this->U(i, c) = this->New[c](i);
      }
    });
  if (!(this->Options.StopTolerance > 0.0))
  {
    return;
  }
  this->Done = true;
  for (int c = 0; c < 2; ++c)
  {
    const Values& u = this->New[c];
    const Values& before = this->Old[c];
    const double area = mesh.GetReduction().Sum(Sum(
      this->Parallel, mesh.NumberOfVertices(), [&](Index i) { return mesh.ControlAreas()[i]; }));
    const double mean = Total(mesh, u, 0, this->Parallel) / area;
    const double pattern = Norm(mesh, this->Parallel, [&](Index i) { return u(i) - mean; });
    const double change = Norm(mesh, this->Parallel, [&](Index i) { return u(i) - before(i); });
    this->Done =
      this->Done && change <= this->Options.StopTolerance * this->Options.TimeStep * pattern;
  }
}

double ReactionDiffusion::Energy() const
{
  const TriangleMesh& mesh = this->Assembly->Mesh();
  double energy = 0.0;
  for (int c = 0; c < 2; ++c)
  {
    energy += this->Stiffness[c].rows() > 0
      ? DirichletEnergy(this->Stiffness[c], this->New[c], this->Parallel)
      : DirichletEnergy(mesh, this->Coefficients[c], this->New[c], this->Parallel);
  }
  return mesh.GetReduction().Sum(energy);
}

} // namespace SurfaceDiffusion
