// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Models/Textures/DispersionRelation.h"
#include "Core/Models/Textures/Kinetics.h"

#include <gtest/gtest.h>

#include <cmath>
#include <string>
#include <utility>

using namespace SurfaceDiffusion;

namespace
{

/// Natural default rates of the texture filter.
constexpr double D1 = 21.0;
constexpr double D2 = 2.6;

Eigen::Vector2d Rates(const Kinetics& kinetics, const KineticsParameters& p, double u1, double u2)
{
  Eigen::Vector2d rates;
  kinetics.React(p, 1, &u1, &u2, &rates[0], &rates[1]);
  return rates;
}

class AnyKinetics : public testing::TestWithParam<int>
{
protected:
  const Kinetics& Terms = GetKinetics(static_cast<KineticsName>(GetParam()));
  KineticsParameters Defaults = Terms.Defaults();
  Eigen::Vector2d Steady = Terms.SteadyState(Defaults);
  Eigen::Matrix2d Jacobian = Terms.Jacobian(Defaults, Steady[0], Steady[1]);
};

TEST_P(AnyKinetics, SteadyStateDoesNotReact)
{
  // Parameters off the defaults show formulas that hold only there.
  for (const double factor : { 1.0, 1.01, 0.99 })
  {
    KineticsParameters p = this->Defaults;
    p[0] *= factor;
    p[2] += factor - 1.0;
    if (this->Terms.Parameters[1].Name == std::string("Saturation"))
    {
      p[1] = factor;
    }
    const Eigen::Vector2d steady = this->Terms.SteadyState(p);
    ASSERT_TRUE(steady.allFinite());
    EXPECT_LT(Rates(this->Terms, p, steady[0], steady[1]).norm(), 1e-12);
  }
}

TEST_P(AnyKinetics, JacobianIsTheDerivative)
{
  const double step = 1e-5;
  KineticsParameters p = this->Defaults;
  p[1] += 0.1;
  const Eigen::Vector2d u(this->Steady[0] + 0.3, this->Steady[1] + 0.2);
  const Eigen::Matrix2d exact = this->Terms.Jacobian(p, u[0], u[1]);
  for (int k = 0; k < 2; ++k)
  {
    const Eigen::Vector2d d = step * Eigen::Vector2d::Unit(k);
    const Eigen::Vector2d column = (Rates(this->Terms, p, u[0] + d[0], u[1] + d[1]) -
                                     Rates(this->Terms, p, u[0] - d[0], u[1] - d[1])) /
      (2.0 * step);
    EXPECT_LT((column - exact.col(k)).norm(), 1e-7 * exact.norm());
  }
}

TEST_P(AnyKinetics, DefaultsMakeAPatternAtTheDefaultRates)
{
  const PatternForecast forecast = ForecastPattern(this->Jacobian, D1, D2);
  EXPECT_EQ(forecast.Obstacle, PatternObstacle::None);
  EXPECT_TRUE(forecast.FirstIsFaster);
  EXPECT_GT(forecast.GrowthRate, 0.1);
  const double wavelength = 2.0 * std::acos(-1.0) / std::sqrt(forecast.SquaredWaveNumber);
  EXPECT_GT(wavelength, 8.0); // mean edges: enough to resolve
  EXPECT_LT(wavelength, 25.0);
}

TEST_P(AnyKinetics, FastestModeIsTheMaximumOfTheGrowthRate)
{
  for (const auto& [d1, d2] : { std::pair(D1, D2), std::pair(21.0, 0.5), std::pair(100.0, 1.0) })
  {
    const PatternForecast forecast = ForecastPattern(this->Jacobian, d1, d2);
    double best = 0.0;
    double bestRate = -1e9;
    const double step = 1e-4 * forecast.SquaredWaveNumber;
    for (int i = 0; i <= 30000; ++i)
    {
      const double rate = GrowthRate(this->Jacobian, d1, d2, step * i);
      if (rate > bestRate)
      {
        best = step * i;
        bestRate = rate;
      }
    }
    EXPECT_NEAR(forecast.SquaredWaveNumber, best, 2.0 * step);
    EXPECT_NEAR(forecast.GrowthRate, bestRate, 1e-6);
  }
}

TEST_P(AnyKinetics, PatternsBeginAtTheCriticalRatio)
{
  const double ratio = ForecastPattern(this->Jacobian, D1, D2).CriticalRatio;
  const PatternForecast below = ForecastPattern(this->Jacobian, 0.999 * ratio, 1.0);
  const PatternForecast above = ForecastPattern(this->Jacobian, 1.001 * ratio, 1.0);
  EXPECT_EQ(below.Obstacle, PatternObstacle::RatesTooClose);
  EXPECT_EQ(above.Obstacle, PatternObstacle::None);
  EXPECT_LT(below.GrowthRate, 0.0);
  EXPECT_GT(above.GrowthRate, 0.0);
}

TEST_P(AnyKinetics, FeatureSizeFactorGivesThatWavelength)
{
  const double wavelength = 0.37;
  const double factor = FeatureSizeFactor(ForecastPattern(this->Jacobian, D1, D2), wavelength);
  const PatternForecast scaled = ForecastPattern(this->Jacobian, factor * D1, factor * D2);
  EXPECT_NEAR(2.0 * std::acos(-1.0) / std::sqrt(scaled.SquaredWaveNumber), wavelength, 1e-12);
}

TEST_P(AnyKinetics, HasAReferenceAndNamedParameters)
{
  EXPECT_NE(std::string(this->Terms.Reference), "");
  EXPECT_NE(std::string(this->Terms.Formula), "");
  EXPECT_NE(this->Terms.Parameters[0].Name, nullptr);
  for (const Kinetics::Parameter& parameter : this->Terms.Parameters)
  {
    if (parameter.Name)
    {
      EXPECT_TRUE(parameter.Default > 0.0 || parameter.Allowed != Kinetics::Range::Positive);
      EXPECT_GE(parameter.Default, 0.0);
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Kinetics, AnyKinetics, testing::Range(0, NumberOfKinetics),
  [](const auto& kinetics)
  { return std::string(GetKinetics(static_cast<KineticsName>(kinetics.param)).Name); });

Eigen::Matrix2d TuringJacobian()
{
  return GetKinetics(KineticsName::Turing).Jacobian({ 16.0, 12.0, 0.0 }, 4.0, 4.0);
}

} // namespace

TEST(Kinetics, TuringRestsAtFour)
{
  const Kinetics& turing = GetKinetics(KineticsName::Turing);
  EXPECT_TRUE(turing.SteadyState({ 16.0, 12.0, 0.0 }) == Eigen::Vector2d(4.0, 4.0));
}

TEST(Kinetics, NoSteadyStateIsTold)
{
  const auto steady = [](KineticsName name, const KineticsParameters& p)
  { return GetKinetics(name).SteadyState(p); };
  EXPECT_TRUE(steady(KineticsName::Turing, { 12.0, 16.0, 0.0 }).hasNaN()); // decay beats growth
  EXPECT_TRUE(steady(KineticsName::GrayScott, { 0.04, 0.08, 0.0 }).hasNaN()); // washed out
  EXPECT_TRUE(steady(KineticsName::FitzHughNagumo, { 1.0, 2.0, 0.0 }).hasNaN()); // three of them
  EXPECT_EQ(ForecastPattern(Eigen::Matrix2d::Constant(std::nan("")), 8.0, 1.0).Obstacle,
    PatternObstacle::NoSteadyState);
}

TEST(DispersionRelation, TuringGrowsFastestAtTheKnownWaveNumbers)
{
  EXPECT_NEAR(ForecastPattern(TuringJacobian(), 8.0, 1.0).SquaredWaveNumber, 0.818, 5e-4);
  EXPECT_NEAR(ForecastPattern(TuringJacobian(), 16.0, 1.0).SquaredWaveNumber, 0.667, 5e-4);
}

TEST(DispersionRelation, TuringNeedsARatioAboveFourAndIsCriticalAtItsKnownWaveNumber)
{
  EXPECT_NEAR(ForecastPattern(TuringJacobian(), 8.0, 1.0).CriticalRatio, 4.0, 1e-12);
  // k^2 = 2 s / sqrt(D1 D2): the growth rate touches zero there and nowhere else.
  EXPECT_NEAR(GrowthRate(TuringJacobian(), 4.0, 1.0, 2.0 / std::sqrt(4.0)), 0.0, 1e-12);
  EXPECT_LT(GrowthRate(TuringJacobian(), 4.0, 1.0, 0.9), 0.0);
  EXPECT_LT(GrowthRate(TuringJacobian(), 4.0, 1.0, 1.1), 0.0);
}

TEST(DispersionRelation, ReasonsAgainstAPatternAreTold)
{
  const auto obstacle = [](double a, double b, double c, double d, double d1, double d2)
  { return ForecastPattern((Eigen::Matrix2d() << a, b, c, d).finished(), d1, d2).Obstacle; };
  EXPECT_EQ(obstacle(-4.0, -4.0, 4.0, 3.0, 8.0, 1.0), PatternObstacle::None);
  EXPECT_EQ(obstacle(-4.0, -4.0, 4.0, 3.0, 1.0, 8.0), PatternObstacle::RatesTooClose);
  EXPECT_EQ(obstacle(-4.0, -4.0, 4.0, 3.0, 3.0, 3.0), PatternObstacle::RatesTooClose);
  EXPECT_EQ(obstacle(-4.0, -4.0, 4.0, 5.0, 8.0, 1.0), PatternObstacle::NotSteady);
  EXPECT_EQ(obstacle(-4.0, -4.0, 4.0, -1.0, 8.0, 1.0), PatternObstacle::NoActivator);
  // The same chemicals in the other order.
  EXPECT_EQ(obstacle(3.0, 4.0, -4.0, -4.0, 1.0, 8.0), PatternObstacle::None);
  EXPECT_EQ(obstacle(3.0, 4.0, -4.0, -4.0, 8.0, 1.0), PatternObstacle::RatesTooClose);
}

TEST(DispersionRelation, NoWaveIsNamedWhereTheUniformStateDecaysSlowest)
{
  const PatternForecast forecast = ForecastPattern(TuringJacobian(), 0.2, 2.6);
  EXPECT_EQ(forecast.SquaredWaveNumber, 0.0);
  EXPECT_EQ(forecast.GrowthRate, -0.5); // half the trace: eigenvalues -0.5 +- 1.9 i
  EXPECT_EQ(FeatureSizeFactor(forecast, 1.0), 0.0);
}

TEST(DispersionRelation, TimeStepOfTuringIsASixteenth)
{
  EXPECT_NEAR(ReactionTimeStep(TuringJacobian()), 1.0 / 16.0, 1e-15);
}
