// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Models/LinearDiffusion.h"

#include "Core/Foundation/Columns.h"
#include "Core/Operators/ExponentialSeries.h"
#include "Core/Models/InitialState.h"
#include "Core/Operators/CotanWeights.h"
#include "Core/Operators/DirichletEnergy.h"
#include "Core/Operators/MixedMass.h"

#include <algorithm>

namespace SurfaceDiffusion
{

double LinearDiffusion::Settings::ImplicitStep() const
{
  switch (this->TimeScheme)
  {
    case Scheme::SDIRK2:
      return Gamma * this->TimeStep;
    case Scheme::Exponential:
      return ExponentialSeries::Step * this->TimeStep;
    default:
      return this->TimeStep;
  }
}

int LinearDiffusion::Settings::NumberOfSolves() const
{
  switch (this->TimeScheme)
  {
    case Scheme::SDIRK2:
      return 2;
    case Scheme::Exponential:
      return ExponentialSeries::Degree;
    default:
      return 1;
  }
}

DiffusionStep LinearDiffusion::Settings::Diffusion() const
{
  DiffusionStep step;
  step.TimeStep = this->TimeScheme == Scheme::SteadyState ? InfiniteTime : this->TimeStep;
  step.Fidelity = this->Fidelity;
  step.IsConstant = true;
  step.IsExponential = this->TimeScheme == Scheme::Exponential;
  return step;
}

LinearDiffusion::LinearDiffusion(std::shared_ptr<const Assembler> assembler,
  CornerWeights coefficients, PointData data, const Settings& settings,
  std::shared_ptr<LinearSolver> solver, const ParallelFor& parallel)
  : StateModel(data.Start)
  , Assembly(std::move(assembler))
  , Coefficients(std::move(coefficients))
  , Data(std::move(data))
  , Fit(this->Data, { settings.Fidelity })
  , Options(settings)
  , Parallel(parallel)
  , System(this->Assembly, std::move(solver), parallel)
  , Conserved(this->Assembly->Mesh(), this->Data, this->Fit.IsPresent(), parallel)
  , Panel(this->Assembly->Mesh(), this->Data, this->Fit, this->U, parallel)
{
  // Values that no equation reads take memory.
  if (!this->Data.Fixed.any() && settings.TimeScheme != Scheme::SteadyState)
  {
    this->Data.Start = Values();
  }
  if (settings.Fidelity == 0.0)
  {
    this->Data.Given = Values();
  }
}

void LinearDiffusion::Prepare(const ProgressMonitor& progress)
{
  const TriangleMesh& mesh = this->Assembly->Mesh();
  double scale = this->Options.ImplicitStep();
  double inertia = 1.0;
  if (this->Options.TimeScheme == Scheme::SteadyState)
  {
    FixFreeComponents(mesh, this->Data, this->Options.Fidelity);
    scale = 1.0;
    inertia = 0.0;
  }
  Vector diagonal(mesh.NumberOfVertices());
  ForEach(this->Parallel, mesh.NumberOfVertices(),
    [&](Index i)
    { diagonal[i] = mesh.ControlAreas()[i] * (inertia + scale * this->Fit.Weight(i)); });
  CornerWeights coefficients =
    this->Coefficients.rows() > 0 ? this->Coefficients : CotanWeights(mesh, this->Parallel);
  if (this->Options.HasMixedMass && inertia > 0.0)
  {
    const CornerWeights mass = MixedMassWeights(mesh, this->Parallel);
    this->MassDifference = MixedMinusLumped(*this->Assembly, mass, this->Parallel);
    coefficients = scale * coefficients + mass;
    scale = 1.0;
  }
  this->System.Assemble(diagonal, scale, coefficients);
  if (this->Data.Fixed.any())
  {
    this->System.Constrain(this->Data.Fixed, this->Data.Start.rowwise() - this->Panel.Means());
  }
  this->Balanced = MeanCorrection(mesh, std::move(diagonal), this->Data.Fixed, this->Parallel);
  this->System.SetUpSolver(progress);
  this->Prepared = true;
}

StepReport LinearDiffusion::Advance(const ProgressMonitor& progress)
{
  StepReport report;
  const double setup = this->Prepared ? 0.0 : 0.5;
  if (!this->Prepared)
  {
    this->Prepare(progress.Part(0.0, setup));
  }
  else if (this->Options.SharesSolver)
  {
    this->System.SetUpSolver(progress.Part(0.0, 0.0));
  }
  const Eigen::Index columns = this->U.cols();
  for (Eigen::Index first = 0; first < columns; first += ColumnPanel)
  {
    const Eigen::Index count = std::min<Eigen::Index>(ColumnPanel, columns - first);
    const double share = (1.0 - setup) / static_cast<double>(columns);
    const ProgressMonitor part = progress.Part(setup + share * static_cast<double>(first),
      setup + share * static_cast<double>(first + count));
    switch (this->Options.TimeScheme)
    {
      case Scheme::BackwardEuler:
        this->StepBackwardEuler(first, count, report, part);
        break;
      case Scheme::SDIRK2:
        this->StepSDIRK2(first, count, report, part);
        break;
      case Scheme::Exponential:
        this->StepExponential(first, count, report, part);
        break;
      case Scheme::SteadyState:
        this->StepToSteadyState(first, count, report, part);
        break;
    }
    this->Panel.Finish(this->Conserved, this->U);
  }
  return report;
}

/// (8), (14), with the fidelity of (16), (18):
/// ((1 + lambda dt chi) M + dt K) u_new = M (u + lambda dt chi f).
void LinearDiffusion::StepBackwardEuler(
  Eigen::Index first, Eigen::Index count, StepReport& report, const ProgressMonitor& progress)
{
  this->Panel.StartStage(this->U, first, count, 1.0, this->Options.TimeStep);
  this->Panel.AddMass(this->MassDifference);
  this->Solve(report, progress);
}

/// The limit dt -> infinity of backward Euler: (lambda chi M + K) u_new = lambda M chi f.
void LinearDiffusion::StepToSteadyState(
  Eigen::Index first, Eigen::Index count, StepReport& report, const ProgressMonitor& progress)
{
  this->Panel.StartStage(this->U, first, count, 0.0, 1.0);
  this->Solve(report, progress);
}

/// With the source s = lambda M chi f in both stages, and lambda chi M in K:
///   (M + gamma dt K) y = M u + gamma dt s, a backward Euler step of gamma dt, and
///   (M + gamma dt K) u_new = M u + (1 - gamma) dt (s - K y) + gamma dt s.
/// The first stage gives dt (s - K y) = M (y - u) / gamma: no product with K is needed.
void LinearDiffusion::StepSDIRK2(
  Eigen::Index first, Eigen::Index count, StepReport& report, const ProgressMonitor& progress)
{
  const double dt = this->Options.ImplicitStep();
  constexpr double ratio = (1.0 - Gamma) / Gamma;
  this->Panel.StartStage(this->U, first, count, 1.0, dt);
  this->Panel.AddMass(this->MassDifference);
  this->Solve(report, progress.Part(0.0, 0.5));
  this->Panel.StartSecondStage(this->U, ratio, dt);
  this->Panel.AddMassOfSecondStage(this->MassDifference, this->U, ratio);
  this->Solve(report, progress.Part(0.5, 1.0));
}

/// See ExponentialSeries.
void LinearDiffusion::StepExponential(
  Eigen::Index first, Eigen::Index count, StepReport& report, const ProgressMonitor& progress)
{
  constexpr int last = ExponentialSeries::Degree;
  const double dt = this->Options.ImplicitStep();
  this->Panel.StartStage(this->U, first, count, 1.0, dt);
  this->Panel.StartSeries();
  for (int k = 1; k <= last; ++k)
  {
    this->Panel.AddMass(this->MassDifference);
    this->Solve(report, progress.Part((k - 1.0) / last, static_cast<double>(k) / last));
    this->Panel.AddTerm(k, dt);
  }
}

void LinearDiffusion::Solve(StepReport& report, const ProgressMonitor& progress)
{
  this->System.Solve(
    this->Panel.RightHandSide, this->Panel.Solution, report, progress, this->Panel.First());
  if (report.MissedResidual <= this->Options.SufficientResidual)
  {
    report.MissedResidual = 0.0;
  }
  this->Panel.Correct(this->Balanced);
}

double LinearDiffusion::Energy() const
{
  const TriangleMesh& mesh = this->Assembly->Mesh();
  return mesh.GetReduction().Sum(
    DirichletEnergy(mesh, this->Coefficients, this->U, this->Parallel) +
    this->Fit.Energy(mesh, this->U, this->Parallel));
}

} // namespace SurfaceDiffusion
