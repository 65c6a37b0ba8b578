// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Core/Foundation/Types.h"

namespace SurfaceDiffusion
{

/// Linear stability of a steady state of (22): a perturbation with wave number k grows like
/// exp(rate t), where rate is the larger real part of the eigenvalues of J - k^2 diag(D1, D2) and
/// J the Jacobian of (F, G) (A. Turing 1952; J. D. Murray, Mathematical Biology II, ch. 2).
double GrowthRate(const Eigen::Matrix2d& jacobian, double d1, double d2, double squaredWaveNumber);

/// The reason why no pattern grows out of small perturbations.
enum class PatternObstacle
{
  None,
  NoSteadyState, ///< the kinetics have no steady state with these parameters
  NotSteady, ///< the steady state is unstable even without diffusion
  NoActivator, ///< neither chemical promotes itself: no diffusion rates make a pattern
  RatesTooClose ///< D1/D2 (or D2/D1) is not above the CriticalRatio
};

/// The pattern that is expected from the dispersion relation.
struct PatternForecast
{
  PatternObstacle Obstacle = PatternObstacle::NoSteadyState;
  /// Of the fastest-growing mode, with its rate; 0 if no mode grows faster than the uniform one.
  double SquaredWaveNumber = 0.0;
  double GrowthRate = 0.0;
  /// The ratio of the larger diffusion rate to the smaller that must be exceeded: 4 for (24) with
  /// gamma = 16, mu = 12. 0 if no ratio suffices.
  double CriticalRatio = 0.0;
  bool FirstIsFaster = true; ///< the ratio is D1/D2
};

/// With J = (a b; c d), b c < 0, the larger eigenvalue has its maximum over q = k^2 at
///   a - d - (D1 - D2) q = -sign(D1 - D2) (D1 + D2) sqrt(-b c / (D1 D2)),
/// and the maximum passes zero at the ratio of rates ((sqrt(det J) + sqrt(-b c)) / d)^2; d
/// belongs to the activator. For (24) at D1/D2 = 8: k^2 = 0.818 s/D2.
PatternForecast ForecastPattern(const Eigen::Matrix2d& jacobian, double d1, double d2);

/// The factor of both diffusion rates that makes the fastest-growing wavelength `wavelength`; 0 if
/// there is no fastest-growing mode.
double FeatureSizeFactor(const PatternForecast& forecast, double wavelength);

/// A time step for explicit reactions: 1/8 of the time constant of the Jacobian's largest
/// eigenvalue, 1/16 for (24) with gamma = 16, mu = 12. Accuracy, not stability, requires it.
double ReactionTimeStep(const Eigen::Matrix2d& jacobian);

} // namespace SurfaceDiffusion
