// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Models/EdgeFunctions.h"

#include <array>

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
  const double c = EdgeFunctionList::Weickert::C;
  const double v = c / (ratio * ratio * ratio * ratio);
  if (!(v < 50.0)) // exp(-v) is far below round-off
  {
    return 0.5 * ratio;
  }
  const double upperGamma34 = std::tgamma(0.75) - LowerGamma34(v);
  return 0.5 * (std::pow(c, 0.25) * upperGamma34 - ratio * std::expm1(-v));
}

} // namespace

double EdgeFunctionList::Weickert::Potential(double squared) const
{
  return this->SquaredThreshold() * WeickertIntegral(this->Ratio(squared));
}

EdgeFunctionProperties GetEdgeFunction(EdgeFunctionKind kind)
{
  return std::apply(
    [kind](const auto&... functions)
    {
      const std::array<EdgeFunctionProperties, NumberOfEdgeFunctions> rows = {
        { { functions.Name, functions.Convex, functions.Dimensionless }... }
      };
      return rows.at(static_cast<std::size_t>(kind));
    },
    EdgeFunctionList::All());
}

} // namespace SurfaceDiffusion
