// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Core/Foundation/Types.h"
#include "Core/Models/Textures/DispersionRelation.h"
#include "Run/ModelInputs.h"

#include <array>

namespace SurfaceDiffusion
{

/// The diffusion rates of the chemicals of a texture, g1 and g2 of each, in LengthUnit^2
/// ReactionRate, per triangle of the mesh, and their means over the surface.
struct TextureRates
{
  std::array<Vector, 2> Along, Across;
  std::array<double, 2> MeanAlong, MeanAcross;

  /// A wavelength with fewer mean edge lengths is not resolved by the mesh.
  static constexpr double EdgesPerWavelength = 6.0;
  static constexpr double EdgesOfRefinement = 8.0; ///< per wavelength, of a mesh that is refined

  /// constant: of u1 along and across, and of u2 likewise, unless inputs.Rates take their place.
  /// unit: that of both. Throws InputError on inputs.Rates that need directions. Collective.
  TextureRates(const std::array<double, 4>& constant, double unit, const ModelInputs& inputs);

  /// Multiply the rates so that the wavelength becomes featureSize, in LengthUnit. Returns the
  /// factor, or 0 if no wave grows faster than the uniform state, when the rates stay.
  double ScaleToFeatureSize(double featureSize, const Eigen::Matrix2d& jacobian);

  /// The pattern that grows out of a steady state with this Jacobian.
  PatternForecast ForecastAlong(const Eigen::Matrix2d& jacobian) const
  {
    return ForecastPattern(jacobian, this->MeanAlong[0], this->MeanAlong[1]);
  }
  PatternForecast ForecastAcross(const Eigen::Matrix2d& jacobian) const
  {
    return ForecastPattern(jacobian, this->MeanAcross[0], this->MeanAcross[1]);
  }

  /// Of this pattern, in the mesh's LengthUnit()^-2; 0 if none grows.
  double FindSquaredWaveNumber(const Eigen::Matrix2d& jacobian) const;

  /// Warn if no pattern grows, or if it is too fine for the mesh.
  void WarnOfObstacles(
    const Eigen::Matrix2d& jacobian, const UnitSystem& units, RunResult& result) const;

private:
  void Read(const ModelInputs& inputs);
};

/// Of the wave that grows fastest, in LengthUnit; 0 if none does.
double WavelengthOf(const PatternForecast& forecast);

} // namespace SurfaceDiffusion
