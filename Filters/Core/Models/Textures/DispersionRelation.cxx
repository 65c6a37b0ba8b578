// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Models/Textures/DispersionRelation.h"

#include <Eigen/LU>

#include <algorithm>
#include <cmath>

namespace SurfaceDiffusion
{

namespace
{

const double Pi = std::acos(-1.0);

} // namespace

double GrowthRate(const Eigen::Matrix2d& jacobian, double d1, double d2, double squaredWaveNumber)
{
  const double a = jacobian(0, 0) - d1 * squaredWaveNumber;
  const double d = jacobian(1, 1) - d2 * squaredWaveNumber;
  const double discriminant = (a - d) * (a - d) + 4.0 * jacobian(0, 1) * jacobian(1, 0);
  return 0.5 * (a + d + std::sqrt(std::max(discriminant, 0.0)));
}

PatternForecast ForecastPattern(const Eigen::Matrix2d& jacobian, double d1, double d2)
{
  PatternForecast forecast;
  if (!jacobian.allFinite())
  {
    return forecast;
  }
  const double a = jacobian(0, 0);
  const double d = jacobian(1, 1);
  const double coupling = -jacobian(0, 1) * jacobian(1, 0);
  const double determinant = jacobian.determinant();
  const double difference = d1 - d2;
  if (coupling > 0.0 && difference != 0.0)
  {
    const double balance = std::copysign((d1 + d2) * std::sqrt(coupling / (d1 * d2)), difference);
    forecast.SquaredWaveNumber = std::max(0.0, (a - d + balance) / difference);
  }
  forecast.GrowthRate = GrowthRate(jacobian, d1, d2, forecast.SquaredWaveNumber);
  const double uniform = GrowthRate(jacobian, d1, d2, 0.0);
  if (!(forecast.GrowthRate > uniform))
  {
    forecast.SquaredWaveNumber = 0.0;
    forecast.GrowthRate = uniform;
  }
  forecast.FirstIsFaster = d > a;

  const double activator = std::max(a, d);
  if (!(a + d < 0.0 && determinant > 0.0))
  {
    forecast.Obstacle = PatternObstacle::NotSteady;
  }
  else if (!(activator > 0.0))
  {
    forecast.Obstacle = PatternObstacle::NoActivator;
  }
  else
  {
    const double root = (std::sqrt(determinant) + std::sqrt(coupling)) / activator;
    forecast.CriticalRatio = root * root;
    const double ratio = forecast.FirstIsFaster ? d1 / d2 : d2 / d1;
    forecast.Obstacle =
      ratio > forecast.CriticalRatio ? PatternObstacle::None : PatternObstacle::RatesTooClose;
  }
  return forecast;
}

double FeatureSizeFactor(const PatternForecast& forecast, double wavelength)
{
  return forecast.SquaredWaveNumber * wavelength * wavelength / (4.0 * Pi * Pi);
}

double ReactionTimeStep(const Eigen::Matrix2d& jacobian)
{
  const double halfTrace = 0.5 * jacobian.trace();
  const double determinant = jacobian.determinant();
  const double discriminant = halfTrace * halfTrace - determinant;
  const double largest =
    discriminant > 0.0 ? std::abs(halfTrace) + std::sqrt(discriminant) : std::sqrt(determinant);
  return 0.125 / largest;
}

} // namespace SurfaceDiffusion
