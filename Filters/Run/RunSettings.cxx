// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Run/RunSettings.h"

#include "Run/Output.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>

namespace SurfaceDiffusion
{

namespace
{

/// The history has a row for each step.
constexpr double LargestNumberOfTimeSteps = 1e9;

/// Each published time is a number that the whole pipeline carries.
constexpr double LargestNumberOfPublishedTimes = 1e6;

} // namespace

void RequireDirections(const FieldSummary& fields, const char* along, double ofAlong,
  const char* across, double ofAcross, Problems& problems)
{
  if (ofAlong != ofAcross && !fields.Directions)
  {
    problems.push_back(Sentence(Word::Setting(along))
      << " is " << ofAlong << " and " << Word::Setting(across) << " is " << ofAcross << " but "
      << Word::Array("DirectionArray")
      << " is not set; allowed: equal values, or an array of directions");
  }
}

void RunSettings::Visit(SettingVisitor& visitor)
{
  visitor.Choice({ "Units", "",
                   "The units of times, weights and thresholds. Natural: lengths are in h, the "
                   "mean edge length of the triangles, and values in R, the largest range (max - "
                   "min) of any component, so that one setting suits any mesh and any array. "
                   "Absolute: lengths are in the unit of the coordinates and values in the unit "
                   "of the data." },
    this->Units, { "Natural", "Absolute" });
  visitor.Choice({ "MaskMode", "",
                   "Inpaint: masked points are missing and are filled in. Exclude: triangles "
                   "with a masked point, and masked cells, are ignored, nothing flows across "
                   "them, and masked points and cells keep their values. The remaining triangles "
                   "are the region of interest.",
                   "MaskArray and (HoldKnownValues=0 or MaskMode=Exclude)" },
    this->MaskMode, { "Inpaint", "Exclude" });
  visitor.Integer({ "RandomSeed", "",
                    "The seed of all random numbers. The same seed gives the same result on every "
                    "machine.",
                    "InitialFill=Noise" },
    this->RandomSeed, SettingRange::AnyFinite());
  visitor.Switch(
    { "IntrinsicDelaunay", "",
      "Assemble the Laplace-Beltrami operator on the intrinsic Delaunay "
      "triangulation of the same surface. No points are added. Its nonnegative "
      "cotan weights let linear diffusion keep the bounds of the data for triangles "
      "of any shape.",
      SettingScope::Surface,
      "(!DiffusionRateArray and DiffusionAxes=0 and Boundary!=Free) or IntrinsicDelaunay=1" },
    this->IntrinsicDelaunay);
  VisitMerging(visitor, this->MergeCoincidentPoints, this->MergeTolerance);
}

std::vector<Output> RunSettings::Finish(const RunState&, RunResult&) const
{
  return { Output::OfState(this->DescribeModel().ResultSuffix) };
}

void RunSettings::Check(const FieldSummary* fields, Problems& problems)
{
  CheckRanges(*this, problems);
  this->CheckTogether(fields, problems);
}

void RunSettings::CheckTogether(const FieldSummary*, Problems&) const {}

void RunSettings::RequireData(const FieldSummary* fields, Problems& problems)
{
  if (fields && !fields->Data)
  {
    problems.push_back(Sentence(fields->DataName)
      << " has 0 values; allowed: a row for each point or " << Word::Cell());
  }
}

void TimeSettings::Visit(SettingVisitor& visitor)
{
  visitor.Number(
    { "TimeStep", "time", "The time step, above 0, in the unit of time that Units selects.",
      "Mode=TimeSteps; FWHM=0; AutomaticTimeStep=0" },
    this->TimeStep, SettingRange::Positive());
  visitor.Integer(
    { "NumberOfTimeSteps", "", "The number of time steps. 0: the output is the initial state.",
      SettingScope::Output, "Mode=TimeSteps" }, // a longer run continues a shorter one
    this->NumberOfTimeSteps,
    SettingRange::Between(0.0, LargestNumberOfTimeSteps, "0 to 1000000000"));
  visitor.Switch({ "GenerateTimeSteps", "",
                   "Publish time steps; time 0 is the initial state. Off: the output is the "
                   "final state.",
                   "Mode=TimeSteps" },
    this->GenerateTimeSteps);
  visitor.Integer({ "OutputInterval", "",
                    "The interval k between published time steps: steps 0, k, 2 k, ... and the "
                    "last step are published.",
                    SettingScope::Output, "GenerateTimeSteps=1; Mode=TimeSteps" },
    this->OutputInterval, SettingRange::AtLeast(1.0, "1 or more"));
  visitor.Integer({ "CheckpointMemoryLimit", "MiB",
                    "Memory, in MiB, for stored states, which make going back in time cheap.",
                    "GenerateTimeSteps=1; Mode=TimeSteps" },
    this->CheckpointMemoryLimit, SettingRange::AtLeast(0.0, "0 or more MiB"));
  this->RunSettings::Visit(visitor);
  visitor.Choice({ "Solver", "",
                   "The linear solver. Direct: sparse Cholesky factorisation, reused while the "
                   "matrix is unchanged. ConjugateGradient: conjugate gradients with a Jacobi "
                   "preconditioner, as in the paper. Multigrid: conjugate gradients with a "
                   "smoothed aggregation preconditioner, for large surfaces and long time steps. "
                   "Automatic: the solver with the lowest estimated cost." },
    this->Solver, { "Automatic", "Direct", "ConjugateGradient", "Multigrid" });
  visitor.Number(
    { "Tolerance", "", "Relative residual at which an iterative solver stops, between 0 and 1.",
      "Solver!=Direct" },
    this->Tolerance, SettingRange::OpenUnitInterval());
  visitor.Integer({ "MaximumNumberOfIterations", "",
                    "The maximum number of iterations of an iterative solver. It is an error if "
                    "the solver does not converge within them.",
                    "Solver!=Direct" },
    this->MaximumNumberOfIterations, SettingRange::AtLeast(1.0, "1 or more"));
}

void TimeSettings::CheckTogether(const FieldSummary* fields, Problems& problems) const
{
  const bool rangesHold = problems.empty();
  this->RunSettings::CheckTogether(fields, problems);
  if (rangesHold && this->PublishesTimes())
  {
    const double times =
      std::ceil(static_cast<double>(this->DescribeModel().NumberOfSteps) / this->OutputInterval);
    Require(times <= LargestNumberOfPublishedTimes,
      Sentence(Word::Setting("NumberOfTimeSteps")) << " / " << Word::Setting("OutputInterval"),
      times, Sentence("up to 1000000 published times; raise ") << Word::Setting("OutputInterval"),
      problems);
  }
}

IterationLimits WithoutInertia(IterationLimits limits)
{
  limits.AskedTolerance = std::min(std::max(limits.AskedTolerance, limits.Tolerance), 1e-3);
  limits.Tolerance = std::min(limits.Tolerance, 1e-10);
  return limits;
}

ModelTraits TimeSettings::DescribeSteps(bool steady) const
{
  ModelTraits traits;
  traits.IsSteady = traits.WeightlessAreMissing = steady;
  traits.NumberOfSteps = steady ? 1 : this->NumberOfTimeSteps;
  traits.TimeStep = this->TimeStep;
  traits.AbsoluteTime = this->IsAbsolute();
  traits.Solver = this->Solver;
  traits.Limits.Tolerance = this->Tolerance;
  traits.Limits.MaximumNumberOfIterations = this->MaximumNumberOfIterations;
  if (this->GenerateTimeSteps && !steady)
  {
    traits.CheckpointMemory = static_cast<std::size_t>(this->CheckpointMemoryLimit) * 1024 * 1024;
  }
  return traits;
}

std::vector<double> TimeSettings::PublishedTimes(int last) const
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

int TimeSettings::FindStep(double time, int last) const
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
  visitor.Switch({ "MergeCoincidentPoints", "",
                   "Treat coincident points as one point of the surface, as STL files and split "
                   "normals require.",
                   SettingScope::Surface },
    merge);
  visitor.Number({ "MergeTolerance", "coordinates",
                   "The largest distance of points that are merged, in the unit of the "
                   "coordinates. 0: only points with equal coordinates.",
                   SettingScope::Surface, "MergeCoincidentPoints=1" },
    tolerance, SettingRange::NonNegative());
}

void VisitTimeIntegrator(SettingVisitor& visitor, TimeIntegrator& integrator,
  const std::vector<bool>& allowed, const char* onlyIf)
{
  visitor.Choice({ "TimeIntegrator", "", "The time integrator.", onlyIf }, integrator,
    { "FirstOrder", "SecondOrder", "Implicit", "Exponential", "Automatic" }, allowed);
}

void VisitResultOnCells(SettingVisitor& visitor, bool& onCells)
{
  visitor.Switch({ "ResultOnCells", "",
                   "Whether the result of data on cells is on cells, too. Off: it is on points. "
                   "No effect on point data.",
                   SettingScope::Output, "CellData" },
    onCells);
}

void VisitAutomaticFidelity(
  SettingVisitor& visitor, bool& automatic, double& noiseLevel, const char* onlyIf)
{
  visitor.Switch(
    { "AutomaticFidelity", "",
      "Choose the fidelity weight of the smallest estimated error: the unbiased risk "
      "(Stein 1981) of the noise level, or generalised cross-validation (Craven and "
      "Wahba 1979) where the data differ more than by that. Where the noise is "
      "correlated the result differs from the data by the noise level (discrepancy "
      "principle, Morozov 1966). Constant parts of the data do not count. Each component "
      "of the data that is not coupled with the others and each connected component of the surface "
      "has a weight of its own. "
      "The weight takes the place of FidelityWeight; of total variation, of 3 alone, its default.",
      onlyIf },
    automatic);
  visitor.Number(
    { "NoiseLevel", "values",
      "Standard deviation of the noise for AutomaticFidelity, in the unit of the "
      "data, where factors of the fidelity are 1. 0: estimated from the data, for white "
      "noise (independent from point to point). A warning reports correlated noise, and data that "
      "are smooth between "
      "neighbours, as noise is that was smoothed or resampled.",
      "AutomaticFidelity=1 or BlurFWHM!=0" },
    noiseLevel, SettingRange::NonNegative());
}

void DataSettings::Visit(SettingVisitor& visitor)
{
  this->TimeSettings::Visit(visitor);
  visitor.Number({ "FidelityWeight", "1/time",
                   "lambda, the weight of the fidelity term lambda chi (f - u), in 1/(unit of "
                   "time). The term pulls the result towards the data wherever they are known "
                   "(chi = 1).",
                   "AutomaticFidelity=0 and (FWHM=0 or FidelityWeight!=0)" },
    this->FidelityWeight, SettingRange::NonNegative());
  visitor.Choice({ "InitialFill", "",
                   "The initial values at missing points. Input: the damaged values themselves, "
                   "or Mean at points that are NaN. Mean: the mean of the known values of the "
                   "connected component. Noise: random values, uniform between the smallest and "
                   "the largest known value. Harmonic: the harmonic function of the known "
                   "values.",
                   "MaskMode=Inpaint" },
    this->InitialFill, { "Input", "Mean", "Noise", "Harmonic" });
  visitor.Switch({ "HoldKnownValues", "",
                   "Keep the known values exactly and fill in the missing points only. At least "
                   "one point must be missing, either by MaskArray or because it is NaN.",
                   "(MaskMode=Inpaint and MaskArray and !FixedArray) or HoldKnownValues=1" },
    this->HoldKnownValues);
  visitor.Number({ "AlongDiffusivity", "",
                   "Factor of the diffusivity along the direction, 0 or more. If it differs from "
                   "AcrossDiffusivity, DirectionArray is required.",
                   "(DirectionArray and FWHM=0) or AlongDiffusivity!=1" },
    this->AlongDiffusivity, SettingRange::NonNegative());
  visitor.Number(
    { "AcrossDiffusivity", "", "Factor of the diffusivity across the direction, 0 or more.",
      "(DirectionArray and FWHM=0) or AcrossDiffusivity!=1" },
    this->AcrossDiffusivity, SettingRange::NonNegative());
  VisitResultOnCells(visitor, this->ResultOnCells);
  visitor.Switch({ "KeepCellDetail", "",
                   "On: differences between neighbouring cells that the points do not resolve "
                   "diffuse on the cells, beside the data at the points, and are added to the "
                   "result. No time steps then return the data. Off: the result is the mean of "
                   "the smoothed data over the cell.",
                   SettingScope::Output, "CellData" },
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
  this->TimeSettings::CheckTogether(fields, problems);
  RequireData(fields, problems);
  if (fields)
  {
    RequireDirections(*fields, "AlongDiffusivity", this->AlongDiffusivity, "AcrossDiffusivity",
      this->AcrossDiffusivity, problems);
  }
}

} // namespace SurfaceDiffusion
