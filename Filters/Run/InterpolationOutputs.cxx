// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
//
// What an interpolation returns beside its state, and what it warns of.

#include "Run/InterpolationSettings.h"

#include "Core/Models/Interpolation/Outliers.h"
#include "Run/CorrelatedNoise.h"
#include "Run/FitOfKnownValues.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

namespace SurfaceDiffusion
{

namespace
{

void WarnOf(Index count, const char* ofOne, const char* ofSeveral, RunResult& result)
{
  if (count > 0)
  {
    result.WarnOnce(Sentence() << count << (count == 1 ? ofOne : ofSeveral));
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
