// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
// The models of TextureSettings.
#include "Run/TextureSettings.h"

#include "Core/Models/Textures/CoarseStart.h"
#include "Core/Models/Textures/TextureColors.h"
#include "Core/Operators/CotanWeights.h"
#include "Run/ModelInputs.h"
#include "Run/TextureRates.h"
#include "Run/UnlikeEdges.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <optional>
#include <utility>

namespace SurfaceDiffusion
{

namespace
{

/// Relative residual that suffices in a coarse space, whose own error is much larger.
constexpr double CoarseTolerance = 1e-4;
/// The factor of StopTolerance there: the pattern looks finished, and the step to the surface
/// changes it more than the time that is left would.
constexpr double CoarseStopFactor = 2.5;

/// Less, relative to the steady state, is no pattern but what is left of the noise at the start.
constexpr double LeastContrast = 1e-3;

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

double TextureSettings::EffectiveFeatureSize(const ModelInputs& inputs) const
{
  constexpr double edgesAcross = 64.0; // that h, and with it the default rates, mean something
  constexpr double wavesAcross = 8.0;
  const TextureSettings usual;
  const bool hasDefaultRates = inputs.Rates.rows() == 0 &&
    this->DiffusionRate1 == usual.DiffusionRate1 && this->DiffusionRate2 == usual.DiffusionRate2 &&
    !this->HasDirectedRates();
  const double across = std::sqrt(inputs.Units.Area);
  const bool suitsSurface = this->FeatureSize == 0.0 && !this->IsAbsolute() &&
    across < edgesAcross * inputs.Units.MeanEdgeLength;
  return suitsSurface && !inputs.Processes.Any(!hasDefaultRates) ? across / wavesAcross
                                                                 : this->FeatureSize;
}

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
  const double size = this->EffectiveFeatureSize(inputs);
  if (units.Natural && !(size > 0.0))
  {
    WarnOfUnlikeEdges(inputs.Surface.Mesh(), result);
  }
  if (size > 0.0)
  {
    scale = rates.ScaleToFeatureSize(size / units.LengthUnit, jacobian);
    if (scale == 0.0 && this->FeatureSize > 0.0)
    {
      result.Warnings.push_back(Sentence(Word::Setting("FeatureSize"))
        << " has no effect: with these rates and parameters no wave grows faster than the uniform "
           "state");
    }
    scale = scale == 0.0 ? 1.0 : scale;
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

std::vector<Output> TextureSettings::Finish(const RunState& state, RunResult& result) const
{
  std::vector<Output> outputs{ Output::OfColumns("u1", 0, 1), Output::OfColumns("u2", 1, 1) };
  outputs[0].Given = 0;
  outputs[1].Given = 1;
  const Vector shown = state.Path.State().col(this->TextureChemical);
  std::array<double, 2> limits = ContrastLimits(shown, state.Surface.Mesh().GetReduction());
  const double contrast = limits[1] - limits[0];
  const double rest =
    GetKinetics(this->Kinetics).SteadyState(this->ChosenParameters())[this->TextureChemical];
  const double unit = rest != 0.0 ? std::abs(rest) : 1.0; // as that of the noise at the start
  if (contrast < LeastContrast * unit)
  {
    limits[1] = limits[0];
    const bool isLast =
      state.Path.Step() >= this->NumberOfTimeSteps || state.Path.CurrentModel().Finished();
    if (isLast && state.Path.Step() > 0 && this->InitialNoise > LeastContrast)
    {
      result.WarnOnce(Sentence("no pattern has grown after ")
        << state.Path.Step() << " steps: the chemical that the texture shows varies by " << contrast
        << ", so that the texture is uniform (other rates or kinetics, a smaller "
        << Word::Setting("FeatureSize") << ", or more steps may let one grow)");
    }
  }
  const Vector texture = StretchContrast(shown, limits);
  outputs.push_back({ "Texture", Place::PerVertex, OutputType::Real, texture });
  if (!this->ColorOutput)
  {
    outputs.back().Active = Role::Scalars;
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
