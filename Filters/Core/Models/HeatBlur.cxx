// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Models/HeatBlur.h"

#include "Core/Foundation/Resize.h"
#include "Core/Operators/CotanWeights.h"
#include "Core/Operators/MeanCorrection.h"

#include <cmath>

namespace SurfaceDiffusion
{

namespace
{

/// x^nu K_nu(x) over its limit at x = 0, 2^(nu - 1) Gamma(nu), for nu > 0: the trapezoidal rule for
/// K_nu(x) = int_0^inf exp(-x cosh t) cosh(nu t) dt, which converges exponentially.
double MaternKernel(double nu, double x)
{
  constexpr double Spacing = 0.05;
  constexpr int Intervals = 200;
  double sum = 0.5 * std::exp(-x);
  for (int k = 1; k <= Intervals; ++k)
  {
    const double t = Spacing * k;
    sum += 0.5 * (std::exp(nu * t - x * std::cosh(t)) + std::exp(-nu * t - x * std::cosh(t)));
  }
  return std::pow(x, nu) * Spacing * sum / (std::exp2(nu - 1.0) * std::tgamma(nu));
}

} // namespace

double HeatBlur::TimeOfWidth(double width, int steps)
{
  double low = 0.5;
  double high = 20.0 + steps;
  while (high - low > 1e-13 * high) // the kernel decreases from 1 to 0
  {
    const double middle = 0.5 * (low + high);
    (MaternKernel(steps - 1.0, middle) > 0.5 ? low : high) = middle;
  }
  return steps * width * width / (4.0 * low * low);
}

HeatBlur::HeatBlur(std::shared_ptr<const Assembler> assembler, double width, int steps,
  std::shared_ptr<LinearSolver> solver, const ParallelFor& parallel)
  : Mesh(assembler->Mesh())
  , Parallel(parallel)
  , Steps(steps)
  , Time(TimeOfWidth(width, steps) / steps)
  , System(assembler, std::move(solver), parallel)
{
  this->System.Assemble(this->Mesh.ControlAreas(), this->Time, CotanWeights(this->Mesh, parallel));
}

void HeatBlur::Prepare(const ProgressMonitor& progress)
{
  this->System.SetUpSolver(progress);
  this->Prepared = true;
}

void HeatBlur::Step(Values& u, StepReport& report, const ProgressMonitor& progress)
{
  if (!this->Prepared)
  {
    this->Prepare(progress.Part(0.0, 0.0));
  }
  Resize(this->RightHandSide, u.rows(), u.cols());
  ForEach(this->Parallel, this->Mesh.NumberOfVertices(),
    [&](Index i) { this->RightHandSide.row(i) = this->Mesh.ControlAreas()[i] * u.row(i); });
  this->System.Solve(this->RightHandSide, u, report, progress);
}

void HeatBlur::Apply(Values& u, StepReport& report, const ProgressMonitor& progress)
{
  // Values are measured from the mean, which H keeps: the errors of a solve are relative to the
  // contrast then.
  FindMeans(this->Mesh, u, this->Mean, this->Parallel);
  u.rowwise() -= this->Mean;
  for (int step = 0; step < this->Steps; ++step)
  {
    const double steps = this->Steps;
    this->Step(u, report, progress.Part(step / steps, (step + 1) / steps));
  }
  u.rowwise() += this->Mean;
}

void HeatBlur::ApplyToWeighted(const Fidelity& fidelity, Values& v, StepReport& report)
{
  ForEach(this->Parallel, this->Mesh.NumberOfVertices(),
    [&](Index i) { v.row(i) *= fidelity.Weight(i); });
  this->Apply(v, report);
}

} // namespace SurfaceDiffusion
