// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Models/LinearDiffusion.h"

#include "Core/Foundation/Columns.h"
#include "Core/Models/InitialState.h"
#include "Core/Operators/DirichletEnergy.h"

#include <algorithm>
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
  , Origin(U.cols())
{
  const TriangleMesh& mesh = this->Assembly->Mesh();
  const double area = mesh.GetReduction().Sum(mesh.ControlAreas().sum());
  std::vector<double> totals;
  Total(mesh, this->U, totals, parallel);
  for (Eigen::Index k = 0; k < this->U.cols(); ++k)
  {
    const double mean = totals[k] / area;
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
  const Eigen::Index columns = this->U.cols();
  for (Eigen::Index first = 0; first < columns; first += ColumnPanel)
  {
    const Eigen::Index count = std::min<Eigen::Index>(ColumnPanel, columns - first);
    for (Values* values : { &this->V, &this->Previous, &this->RightHandSide })
    {
      values->resize(this->U.rows(), count);
    }
    const double share = (1.0 - setup) / static_cast<double>(columns);
    this->AdvanceColumns(first, report,
      progress.Part(setup + share * static_cast<double>(first),
        setup + share * static_cast<double>(first + count)));
  }
  return report;
}

void LinearDiffusion::AdvanceColumns(
  Eigen::Index first, StepReport& report, const ProgressMonitor& progress)
{
  const TriangleMesh& mesh = this->Assembly->Mesh();
  const Eigen::Index columns = this->V.cols();
  // Values are measured from the mean: the errors of a solve are relative to the contrast then.
  ForEach(this->Parallel, mesh.NumberOfVertices(),
    [&](Index i)
    {
      for (Eigen::Index k = 0; k < columns; ++k)
      {
        this->V(i, k) = this->U(i, first + k) - this->Origin[first + k];
      }
    });
  if (this->Options.TimeScheme == Scheme::SDIRK2)
  {
    this->SDIRK2Step(first, report, progress);
  }
  else
  {
    this->BackwardEulerStep(first, report, progress);
  }
  ForEach(this->Parallel, mesh.NumberOfVertices(),
    [&](Index i)
    {
      for (Eigen::Index k = 0; k < columns; ++k)
      {
        this->V(i, k) = this->Data.Fixed[i] ? this->Data.Start(i, first + k)
                                            : this->V(i, k) + this->Origin[first + k];
      }
    });
  this->Conserved.Restore(mesh, this->V, this->Parallel, first);
  ForEach(this->Parallel, mesh.NumberOfVertices(),
    [&](Index i) { this->U.row(i).segment(first, columns) = this->V.row(i); });
}

/// (8), (14), with the fidelity of (16), (18):
/// ((1 + lambda dt chi) M + dt K) u_new = M (u + lambda dt chi f); the limit dt -> infinity is
/// (lambda chi M + K) u_new = lambda M chi f.
void LinearDiffusion::BackwardEulerStep(
  Eigen::Index first, StepReport& report, const ProgressMonitor& progress)
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
      for (Eigen::Index k = 0; k < this->V.cols(); ++k)
      {
        this->RightHandSide(i, k) =
          area * (inertia * this->V(i, k) + this->Source(source, i, first + k));
      }
    });
  this->Solve(first, report, progress);
}

/// With the source s = lambda M chi f in both stages, and lambda chi M in K,
///   (M + gamma dt K) y = M u + gamma dt s
///   (M + gamma dt K) u_new = M u + (1 - gamma) dt (s - K y) + gamma dt s,
/// and the first stage gives dt (s - K y) = M (y - u) / gamma: no product with K is needed.
void LinearDiffusion::SDIRK2Step(
  Eigen::Index first, StepReport& report, const ProgressMonitor& progress)
{
  const TriangleMesh& mesh = this->Assembly->Mesh();
  const double dt = this->Options.ImplicitStep();
  this->Previous = this->V;
  const double ratio = (1.0 - Gamma) / Gamma;
  for (const double second : { 0.0, ratio })
  {
    ForEach(this->Parallel, mesh.NumberOfVertices(),
      [&](Index i)
      {
        const double area = mesh.ControlAreas()[i];
        const double source = dt * this->Fit.Weight(i);
        for (Eigen::Index k = 0; k < this->V.cols(); ++k)
        {
          const double previous = this->Previous(i, k);
          this->RightHandSide(i, k) = area *
            (previous + second * (this->V(i, k) - previous) + this->Source(source, i, first + k));
        }
      });
    this->Solve(first, report, second > 0.0 ? progress.Part(0.5, 1.0) : progress.Part(0.0, 0.5));
  }
}

void LinearDiffusion::Solve(Eigen::Index first, StepReport& report, const ProgressMonitor& progress)
{
  this->System.Solve(this->RightHandSide, this->V, report, progress, first);
  this->Balanced.Restore(this->Assembly->Mesh(), this->RightHandSide, this->V, this->Parallel);
}

double LinearDiffusion::Energy() const
{
  const TriangleMesh& mesh = this->Assembly->Mesh();
  return mesh.GetReduction().Sum(
    DirichletEnergy(mesh, this->Coefficients, this->U, this->Parallel) +
    this->Fit.Energy(mesh, this->U, this->Parallel));
}

} // namespace SurfaceDiffusion
