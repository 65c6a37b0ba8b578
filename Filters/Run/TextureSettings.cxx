// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Run/TextureSettings.h"

#include "Core/Models/Textures/CoarseStart.h"
#include "Core/Models/Textures/DispersionRelation.h"
#include "Core/Models/Textures/ReactionDiffusion.h"
#include "Core/Models/Textures/TextureColors.h"
#include "Core/Operators/CotanWeights.h"
#include "Run/ModelInputs.h"
#include "Run/TextureRates.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <optional>
#include <string>
#include <utility>

namespace SurfaceDiffusion
{

namespace
{

std::vector<const char*> WordsOfKinetics()
{
  std::vector<const char*> words;
  for (int k = 0; k < NumberOfKinetics; ++k)
  {
    words.push_back(GetKinetics(static_cast<KineticsName>(k)).Name);
  }
  return words;
}

std::string DescribeKinetics()
{
  std::string text = "The reaction terms F, G. ";
  for (int k = 0; k < NumberOfKinetics; ++k)
  {
    const Kinetics& terms = GetKinetics(static_cast<KineticsName>(k));
    text += std::string(terms.Name) + ": " + terms.Formula + ". ";
  }
  return text +
    "All are multiplied by ReactionRate. Use AutomaticTimeStep with kinetics other than Turing.";
}

SettingRange RangeOf(const Kinetics::Parameter& parameter)
{
  switch (parameter.Allowed)
  {
    case Kinetics::Range::Positive:
      return SettingRange::Positive();
    case Kinetics::Range::NonNegative:
      return SettingRange::NonNegative();
    case Kinetics::Range::AnyFinite:
      return SettingRange::AnyFinite();
  }
  return SettingRange::Anything();
}

/// Relative residual that suffices in a coarse space, whose own error is much larger.
constexpr double CoarseTolerance = 1e-4;
/// The factor of StopTolerance there: the pattern looks finished, and the step to the surface
/// changes it more than the time that is left would.
constexpr double CoarseStopFactor = 2.5;

std::array<double, 3> AsColor(const std::vector<double>& numbers)
{
  return { numbers.at(0), numbers.at(1), numbers.at(2) };
}

/// The model in the space, from the initial state on the surface. Takes the matrices of the space.
std::unique_ptr<ReactionDiffusion> MakeCoarseModel(CoarseSpace& space, const ModelInputs& inputs,
  const Reaction& reaction, ReactionDiffusion::Settings settings, const IterationLimits& limits)
{
  settings.StopTolerance *= CoarseStopFactor;
  std::array<ReactionDiffusion::Chemical, 2> chemicals;
  for (std::size_t c = 0; c < 2; ++c)
  {
    // Few iterations, because a wavelength has few vertices.
    chemicals[c].Solver = MakeSolver({ SolverMethod::ConjugateGradient, true }, inputs.Parallel);
    chemicals[c].Solver->SetLimits(limits);
    chemicals[c].Stiffness = std::move(space.Stiffness[c]);
  }
  return std::make_unique<ReactionDiffusion>(space.Assembly, reaction, std::move(chemicals),
    PointData::FromValues(space.Restrict(inputs.Surface.Mesh(), inputs.Data.Start)), settings,
    inputs.Parallel);
}

} // namespace

void TextureSettings::Visit(SettingVisitor& visitor)
{
  this->TimeSettings::Visit(visitor);
  VisitTimeIntegrator(visitor, this->TimeIntegrator, { true, true, false });
  static const std::string kinetics = DescribeKinetics();
  visitor.Choice({ "Kinetics", "", kinetics.c_str() }, this->Kinetics, WordsOfKinetics());
  visitor.Number({ "ReactionRate", "1/time",
                   "s, the factor of F and G, above 0, in 1/time. The natural unit of time is "
                   "1/s." },
    this->ReactionRate, SettingRange::Positive());
  visitor.Number({ "DiffusionRate1", "h^2 ReactionRate",
                   "Diffusion rate of u1, along the direction if there is one, 0 or more, in "
                   "length^2/time (natural units: h^2 ReactionRate). With the default kinetics a "
                   "pattern requires more than four times DiffusionRate2." },
    this->DiffusionRate1, SettingRange::NonNegative());
  visitor.Number({ "DiffusionRate2", "h^2 ReactionRate",
                   "Diffusion rate of u2, along the direction if there is one, 0 or more, in "
                   "length^2/time (natural units: h^2 ReactionRate)." },
    this->DiffusionRate2, SettingRange::NonNegative());
  const auto across =
    SettingRange::NonNegativeOr(-1.0, "finite numbers, 0 or more, or -1: as along");
  visitor.Number({ "DiffusionRateAcross1", "h^2 ReactionRate",
                   "Diffusion rate of u1 across the direction, 0 or more, in the unit of "
                   "DiffusionRate1. -1: the same as along it." },
    this->DiffusionRateAcross1, across);
  visitor.Number({ "DiffusionRateAcross2", "h^2 ReactionRate",
                   "Diffusion rate of u2 across the direction, 0 or more, in the unit of "
                   "DiffusionRate2. -1: the same as along it." },
    this->DiffusionRateAcross2, across);
  visitor.Number({ "FeatureSize", "coordinates",
                   "The wavelength of the pattern: the fastest-growing wavelength along the "
                   "direction, in the unit of the coordinates. All diffusion rates are "
                   "multiplied by the factor that gives this wavelength. The mesh should have at "
                   "least six edges per wavelength. 0: off." },
    this->FeatureSize, SettingRange::NonNegative());
  visitor.Number({ "InitialNoise", "",
                   "Half width of the uniform noise around the steady state at the start, "
                   "relative to the steady state." },
    this->InitialNoise, SettingRange::NonNegative());
  visitor.Switch({ "ClampToNonNegative", "",
                   "Keep concentrations nonnegative. Without it, Turing is unstable as soon as "
                   "u2 becomes negative. (The variables of FitzHughNagumo are not concentrations "
                   "and are not clamped.)" },
    this->ClampToNonNegative);
  visitor.Switch({ "AutomaticTimeStep", "",
                   "Choose the time step for the kinetics: 1/8 of the time constant of their "
                   "fastest mode. TimeStep is ignored." },
    this->AutomaticTimeStep);
  visitor.Number({ "StopTolerance", "1/time",
                   "Stop before NumberOfTimeSteps when the pattern is stationary, that is, when "
                   "its relative change per unit of time is at most this value. At 0.05 it looks "
                   "finished. 0: run all steps." },
    this->StopTolerance, SettingRange::NonNegative());
  visitor.Integer({ "CoarseStartSize", "vertices",
                    "On a surface with more vertices than this, the pattern grows on a coarser "
                    "mesh until its relative change is 2.5 StopTolerance, and only the last two "
                    "steps run on the surface itself. The first result is an order of magnitude "
                    "sooner, with about the same wavelength, but differs in detail. 0: all steps "
                    "run on the surface." },
    this->CoarseStartSize, SettingRange::AtLeast(0.0, "0 or more vertices"));

  for (int k = 0; k < NumberOfKinetics; ++k)
  {
    // The parameters of kinetics that are not chosen have no effect and may be anything.
    const bool chosen = static_cast<int>(this->Kinetics) == k;
    const auto& list = GetKinetics(static_cast<KineticsName>(k)).Parameters;
    for (std::size_t p = 0; p < list.size(); ++p)
    {
      if (list[p].Name)
      {
        visitor.Number({ list[p].Name, "", list[p].Documentation,
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
  visitor.Numbers(
    { "LowColor", "", "Red, green and blue, from 0 to 1, for low concentrations of the chemical.",
      SettingScope::Output },
    this->LowColor, SettingRange::ClosedUnitInterval());
  visitor.Numbers(
    { "HighColor", "", "Red, green and blue, from 0 to 1, for high concentrations of the chemical.",
      SettingScope::Output },
    this->HighColor, SettingRange::ClosedUnitInterval());
}

TextureSettings::TextureSettings()
{
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
  this->TimeSettings::CheckTogether(fields, problems);
  for (const auto& [name, color] :
    { std::pair{ "LowColor", &this->LowColor }, std::pair{ "HighColor", &this->HighColor } })
  {
    Require(color->size() == 3, Sentence("the number of entries of ") << Word::Setting(name),
      static_cast<double>(color->size()), "3", problems);
  }
  if (!fields)
  {
    return;
  }
  const Word data = Word::Array("InputArray");
  const Word rates = Word::Array("DiffusionRateArray");
  const Word directions = Word::Array("DirectionArray");
  if (fields->Data && fields->DataComponents != 2)
  {
    problems.push_back(Sentence(data)
      << " holds colours, whose last component is alpha; allowed: 2 components of a type other "
         "than unsigned char");
  }
  if (fields->Rates && this->IntrinsicDelaunay)
  {
    problems.push_back(Sentence(Word::Setting("IntrinsicDelaunay"))
      << " is " << Word::Switch(true) << " but " << rates << " gives rates per " << Word::Cell()
      << ", whose triangles it would replace; allowed: one of the two");
  }
  if (!fields->Directions && !fields->Rates && this->HasDirectedRates())
  {
    problems.push_back(Sentence(Word::Setting("DiffusionRateAcross1"))
      << " or " << Word::Setting("DiffusionRateAcross2") << " differs from the rate along but "
      << directions << " is not set; allowed: -1, or an array of directions");
  }
  if (fields->Fixed && !fields->Data)
  {
    problems.push_back(Sentence(Word::Array("FixedArray"))
      << " is set but " << data << ", the values to hold, is not; allowed: both or neither");
  }
}

double TextureSettings::EdgeLengthForFeatures(double meanEdgeLength) const
{
  constexpr double edgesPerWavelength = 8.0;
  return this->FeatureSize < TextureRates::EdgesPerWavelength * meanEdgeLength
    ? this->FeatureSize / edgesPerWavelength
    : 0.0;
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
  ModelTraits traits = this->DescribeSteps();
  traits.MayEndEarly = this->StopTolerance > 0.0;
  traits.TimeStep = this->EffectiveTimeStep();
  traits.TimeFactor = 1.0 / this->ReactionRate;
  traits.Energy = { 2.0, 0.0 };
  traits.HasValueRange = false;
  traits.CountsClamped = true;
  traits.UsesRandomNumbers = true;
  return traits;
}

std::unique_ptr<Model> TextureSettings::Make(ModelInputs& inputs, RunResult& result) const
{
  const TextureRates rates = this->MakeRates(inputs, result);

  const bool fromNoise = inputs.Data.Given.cols() == 0;
  const Reaction reaction = this->MakeStart(inputs, fromNoise);
  result.HasMissing = inputs.Data.Missing.any();

  const double perTime = this->IsAbsolute() ? this->ReactionRate : 1.0;
  ReactionDiffusion::Settings settings;
  settings.TimeStep = this->EffectiveTimeStep() * perTime;
  settings.TimeScheme = this->TimeIntegrator == SurfaceDiffusion::TimeIntegrator::SecondOrder
    ? ReactionDiffusion::Scheme::SecondOrder
    : ReactionDiffusion::Scheme::FirstOrder;
  settings.KeepNonNegative = this->ClampToNonNegative && reaction.Terms->NonNegative;
  settings.StopTolerance = this->StopTolerance / perTime;

  std::array<CornerWeights, 2> coefficients = MakeCoefficients(inputs, rates);
  const double squaredWaveNumber =
    fromNoise ? rates.FindSquaredWaveNumber(this->JacobianAtRest()) : 0.0;
  std::optional<CoarseSpace> space;
  if (this->MayStartCoarse(inputs) && squaredWaveNumber > 0.0)
  {
    space = MakeCoarseSpace(
      *inputs.Surface.SharedAssembler(), coefficients, squaredWaveNumber, inputs.Parallel);
  }
  std::unique_ptr<ReactionDiffusion> coarse;
  if (space)
  {
    coarse = MakeCoarseModel(*space, inputs, reaction, settings, this->CoarseLimits());
  }
  result.AddNumber(
    "CoarseStartVertices", space ? space->NumberOfVertices() : 0, OutputType::Integer);
  auto chemicals =
    MakeChemicals(inputs, rates, std::move(coefficients), settings, space.has_value());
  auto model = std::make_unique<ReactionDiffusion>(inputs.Surface.SharedAssembler(), reaction,
    std::move(chemicals), std::move(inputs.Data), settings, inputs.Parallel);
  if (!space)
  {
    return model;
  }
  return std::make_unique<CoarseStart>(
    std::move(*space), std::move(coarse), std::move(model), inputs.Parallel);
}

namespace
{

/// The diagonal of the bounding box of all pieces, in coordinate units.
double DiagonalOf(const Points& points, const Reduction& processes)
{
  constexpr double none = std::numeric_limits<double>::lowest();
  std::array<double, 6> ends; // the largest coordinates, and minus the smallest
  ends.fill(none);
  for (Eigen::Index axis = 0; points.rows() > 0 && axis < 3; ++axis)
  {
    ends[static_cast<std::size_t>(axis)] = points.col(axis).maxCoeff();
    ends[static_cast<std::size_t>(axis) + 3] = -points.col(axis).minCoeff();
  }
  processes.Max(ends.data(), 6);
  return std::hypot(ends[0] + ends[3], ends[1] + ends[4], ends[2] + ends[5]);
}

} // namespace

/// The rates, scaled to FeatureSize. Reports the wavelength.
TextureRates TextureSettings::MakeRates(const ModelInputs& inputs, RunResult& result) const
{
  const UnitSystem& units = inputs.Units;
  const double unit = units.ToCore(1.0, 2.0, 0.0) / (units.Natural ? 1.0 : this->ReactionRate);
  const auto orAlong = [](double across, double along) { return across == -1.0 ? along : across; };
  TextureRates rates(
    { this->DiffusionRate1, orAlong(this->DiffusionRateAcross1, this->DiffusionRate1),
      this->DiffusionRate2, orAlong(this->DiffusionRateAcross2, this->DiffusionRate2) },
    unit, inputs);
  const Eigen::Matrix2d jacobian = this->JacobianAtRest();
  double scale = 1.0;
  if (this->FeatureSize > 0.0)
  {
    scale = rates.ScaleToFeatureSize(this->FeatureSize / units.LengthUnit, jacobian);
    if (scale == 0.0)
    {
      scale = 1.0;
      result.Warnings.push_back(Sentence(Word::Setting("FeatureSize"))
        << " has no effect: with these rates and parameters no wave grows faster than the uniform "
           "state");
    }
    const double diagonal = DiagonalOf(inputs.Surface.Points(), inputs.Processes);
    if (this->FeatureSize > diagonal)
    {
      result.Warnings.push_back(Sentence(Word::Setting("FeatureSize"))
        << " is " << this->FeatureSize << ", but the surface is " << diagonal
        << " from corner to corner: it has no room for a pattern");
    }
  }
  const PatternForecast forecast = rates.ForecastAlong(jacobian);
  result.AddNumber("DiffusionRateFactor", scale);
  result.AddNumber("Wavelength", WavelengthOf(forecast) * units.LengthUnit);
  result.AddNumber(
    "WavelengthGrowthRate", forecast.GrowthRate * (this->IsAbsolute() ? this->ReactionRate : 1.0));
  rates.WarnOfObstacles(jacobian, units, result);
  return rates;
}

/// The reaction, in units of 1/ReactionRate, and the initial state, which is put into inputs.Data.
Reaction TextureSettings::MakeStart(ModelInputs& inputs, bool fromNoise) const
{
  Reaction reaction;
  reaction.Terms = &GetKinetics(this->Kinetics);
  reaction.Parameters = this->ChosenParameters();
  if (!fromNoise)
  {
    FillMissing(
      inputs.Surface.Mesh(), inputs.Data, InitialFill::Mean, this->RandomSeed, inputs.Ids);
  }
  else if (!reaction.Terms->SteadyState(reaction.Parameters).allFinite())
  {
    throw InputError(Sentence(Word::Setting("Kinetics"))
      << " is " << Word::Choice("Kinetics", this->Kinetics, reaction.Terms->Name)
      << ", which has no steady state with these parameters to start from; allowed: others (for "
      << Word::Choice("Kinetics", KineticsName::Turing, "Turing") << " "
      << Word::Setting("GrowthRate") << " above " << Word::Setting("DecayRate")
      << "), or an initial state as " << Word::Array("InputArray"));
  }
  else
  {
    inputs.Data = PointData::FromValues(
      NoisySteadyState(reaction, this->InitialNoise, this->RandomSeed, inputs.Ids));
  }
  return reaction;
}

/// Of a large surface that is whole, on which the pattern grows until it is stationary.
bool TextureSettings::MayStartCoarse(const ModelInputs& inputs) const
{
  const TriangleMesh& mesh = inputs.Surface.Mesh();
  return this->CoarseStartSize > 0 && mesh.NumberOfVertices() > this->CoarseStartSize &&
    mesh.GetReduction().IsSerial() && this->StopTolerance > 0.0;
}

/// Of all solves of a run that starts coarse: the last steps only remove traces of interpolation.
IterationLimits TextureSettings::CoarseLimits() const
{
  return { std::max(this->Tolerance, CoarseTolerance), this->MaximumNumberOfIterations };
}

std::array<CornerWeights, 2> TextureSettings::MakeCoefficients(
  const ModelInputs& inputs, const TextureRates& rates)
{
  const TriangleMesh& mesh = inputs.Surface.Mesh();
  const CornerWeights isotropic = CotanWeights(mesh, inputs.Parallel);
  const TangentVectors directions = inputs.Directions.rows() > 0
    ? inputs.Directions
    : TangentVectors(TangentVectors::Zero(mesh.NumberOfTriangles(), 2));
  std::array<CornerWeights, 2> coefficients;
  for (std::size_t c = 0; c < 2; ++c)
  {
    coefficients[c] = AnisotropicWeights(
      mesh, isotropic, directions, rates.Along[c], rates.Across[c], inputs.Parallel);
  }
  return coefficients;
}

/// The chemicals on the surface. startsCoarse: only the last steps run there.
std::array<ReactionDiffusion::Chemical, 2> TextureSettings::MakeChemicals(ModelInputs& inputs,
  const TextureRates& rates, std::array<CornerWeights, 2> coefficients,
  const ReactionDiffusion::Settings& settings, bool startsCoarse) const
{
  const double h = inputs.Units.CoreEdgeLength();
  const double solvesPerStep =
    settings.TimeScheme == ReactionDiffusion::Scheme::SecondOrder ? 2.0 : 1.0;
  std::array<ReactionDiffusion::Chemical, 2> chemicals;
  for (std::size_t c = 0; c < 2; ++c)
  {
    const double fastest = std::max(rates.MeanAlong[c], rates.MeanAcross[c]);
    SolverTask task;
    task.NumberOfVertices = inputs.Surface.Mesh().NumberOfVertices();
    task.DiffusionNumber = fastest * settings.TimeStep / (h * h);
    task.Anisotropy =
      fastest > 0.0 ? fastest / std::min(rates.MeanAlong[c], rates.MeanAcross[c]) : 1.0;
    task.NumberOfSolves = solvesPerStep * CoarseStart::StepsOnSurface;
    const SolverPurpose purpose = c == 0 ? SolverPurpose::Step : SolverPurpose::SecondChemical;
    chemicals[c].Solver = inputs.Solvers.Find(purpose, task, startsCoarse ? 0.0 : solvesPerStep);
    if (startsCoarse)
    {
      chemicals[c].Solver->SetLimits(this->CoarseLimits());
    }
    chemicals[c].Coefficients = std::move(coefficients[c]);
  }
  return chemicals;
}

std::vector<Output> TextureSettings::Finish(const RunState& state, RunResult&) const
{
  std::vector<Output> outputs{ Output::OfColumns("u1", 0, 1), Output::OfColumns("u2", 1, 1) };
  outputs[0].Given = 0;
  outputs[1].Given = 1;
  const Vector shown = state.Path.State().col(this->TextureChemical);
  const Vector texture =
    StretchContrast(shown, ContrastLimits(shown, state.Surface.Mesh().GetReduction()));
  outputs.push_back({ "Texture", Place::PerVertex, OutputType::Real, texture });
  if (!this->ColorOutput)
  {
    outputs[0].Active = Role::Scalars;
    return outputs;
  }
  const auto mix = [this](const Vector& shares) -> Values
  { return MixColors(shares, AsColor(this->LowColor), AsColor(this->HighColor)).cast<double>(); };
  outputs.push_back(
    { "TextureColor", Place::PerVertex, OutputType::Byte, mix(texture), Role::Scalars });
  outputs.back().Elsewhere = mix(Vector::Zero(1));
  return outputs;
}

} // namespace SurfaceDiffusion
