// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Run/RunSettings.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <sstream>

namespace SurfaceDiffusion
{

namespace
{

/// The history has a row for each step.
constexpr double LargestNumberOfTimeSteps = 1e9;

/// Each published time is a number that the whole pipeline carries.
constexpr double LargestNumberOfPublishedTimes = 1e6;

} // namespace

void RunSettings::Visit(SettingVisitor& visitor)
{
  visitor.Number(
    { "TimeStep", "time", "The time step." }, this->TimeStep, SettingRange::Positive());
  visitor.Integer({ "NumberOfTimeSteps", "",
                    "The number of time steps n. There are n + 1 states, from the initial one on.",
                    SettingScope::Output }, // a longer run continues a shorter one
    this->NumberOfTimeSteps,
    SettingRange::Between(0.0, LargestNumberOfTimeSteps, "0 to 1000000000"));
  visitor.Choice({ "Units", "",
                   "The units of times, weights and thresholds. Natural: lengths in the mean edge "
                   "length h, values in the range R. Absolute: coordinate and array units." },
    this->Units, { "Natural", "Absolute" });
  visitor.Switch({ "GenerateTimeSteps", "", "Whether every published time can be requested." },
    this->GenerateTimeSteps);
  visitor.Integer(
    { "OutputInterval", "", "The published times are those of steps 0, k, 2 k, ... and the last.",
      SettingScope::Output },
    this->OutputInterval, SettingRange::AtLeast(1.0, "1 or more"));
  visitor.Choice(
    { "MaskMode", "",
      "Inpaint: masked points are missing and are filled in. Exclude: triangles with a "
      "masked vertex are ignored." },
    this->MaskMode, { "Inpaint", "Exclude" });
  visitor.Integer({ "RandomSeed", "", "The seed of all random numbers." }, this->RandomSeed,
    SettingRange::AnyFinite());
  visitor.Choice({ "TimeIntegrator", "", "The time integrator. FirstOrder is the paper's." },
    this->TimeIntegrator, { "FirstOrder", "SecondOrder", "Implicit" }, this->AllowedIntegrators());
  visitor.Choice({ "Solver", "", "How linear systems are solved." }, this->Solver,
    { "Automatic", "Direct", "ConjugateGradient", "Multigrid" });
  visitor.Number({ "Tolerance", "",
                   "The relative residual, in the norm of the inverse diagonal, at which iterative "
                   "solvers stop." },
    this->Tolerance, SettingRange::OpenUnitInterval());
  visitor.Integer(
    { "MaximumNumberOfIterations", "", "The largest number of iterations of a solve." },
    this->MaximumNumberOfIterations, SettingRange::AtLeast(1.0, "1 or more"));
  visitor.Switch({ "IntrinsicDelaunay", "",
                   "Whether the equation is solved on the intrinsic Delaunay triangulation of the "
                   "surface.",
                   SettingScope::Surface },
    this->IntrinsicDelaunay);
  VisitMerging(visitor, this->MergeCoincidentPoints, this->MergeTolerance);
  visitor.Integer({ "CheckpointMemoryLimit", "MiB",
                    "The memory for states that are kept so that going back in time is cheap." },
    this->CheckpointMemoryLimit, SettingRange::AtLeast(0.0, "0 or more MiB"));
}

void RunSettings::Finish(const RunState&, RunResult&) const {}

void RunSettings::Check(const FieldSummary* fields, Problems& problems)
{
  CheckRanges(*this, problems);
  const bool rangesHold = problems.empty();
  this->CheckTogether(fields, problems);
  if (this->GenerateTimeSteps && rangesHold)
  {
    const double times =
      std::ceil(static_cast<double>(this->DescribeModel().NumberOfSteps) / this->OutputInterval);
    Require(times <= LargestNumberOfPublishedTimes, "NumberOfTimeSteps / OutputInterval", times,
      "up to 1000000 published times; raise OutputInterval", problems);
  }
}

void RunSettings::CheckTogether(const FieldSummary*, Problems&) const {}

std::vector<double> RunSettings::PublishedTimes(int last) const
{
  const ModelTraits traits = this->DescribeModel();
  std::vector<double> times;
  for (std::int64_t step = 0; step < last; step += this->OutputInterval)
  {
    times.push_back(static_cast<double>(step) * traits.TimeStep);
  }
  times.push_back(last * traits.TimeStep);
  return times;
}

int RunSettings::FindStep(double time, int last) const
{
  const ModelTraits traits = this->DescribeModel();
  const std::vector<double> times = this->PublishedTimes(last);
  // A time that another program has printed or summed may have lost its last bits.
  const double slack = 1e-9 * traits.TimeStep;
  const auto after = std::upper_bound(times.begin(), times.end(), time + slack);
  const std::int64_t index = std::max<std::ptrdiff_t>(after - times.begin() - 1, 0);
  return static_cast<int>(std::min<std::int64_t>(index * this->OutputInterval, last));
}

void VisitMerging(SettingVisitor& visitor, bool& merge, double& tolerance)
{
  visitor.Switch(
    { "MergeCoincidentPoints", "",
      "Whether points within MergeTolerance are one point of the surface.", SettingScope::Surface },
    merge);
  visitor.Number({ "MergeTolerance", "coordinates", "The largest distance of merged points.",
                   SettingScope::Surface },
    tolerance, SettingRange::NonNegative());
}

void VisitResultOnCells(SettingVisitor& visitor, bool& onCells)
{
  visitor.Switch(
    { "ResultOnCells", "", "Whether data on cells have a result on cells rather than on points.",
      SettingScope::Output },
    onCells);
}

void VisitAutomaticFidelity(SettingVisitor& visitor, bool& automatic, double& noiseLevel)
{
  visitor.Switch({ "AutomaticFidelity", "",
                   "Whether lambda is chosen by the discrepancy principle (Morozov 1966), over the "
                   "part of the data that is not constant." },
    automatic);
  visitor.Number({ "NoiseLevel", "values",
                   "The standard deviation of the noise for AutomaticFidelity; 0: estimated, for "
                   "white noise. A warning reports correlated noise, and data that are smooth "
                   "between neighbours, as noise is that was smoothed or resampled." },
    noiseLevel, SettingRange::NonNegative());
}

void DataSettings::Visit(SettingVisitor& visitor)
{
  this->RunSettings::Visit(visitor);
  visitor.Number({ "FidelityWeight", "1/time",
                   "lambda of (16) to (19), the weight of lambda chi (f - u), with chi the "
                   "indicator of the known part." },
    this->FidelityWeight, SettingRange::NonNegative());
  visitor.Choice({ "InitialFill", "",
                   "The start on missing points: the input itself, the mean of the known values of "
                   "the connected component, uniform noise between the extreme known values, or "
                   "the harmonic function of the known values." },
    this->InitialFill, { "Input", "Mean", "Noise", "Harmonic" });
  visitor.Switch({ "HoldKnownValues", "",
                   "Whether known points keep their value exactly, so that only missing points "
                   "change." },
    this->HoldKnownValues);
  visitor.Number({ "AlongDiffusivity", "", "The factor of the diffusivity along e1." },
    this->AlongDiffusivity, SettingRange::NonNegative());
  visitor.Number({ "AcrossDiffusivity", "", "The factor of the diffusivity along e2." },
    this->AcrossDiffusivity, SettingRange::NonNegative());
  VisitResultOnCells(visitor, this->ResultOnCells);
  visitor.Switch(
    { "KeepCellDetail", "",
      "Whether differences between cells that the points do not resolve, d = f - P* u(0), "
      "diffuse on the cells and are added to the result, P* u + d, rather than left out, where "
      "P* u is the mean over the cell. No time steps then return the data.",
      SettingScope::Output },
    this->KeepCellDetail);
}

double DataSettings::LargestDiffusivity() const
{
  return std::max(this->AlongDiffusivity, this->AcrossDiffusivity);
}

double DataSettings::Anisotropy() const
{
  return this->IsDirected()
    ? this->LargestDiffusivity() / std::min(this->AlongDiffusivity, this->AcrossDiffusivity)
    : 1.0;
}

void DataSettings::CheckTogether(const FieldSummary* fields, Problems& problems) const
{
  this->RunSettings::CheckTogether(fields, problems);
  if (fields && !fields->Directions && this->IsDirected())
  {
    std::ostringstream text;
    text << "AlongDiffusivity is " << this->AlongDiffusivity << " and AcrossDiffusivity is "
         << this->AcrossDiffusivity << " but DirectionArray is not set; allowed: equal values, or "
         << "an array of directions";
    problems.push_back(text.str());
  }
}

} // namespace SurfaceDiffusion
