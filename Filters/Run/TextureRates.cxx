// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Run/TextureRates.h"

#include "Run/Collective.h"

#include <algorithm>
#include <cmath>
#include <sstream>

namespace SurfaceDiffusion
{

namespace
{

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
      const double ratio = first ? rate1 / rate2 : rate2 / rate1;
      return std::string("no pattern grows: the diffusion rate of ") + (first ? "u1" : "u2") +
        " must be more than " + Quantity(forecast.CriticalRatio) + " times that of " +
        (first ? "u2" : "u1") +
        (std::isnan(ratio) ? ", and both are 0" : ", and is " + Quantity(ratio) + " times");
    }
    case PatternObstacle::None:
      break;
  }
  return std::string();
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

double WavelengthOf(const PatternForecast& forecast)
{
  return forecast.SquaredWaveNumber > 0.0
    ? 2.0 * std::acos(-1.0) / std::sqrt(forecast.SquaredWaveNumber)
    : 0.0;
}

TextureRates::TextureRates(
  const std::array<double, 4>& constant, double unit, const ModelInputs& inputs)
{
  const TriangleMesh& mesh = inputs.Surface.Mesh();
  for (int c = 0; c < 2; ++c)
  {
    this->MeanAlong[c] = unit * constant[2 * c];
    this->MeanAcross[c] = unit * constant[2 * c + 1];
    this->Along[c] = Vector::Constant(mesh.NumberOfTriangles(), constant[2 * c]);
    this->Across[c] = Vector::Constant(mesh.NumberOfTriangles(), constant[2 * c + 1]);
  }
  RunCollectively(inputs.Processes,
    [&]
    {
      if (inputs.Rates.rows() > 0)
      {
        this->Read(inputs);
      }
    });
  const bool perTriangle = inputs.Processes.Any(inputs.Rates.rows() > 0);
  for (int c = 0; c < 2; ++c)
  {
    this->Along[c] *= unit;
    this->Across[c] *= unit;
    if (perTriangle)
    {
      this->MeanAlong[c] = MeanOverSurface(mesh, this->Along[c]);
      this->MeanAcross[c] = MeanOverSurface(mesh, this->Across[c]);
    }
  }
}

/// The rates per triangle, in the user's unit.
void TextureRates::Read(const ModelInputs& inputs)
{
  const TriangleMesh& mesh = inputs.Surface.Mesh();
  for (Index t = 0; t < mesh.NumberOfTriangles(); ++t)
  {
    const Index row =
      inputs.Surface.InputTriangle(mesh.InputTriangle()[static_cast<std::size_t>(t)]);
    for (int k = 0; k < 4; ++k)
    {
      (k % 2 == 0 ? this->Along : this->Across)[k / 2][t] = inputs.Rates(row, k);
    }
  }
  const bool directed = this->Along[0] != this->Across[0] || this->Along[1] != this->Across[1];
  if (directed && inputs.Directions.rows() == 0)
  {
    throw InputError(Sentence(Word::Array("DiffusionRateArray"))
      << " has other rates across than along but " << Word::Array("DirectionArray")
      << " is not set; allowed: the same, or an array of directions");
  }
}

double TextureRates::ScaleToFeatureSize(double featureSize, const Eigen::Matrix2d& jacobian)
{
  const double factor = FeatureSizeFactor(this->ForecastAlong(jacobian), featureSize);
  if (!std::isfinite(factor) || factor <= 0.0)
  {
    return 0.0;
  }
  for (int c = 0; c < 2; ++c)
  {
    this->Along[c] *= factor;
    this->Across[c] *= factor;
    this->MeanAlong[c] *= factor;
    this->MeanAcross[c] *= factor;
  }
  return factor;
}

double TextureRates::FindSquaredWaveNumber(const Eigen::Matrix2d& jacobian) const
{
  double product = 1.0;
  int count = 0;
  for (const PatternForecast& wave :
    { this->ForecastAlong(jacobian), this->ForecastAcross(jacobian) })
  {
    if (wave.Obstacle == PatternObstacle::None && wave.SquaredWaveNumber > 0.0)
    {
      product *= wave.SquaredWaveNumber;
      ++count;
    }
  }
  // Aggregates are as anisotropic as the diffusion: their area counts, and the geometric mean.
  return count == 2 ? std::sqrt(product) : count * product;
}

void TextureRates::WarnOfObstacles(
  const Eigen::Matrix2d& jacobian, const UnitSystem& units, RunResult& result) const
{
  const PatternForecast along = this->ForecastAlong(jacobian);
  const PatternForecast across = this->ForecastAcross(jacobian);
  const bool grows =
    along.Obstacle == PatternObstacle::None || across.Obstacle == PatternObstacle::None;
  const std::string reason = ExplainObstacle(along, this->MeanAlong[0], this->MeanAlong[1]);
  if (!grows && !reason.empty())
  {
    result.Warnings.push_back(reason);
  }
  double shortest = 0.0; // of the waves that grow
  for (const PatternForecast& wave : { along, across })
  {
    const double length = WavelengthOf(wave) * units.LengthUnit;
    if (wave.Obstacle == PatternObstacle::None && length > 0.0)
    {
      shortest = shortest > 0.0 ? std::min(shortest, length) : length;
    }
  }
  const double h = units.MeanEdgeLength;
  if (shortest > 0.0 && shortest < EdgesPerWavelength * h)
  {
    result.Warnings.push_back(Sentence("the pattern's wavelength ")
      << Quantity(shortest) << " is only " << Quantity(shortest / h)
      << " mean edge lengths, which the mesh cannot resolve; allow at least "
      << Quantity(EdgesPerWavelength) << ", that is, " << Quantity(EdgesPerWavelength * h)
      << " (or set " << Word::Setting("RefineTo") << " to "
      << Quantity(shortest / EdgesOfRefinement) << ")");
  }
}

} // namespace SurfaceDiffusion
