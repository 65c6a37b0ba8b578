// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Run/TextureRates.h"

#include "Core/Models/Textures/DispersionRelation.h"
#include "Run/Collective.h"
#include "Run/ModelInputs.h"

#include <algorithm>
#include <cmath>
#include <sstream>

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
  RunCollectively(inputs.Processes,
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
    throw InputError(Sentence(Word::Array("DiffusionRateArray"))
      << " has other rates across than along but " << Word::Array("DirectionArray")
      << " is not set; allowed: the same, or an array of directions");
  }
}

/// Scale the rates to FeatureSize, and report the wavelength.
void TextureSettings::ScaleToFeatureSize(
  const ModelInputs& inputs, Rates& rates, RunResult& result) const
{
  const Eigen::Matrix2d jacobian = this->JacobianAtRest();
  PatternForecast forecast = ForecastPattern(jacobian, rates.MeanAlong[0], rates.MeanAlong[1]);
  double scale = 1.0;
  if (this->FeatureSize > 0.0)
  {
    const double factor = FeatureSizeFactor(forecast, this->FeatureSize / inputs.Units.LengthUnit);
    if (std::isfinite(factor) && factor > 0.0)
    {
      scale = factor;
      rates.Scale(factor);
      forecast = ForecastPattern(jacobian, rates.MeanAlong[0], rates.MeanAlong[1]);
    }
    else
    {
      result.Warnings.push_back(Sentence(Word::Setting("FeatureSize"))
        << " has no effect: with these rates and parameters no wave grows faster than the uniform "
           "state");
    }
  }
  result.AddNumber("DiffusionRateFactor", scale);
  result.AddNumber("Wavelength", WavelengthOf(forecast) * inputs.Units.LengthUnit);
  result.AddNumber(
    "WavelengthGrowthRate", forecast.GrowthRate * (this->IsAbsolute() ? this->ReactionRate : 1.0));
}

double TextureSettings::FindSquaredWaveNumber(const Rates& rates) const
{
  const Eigen::Matrix2d jacobian = this->JacobianAtRest();
  double product = 1.0;
  int count = 0;
  for (const auto* mean : { &rates.MeanAlong, &rates.MeanAcross })
  {
    const PatternForecast wave = ForecastPattern(jacobian, (*mean)[0], (*mean)[1]);
    if (wave.Obstacle == PatternObstacle::None && wave.SquaredWaveNumber > 0.0)
    {
      product *= wave.SquaredWaveNumber;
      ++count;
    }
  }
  // Aggregates are as anisotropic as the diffusion: their area counts, and the geometric mean.
  return count == 2 ? std::sqrt(product) : count * product;
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

} // namespace SurfaceDiffusion
