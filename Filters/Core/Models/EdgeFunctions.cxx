// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Models/EdgeFunctions.h"

namespace SurfaceDiffusion
{

namespace
{

/// Lower incomplete gamma function of 3/4 by its power series; v >= 0, fast for v below 50.
double LowerGamma34(double v)
{
  double term = 1.0 / 0.75;
  double sum = term;
  for (double a = 1.75; term > 1e-17 * sum; a += 1.0)
  {
    term *= v / a;
    sum += term;
  }
  return sum * std::pow(v, 0.75) * std::exp(-v);
}

/// Integral of x (1 - exp(-C/x^8)) from 0 to sqrt(ratio): by parts, and with v = C/x^8,
/// 1/2 (ratio (1 - exp(-v)) + C^(1/4) Gamma(3/4, v)).
double WeickertIntegral(double ratio)
{
  const double c = EdgeFunction::WeickertConstant;
  const double v = c / (ratio * ratio * ratio * ratio);
  if (!(v < 50.0)) // exp(-v) is far below round-off
  {
    return 0.5 * ratio;
  }
  const double upperGamma34 = std::tgamma(0.75) - LowerGamma34(v);
  return 0.5 * (std::pow(c, 0.25) * upperGamma34 - ratio * std::expm1(-v));
}

} // namespace

double EdgeFunction::Potential(double squared) const
{
  const double k2 = this->Threshold * this->Threshold;
  const double ratio = squared / k2;
  switch (this->Kind)
  {
    case EdgeFunctionKind::TotalVariation: // sqrt(s^2 + beta) - sqrt(beta)
      return squared > 0.0 ? squared / (std::sqrt(squared + this->Beta) + std::sqrt(this->Beta))
                           : 0.0;
    case EdgeFunctionKind::PeronaMalikExponential:
      return -0.5 * k2 * std::expm1(-ratio);
    case EdgeFunctionKind::PeronaMalikRational:
      return 0.5 * k2 * std::log1p(ratio);
    case EdgeFunctionKind::Charbonnier: // K^2 (sqrt(1 + (s/K)^2) - 1)
      return squared / (1.0 + std::sqrt(1.0 + ratio));
    case EdgeFunctionKind::Weickert:
      return k2 * WeickertIntegral(ratio);
    case EdgeFunctionKind::Constant:
      break;
  }
  return 0.5 * squared;
}

} // namespace SurfaceDiffusion
