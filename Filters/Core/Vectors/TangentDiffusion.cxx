// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Vectors/TangentDiffusion.h"

#include "Core/Operators/ExponentialSeries.h"
#include "Core/Operators/MixedMass.h"

#include <algorithm>

namespace SurfaceDiffusion
{

namespace
{

/// Of the steady state, times the mass matrix over the area of a component: it keeps what K and the data
/// leave open as it was.
constexpr double SteadyInertia = 1e-10;

/// Rows and columns of fixed vertices become those of the unit matrix times their diagonals. load: what
/// their values w make of the right-hand side of the others, and their own right-hand side.
void Constrain(SparseMatrix& matrix, const Flags& fixed, const Values& w, Values& load)
{
  load = Values::Zero(w.rows(), w.cols());
  for (Index row = 0; row < static_cast<Index>(matrix.rows()); ++row)
  {
    for (SparseMatrix::InnerIterator entry(matrix, row); entry; ++entry)
    {
      const auto other = static_cast<Index>(entry.index());
      if (other == row)
      {
        load.row(row) +=
          fixed[row / 2] ? Values(entry.value() * w.row(row)) : Values::Zero(1, w.cols());
      }
      else if (fixed[row / 2] || fixed[other / 2])
      {
        if (!fixed[row / 2])
        {
          load.row(row) -= entry.value() * w.row(other);
        }
        entry.valueRef() = 0.0;
      }
    }
  }
}

} // namespace

TangentDiffusion::TangentDiffusion(std::shared_ptr<const Assembler> assembler,
  std::shared_ptr<const TangentPlanes> planes, CornerWeights coefficients, PointData data,
  const Settings& settings, std::shared_ptr<LinearSolver> solver, std::unique_ptr<Model> normal,
  const ParallelFor& parallel)
  : Assembly(std::move(assembler))
  , Planes(std::move(planes))
  , Data(std::move(data))
  , Fit(this->Data, { settings.Diffusion.Fidelity })
  , Options(settings)
  , Stiffness(*this->Planes, settings.Laplacian, std::move(coefficients))
  , Solver(std::move(solver))
  , Normal(std::move(normal))
  , Parallel(parallel)
  , W(this->Planes->Coordinates(this->Data.Start))
{
  if (this->Fit.IsPresent())
  {
    this->F = this->Planes->Coordinates(this->Data.Given);
  }
  if (settings.NormalPart == NormalPart::Keep)
  {
    this->NormalParts = this->Planes->NormalParts(this->Data.Start);
  }
  this->Data.Given = Values();
  if (!this->Data.Fixed.any())
  {
    this->Data.Start = Values();
  }
  this->MakeState();
}

/// Fixed vertices keep what they have, also along the normal.
void TangentDiffusion::MakeState()
{
  this->Planes->SetVectors(
    this->W, this->Normal ? this->Normal->State() : this->NormalParts, this->U);
  for (Index i = 0; i < static_cast<Index>(this->Data.Start.rows()); ++i)
  {
    if (this->Data.Fixed[i])
    {
      this->U.row(i) = this->Data.Start.row(i);
    }
  }
}

/// B becomes M w, or with the mixed mass matrix B w; of a steady state what stands in their place.
void TangentDiffusion::StartFrom(const Values& w)
{
  this->B.resize(w.rows(), w.cols());
  this->B.setZero();
  if (this->MassDifference.rows() > 0)
  {
    Multiply(this->MassDifference, w, this->B, this->Parallel);
  }
  ForEach(this->Parallel, static_cast<Index>(w.rows()),
    [&](Index row) { this->B.row(row) += this->Inertia[row] * w.row(row); });
}

void TangentDiffusion::Prepare(const ProgressMonitor& progress)
{
  const TriangleMesh& mesh = this->Assembly->Mesh();
  const LinearDiffusion::Settings& diffusion = this->Options.Diffusion;
  const bool isSteady = diffusion.TimeScheme == LinearDiffusion::Scheme::SteadyState;
  const double scale = isSteady ? 1.0 : diffusion.ImplicitStep();
  this->Inertia.resize(this->W.rows());
  for (Index c = 0; c < mesh.NumberOfComponents(); ++c)
  {
    const Index begin = mesh.ComponentsBegin()[c];
    const auto areas = mesh.ControlAreas().segment(begin, mesh.ComponentsBegin()[c + 1] - begin);
    const double factor = isSteady ? SteadyInertia / areas.sum() : 1.0;
    for (Index row = 2 * begin; row < 2 * mesh.ComponentsBegin()[c + 1]; ++row)
    {
      this->Inertia[row] = factor * this->Area(row);
    }
  }
  Vector diagonal(this->W.rows());
  ForEach(this->Parallel, static_cast<Index>(this->W.rows()),
    [&](Index row)
    { diagonal[row] = this->Inertia[row] + scale * this->RowWeight(row) * this->Area(row); });
  const SparsePattern pattern = this->Assembly->Pattern(this->Parallel);
  this->Matrix = this->Stiffness.Assemble(pattern, diagonal, scale, this->Parallel);
  if (diffusion.HasMixedMass && !isSteady)
  {
    const VectorStiffness difference(
      *this->Planes, VectorLaplacian::Connection, MixedMassWeights(mesh, this->Parallel));
    this->MassDifference =
      difference.Assemble(pattern, Vector::Zero(this->W.rows()), 1.0, this->Parallel);
    Eigen::Map<Vector>(this->Matrix.valuePtr(), this->Matrix.nonZeros()) +=
      Eigen::Map<const Vector>(this->MassDifference.valuePtr(), this->Matrix.nonZeros());
  }
  if (this->Data.Fixed.any())
  {
    Constrain(this->Matrix, this->Data.Fixed, this->W, this->Load);
  }
  this->Solver->SetMatrix(this->Matrix, progress);
  this->Prepared = true;
}

/// Solution becomes that of (M + dt (K + lambda M chi)) w = B + dt lambda M chi f, after StartFrom().
void TangentDiffusion::Solve(double dt, StepReport& report, const ProgressMonitor& progress)
{
  ForEach(this->Parallel, static_cast<Index>(this->B.rows()),
    [&](Index row)
    {
      if (this->Data.Fixed[row / 2])
      {
        this->B.row(row) = this->Load.row(row);
        return;
      }
      if (this->Load.rows() > 0)
      {
        this->B.row(row) += this->Load.row(row);
      }
      if (this->Fit.IsPresent())
      {
        this->B.row(row) += dt * this->RowWeight(row) * this->Area(row) * this->F.row(row);
      }
    });
  const SolveReport solve = this->Solver->Solve(this->B, this->Solution, progress);
  report.Add(solve);
  RequireAnswer(solve, this->Solver->GetLimits());
}

void TangentDiffusion::TakeStep(StepReport& report, const ProgressMonitor& progress)
{
  const LinearDiffusion::Settings& diffusion = this->Options.Diffusion;
  const bool isSteady = diffusion.TimeScheme == LinearDiffusion::Scheme::SteadyState;
  const double dt = isSteady ? 1.0 : diffusion.ImplicitStep();
  if (diffusion.TimeScheme == LinearDiffusion::Scheme::Exponential)
  {
    this->StepExponential(dt, report, progress);
    return;
  }
  this->Solution = this->W;
  if (diffusion.TimeScheme == LinearDiffusion::Scheme::SDIRK2) // LinearDiffusion::StepSDIRK2()
  {
    this->StartFrom(this->W);
    this->Solve(dt, report, progress.Part(0.0, 0.5));
    constexpr double ratio = (1.0 - LinearDiffusion::Gamma) / LinearDiffusion::Gamma;
    this->Term = this->W + ratio * (this->Solution - this->W);
    this->StartFrom(this->Term);
    this->Solve(dt, report, progress.Part(0.5, 1.0));
  }
  else
  {
    this->StartFrom(this->W);
    this->Solve(dt, report, progress);
  }
  this->W = this->Solution;
}

/// See ExponentialSeries.
void TangentDiffusion::StepExponential(
  double dt, StepReport& report, const ProgressMonitor& progress)
{
  constexpr double all = ExponentialSeries::Degree;
  ExponentialSeries::Apply(this->W, this->Series,
    [&](int k, const Values& last, Values& y)
    {
      this->StartFrom(last);
      this->Solution = last;
      this->Solve(dt, report, progress.Part((k - 1.0) / all, k / all));
      y = this->Solution;
    });
}

StepReport TangentDiffusion::Advance(const ProgressMonitor& progress)
{
  StepReport report;
  const double ofTangents = this->Normal ? 0.8 : 1.0;
  const double setup = this->Prepared ? 0.0 : 0.5 * ofTangents;
  if (!this->Prepared)
  {
    this->Prepare(progress.Part(0.0, setup));
  }
  this->TakeStep(report, progress.Part(setup, ofTangents));
  if (this->Normal)
  {
    const StepReport ofNormal = this->Normal->Advance(progress.Part(ofTangents, 1.0));
    report.Iterations = std::max(report.Iterations, ofNormal.Iterations);
    report.Residual = std::max(report.Residual, ofNormal.Residual);
    report.MissedResidual = std::max(report.MissedResidual, ofNormal.MissedResidual);
  }
  if (report.MissedResidual <= this->Options.Diffusion.SufficientResidual)
  {
    report.MissedResidual = 0.0;
  }
  this->MakeState();
  return report;
}

double TangentDiffusion::Energy() const
{
  double energy = this->Stiffness.Energy(this->W, this->Parallel);
  if (this->Fit.IsPresent())
  {
    energy += Sum(this->Parallel, static_cast<Index>(this->W.rows()),
      [&](Index row)
      {
        return 0.5 * this->Area(row) * this->RowWeight(row) *
          (this->W.row(row) - this->F.row(row)).squaredNorm();
      });
  }
  return energy + (this->Normal ? this->Normal->Energy() : 0.0);
}

std::size_t TangentDiffusion::CheckpointSize() const
{
  return static_cast<std::size_t>(this->W.size()) +
    (this->Normal ? this->Normal->CheckpointSize() : 0);
}

void TangentDiffusion::Save(double* checkpoint) const
{
  std::copy(this->W.data(), this->W.data() + this->W.size(), checkpoint);
  if (this->Normal)
  {
    this->Normal->Save(checkpoint + this->W.size());
  }
}

void TangentDiffusion::Restore(const double* checkpoint)
{
  std::copy(checkpoint, checkpoint + this->W.size(), this->W.data());
  if (this->Normal)
  {
    this->Normal->Restore(checkpoint + this->W.size());
  }
  this->MakeState();
}

} // namespace SurfaceDiffusion
