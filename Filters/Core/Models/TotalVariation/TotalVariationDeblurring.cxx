// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Models/TotalVariation/TotalVariationDeblurring.h"

#include "Core/Models/InitialState.h"
#include "Core/Statistics/ValueRange.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace SurfaceDiffusion
{

namespace
{

/// The relative duality gap of the first shrinkage, and the power of its decrease.
constexpr double FirstGap = 1e-3;
constexpr double GapExponent = 4.5;
/// The largest error of a shrinkage that needs no smaller gap, in the change at which the iteration
/// stops.
constexpr double NegligibleError = 0.1;
constexpr int IterationsPerShrinkage = 200;

double LargestFidelityFactor(const PointData& data)
{
  double largest = 0.0;
  for (Index i = 0; i < static_cast<Index>(data.Missing.size()); ++i)
  {
    largest = std::max(largest, data.FidelityFactor(i));
  }
  return largest > 0.0 ? largest : 1.0;
}

/// a + s (b - a) + t (c - a).
Values Combine(const Values& a, double s, const Values& b, double t, const Values& c)
{
  return a + s * (b - a) + t * (c - a);
}

} // namespace

TotalVariationDeblurring::TotalVariationDeblurring(std::shared_ptr<const Assembler> assembler,
  const TangentVectors& frames, PointData data, const Settings& settings,
  std::unique_ptr<HeatBlur> blur, const ParallelFor& parallel)
  : StateModel(data.Start)
  , Assembly(std::move(assembler))
  , Data(std::move(data))
  , Fit(this->Data, { settings.Fidelity })
  , Options(settings)
  , Parallel(parallel)
  , Step(1.0 / (settings.Fidelity * LargestFidelityFactor(this->Data)))
  , Range(ValueRange(this->Data.Start, this->Assembly->Mesh().GetReduction()))
  , Blur(std::move(blur))
  , Conserved(this->Assembly->Mesh(), this->Data, true, parallel)
{
  FixFreeComponents(this->Assembly->Mesh(), this->Data, settings.Fidelity);
  TotalVariationFlow::Settings shrinkage = settings.Regularization;
  shrinkage.SteadyState = false;
  shrinkage.TimeStep = this->Step;
  shrinkage.Fidelity = 0.0;
  shrinkage.ConservesTotal = false;
  this->Shrinkage =
    std::make_unique<TotalVariationFlow>(this->Assembly, frames, this->Data, shrinkage, parallel);
}

StepReport TotalVariationDeblurring::Advance(const ProgressMonitor& progress)
{
  this->Blur->Prepare(progress.Part(0.0, 0.1));
  const double tolerance = this->Options.StopTolerance;
  StepReport report;
  StepReport blurs;
  Point u;
  u.U = this->Data.Start;
  this->Shrinkage->SetState(u.U);
  this->Measure(u, blurs);
  Values y = u.U;
  Values blurredY = u.Blurred;
  Point z;
  // E of a shrinkage exceeds its minimum by at least 1/2 L int |z - z*|^2.
  const double negligible = NegligibleError * tolerance * this->Range;
  const double leastGap = 0.5 / this->Step * this->Assembly->Mesh().ControlAreas().sum() *
    static_cast<double>(u.U.cols()) * negligible * negligible;
  double t = 1.0;
  double fraction = 0.0;
  do
  {
    ++report.Iterations;
    const double gap = FirstGap * std::pow(report.Iterations, -GapExponent);
    this->Shrinkage->SetLimits(std::max(gap, leastGap / u.Energy), IterationsPerShrinkage);
    this->Shrink(y, blurredY, z, report.Iterations > 1, blurs, progress.Part(fraction, fraction));
    report.Residual = this->RootMeanSquare(z.U, y) / this->Range;
    const Point last = u;
    if (z.Energy <= u.Energy)
    {
      u = z;
    }
    const double next = 0.5 + std::sqrt(0.25 + t * t);
    y = Combine(u.U, t / next, z.U, -(t - 1.0) / next, last.U);
    blurredY = Combine(u.Blurred, t / next, z.Blurred, -(t - 1.0) / next, last.Blurred);
    t = next;
    const double left = std::log(std::max(1.0, report.Residual / tolerance));
    fraction = std::max(fraction, 1.0 - left / std::log(1.0 / tolerance));
    progress.Part(0.1, 1.0).Report(fraction);
  } while (
    report.Residual > tolerance && report.Iterations < this->Options.MaximumNumberOfIterations);
  report.MissedResidual = blurs.MissedResidual;
  this->U = u.U;
  this->Conserved.Restore(this->Assembly->Mesh(), this->U, this->Parallel);
  return report;
}

void TotalVariationDeblurring::Shrink(const Values& y, const Values& blurredY, Point& z,
  bool keepMultipliers, StepReport& report, const ProgressMonitor& progress)
{
  z.U = blurredY - this->Data.Given;
  this->Blur->ApplyToWeighted(this->Fit, z.U, report);
  z.U = y - this->Step * z.U;
  ForEach(this->Parallel, static_cast<Index>(z.U.rows()),
    [&](Index i)
    {
      if (this->Data.Fixed[i])
      {
        z.U.row(i) = this->Data.Start.row(i);
      }
    });
  this->Shrinkage->SetState(z.U, keepMultipliers);
  this->Shrinkage->Advance(progress);
  z.U = this->Shrinkage->State();
  this->Measure(z, report);
}

/// The blur and the energy of point.U, which is the state of the shrinkage.
void TotalVariationDeblurring::Measure(Point& point, StepReport& report) const
{
  point.Blurred = point.U;
  this->Blur->Apply(point.Blurred, report);
  point.Energy = this->Shrinkage->Energy() + this->FidelityEnergy(point.Blurred);
}

double TotalVariationDeblurring::FidelityEnergy(const Values& blurred) const
{
  return this->Fit.Energy(this->Assembly->Mesh(), blurred, this->Parallel);
}

double TotalVariationDeblurring::RootMeanSquare(const Values& a, const Values& b) const
{
  const Vector& areas = this->Assembly->Mesh().ControlAreas();
  const double square = Sum(this->Parallel, static_cast<Index>(a.rows()),
    [&](Index i) { return areas[i] * (a.row(i) - b.row(i)).squaredNorm(); });
  return std::sqrt(square / (areas.sum() * static_cast<double>(a.cols())));
}

double TotalVariationDeblurring::Energy() const
{
  this->Shrinkage->SetState(this->U);
  Values blurred = this->U;
  StepReport unused;
  this->Blur->Apply(blurred, unused);
  return this->Shrinkage->Energy() + this->FidelityEnergy(blurred);
}

DiffusionStep TotalVariationDeblurring::Diffusion() const
{
  DiffusionStep step;
  step.TimeStep = InfiniteTime;
  step.Fidelity = this->Options.Fidelity;
  step.SharesTensor = this->Shrinkage->Diffusion().SharesTensor;
  return step;
}

} // namespace SurfaceDiffusion
