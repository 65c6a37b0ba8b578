// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Models/EdgeFunctions.h"

#include <gtest/gtest.h>

#include <limits>
#include <string>
#include <vector>

using namespace SurfaceDiffusion;

namespace
{

using Kind = EdgeFunctionKind;

std::vector<Kind> ListKinds()
{
  std::vector<Kind> kinds;
  for (int kind = 0; kind < NumberOfEdgeFunctions; ++kind)
  {
    kinds.push_back(static_cast<Kind>(kind));
  }
  return kinds;
}

const std::vector<Kind> AllKinds = ListKinds();

const std::vector<double> Gradients = { 0.01, 0.3, 0.6, 0.69, 0.7, 0.8, 1.0, 2.0, 7.0 };

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

TEST(EdgeFunctions, HaveTheirNames)
{
  const auto name = [](Kind kind) { return std::string(GetEdgeFunction(kind).Name); };
  EXPECT_EQ(NumberOfEdgeFunctions, 6);
  EXPECT_EQ(name(Kind::TotalVariation), "TotalVariation");
  EXPECT_EQ(name(Kind::PeronaMalikExponential), "PeronaMalikExponential");
  EXPECT_EQ(name(Kind::PeronaMalikRational), "PeronaMalikRational");
  EXPECT_EQ(name(Kind::Charbonnier), "Charbonnier");
  EXPECT_EQ(name(Kind::Weickert), "Weickert");
  EXPECT_EQ(name(Kind::Constant), "Constant");
}

TEST(EdgeFunctions, AreConvexIfTheirFluxNeverFalls)
{
  for (const Kind kind : AllKinds)
  {
    const EdgeFunction g{ kind, 0.0, 0.7 };
    bool falls = false;
    for (double s = 0.1; s < 5.0; s += 0.1)
    {
      falls = falls || Flux(g, s + 0.1) < Flux(g, s) * (1.0 - 1e-12);
    }
    EXPECT_EQ(GetEdgeFunction(kind).Convex, !falls) << GetEdgeFunction(kind).Name;
  }
}

TEST(EdgeFunctions, AreDimensionlessIfGradientAndThresholdScaleTogether)
{
  for (const Kind kind : AllKinds)
  {
    const EdgeFunction g{ kind, 0.0, 0.7 };
    const EdgeFunction scaled{ kind, 0.0, 7.0 };
    const double factor = GetEdgeFunction(kind).Dimensionless ? 1.0 : 0.1;
    EXPECT_NEAR(scaled(25.0), factor * g(0.25), 1e-14) << GetEdgeFunction(kind).Name;
  }
}

TEST(EdgeFunctions, ShrinkToTheProximalPoint)
{
  for (const Kind kind : AllKinds)
  {
    const EdgeFunction g{ kind, 0.0, 0.7 };
    for (const double r : { 0.1, 1.0, 20.0 })
    {
      for (const double s : Gradients)
      {
        const double p = g.Shrinkage(r, s) * s;
        if (GetEdgeFunction(kind).Convex && p > 0.0)
        {
          EXPECT_NEAR(p + Flux(g, p) / r, s, 1e-14 * s) << GetEdgeFunction(kind).Name;
        }
        else if (GetEdgeFunction(kind).Convex)
        {
          EXPECT_LE(s, Flux(g, 1e-200) / r); // within the subdifferential at zero
        }
      }
    }
  }
}

TEST(EdgeFunctions, HaveTheConjugateOfTheirPotential)
{
  for (const Kind kind : AllKinds)
  {
    const EdgeFunction g{ kind, 0.0, 0.7 };
    for (const double s : Gradients)
    {
      const double y = Flux(g, s);
      if (GetEdgeFunction(kind).Convex) // equality in Fenchel's inequality
      {
        EXPECT_NEAR(g.Conjugate(y * y), s * y - g.Potential(s * s), 1e-13 * (1.0 + s * s))
          << GetEdgeFunction(kind).Name;
      }
    }
  }
}

TEST(EdgeFunctions, AreOneForConstants)
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
    for (const double s : Gradients)
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
