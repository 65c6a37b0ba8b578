// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Models/StructureTensor.h"

#include "Core/Operators/GradientTensor.h"

#include <utility>

namespace SurfaceDiffusion
{

TensorSmoothing::TensorSmoothing(std::shared_ptr<const LineFieldOperator> laplacian, double width,
  int steps, std::shared_ptr<LinearSolver> solver, const ParallelFor& parallel)
  : Laplacian(std::move(laplacian))
  , Solver(std::move(solver))
  , Parallel(parallel)
  , Steps(steps)
  , Matrix(HeatBlur::TimeOfWidth(width, steps) / steps * this->Laplacian->Stiffness())
{
  this->Matrix.diagonal() += this->Laplacian->Mass();
}

void TensorSmoothing::Apply(TangentVectors& z, StepReport& report, const ProgressMonitor& progress)
{
  if (!this->Prepared)
  {
    this->Solver->SetMatrix(this->Matrix, progress.Part(0.0, 0.5));
    this->Prepared = true;
  }
  const Vector& mass = this->Laplacian->Mass();
  const auto rows = static_cast<Index>(mass.size());
  this->OnEdges.resize(rows, 1);
  this->Laplacian->Integrate(z, this->RightHandSide, this->Parallel);
  for (int step = 0; step < this->Steps; ++step)
  {
    if (step > 0)
    {
      ForEach(this->Parallel, rows,
        [&](Index i) { this->RightHandSide(i, 0) = mass[i] * this->OnEdges(i, 0); });
    }
    ForEach(this->Parallel, rows,
      [&](Index i) { this->OnEdges(i, 0) = this->RightHandSide(i, 0) / mass[i]; });
    const double steps = this->Steps;
    const SolveReport solve = this->Solver->Solve(this->RightHandSide, this->OnEdges,
      progress.Part(0.5 + 0.5 * step / steps, 0.5 + 0.5 * (step + 1) / steps));
    RequireAnswer(solve, this->Solver->GetLimits());
    report.Add(solve);
  }
  const Eigen::Map<const Vector> onEdges(this->OnEdges.data(), rows); // a copy otherwise
  ForEach(this->Parallel, static_cast<Index>(z.rows()),
    [&](Index t) { z.row(t) = this->Laplacian->Mean(onEdges, t); });
}

StructureTensor::StructureTensor(std::shared_ptr<const TriangleMesh> mesh,
  std::unique_ptr<HeatBlur> noise, std::unique_ptr<TensorSmoothing> integration,
  const ParallelFor& parallel)
  : Surface(std::move(mesh))
  , Noise(std::move(noise))
  , Integration(std::move(integration))
  , Parallel(parallel)
  , Deviator(this->Surface->NumberOfTriangles(), 2)
  , Trace(this->Surface->NumberOfTriangles())
{
}

void StructureTensor::Evaluate(const Values& u, StepReport& report, const ProgressMonitor& progress)
{
  if (this->Noise)
  {
    this->Smooth = u;
    this->Noise->Apply(this->Smooth, report, progress.Part(0.0, 0.3));
  }
  const Values& smooth = this->Noise ? this->Smooth : u;
  ForEach(this->Parallel, this->Surface->NumberOfTriangles(),
    [&](Index t)
    {
      const PlaneTensor sum = SumGradients(*this->Surface, smooth, t).T;
      this->Deviator.row(t) = sum.Deviator();
      this->Trace[t] = sum.Trace();
    });
  if (this->Integration)
  {
    this->Integration->Apply(this->Deviator, report, progress.Part(0.3, 1.0));
  }
}

} // namespace SurfaceDiffusion
