// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Run/TextureSettings.h"

#include "Core/Models/DispersionRelation.h"
#include "Core/Models/ReactionDiffusion.h"
#include "Core/Models/TextureColors.h"
#include "Core/Operators/CotanWeights.h"
#include "Run/ModelInputs.h"

#include <algorithm>
#include <cmath>
#include <sstream>
#include <stdexcept>

namespace SurfaceDiffusion
{

namespace
{

/// A wavelength with fewer mean edge lengths is not resolved by the mesh.
constexpr double EdgesPerWavelength = 6.0;

std::string Quantity(double value)
{
  std::ostringstream text;
  text.precision(3);
  text << value;
  return text.str();
}

/// The reason why no pattern grows; empty if one does.
std::string ExplainObstacle(const PatternForecast& forecast, double rate1, double rate2)
{
  switch (forecast.Obstacle)
  {
    case PatternObstacle::NoSteadyState:
      return "the kinetics have no steady state with these parameters, out of which a pattern "
             "could grow";
    case PatternObstacle::NotSteady:
      return "the steady state of the kinetics is unstable even without diffusion: the whole "
             "surface may oscillate in unison instead of forming a stationary pattern";
    case PatternObstacle::NoActivator:
      return "no pattern grows: neither chemical promotes itself with these parameters";
    case PatternObstacle::RatesTooClose:
    {
      const bool first = forecast.FirstIsFaster;
      return std::string("no pattern grows: the diffusion rate of ") + (first ? "u1" : "u2") +
        " must be more than " + Quantity(forecast.CriticalRatio) + " times that of " +
        (first ? "u2" : "u1") + ", and is " + Quantity(first ? rate1 / rate2 : rate2 / rate1) +
        " times";
    }
    case PatternObstacle::None:
      break;
  }
  return std::string();
}

double WavelengthOf(const PatternForecast& forecast)
{
  return forecast.SquaredWaveNumber > 0.0
    ? 2.0 * std::acos(-1.0) / std::sqrt(forecast.SquaredWaveNumber)
    : 0.0;
}

std::vector<const char*> WordsOfKinetics()
{
  std::vector<const char*> words;
  for (int k = 0; k < NumberOfKinetics; ++k)
  {
    words.push_back(GetKinetics(static_cast<KineticsName>(k)).Name);
  }
  return words;
}

SettingRange RangeOf(const Kinetics::Parameter& parameter)
{
  if (parameter.Minimum == 0.0)
  {
    return SettingRange::Positive();
  }
  return std::isfinite(parameter.Minimum) ? SettingRange::NonNegative() : SettingRange::AnyFinite();
}

/// The area-weighted mean over the surface.
double MeanOverSurface(const TriangleMesh& mesh, const Vector& rate)
{
  double area = 0.0;
  double sum = 0.0;
  for (Index t = 0; t < mesh.NumberOfTriangles(); ++t)
  {
    area += mesh.Shapes()[t].Area();
    sum += mesh.Shapes()[t].Area() * rate[t];
  }
  area = mesh.GetReduction().Sum(area);
  sum = mesh.GetReduction().Sum(sum);
  return area > 0.0 ? sum / area : 0.0;
}

} // namespace

/// g1 and g2 of both chemicals in LengthUnit^2 ReactionRate, per triangle of the mesh, and their
/// means over the surface.
struct TextureSettings::Rates
{
  std::array<Vector, 2> Along, Across;
  std::array<double, 2> MeanAlong, MeanAcross;

  void Scale(double factor)
  {
    for (int c = 0; c < 2; ++c)
    {
      this->Along[c] *= factor;
      this->Across[c] *= factor;
      this->MeanAlong[c] *= factor;
      this->MeanAcross[c] *= factor;
    }
  }
};

void TextureSettings::Visit(SettingVisitor& visitor)
{
  this->RunSettings::Visit(visitor);
  visitor.Choice(
    { "Kinetics", "", "The reaction terms F and G." }, this->Kinetics, WordsOfKinetics());
  visitor.Number({ "ReactionRate", "1/time", "The rate s of the reaction." }, this->ReactionRate,
    SettingRange::Positive());
  visitor.Number({ "DiffusionRate1", "h^2 ReactionRate", "The diffusion rate of u1 along e1." },
    this->DiffusionRate1, SettingRange::NonNegative());
  visitor.Number({ "DiffusionRate2", "h^2 ReactionRate", "The diffusion rate of u2 along e1." },
    this->DiffusionRate2, SettingRange::NonNegative());
  const auto across =
    SettingRange::NonNegativeOr(-1.0, "finite numbers, 0 or more, or -1: as along");
  visitor.Number({ "DiffusionRateAcross1", "h^2 ReactionRate",
                   "The diffusion rate of u1 along e2; -1: as along e1." },
    this->DiffusionRateAcross1, across);
  visitor.Number({ "DiffusionRateAcross2", "h^2 ReactionRate",
                   "The diffusion rate of u2 along e2; -1: as along e1." },
    this->DiffusionRateAcross2, across);
  visitor.Number({ "FeatureSize", "coordinates",
                   "The fastest-growing wavelength along e1 to which the diffusion rates are "
                   "scaled; 0: off." },
    this->FeatureSize, SettingRange::NonNegative());
  visitor.Number(
    { "InitialNoise", "", "The half width of the uniform relative noise around the steady state." },
    this->InitialNoise, SettingRange::NonNegative());
  visitor.Switch({ "ClampToNonNegative", "", "Whether concentrations stay at 0 and above." },
    this->ClampToNonNegative);
  visitor.Switch({ "AutomaticTimeStep", "",
                   "Whether the time step is 1/8 of the time constant of the kinetics' fastest "
                   "mode." },
    this->AutomaticTimeStep);
  visitor.Number({ "StopTolerance", "1/time",
                   "The relative change per unit of time at which the run ends; 0: never." },
    this->StopTolerance, SettingRange::NonNegative());

  for (int k = 0; k < NumberOfKinetics; ++k)
  {
    // The parameters of kinetics that are not chosen have no effect and may be anything.
    const bool chosen = static_cast<int>(this->Kinetics) == k;
    const auto& list = GetKinetics(static_cast<KineticsName>(k)).Parameters;
    for (std::size_t p = 0; p < list.size(); ++p)
    {
      if (list[p].Name)
      {
        visitor.Number({ list[p].Name, "", "A parameter of the kinetics.",
                         chosen ? SettingScope::Model : SettingScope::Output },
          this->Parameters[static_cast<std::size_t>(k)][p],
          chosen ? RangeOf(list[p]) : SettingRange::Anything());
      }
    }
  }
  visitor.Choice({ "TextureChemical", "", "The chemical that Texture and TextureColor show.",
                   SettingScope::Output },
    this->TextureChemical, { "U1", "U2" }, {});
  visitor.Switch(
    { "ColorOutput", "", "Whether the texture is written as colours, too.", SettingScope::Output },
    this->ColorOutput);
}

TextureSettings::TextureSettings()
{
  this->TimeIntegrator = SurfaceDiffusion::TimeIntegrator::SecondOrder;
  this->TimeStep = 1.0 / 16.0;
  this->NumberOfTimeSteps = 640;
  for (int k = 0; k < NumberOfKinetics; ++k)
  {
    this->Parameters[static_cast<std::size_t>(k)] =
      GetKinetics(static_cast<KineticsName>(k)).Defaults();
  }
}

bool TextureSettings::HasKnownKinetics() const
{
  const int number = static_cast<int>(this->Kinetics);
  return number >= 0 && number < NumberOfKinetics;
}

const KineticsParameters& TextureSettings::ChosenParameters() const
{
  return this->Parameters[static_cast<std::size_t>(this->Kinetics)];
}

Eigen::Matrix2d TextureSettings::JacobianAtRest() const
{
  const auto& terms = GetKinetics(this->Kinetics);
  const Eigen::Vector2d steady = terms.SteadyState(this->ChosenParameters());
  return terms.Jacobian(this->ChosenParameters(), steady[0], steady[1]);
}

bool TextureSettings::HasDirectedRates() const
{
  const auto differs = [](double along, double across)
  { return across != -1.0 && across != along; };
  return differs(this->DiffusionRate1, this->DiffusionRateAcross1) ||
    differs(this->DiffusionRate2, this->DiffusionRateAcross2);
}

void TextureSettings::CheckTogether(const FieldSummary* fields, Problems& problems) const
{
  this->RunSettings::CheckTogether(fields, problems);
  if (!fields)
  {
    return;
  }
  const auto require = [&](bool holds, const char* problem)
  {
    if (!holds)
    {
      problems.emplace_back(problem);
    }
  };
  require(!fields->Data || fields->DataComponents == 2,
    "InputArray holds colours, whose last component is alpha; allowed: 2 components of a type "
    "other than unsigned char");
  require(!fields->Rates || !this->IntrinsicDelaunay,
    "IntrinsicDelaunay is on but DiffusionRateArray gives rates per cell, whose triangles it would "
    "replace; allowed: one of the two");
  require(fields->Directions || fields->Rates || !this->HasDirectedRates(),
    "DiffusionRateAcross1 or DiffusionRateAcross2 differs from the rate along but DirectionArray "
    "is not set; allowed: -1, or an array of directions");
  require(!fields->Fixed || fields->Data,
    "FixedArray is set but InputArray, the values to hold, is not; allowed: both or neither");
}

double TextureSettings::EffectiveTimeStep() const
{
  if (!this->AutomaticTimeStep || !this->HasKnownKinetics())
  {
    return this->TimeStep;
  }
  const double step = ReactionTimeStep(this->JacobianAtRest());
  if (!std::isfinite(step))
  {
    return this->TimeStep; // no steady state
  }
  return this->IsAbsolute() ? step / this->ReactionRate : step;
}

ModelTraits TextureSettings::DescribeModel() const
{
  ModelTraits traits;
  traits.NumberOfSteps = this->NumberOfTimeSteps;
  traits.TimeStep = this->EffectiveTimeStep();
  traits.AbsoluteTime = this->IsAbsolute();
  traits.TimeFactor = 1.0 / this->ReactionRate;
  traits.Energy = { 2.0, 0.0 };
  traits.HasValueRange = false;
  traits.CountsClamped = true;
  return traits;
}

TextureSettings::Rates TextureSettings::MakeRates(const ModelInputs& inputs) const
{
  const TriangleMesh& mesh = inputs.Surface.Mesh();
  const UnitSystem& units = inputs.Units;
  const double unit = units.ToCore(1.0, 2.0, 0.0) / (units.Natural ? 1.0 : this->ReactionRate);
  const auto orAlong = [](double across, double along) { return across == -1.0 ? along : across; };
  const double constant[4] = { this->DiffusionRate1,
    orAlong(this->DiffusionRateAcross1, this->DiffusionRate1), this->DiffusionRate2,
    orAlong(this->DiffusionRateAcross2, this->DiffusionRate2) };
  Rates rates;
  for (int c = 0; c < 2; ++c)
  {
    rates.MeanAlong[c] = unit * constant[2 * c];
    rates.MeanAcross[c] = unit * constant[2 * c + 1];
    rates.Along[c] = Vector::Constant(mesh.NumberOfTriangles(), constant[2 * c]);
    rates.Across[c] = Vector::Constant(mesh.NumberOfTriangles(), constant[2 * c + 1]);
  }
  inputs.Processes.RunCollectively(
    [&]
    {
      if (inputs.Rates.rows() > 0)
      {
        this->ReadRates(inputs, rates);
      }
    });
  const bool perTriangle = inputs.Processes.Any(inputs.Rates.rows() > 0);
  for (int c = 0; c < 2; ++c)
  {
    rates.Along[c] *= unit;
    rates.Across[c] *= unit;
    if (perTriangle)
    {
      rates.MeanAlong[c] = MeanOverSurface(mesh, rates.Along[c]);
      rates.MeanAcross[c] = MeanOverSurface(mesh, rates.Across[c]);
    }
  }
  return rates;
}

/// The rates per triangle, in the user's unit.
void TextureSettings::ReadRates(const ModelInputs& inputs, Rates& rates) const
{
  const TriangleMesh& mesh = inputs.Surface.Mesh();
  for (Index t = 0; t < mesh.NumberOfTriangles(); ++t)
  {
    const Index row =
      inputs.Surface.InputTriangle(mesh.InputTriangle()[static_cast<std::size_t>(t)]);
    for (int k = 0; k < 4; ++k)
    {
      (k % 2 == 0 ? rates.Along : rates.Across)[k / 2][t] = inputs.Rates(row, k);
    }
  }
  const bool directed = rates.Along[0] != rates.Across[0] || rates.Along[1] != rates.Across[1];
  if (directed && inputs.Directions.rows() == 0)
  {
    throw std::runtime_error("DiffusionRateArray has other rates across than along but "
                             "DirectionArray is not set; allowed: the same, or an array of "
                             "directions");
  }
}

/// Scale the rates to FeatureSize, and report the wavelength.
void TextureSettings::ScaleToFeatureSize(
  const ModelInputs& inputs, Rates& rates, RunResult& result) const
{
  const Eigen::Matrix2d jacobian = this->JacobianAtRest();
  PatternForecast forecast = ForecastPattern(jacobian, rates.MeanAlong[0], rates.MeanAlong[1]);
  result.DiffusionRateFactor = 1.0;
  if (this->FeatureSize > 0.0)
  {
    const double factor = FeatureSizeFactor(forecast, this->FeatureSize / inputs.Units.LengthUnit);
    if (std::isfinite(factor) && factor > 0.0)
    {
      result.DiffusionRateFactor = factor;
      rates.Scale(factor);
      forecast = ForecastPattern(jacobian, rates.MeanAlong[0], rates.MeanAlong[1]);
    }
    else
    {
      result.Warnings.emplace_back("FeatureSize has no effect: with these rates and parameters no "
                                   "wave grows faster than the uniform state");
    }
  }
  result.Wavelength = WavelengthOf(forecast) * inputs.Units.LengthUnit;
  result.WavelengthGrowthRate =
    forecast.GrowthRate * (this->IsAbsolute() ? this->ReactionRate : 1.0);
}

void TextureSettings::WarnOfObstacles(
  const ModelInputs& inputs, const Rates& rates, RunResult& result) const
{
  const Eigen::Matrix2d jacobian = this->JacobianAtRest();
  const PatternForecast along = ForecastPattern(jacobian, rates.MeanAlong[0], rates.MeanAlong[1]);
  const PatternForecast across =
    ForecastPattern(jacobian, rates.MeanAcross[0], rates.MeanAcross[1]);
  const bool grows =
    along.Obstacle == PatternObstacle::None || across.Obstacle == PatternObstacle::None;
  const std::string reason = ExplainObstacle(along, rates.MeanAlong[0], rates.MeanAlong[1]);
  if (!grows && !reason.empty())
  {
    result.Warnings.push_back(reason);
  }
  double shortest = 0.0; // of the waves that grow
  for (const PatternForecast& wave : { along, across })
  {
    const double length = WavelengthOf(wave) * inputs.Units.LengthUnit;
    if (wave.Obstacle == PatternObstacle::None && length > 0.0)
    {
      shortest = shortest > 0.0 ? std::min(shortest, length) : length;
    }
  }
  const double h = inputs.Units.MeanEdgeLength;
  if (shortest > 0.0 && shortest < EdgesPerWavelength * h)
  {
    result.Warnings.push_back("the pattern's wavelength " + Quantity(shortest) + " is only " +
      Quantity(shortest / h) +
      " mean edge lengths, which the mesh cannot resolve; allow at least " +
      Quantity(EdgesPerWavelength) + ", that is, " + Quantity(EdgesPerWavelength * h));
  }
}

std::unique_ptr<Model> TextureSettings::Make(ModelInputs& inputs, RunResult& result) const
{
  const TriangleMesh& mesh = inputs.Surface.Mesh();
  Rates rates = this->MakeRates(inputs);
  this->ScaleToFeatureSize(inputs, rates, result);
  this->WarnOfObstacles(inputs, rates, result);

  Reaction reaction; // in units of 1/ReactionRate
  reaction.Terms = &GetKinetics(this->Kinetics);
  reaction.Parameters = this->ChosenParameters();
  if (inputs.Data.Given.cols() > 0)
  {
    FillMissing(mesh, inputs.Data, InitialFill::Mean, this->RandomSeed, inputs.Ids);
  }
  else if (!reaction.Terms->SteadyState(reaction.Parameters).allFinite())
  {
    throw std::runtime_error(std::string("Kinetics is ") + reaction.Terms->Name +
      ", which has no steady state with these parameters to start from; allowed: others (for "
      "Turing GrowthRate above DecayRate), or an initial state as InputArray");
  }
  else
  {
    inputs.Data = PointData::FromValues(
      NoisySteadyState(reaction, this->InitialNoise, this->RandomSeed, inputs.Ids));
  }
  result.HasMissing = inputs.Data.Missing.any();

  const double perTime = this->IsAbsolute() ? this->ReactionRate : 1.0;
  const bool secondOrder = this->TimeIntegrator == SurfaceDiffusion::TimeIntegrator::SecondOrder;
  ReactionDiffusion::Settings settings;
  settings.TimeStep = this->EffectiveTimeStep() * perTime;
  settings.TimeScheme =
    secondOrder ? ReactionDiffusion::Scheme::SecondOrder : ReactionDiffusion::Scheme::FirstOrder;
  settings.KeepNonNegative = this->ClampToNonNegative && reaction.Terms->NonNegative;
  settings.StopTolerance = this->StopTolerance / perTime;

  const double h = inputs.Units.CoreEdgeLength();
  const CornerWeights isotropic = CotanWeights(mesh, inputs.Parallel);
  const TangentVectors directions = inputs.Directions.rows() > 0
    ? inputs.Directions
    : TangentVectors(TangentVectors::Zero(mesh.NumberOfTriangles(), 2));
  std::array<ReactionDiffusion::Chemical, 2> chemicals;
  for (int c = 0; c < 2; ++c)
  {
    const double fastest = std::max(rates.MeanAlong[c], rates.MeanAcross[c]);
    SolverTask task;
    task.NumberOfVertices = mesh.NumberOfVertices();
    task.DiffusionNumber = fastest * settings.TimeStep / (h * h);
    task.NumberOfSolves = (secondOrder ? 2.0 : 1.0) * this->NumberOfTimeSteps;
    chemicals[c].Solver =
      inputs.Solvers.Find(c == 0 ? SolverPurpose::Step : SolverPurpose::SecondChemical, task);
    chemicals[c].Coefficients = AnisotropicWeights(
      mesh, isotropic, directions, rates.Along[c], rates.Across[c], inputs.Parallel);
  }
  return std::make_unique<ReactionDiffusion>(inputs.Surface.SharedAssembler(), reaction,
    std::move(chemicals), std::move(inputs.Data), settings, inputs.Parallel);
}

void TextureSettings::Finish(const RunState& state, RunResult& result) const
{
  result.ContrastLimits = ContrastLimits(
    state.Path.State().col(this->TextureChemical), state.Surface.Mesh().GetReduction());
}

} // namespace SurfaceDiffusion
