// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Models/LinearDiffusion.h"

#include "Core/Foundation/Columns.h"
#include "Core/Models/InitialState.h"
#include "Core/Operators/CotanWeights.h"
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
{
  FindMeans(this->Assembly->Mesh(), this->U, this->Origin, parallel);
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
  this->System.Assemble(diagonal, scale,
    this->Coefficients.rows() > 0 ? this->Coefficients : CotanWeights(mesh, this->Parallel));
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
    this->V.resize(this->U.rows(), count);
    this->RightHandSide.resize(this->U.rows(), count);
    const double share = (1.0 - setup) / static_cast<double>(columns);
    this->AdvanceColumns(first, report,
      progress.Part(setup + share * static_cast<double>(first),
        setup + share * static_cast<double>(first + count)));
  }
  return report;
}

/// SDIRK2, with the source s = lambda M chi f in both stages, and lambda chi M in K:
///   (M + gamma dt K) y = M u + gamma dt s
///   (M + gamma dt K) u_new = M u + (1 - gamma) dt (s - K y) + gamma dt s,
/// and the first stage gives dt (s - K y) = M (y - u) / gamma: no product with K is needed.
void LinearDiffusion::AdvanceColumns(
  Eigen::Index first, StepReport& report, const ProgressMonitor& progress)
{
  ForColumns(this->V.cols(),
    [&](auto number)
    {
      constexpr int columns = decltype(number)::value;
      this->StartStep<columns>(first);
      if (this->Options.TimeScheme == Scheme::SDIRK2)
      {
        this->Solve(first, report, progress.Part(0.0, 0.5));
        this->StartSecondStage<columns>(first);
        this->Solve(first, report, progress.Part(0.5, 1.0));
      }
      else
      {
        this->Solve(first, report, progress);
      }
      this->FinishStep<columns>(first);
    });
}

/// The right-hand side of a backward Euler step (8), (14), with the fidelity of (16), (18):
/// ((1 + lambda dt chi) M + dt K) u_new = M (u + lambda dt chi f); the limit dt -> infinity is
/// (lambda chi M + K) u_new = lambda M chi f. The first stage of SDIRK2 is such a step of gamma dt.
/// Values are measured from the mean: the errors of a solve are relative to the contrast then.
template <int K>
void LinearDiffusion::StartStep(Eigen::Index first)
{
  const ColumnCount<K> columns(this->V.cols());
  const TriangleMesh& mesh = this->Assembly->Mesh();
  const bool limit = this->Options.TimeScheme == Scheme::SteadyState;
  const double inertia = limit ? 0.0 : 1.0;
  const double dt = limit ? 1.0 : this->Options.ImplicitStep();
  const double* const origin = this->Origin.data() + first;
  ForEach(this->Parallel, mesh.NumberOfVertices(),
    [&](Index i)
    {
      const double area = mesh.ControlAreas()[i];
      const double source = dt * this->Fit.Weight(i);
      const double* const u = &this->U(i, first);
      double* const v = &this->V(i, 0);
      double* const b = &this->RightHandSide(i, 0);
      for (int k = 0; k < columns; ++k)
      {
        v[k] = u[k] - origin[k];
        b[k] = area * (inertia * v[k]);
      }
      if (source > 0.0) // f is not read without a weight, which would cost many columns time
      {
        for (int k = 0; k < columns; ++k)
        {
          b[k] = area * (inertia * v[k] + source * (this->Data.Given(i, first + k) - origin[k]));
        }
      }
    });
}

template <typename Body>
void LinearDiffusion::ForEachShifted(const Body& body) const
{
  const TriangleMesh& mesh = this->Assembly->Mesh();
  for (Index c = 0; c < mesh.NumberOfComponents(); ++c)
  {
    const Index begin = mesh.ComponentsBegin()[c];
    const double* const shifts =
      this->Shifts.data() + static_cast<std::ptrdiff_t>(c) * this->Shifts.cols();
    ForEach(this->Parallel, mesh.ComponentsBegin()[c + 1] - begin,
      [&](Index i) { body(begin + i, shifts); });
  }
}

/// The right-hand side of the second stage, from V, the result y of the first one.
template <int K>
void LinearDiffusion::StartSecondStage(Eigen::Index first)
{
  const ColumnCount<K> columns(this->V.cols());
  const TriangleMesh& mesh = this->Assembly->Mesh();
  const double dt = this->Options.ImplicitStep();
  const double ratio = (1.0 - Gamma) / Gamma;
  const double* const origin = this->Origin.data() + first;
  this->ForEachShifted(
    [&](Index i, const double* shifts)
    {
      const double area = mesh.ControlAreas()[i];
      const double source = dt * this->Fit.Weight(i);
      const double* const u = &this->U(i, first);
      double* const v = &this->V(i, 0);
      double* const b = &this->RightHandSide(i, 0);
      for (int k = 0; k < columns; ++k)
      {
        const double previous = u[k] - origin[k];
        v[k] += shifts[k];
        b[k] = previous + ratio * (v[k] - previous);
      }
      if (source > 0.0)
      {
        for (int k = 0; k < columns; ++k)
        {
          b[k] += source * (this->Data.Given(i, first + k) - origin[k]);
        }
      }
      for (int k = 0; k < columns; ++k)
      {
        b[k] *= area;
      }
    });
}

/// From V to U.
template <int K>
void LinearDiffusion::FinishStep(Eigen::Index first)
{
  const ColumnCount<K> columns(this->V.cols());
  const double* const origin = this->Origin.data() + first;
  this->ForEachShifted(
    [&](Index i, const double* shifts)
    {
      double* const v = &this->V(i, 0);
      if (this->Data.Fixed[i])
      {
        CopyColumns<K>(&this->Data.Start(i, first), v, columns);
        return;
      }
      for (int k = 0; k < columns; ++k)
      {
        v[k] = v[k] + shifts[k] + origin[k];
      }
    });
  this->Conserved.FindShifts(this->Assembly->Mesh(), this->V, this->Parallel, first, this->Shifts);
  this->ForEachShifted(
    [&](Index i, const double* shifts)
    {
      const double* const v = &this->V(i, 0);
      double* const u = &this->U(i, first);
      for (int k = 0; k < columns; ++k)
      {
        u[k] = v[k] + shifts[k];
      }
    });
}

void LinearDiffusion::Solve(Eigen::Index first, StepReport& report, const ProgressMonitor& progress)
{
  this->System.Solve(this->RightHandSide, this->V, report, progress, first);
  this->Balanced.FindShifts(
    this->Assembly->Mesh(), this->RightHandSide, this->V, this->Parallel, this->Shifts);
}

DiffusionStep LinearDiffusion::Diffusion() const
{
  DiffusionStep step;
  step.TimeStep =
    this->Options.TimeScheme == Scheme::SteadyState ? InfiniteTime : this->Options.TimeStep;
  step.Fidelity = this->Options.Fidelity;
  step.IsConstant = true;
  return step;
}

double LinearDiffusion::Energy() const
{
  const TriangleMesh& mesh = this->Assembly->Mesh();
  return mesh.GetReduction().Sum(
    DirichletEnergy(mesh, this->Coefficients, this->U, this->Parallel) +
    this->Fit.Energy(mesh, this->U, this->Parallel));
}

} // namespace SurfaceDiffusion
