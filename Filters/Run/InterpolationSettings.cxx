// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Run/InterpolationSettings.h"

#include "Core/Models/Interpolation/InterpolationModel.h"
#include "Core/Models/Interpolation/Outliers.h"
#include "Core/Operators/CotanWeights.h"
#include "Run/CorrelatedNoise.h"
#include "Run/FarPoints.h"
#include "Run/ModelInputs.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

namespace SurfaceDiffusion
{

namespace
{

/// The model with what its data were.
class FitOfKnownValues : public InterpolationModel
{
public:
  FitOfKnownValues(std::shared_ptr<const Assembler> assembler, CornerWeights coefficients,
    KnownValues known, const SmoothInterpolation::Settings& settings, const ParallelFor& parallel,
    bool isRobust)
    : InterpolationModel(std::move(assembler), std::move(coefficients), std::move(known.Values),
        settings, parallel, isRobust)
    , AreSamples(known.AreSamples)
    , Rows(std::move(known.Rows))
    , NumberOfRows(known.NumberOfRows)
    , Where(known.AreSamples ? Place::PerSample
          : known.OnCells    ? Place::PerCell
                             : Place::PerPoint)
    , NameOfSamples(std::move(known.SamplesName))
  {
  }

  const bool AreSamples;
  const std::vector<Eigen::Index> Rows; ///< of the data, per value
  const Eigen::Index NumberOfRows;
  const Place Where; ///< the data are
  const std::string NameOfSamples;
};

void WarnOf(Index count, const char* ofOne, const char* ofSeveral, RunResult& result)
{
  if (count > 0)
  {
    result.WarnOnce(Sentence() << count << (count == 1 ? ofOne : ofSeveral));
  }
}

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

/// u: the result, in array units 1/unit. Values at more than three places of one triangle contradict
/// each other.
void WarnOfMisfit(
  const SmoothInterpolation::Result& found, const Values& u, double unit, RunResult& result)
{
  constexpr double roundOff = 1e-6; // of the range
  for (Eigen::Index k = 0; k < u.cols(); ++k)
  {
    double low = std::numeric_limits<double>::infinity();
    double high = -low;
    for (const double value : u.col(k))
    {
      low = std::isnan(value) ? low : std::min(low, value);
      high = std::isnan(value) ? high : std::max(high, value);
    }
    const double misfit = found.Columns[static_cast<std::size_t>(k)].Residual;
    if (misfit > roundOff * (high - low))
    {
      result.WarnOnce(Sentence("the values do not hold exactly but to ")
        << misfit * unit << " (root mean square): some triangles have more values than corners (to "
        << "smooth them, turn " << Word::Setting("Exact")
        << " off; to hold them, refine the surface)");
      return;
    }
  }
}

/// Rows of values as rows of the data: where no value counts, `otherwise`.
Output PerGivenRow(const char* name, const FitOfKnownValues& model, OutputType type,
  const Values& rows, double otherwise)
{
  Values all = Values::Constant(model.NumberOfRows, rows.cols(), otherwise);
  for (std::size_t i = 0; i < model.Rows.size(); ++i)
  {
    all.row(model.Rows[i]) = rows.row(static_cast<Eigen::Index>(i));
  }
  Output output{ name, model.Where, type, std::move(all) };
  output.IsBesideResult = true;
  return output;
}

void WarnOfFit(const SmoothInterpolation::Result& found, RunResult& result)
{
  WarnOf(found.ContradictingPlaces, " place has different values: their weighted mean counts",
    " places have different values: their weighted means count", result);
  if (found.PartsWithTooFewValues > 0)
  {
    Sentence text("fewer than ");
    text << found.EnoughPlaces << " places";
    if (found.Parts > 1)
    {
      text << " of " << found.PartsWithTooFewValues
           << (found.PartsWithTooFewValues == 1 ? " connected component" : " connected components");
    }
    result.WarnOnce(text << " have a value, too few for " << Word::Setting("AutomaticSmoothing")
                         << ": the values hold exactly" << (found.Parts > 1 ? " there" : ""));
  }
  if (found.HasUnknownError)
  {
    result.WarnOnce(
      Sentence("the values leave nothing to estimate their deviation from, and the standard errors "
               "are NaN; they are known with ")
      << Word::Setting("NoiseLevel") << " above 0 and without " << Word::Setting("Exact"));
  }
  if (found.IsFlattest)
  {
    result.WarnOnce(Sentence("the values leave slopes open with ")
      << Word::Setting("Boundary") << " " << Word::Choice("Boundary", RimCondition::Free, "Free")
      << ": the flattest result is taken"
      << (found.HasInfiniteError ? ", and standard errors are infinite where slopes are open"
                                 : ""));
  }
  if (found.DropsNegativeCurvature)
  {
    result.WarnOnce(Sentence("the mesh is too coarse for its saddles with ")
      << Word::Setting("Boundary") << " " << Word::Choice("Boundary", RimCondition::Free, "Free")
      << ": negative curvature is left out of the energy");
  }
  if (!found.RangeIsOptimal)
  {
    result.WarnOnce(Sentence(Word::Setting("KeepRange"))
      << ": the set of points at the bounds did not settle, or exact values inside triangles "
         "exclude "
         "each other; the result is within the range but not the smoothest one");
  }
}

/// Of those left out, or of those that `Robust` would leave out.
void WarnOfOutliers(const InterpolationSettings& settings, const InterpolationModel& model,
  const Values& residuals, RunResult& result)
{
  if (settings.Robust)
  {
    WarnOf(static_cast<Index>(model.Outliers().sum()),
      " value is contradicted by others and left out",
      " values are contradicted by others and left out", result);
    return;
  }
  for (Eigen::Index c = 0; c < residuals.cols() && settings.AutomaticSmoothing; ++c)
  {
    if (const Index count = CountOutliers(model.Given(), residuals, c))
    {
      result.WarnOnce(Sentence() << count << (count == 1 ? " value is" : " values are")
                                 << " farther from the result than four standard deviations of the "
                                    "others (to leave outliers out, turn "
                                 << Word::Setting("Robust") << " on)");
      return;
    }
  }
}

/// The rows of the data whose values count, in one column at least.
Output FindUsedRows(const FitOfKnownValues& model)
{
  Values used(static_cast<Eigen::Index>(model.Rows.size()), 1);
  Eigen::Index count = 0;
  for (std::size_t i = 0; i < model.Rows.size(); ++i)
  {
    if (model.Outliers().row(static_cast<Eigen::Index>(i)).minCoeff() == 0.0)
    {
      used(count++, 0) = static_cast<double>(model.Rows[i]);
    }
  }
  used.conservativeResize(count, 1);
  return { "UsedRows", Place::Number, OutputType::Integer, std::move(used) };
}

/// The residuals, which values were left out, and what the result without each of them is.
void AddOfValues(const InterpolationSettings& settings, const FitOfKnownValues& model,
  const Values& residuals, double unit, std::vector<Output>& outputs)
{
  constexpr double none = std::numeric_limits<double>::quiet_NaN();
  const auto add = [&](const char* name, const Values& rows)
  { outputs.push_back(PerGivenRow(name, model, OutputType::Double, rows, none)); };
  if (settings.Robust)
  {
    outputs.push_back(PerGivenRow("Outliers", model, OutputType::Integer, model.Outliers(), 0.0));
  }
  if (settings.Robust || settings.LeaveOneOut)
  {
    add("Residuals", unit * residuals);
  }
  if (settings.LeaveOneOut)
  {
    const SmoothInterpolation::Result& found = model.Found();
    Values left = 1.0 - found.Leverage.array().min(1.0 - 1e-9);
    add("LeaveOneOutResiduals", unit * residuals.cwiseQuotient(left));
    for (Eigen::Index c = 0; c < left.cols(); ++c)
    {
      const double noise = unit * found.Columns[static_cast<std::size_t>(c)].NoiseLevel;
      left.col(c) =
        (noise / (left.col(c).array() * model.Given().Weights.array()).sqrt()).cwiseMax(0.0);
      left.col(c) = (model.Outliers().col(c).array() != 0.0).select(none, left.col(c));
    }
    add("LeaveOneOutErrors", left);
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

std::vector<Output> InterpolationSettings::Finish(const RunState& state, RunResult& result) const
{
  const auto& model = static_cast<const FitOfKnownValues&>(state.Path.CurrentModel().Innermost());
  const SmoothInterpolation::Result& found = model.Found();
  WarnOfFit(found, result);
  const double unit = state.Units.ValueUnit;
  const bool findsNoise = !this->Exact && this->AutomaticSmoothing && this->NoiseLevel == 0.0;
  for (std::size_t c = 0; c < found.Columns.size() && findsNoise; ++c)
  {
    // Of white noise a smooth fit leaves more: the residuals of a tenth of the values are no estimate.
    constexpr double most = 0.9;
    const SmoothInterpolation::Column& column = found.Columns[c];
    if (column.Mu > 0.0 && column.DegreesOfFreedom > most * model.Given().Count())
    {
      const Sentence text = DescribeSmoothValues(
        model.Given(), static_cast<int>(c), column.NoiseLevel * unit, unit, state.Surface);
      if (!text.Words().empty())
      {
        result.WarnOnce(text);
        break;
      }
    }
  }
  if (this->Exact && found.RangeIsOptimal)
  {
    WarnOfMisfit(found, model.State(), unit, result);
  }
  const Eigen::RowVectorXd none =
    Eigen::RowVectorXd::Constant(model.State().cols(), std::numeric_limits<double>::quiet_NaN());
  std::vector<Output> outputs;
  outputs.push_back(Output::OfState(this->DescribeModel().ResultSuffix));
  if (model.AreSamples)
  {
    Output& output = outputs.back();
    output.Type = OutputType::Real;
    output.IsState = false;
    output.Rows = unit * model.State();
    output.Given = -1;
    output.Elsewhere = none;
    output.DataName = model.NameOfSamples;
  }
  if (found.Error.rows() > 0)
  {
    Output error{ "Error", Place::PerVertex, OutputType::Real, unit * found.Error };
    error.IsBesideResult = true;
    error.MayBeInfinite = true;
    error.DataName = model.NameOfSamples;
    error.Elsewhere = none;
    outputs.push_back(error);
    if (!this->Exact)
    {
      error.Name = "SlopeError";
      error.Rows = unit / state.Surface.Mesh().LengthUnit() * found.SlopeError;
      outputs.push_back(std::move(error));
    }
  }
  if (!this->Exact)
  {
    const Values residuals = ResidualsOf(model.Given(), model.State());
    WarnOfOutliers(*this, model, residuals, result);
    AddOfValues(*this, model, residuals, unit, outputs);
  }
  outputs.push_back(FindUsedRows(model));
  const auto columns = static_cast<Eigen::Index>(found.Columns.size());
  Values rows(columns, 6);
  const double ofSmoothing = 1.0 / state.Units.ToCore(1.0, 2.0, 0.0);
  for (Eigen::Index c = 0; c < columns; ++c)
  {
    const SmoothInterpolation::Column& column = found.Columns[static_cast<std::size_t>(c)];
    rows.row(c) << static_cast<double>(c), column.Mu * ofSmoothing, column.Score * unit * unit,
      column.Residual * unit, column.DegreesOfFreedom, column.NoiseLevel * unit;
  }
  const char* const names[] = { "Component", "Smoothing", "Score", "Misfit", "DegreesOfFreedom",
    "NoiseLevel" };
  for (Eigen::Index k = 0; k < rows.cols(); ++k)
  {
    outputs.push_back(
      { names[k], Place::Column, k == 0 ? OutputType::Integer : OutputType::Double, rows.col(k) });
  }
  outputs.push_back(Output::OfNumber("EffectiveSmoothing", columns > 0 ? rows(0, 1) : 0.0));
  return outputs;
}

} // namespace SurfaceDiffusion
