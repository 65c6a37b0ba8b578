// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Models/EdgeFunctions.h"

#include <gtest/gtest.h>

#include <limits>
#include <vector>

using namespace SurfaceDiffusion;

namespace
{

using Kind = EdgeFunctionKind;

const std::vector<Kind> AllKinds = { Kind::TotalVariation, Kind::PeronaMalikExponential,
  Kind::PeronaMalikRational, Kind::Charbonnier, Kind::Weickert, Kind::Constant };

double Flux(const EdgeFunction& g, double s)
{
  return s * g(s * s);
}

} // namespace

TEST(EdgeFunctions, AreTheirFormulas)
{
  const double s = 0.3, k = 0.2, beta = 0.01, r = s / k;
  const auto value = [&](Kind kind) { return EdgeFunction{ kind, beta, k }(s * s); };
  EXPECT_DOUBLE_EQ(value(Kind::TotalVariation), 1.0 / std::sqrt(s * s + beta));
  EXPECT_DOUBLE_EQ(value(Kind::PeronaMalikExponential), std::exp(-r * r));
  EXPECT_DOUBLE_EQ(value(Kind::PeronaMalikRational), 1.0 / (1.0 + r * r));
  EXPECT_DOUBLE_EQ(value(Kind::Charbonnier), 1.0 / std::sqrt(1.0 + r * r));
  EXPECT_NEAR(value(Kind::Weickert), 1.0 - std::exp(-3.31488 / std::pow(r, 8)), 1e-15);
  EXPECT_DOUBLE_EQ(value(Kind::Constant), 1.0);
}

TEST(EdgeFunctions, AreOneWhereNothingChanges)
{
  for (const Kind kind : AllKinds)
  {
    EXPECT_DOUBLE_EQ((EdgeFunction{ kind, 1.0, 0.1 }(0.0)), 1.0);
  }
}

TEST(EdgeFunctions, ArePotentialsDerivativeOverTheGradient)
{
  for (const Kind kind : AllKinds)
  {
    const EdgeFunction g{ kind, 0.04, 0.7 };
    EXPECT_EQ(g.Potential(0.0), 0.0);
    for (const double s : { 0.01, 0.3, 0.6, 0.69, 0.7, 0.8, 1.0, 2.0, 7.0 })
    {
      const double d = 1e-4 * s;
      const double slope =
        (g.Potential((s + d) * (s + d)) - g.Potential((s - d) * (s - d))) / (2.0 * d);
      EXPECT_NEAR(slope, Flux(g, s), 2e-7 * s) << static_cast<int>(kind) << " at " << s;
    }
  }
}

TEST(EdgeFunctions, PassMostFluxAtTheThreshold)
{
  const double k = 0.5;
  const auto peaksAt = [&](Kind kind, double s)
  {
    const EdgeFunction g{ kind, 0.0, k };
    return Flux(g, s) > Flux(g, 0.99 * s) && Flux(g, s) > Flux(g, 1.01 * s);
  };
  EXPECT_TRUE(peaksAt(Kind::PeronaMalikExponential, k * std::sqrt(0.5)));
  EXPECT_TRUE(peaksAt(Kind::PeronaMalikRational, k));
  EXPECT_TRUE(peaksAt(Kind::Weickert, k));
}

TEST(EdgeFunctions, StayFiniteAtExtremeGradients)
{
  for (const Kind kind : AllKinds)
  {
    const EdgeFunction g{ kind, 1e-24, 1e-3 };
    for (const double s : { 0.0, 1e-160, 1e-12, 1e12, 1e75 })
    {
      EXPECT_TRUE(std::isfinite(g(s * s))) << static_cast<int>(kind) << " at " << s;
      EXPECT_GE(g(s * s), 0.0);
      EXPECT_TRUE(std::isfinite(g.Potential(s * s))) << static_cast<int>(kind) << " at " << s;
      EXPECT_GE(g.Potential(s * s), 0.0);
    }
  }
}
