// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Run/InterpolationSettings.h"

#include "Core/Operators/CotanWeights.h"
#include "Run/FarPoints.h"
#include "Run/FitOfKnownValues.h"
#include "Run/ModelInputs.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace SurfaceDiffusion
{

namespace
{

void WarnOfValues(const KnownValues& known, double maximumDistance, RunResult& result)
{
  if (known.TooFar > 0)
  {
    result.WarnOnce(Sentence() << known.TooFar << (known.TooFar == 1 ? " value is" : " values are")
                               << " farther from the surface than "
                               << Word::Setting("MaximumDistance") << " " << maximumDistance
                               << " and left out");
  }
  if (known.Outside > 0)
  {
    result.WarnOnce(
      Sentence() << known.Outside << (known.Outside == 1 ? " value is" : " values are") << " where "
                 << Word::Array("MaskArray") << " excludes the surface, and left out");
  }
  const Values& given = known.Values.Given;
  if (given.rows() > 1 && (given.rowwise() - given.row(0)).isZero(0.0))
  {
    result.WarnOnce("all known values are equal, and so is the result");
  }
}

} // namespace

void InterpolationSettings::Visit(SettingVisitor& visitor)
{
  this->RunSettings::Visit(visitor);
  visitor.Number({ "CorrelationLength", "coordinates",
                   "1/kappa, the distance beyond which the result returns to the mean of the "
                   "values of its connected component, in the unit of the coordinates, 0 or more. "
                   "0: infinite, the result continues smoothly." },
    this->CorrelationLength, SettingRange::NonNegative());
  visitor.Switch({ "Exact", "",
                   "On: the result has the known values exactly. Off: it is smoothed, as noisy "
                   "values need." },
    this->Exact);
  visitor.Switch({ "AutomaticSmoothing", "",
                   "Without Exact. On: find mu, the strength of the smoothing, by generalised "
                   "cross-validation (of few values with the restricted likelihood as a lower "
                   "bound), or from NoiseLevel if that is above 0. Off: mu is Smoothing.",
                   "Exact=0" },
    this->AutomaticSmoothing);
  visitor.Number(
    { "NoiseLevel", "values",
      "The standard deviation of the noise of values with weight 1, in the unit of "
      "the data, 0 or more. AutomaticSmoothing and the standard errors use it. 0: "
      "estimated from what the smoothed result leaves of the values, and from "
      "repeated values at one place. Correlated noise is reported by a warning if there are 200 "
      "values or more.",
      "Exact=0" },
    this->NoiseLevel, SettingRange::NonNegative());
  visitor.Number({ "Smoothing", "h^2",
                   "mu, with AutomaticSmoothing off: the weight of the energy against the values, "
                   "above 0, in length^2 (natural units: h^2).",
                   "Exact=0 and AutomaticSmoothing=0" },
    this->Smoothing,
    this->AutomaticSmoothing || this->Exact ? SettingRange::Anything() : SettingRange::Positive());
  visitor.Switch({ "KeepRange", "",
                   "Keep the result between the smallest and the largest known value of each "
                   "component." },
    this->KeepRange);
  visitor.Switch({ "ComputeError", "",
                   "Add the standard error of the result, which shows where nothing was "
                   "measured. A band of 1.645 standard errors on each side holds 90 %: of few "
                   "values they are longer, by Student's distribution and since the smoothing is "
                   "not sure. With CorrelationLength they contain that of the mean. They are NaN "
                   "where NoiseLevel is 0 and the values leave nothing to estimate it from, and "
                   "infinite where they leave the slope open. On cells they are the means of the "
                   "corners, upper bounds." },
    this->ComputeError);
  visitor.Switch(
    { "Robust", "",
      "On: values that the others contradict are found and left out: those farther from a "
      "robust fit than four standard deviations of the others. Up to half of "
      "the values may be wrong.",
      "Exact=0" },
    this->Robust);
  visitor.Switch(
    { "LeaveOneOut", "",
      "Add, for each value, how far it is from the result without it, at the same mu, and "
      "the standard error of this difference: how maps are checked. Not for samples in "
      "VTK.",
      "Exact=0" },
    this->LeaveOneOut);
  visitor.Choice({ "Boundary", "",
                   "The condition at the boundary of the surface. Automatic: Free, but Natural "
                   "with diffusivities other than 1 or IntrinsicDelaunay and on closed connected "
                   "parts. Natural: the result becomes flat towards the boundary. Free: it "
                   "continues its slope, and linear functions on flat pieces come back exactly "
                   "from a few values: of a planar wave of 0.6 m/s the speed near the boundary is "
                   "0.60 m/s, and 0.8 to 1.1 m/s with Natural.",
                   "IntrinsicDelaunay=0 and AlongDiffusivity=1 and AcrossDiffusivity=1" },
    this->Boundary, { "Natural", "Free", "Automatic" });
  visitor.Number({ "MaximumDistance", "coordinates",
                   "The largest distance of points with values from the surface, in the unit of "
                   "the coordinates, 0 or more. Farther ones are counted and left out. 0: any." },
    this->MaximumDistance, SettingRange::NonNegative());
  visitor.Numbers({ "MissingValue", "values",
                    "Numbers that stand for no value, as NaN does: -10000 in electroanatomical "
                    "maps, fill values of "
                    "netCDF. They are compared up to single precision, and values with one in any "
                    "component do not "
                    "count. None: all numbers are values." },
    this->MissingValue, SettingRange::AnyFinite());
  visitor.Number({ "AlongDiffusivity", "",
                   "Factor of the diffusivity along the direction, above 0. If it differs from "
                   "AcrossDiffusivity, DirectionArray is required.",
                   "(DirectionArray and Boundary!=Free) or AlongDiffusivity!=1" },
    this->AlongDiffusivity, SettingRange::Positive());
  visitor.Number(
    { "AcrossDiffusivity", "", "Factor of the diffusivity across the direction, above 0.",
      "(DirectionArray and Boundary!=Free) or AcrossDiffusivity!=1" },
    this->AcrossDiffusivity, SettingRange::Positive());
  VisitResultOnCells(visitor, this->ResultOnCells);
}

void InterpolationSettings::CheckTogether(const FieldSummary* fields, Problems& problems) const
{
  this->RunSettings::CheckTogether(fields, problems);
  RequireData(fields, problems);
  const bool isFree = this->Boundary == RimCondition::Free;
  if (isFree && this->HasDiffusivities())
  {
    problems.push_back(Sentence(Word::Setting("Boundary"))
      << " is " << Word::Choice("Boundary", RimCondition::Free, "Free") << " but "
      << Word::Setting("AlongDiffusivity") << " is " << this->AlongDiffusivity << " and "
      << Word::Setting("AcrossDiffusivity") << " is " << this->AcrossDiffusivity
      << "; allowed: both 1, or " << Word::Choice("Boundary", RimCondition::Natural, "Natural"));
  }
  if (isFree && this->IntrinsicDelaunay)
  {
    problems.push_back(Sentence(Word::Setting("Boundary"))
      << " is " << Word::Choice("Boundary", RimCondition::Free, "Free") << " but "
      << Word::Setting("IntrinsicDelaunay") << " is " << Word::Switch(true)
      << "; allowed: " << Word::Switch(false) << ", or "
      << Word::Choice("Boundary", RimCondition::Natural, "Natural"));
  }
  if (fields)
  {
    RequireDirections(*fields, "AlongDiffusivity", this->AlongDiffusivity, "AcrossDiffusivity",
      this->AcrossDiffusivity, problems);
  }
}

ModelTraits InterpolationSettings::DescribeModel() const
{
  ModelTraits traits;
  traits.ResultSuffix = "Interpolated";
  traits.Energy = { 0.0, 2.0 };
  traits.UsesFidelity = true;
  traits.UsesKnownValues = true;
  traits.MaximumDistance = this->MaximumDistance;
  traits.MissingValues = this->MissingValue;
  traits.NeedsDirections = this->IsDirected();
  traits.StartsFromKnownValues = true;
  traits.ResultOnCells = this->ResultOnCells;
  traits.KeepCellDetail = false;
  traits.CanBeDistributed = false;
  return traits;
}

SmoothInterpolation::Settings InterpolationSettings::MakeCoreSettings(const UnitSystem& units) const
{
  using Choice = SmoothInterpolation::Choice;
  SmoothInterpolation::Settings settings;
  settings.Kappa = this->CorrelationLength > 0.0 ? units.LengthUnit / this->CorrelationLength : 0.0;
  const bool excludesFree = this->HasDiffusivities() || this->IntrinsicDelaunay;
  settings.Rim = this->Boundary == RimCondition::Automatic && excludesFree ? RimCondition::Natural
                                                                           : this->Boundary;
  settings.Smoothing = this->Exact ? Choice::Exact
    : !this->AutomaticSmoothing    ? Choice::Given
    : this->NoiseLevel > 0.0       ? Choice::NoiseLevel
                                   : Choice::Automatic;
  settings.Mu = units.ToCore(this->Smoothing, 2.0, 0.0);
  settings.NoiseLevel = this->NoiseLevel / units.ValueUnit;
  settings.KeepRange = this->KeepRange;
  settings.ComputeError = this->ComputeError;
  settings.ComputeLeverage = this->LeaveOneOut && !this->Exact;
  return settings;
}

std::unique_ptr<Model> InterpolationSettings::Make(ModelInputs& inputs, RunResult& result) const
{
  KnownValues& known = inputs.Known;
  if (known.Values.Count() == 0 && inputs.Surface.Mesh().NumberOfVertices() > 0)
  {
    throw InputError("no value is known; allowed: one or more with a weight above 0");
  }
  result.HasMissing = inputs.Data.Missing.any();
  WarnOfValues(known, this->MaximumDistance, result);
  result.Numbers.push_back(Output::OfNumber(
    "NumberOfValues", known.Values.Count(), Combination::Sum, OutputType::Integer));
  result.Numbers.push_back(
    Output::OfNumber("NumberOfFarValues", known.TooFar, Combination::Sum, OutputType::Integer));
  ReportDistances(inputs.Surface, known, this->MaximumDistance, result);
  const TriangleMesh& mesh = inputs.Surface.Mesh();
  const CornerWeights isotropic = CotanWeights(mesh, inputs.Parallel);
  CornerWeights coefficients = this->IsDirected()
    ? AnisotropicWeights(mesh, isotropic, inputs.Directions, this->AlongDiffusivity,
        this->AcrossDiffusivity, inputs.Parallel)
    : CornerWeights(this->AlongDiffusivity * isotropic);
  return std::make_unique<FitOfKnownValues>(inputs.Surface.SharedAssembler(),
    std::move(coefficients), std::move(known), this->MakeCoreSettings(inputs.Units),
    inputs.Parallel, this->Robust && !this->Exact);
}

} // namespace SurfaceDiffusion
