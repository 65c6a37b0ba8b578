// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Models/LinearDiffusion.h"

#include "Core/Models/InitialState.h"
#include "Core/Operators/SparsePattern.h"

#include <cmath>

namespace SurfaceDiffusion
{

LinearDiffusion::LinearDiffusion(std::shared_ptr<const Assembler> assembler,
  CornerWeights coefficients, PointData data, const Settings& settings,
  std::shared_ptr<LinearSolver> solver, const ParallelFor& parallel)
  : Operators(std::move(assembler))
  , Coefficients(std::move(coefficients))
  , Data(std::move(data))
  , Options(settings)
  , Solver(std::move(solver))
  , Parallel(parallel)
  , Conserved(this->Operators->Mesh(), this->Data, settings.Fidelity > 0.0, parallel)
  , U(this->Data.Start)
  , RightHandSide(U.rows(), U.cols())
  , Origin(U.cols())
{
  const TriangleMesh& mesh = this->Operators->Mesh();
  const double area = mesh.GetReduction().Sum(mesh.ControlAreas().sum());
  for (Eigen::Index k = 0; k < this->U.cols(); ++k)
  {
    const double mean = Total(mesh, this->U, k, parallel) / area;
    this->Origin[k] = std::isfinite(mean) ? mean : 0.0;
  }
}

void LinearDiffusion::Restore(const double* checkpoint)
{
  std::copy(checkpoint, checkpoint + this->U.size(), this->U.data());
}

void LinearDiffusion::Prepare(const ProgressMonitor& progress)
{
  const TriangleMesh& mesh = this->Operators->Mesh();
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
    { diagonal[i] = mesh.ControlAreas()[i] * (inertia + scale * this->FidelityAt(i)); });
  TakePattern(this->Operators->Pattern(), this->Matrix, this->Parallel);
  this->Operators->Fill(this->Matrix, diagonal, scale, this->Coefficients, nullptr, this->Parallel);
  this->Load = Values::Zero(this->U.rows(), this->U.cols());
  if (this->Data.Fixed.any())
  {
    const Values known = this->Data.Start.rowwise() - this->Origin;
    this->Operators->Constrain(this->Matrix, this->Data.Fixed, known, this->Load, this->Parallel);
  }
  this->Balanced = MeanCorrection(mesh, std::move(diagonal), this->Data.Fixed, this->Parallel);
  this->Solver->SetMatrix(this->Matrix, progress);
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
  const TriangleMesh& mesh = this->Operators->Mesh();
  // Measured from the mean, so that the errors of a solve go with the contrast, not the offset.
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
/// ((1 + lambda dt) M + dt K) u_new = M (u + lambda dt f); without M u where only the limit counts.
void LinearDiffusion::BackwardEulerStep(StepReport& report, const ProgressMonitor& progress)
{
  const TriangleMesh& mesh = this->Operators->Mesh();
  const bool limit = this->Options.TimeScheme == Scheme::SteadyState;
  const double inertia = limit ? 0.0 : 1.0;
  const double dt = limit ? 1.0 : this->Options.TimeStep;
  ForEach(this->Parallel, mesh.NumberOfVertices(),
    [&](Index i)
    {
      const double area = this->Data.Fixed[i] ? 0.0 : mesh.ControlAreas()[i];
      const double source = dt * this->FidelityAt(i);
      for (Eigen::Index k = 0; k < this->U.cols(); ++k)
      {
        this->RightHandSide(i, k) =
          area * (inertia * this->U(i, k) + source * (this->Data.Given(i, k) - this->Origin[k])) +
          this->Load(i, k);
      }
    });
  this->Solve(report, progress);
}

/// With s the fidelity's source and both stages implicit,
///   (M + gamma dt K) y = M u + gamma dt s
///   (M + gamma dt K) u_new = M u + (1 - gamma) dt (s - K y) + gamma dt s,
/// where the first stage gives dt (s - K y) = M (y - u) / gamma: no product with K is needed.
void LinearDiffusion::SDIRK2Step(StepReport& report, const ProgressMonitor& progress)
{
  const TriangleMesh& mesh = this->Operators->Mesh();
  const double dt = this->Options.ImplicitStep();
  this->Previous = this->U;
  const double ratio = (1.0 - Gamma) / Gamma;
  for (const double second : { 0.0, ratio })
  {
    ForEach(this->Parallel, mesh.NumberOfVertices(),
      [&](Index i)
      {
        const double area = this->Data.Fixed[i] ? 0.0 : mesh.ControlAreas()[i];
        const double source = dt * this->FidelityAt(i);
        for (Eigen::Index k = 0; k < this->U.cols(); ++k)
        {
          const double previous = this->Previous(i, k);
          this->RightHandSide(i, k) = area *
              (previous + second * (this->U(i, k) - previous) +
                source * (this->Data.Given(i, k) - this->Origin[k])) +
            this->Load(i, k);
        }
      });
    this->Solve(report, second > 0.0 ? progress.Part(0.5, 1.0) : progress.Part(0.0, 0.5));
  }
}

void LinearDiffusion::Solve(StepReport& report, const ProgressMonitor& progress)
{
  const SolveReport solve = this->Solver->Solve(this->RightHandSide, this->U, progress);
  if (!solve.Converged)
  {
    throw NotConverged(solve);
  }
  report.Iterations += solve.Iterations;
  report.Residual = std::max(report.Residual, solve.Residual);
  this->Balanced.Restore(this->Operators->Mesh(), this->RightHandSide, this->U, this->Parallel);
}

double LinearDiffusion::Energy() const
{
  const TriangleMesh& mesh = this->Operators->Mesh();
  double energy = DirichletEnergy(mesh, this->Coefficients, this->U, this->Parallel);
  if (this->Options.Fidelity > 0.0)
  {
    energy += 0.5 *
      Sum(this->Parallel, mesh.NumberOfVertices(),
        [&](Index i)
        {
          return mesh.ControlAreas()[i] * this->FidelityAt(i) *
            (this->U.row(i) - this->Data.Given.row(i)).squaredNorm();
        });
  }
  return mesh.GetReduction().Sum(energy);
}

double DirichletEnergy(const TriangleMesh& mesh, const CornerWeights& coefficients, const Values& u,
  const ParallelFor& parallel)
{
  const Triangles& corners = mesh.TriangleVertices();
  return 0.5 *
    Sum(parallel, mesh.NumberOfTriangles(),
      [&](Index t)
      {
        const auto square = [&](int a, int b)
        {
          double sum = 0.0;
          for (Eigen::Index k = 0; k < u.cols(); ++k)
          {
            const double difference = u(corners(t, a), k) - u(corners(t, b), k);
            sum += difference * difference;
          }
          return sum;
        };
        return coefficients(t, 0) * square(1, 2) + coefficients(t, 1) * square(2, 0) +
          coefficients(t, 2) * square(0, 1);
      });
}

} // namespace SurfaceDiffusion
