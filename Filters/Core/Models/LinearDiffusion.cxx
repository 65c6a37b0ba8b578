// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Models/LinearDiffusion.h"

#include "Core/Models/InitialState.h"
#include "Core/Operators/DirichletEnergy.h"

#include <cmath>

namespace SurfaceDiffusion
{

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
  , RightHandSide(U.rows(), U.cols())
  , Origin(U.cols())
{
  const TriangleMesh& mesh = this->Assembly->Mesh();
  const double area = mesh.GetReduction().Sum(mesh.ControlAreas().sum());
  for (Eigen::Index k = 0; k < this->U.cols(); ++k)
  {
    const double mean = Total(mesh, this->U, k, parallel) / area;
    this->Origin[k] = std::isfinite(mean) ? mean : 0.0;
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
  this->System.Assemble(diagonal, scale, this->Coefficients);
  if (this->Data.Fixed.any())
  {
    this->System.Constrain(this->Data.Fixed, this->Data.Start.rowwise() - this->Origin);
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
  const TriangleMesh& mesh = this->Assembly->Mesh();
  // Values are measured from the mean: the errors of a solve are relative to the contrast then.
  const Eigen::Index columns = this->U.cols();
  ForEach(this->Parallel, mesh.NumberOfVertices(),
    [&](Index i)
    {
      for (Eigen::Index k = 0; k < columns; ++k)
      {
        this->U(i, k) -= this->Origin[k];
      }
    });
  if (this->Options.TimeScheme == Scheme::SDIRK2)
  {
    this->SDIRK2Step(report, progress.Part(setup, 1.0));
  }
  else
  {
    this->BackwardEulerStep(report, progress.Part(setup, 1.0));
  }
  ForEach(this->Parallel, mesh.NumberOfVertices(),
    [&](Index i)
    {
      for (Eigen::Index k = 0; k < columns; ++k)
      {
        this->U(i, k) =
          this->Data.Fixed[i] ? this->Data.Start(i, k) : this->U(i, k) + this->Origin[k];
      }
    });
  this->Conserved.Restore(mesh, this->U, this->Parallel);
  return report;
}

/// (8), (14), with the fidelity of (16), (18):
/// ((1 + lambda dt chi) M + dt K) u_new = M (u + lambda dt chi f); the limit dt -> infinity is
/// (lambda chi M + K) u_new = lambda M chi f.
void LinearDiffusion::BackwardEulerStep(StepReport& report, const ProgressMonitor& progress)
{
  const TriangleMesh& mesh = this->Assembly->Mesh();
  const bool limit = this->Options.TimeScheme == Scheme::SteadyState;
  const double inertia = limit ? 0.0 : 1.0;
  const double dt = limit ? 1.0 : this->Options.TimeStep;
  ForEach(this->Parallel, mesh.NumberOfVertices(),
    [&](Index i)
    {
      const double area = mesh.ControlAreas()[i];
      const double source = dt * this->Fit.Weight(i);
      for (Eigen::Index k = 0; k < this->U.cols(); ++k)
      {
        this->RightHandSide(i, k) =
          area * (inertia * this->U(i, k) + source * (this->Data.Given(i, k) - this->Origin[k]));
      }
    });
  this->Solve(report, progress);
}

/// With the source s = lambda M chi f in both stages, and lambda chi M in K,
///   (M + gamma dt K) y = M u + gamma dt s
///   (M + gamma dt K) u_new = M u + (1 - gamma) dt (s - K y) + gamma dt s,
/// and the first stage gives dt (s - K y) = M (y - u) / gamma: no product with K is needed.
void LinearDiffusion::SDIRK2Step(StepReport& report, const ProgressMonitor& progress)
{
  const TriangleMesh& mesh = this->Assembly->Mesh();
  const double dt = this->Options.ImplicitStep();
  this->Previous = this->U;
  const double ratio = (1.0 - Gamma) / Gamma;
  for (const double second : { 0.0, ratio })
  {
    ForEach(this->Parallel, mesh.NumberOfVertices(),
      [&](Index i)
      {
        const double area = mesh.ControlAreas()[i];
        const double source = dt * this->Fit.Weight(i);
        for (Eigen::Index k = 0; k < this->U.cols(); ++k)
        {
          const double previous = this->Previous(i, k);
          this->RightHandSide(i, k) = area *
            (previous + second * (this->U(i, k) - previous) +
              source * (this->Data.Given(i, k) - this->Origin[k]));
        }
      });
    this->Solve(report, second > 0.0 ? progress.Part(0.5, 1.0) : progress.Part(0.0, 0.5));
  }
}

void LinearDiffusion::Solve(StepReport& report, const ProgressMonitor& progress)
{
  this->System.Solve(this->RightHandSide, this->U, report, progress);
  this->Balanced.Restore(this->Assembly->Mesh(), this->RightHandSide, this->U, this->Parallel);
}

double LinearDiffusion::Energy() const
{
  const TriangleMesh& mesh = this->Assembly->Mesh();
  return mesh.GetReduction().Sum(
    DirichletEnergy(mesh, this->Coefficients, this->U, this->Parallel) +
    this->Fit.Energy(mesh, this->U, this->Parallel));
}

} // namespace SurfaceDiffusion
