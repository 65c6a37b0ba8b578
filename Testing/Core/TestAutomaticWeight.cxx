// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Heat.h"
#include "KindsOfNoise.h"
#include "RunInput.h"

#include "Run/HeatSettings.h"
#include "Run/TotalVariationSettings.h"

#include "Core/Models/HeatBlur.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <string>
#include <vector>

// The fidelity weight that is found: of data with constant parts, and of blurred data.

namespace SurfaceDiffusion
{

namespace
{

using Testing::Alone;
using Testing::RunInput;
using Testing::StateOf;

/// Points with the largest values of a function of the place: the rest of them is constant.
std::vector<char> Part(const Testing::Surface& s, double share)
{
  std::vector<double> order;
  for (Eigen::Index i = 0; i < s.Vertices.rows(); ++i)
  {
    order.push_back(s.Vertices(i, 0) + 0.3 * s.Vertices(i, 1));
  }
  std::vector<double> sorted = order;
  std::sort(sorted.begin(), sorted.end());
  const double limit =
    sorted[static_cast<std::size_t>(std::lround(share * static_cast<double>(sorted.size() - 1)))];
  std::vector<char> part;
  for (const double place : order)
  {
    part.push_back(place >= limit);
  }
  return part;
}

struct Noisy
{
  RunInput Input;
  Vector Clean;
};

/// A smooth function on a part, `background` elsewhere, and noise on the part or everywhere.
Noisy MakeNoisy(const Testing::Surface& s, const std::vector<char>& part, double sigma,
  double background, bool noisyEverywhere)
{
  Noisy data{ RunInput(s), Vector(s.Vertices.rows()) };
  for (Eigen::Index i = 0; i < s.Vertices.rows(); ++i)
  {
    const bool inside = part[static_cast<std::size_t>(i)] != 0;
    data.Clean[i] = background + (inside ? 0.2 * std::sin(3.0 * s.Vertices(i, 1)) : 0.0);
    data.Input.Data.Data.Values(i, 0) =
      data.Clean[i] + (inside || noisyEverywhere ? sigma * Testing::GaussianNumber(i, 4) : 0.0);
  }
  return data;
}

/// Of the differences from the clean data at the points of a part.
template <typename ModelSettings>
double ErrorOf(
  const Noisy& data, const std::vector<char>& part, const ModelSettings& settings, bool& warned)
{
  SurfaceDiffusion::Run run(SerialFor());
  const Values u = StateOf(run, { data.Input.Block() }, settings);
  warned = !run.FindWarnings(Alone).empty();
  double sum = 0.0;
  double count = 0.0;
  for (Eigen::Index i = 0; i < data.Clean.size(); ++i)
  {
    if (part[static_cast<std::size_t>(i)] != 0)
    {
      const Index v = run.GetBlock(0).Surface->VertexOf(static_cast<Index>(i));
      sum += std::pow(u(v, 0) - data.Clean[i], 2);
      count += 1.0;
    }
  }
  return std::sqrt(sum / count);
}

} // namespace

TEST(AutomaticWeight, LeavesConstantPartsOutOfTheNoise)
{
  constexpr double sigma = 0.1;
  HeatSettings heat;
  heat.Mode = HeatMode::SteadyState;
  heat.AutomaticFidelity = true;
  TotalVariationSettings tv;
  tv.Mode = TotalVariationMode::SteadyState;
  tv.AutomaticFidelity = true;
  const Testing::Surface strip =
    Testing::Jittered(Testing::Strip(50, 50), 0.35 / 50.0, 0.001, 0.999, 0.001, 0.999);
  for (const Testing::Surface& s : { Testing::Icosphere(4), strip })
  {
    for (const double share : { 0.4, 0.6, 0.9 })
    {
      for (const double background : { 0.0, 0.7 })
      {
        const std::vector<char> part = Part(s, share);
        const Noisy constant = MakeNoisy(s, part, sigma, background, false);
        const Noisy without = MakeNoisy(s, part, sigma, background, true);
        bool warned = false;
        const double ofHeat = ErrorOf(constant, part, heat, warned);
        EXPECT_FALSE(warned) << share;
        EXPECT_LT(ofHeat, 1.5 * ErrorOf(without, part, heat, warned)) << share;
        EXPECT_LT(ofHeat, 0.5 * sigma);
        const double ofTV = ErrorOf(constant, part, tv, warned);
        EXPECT_FALSE(warned) << share;
        EXPECT_LT(ofTV, 1.5 * ErrorOf(without, part, tv, warned)) << share;
        EXPECT_LT(ofTV, 0.6 * sigma);
      }
    }
  }
}

namespace
{

/// The errors at the weight that is found over those at the best weight.
template <typename ModelSettings, typename ModeType>
std::vector<double> ErrorsOverBest(ModeType steady)
{
  const Testing::Surface s = Testing::Icosphere(4);
  const std::vector<char> all(static_cast<std::size_t>(s.Vertices.rows()), 1);
  std::vector<double> ratios;
  for (int kind = 0; kind < 5; ++kind)
  {
    for (int signal = 0; signal < 3; ++signal)
    {
      Noisy data{ RunInput(s), Vector(s.Vertices.rows()) };
      for (Eigen::Index i = 0; i < s.Vertices.rows(); ++i)
      {
        const double z = s.Vertices(i, 2);
        data.Clean[i] = signal == 0 ? std::sin(3.0 * z)
          : signal == 1             ? (z > 0.3 ? 1.0 : 0.0)
                                    : std::max(-0.5, std::min(0.5, z));
        data.Input.Data.Data.Values(i, 0) =
          Testing::WithNoise(static_cast<Testing::NoiseKind>(kind), data.Clean[i], 0.2, i);
      }
      ModelSettings settings;
      settings.Mode = steady;
      settings.AutomaticFidelity = true;
      bool warned = false;
      SurfaceDiffusion::Run run(SerialFor());
      StateOf(run, { data.Input.Block() }, settings);
      const double weight = FindNumber(run.GetBlock(0).Outputs, "EffectiveFidelityWeight");
      const double error = ErrorOf(data, all, settings, warned);
      EXPECT_FALSE(warned);
      settings.AutomaticFidelity = false;
      double best = error;
      for (const double exponent : { -4, -3, -2, -1, 1, 2, 3, 4 })
      {
        settings.FidelityWeight = weight * std::exp2(exponent);
        best = std::min(best, ErrorOf(data, all, settings, warned));
      }
      ratios.push_back(error / best);
    }
  }
  std::sort(ratios.begin(), ratios.end());
  return ratios;
}

} // namespace

TEST(AutomaticWeight, HasNearlyTheSmallestErrorForAnyDistributionOfNoise)
{
  const auto heat = ErrorsOverBest<HeatSettings>(HeatMode::SteadyState);
  EXPECT_LT(heat[heat.size() / 2], 1.05);
  EXPECT_LT(heat.back(), 1.3);
  const auto tv = ErrorsOverBest<TotalVariationSettings>(TotalVariationMode::SteadyState);
  EXPECT_LT(tv[tv.size() / 2], 1.1);
  EXPECT_LT(tv.back(), 1.6);
}

// A part without noise is held, and the iterations of the other one are as exact as without it.
TEST(AutomaticWeight, OfAPartWithoutNoiseLeavesTheOtherAlone)
{
  const Testing::Surface part = Testing::Icosphere(4);
  const Noisy alone = MakeNoisy(part, std::vector<char>(part.Vertices.rows(), 1), 0.1, 0.0, true);
  RunInput both(Testing::Joined(part, Testing::Moved(part, { 4.0, 0.0, 0.0 })));
  both.Data.Data.Values.setConstant(5.0);
  both.Data.Data.Values.topRows(part.Vertices.rows()) = alone.Input.Data.Data.Values;
  HeatSettings heat;
  heat.Mode = HeatMode::SteadyState;
  heat.AutomaticFidelity = true;
  heat.Solver = SolverMethod::ConjugateGradient;
  SurfaceDiffusion::Run run(SerialFor());
  SurfaceDiffusion::Run runOfBoth(SerialFor());
  const Values u = StateOf(run, { alone.Input.Block() }, heat);
  const Values uOfBoth = StateOf(runOfBoth, { both.Block() }, heat);
  for (Index i = 0; i < part.NumberOfVertices(); ++i)
  {
    const Index v = runOfBoth.GetBlock(0).Surface->VertexOf(i);
    const Index held = runOfBoth.GetBlock(0).Surface->VertexOf(i + part.NumberOfVertices());
    EXPECT_NEAR(uOfBoth(v, 0), u(run.GetBlock(0).Surface->VertexOf(i), 0), 1e-7);
    EXPECT_EQ(uOfBoth(held, 0), 5.0);
  }
}

// Noise of .03 on one half and .3 on the other, and factors 1/s^2 of it in three units.
TEST(AutomaticWeight, OfUnevenNoiseWithItsFactorsLeavesLessThanTheDataHaveInAnyUnit)
{
  const Testing::Surface s = Testing::Icosphere(4);
  const std::vector<char> all(static_cast<std::size_t>(s.Vertices.rows()), 1);
  Noisy data{ RunInput(s), Vector(s.Vertices.rows()) };
  data.Input.Data.FidelityFactors.Values.resize(all.size());
  double first = 0.0;
  for (const double unit : { 1.0, 0.3, 50.0 }) // the noise where the factor is 1
  {
    double noise = 0.0;
    for (Eigen::Index i = 0; i < s.Vertices.rows(); ++i)
    {
      const double sigma = s.Vertices(i, 2) > 0.0 ? 0.03 : 0.3;
      data.Clean[i] = std::sin(3.0 * s.Vertices(i, 0));
      data.Input.Data.Data.Values(i, 0) = data.Clean[i] + sigma * Testing::GaussianNumber(i, 4);
      data.Input.Data.FidelityFactors.Values[static_cast<std::size_t>(i)] =
        unit * unit / (sigma * sigma);
      noise += sigma * sigma / static_cast<double>(s.Vertices.rows());
    }
    HeatSettings heat;
    heat.Mode = HeatMode::SteadyState;
    heat.AutomaticFidelity = true;
    bool warned = false;
    const double estimated = ErrorOf(data, all, heat, warned);
    EXPECT_FALSE(warned);
    EXPECT_LT(estimated, 0.9 * std::sqrt(noise));
    first = unit == 1.0 ? estimated : first;
    EXPECT_NEAR(estimated, first, 0.01 * first); // the search ends at 1 % of the weight
    heat.NoiseLevel = unit;
    EXPECT_NEAR(ErrorOf(data, all, heat, warned), estimated, 0.03 * estimated);
  }
}

TEST(AutomaticWeight, KeepsMasksAndSpikesAndSaysSo)
{
  const Testing::Surface s = Testing::Icosphere(4);
  HeatSettings heat;
  heat.Mode = HeatMode::SteadyState;
  heat.AutomaticFidelity = true;
  for (const bool spikes : { false, true })
  {
    RunInput input(s);
    for (Eigen::Index i = 0; i < s.Vertices.rows(); ++i)
    {
      input.Data.Data.Values(i, 0) = (spikes ? i % 97 == 0 : s.Vertices(i, 2) > 0.3) ? 1.0 : 0.0;
    }
    SurfaceDiffusion::Run run(SerialFor());
    const Values u = StateOf(run, { input.Block() }, heat);
    const Surface& surface = *run.GetBlock(0).Surface;
    for (Eigen::Index i = 0; i < s.Vertices.rows(); ++i)
    {
      EXPECT_NEAR(
        u(surface.VertexOf(static_cast<Index>(i)), 0), input.Data.Data.Values(i, 0), 1e-5);
    }
    const std::vector<Warning> warnings = run.FindWarnings(Alone);
    ASSERT_EQ(warnings.size(), 1u);
    EXPECT_NE(warnings[0].Sentence.Text().find("finds no noise"), std::string::npos);
    EXPECT_NE(warnings[0].Sentence.Text().find("NoiseLevel"), std::string::npos);
  }
}

//------------------------------------------------------------------------------------------------
namespace
{

/// White noise of deviation 1 smoothed with a Gaussian kernel of a standard deviation of `edges`
/// mean edge lengths, times `deviation`, added to `input`.
void AddSmoothedNoise(RunInput& input, double edges, double deviation)
{
  const auto mesh = std::make_shared<TriangleMesh>(input.Vertices, input.Faces);
  const double length =
    edges * mesh->TotalEdgeLength() / mesh->NumberOfEdges() * mesh->LengthUnit();
  Values noise(mesh->NumberOfVertices(), 1);
  for (Index i = 0; i < mesh->NumberOfVertices(); ++i)
  {
    noise(i, 0) = Testing::GaussianNumber(i, 17);
  }
  noise = Testing::Diffuse(std::make_shared<Assembler>(mesh), PointData::FromValues(noise),
    length * length / 2.0, 8, 0.0, Testing::Scheme::SDIRK2);
  noise.array() -= noise.mean();
  noise *= deviation / std::sqrt(noise.squaredNorm() / static_cast<double>(noise.size()));
  input.Data.Data.Values +=
    Testing::ToInput(*mesh, noise, static_cast<Index>(input.Vertices.rows()));
}

template <typename ModelSettings>
std::vector<Warning> WarningsOf(const RunInput& input, const ModelSettings& settings)
{
  SurfaceDiffusion::Run run(SerialFor());
  StateOf(run, { input.Block() }, settings);
  return run.FindWarnings(Alone);
}

/// Of data in other units, on a surface in other units.
template <typename ModelSettings, typename ModeType>
void ExpectWordsOnSmoothedNoise(ModeType steady)
{
  constexpr double deviation = 250.0;
  RunInput input(Testing::Icosphere(4, 40.0));
  input.Data.Data.Values.setConstant(1000.0);
  AddSmoothedNoise(input, 3.0, deviation);
  ModelSettings settings;
  settings.Mode = steady;
  settings.AutomaticFidelity = true;
  const std::vector<Warning> warnings = WarningsOf(input, settings);
  ASSERT_EQ(warnings.size(), 1u);
  const std::string text = warnings[0].Sentence.Text();
  EXPECT_EQ(text.rfind("NoiseLevel: the data show no white noise", 0), 0u) << text;
  EXPECT_NE(text.find("(set NoiseLevel)"), std::string::npos) << text;
  const auto numberAfter = [&](const std::string& words)
  { return std::stod(text.substr(text.find(words) + words.size())); };
  EXPECT_NEAR(numberAfter("without a signal the noise is "), deviation, 0.001 * deviation);
  EXPECT_LT(numberAfter("its estimate, "), 0.1 * deviation);
  // 3 edges of 40 * 0.0747, times 2.35
  EXPECT_NEAR(numberAfter("smooth over about "), 21.0, 4.0) << text;
  settings.NoiseLevel = deviation;
  for (const Warning& warning : WarningsOf(input, settings))
  {
    EXPECT_EQ(warning.Sentence.Text().find("no white noise"), std::string::npos)
      << warning.Sentence;
  }
}

} // namespace

TEST(AutomaticWeight, OfNoiseWithoutASignalThatWasSmoothedWarnsOnceAndNamesItsDeviation)
{
  ExpectWordsOnSmoothedNoise<HeatSettings>(HeatMode::SteadyState);
  ExpectWordsOnSmoothedNoise<TotalVariationSettings>(TotalVariationMode::SteadyState);
}

TEST(AutomaticWeight, OfWhiteNoiseOnASignalWarnsOfNothing)
{
  HeatSettings heat;
  heat.Mode = HeatMode::SteadyState;
  heat.AutomaticFidelity = true;
  TotalVariationSettings tv;
  tv.Mode = TotalVariationMode::SteadyState;
  tv.AutomaticFidelity = true;
  for (const double sigma : { 0.02, 0.3 })
  {
    RunInput input(Testing::Torus(50, 25));
    for (Eigen::Index i = 0; i < input.Vertices.rows(); ++i)
    {
      input.Data.Data.Values(i, 0) = 0.5 * std::sin(2.0 * input.Vertices(i, 0)) +
        (input.Vertices(i, 1) > 0.4 ? 1.0 : 0.0) + sigma * Testing::GaussianNumber(i, 3);
    }
    EXPECT_TRUE(WarningsOf(input, heat).empty()) << sigma;
    EXPECT_TRUE(WarningsOf(input, tv).empty()) << sigma;
  }
}

//------------------------------------------------------------------------------------------------
namespace
{

/// A cap, blurred with the given width, and noise.
Noisy BlurredCap(int level, double width, double sigma)
{
  const Testing::Surface s = Testing::Icosphere(level);
  Noisy data{ RunInput(s), Vector(s.Vertices.rows()) };
  HeatSettings blur;
  blur.FWHM = width;
  blur.NumberOfTimeSteps = 20;
  for (Eigen::Index i = 0; i < s.Vertices.rows(); ++i)
  {
    data.Clean[i] = s.Vertices(i, 2) > 0.5 ? 1.0 : 0.0;
    data.Input.Data.Data.Values(i, 0) = data.Clean[i];
  }
  SurfaceDiffusion::Run run(SerialFor());
  const Values u = StateOf(run, { data.Input.Block() }, blur);
  for (Eigen::Index i = 0; i < s.Vertices.rows(); ++i)
  {
    data.Input.Data.Data.Values(i, 0) =
      u(run.GetBlock(0).Surface->VertexOf(static_cast<Index>(i)), 0) +
      sigma * Testing::GaussianNumber(i, 7);
  }
  return data;
}

/// With BlurFWHM and the default weight the weight is that of AutomaticFidelity; others are used.
template <typename ModelSettings, typename ModeType>
void ExpectFoundWeight(ModeType steady, double improvement)
{
  constexpr double width = 0.3; // 4.3 h
  const Noisy data = BlurredCap(4, width, 0.02);
  const std::vector<char> everywhere(static_cast<std::size_t>(data.Clean.size()), 1);
  ModelSettings settings;
  settings.Mode = steady;
  settings.Blur.FWHM = width;
  bool warned = false;
  const double byDefault = ErrorOf(data, everywhere, settings, warned);
  const double before = (data.Input.Data.Data.Values.col(0) - data.Clean).norm() /
    std::sqrt(static_cast<double>(data.Clean.size()));
  EXPECT_LT(byDefault, improvement * before);
  SurfaceDiffusion::Run run(SerialFor());
  const Values found = StateOf(run, { data.Input.Block() }, settings);
  const double weight = FindNumber(run.GetBlock(0).Outputs, "EffectiveFidelityWeight");
  settings.AutomaticFidelity = true;
  EXPECT_EQ((StateOf(run, { data.Input.Block() }, settings) - found).norm(), 0.0);
  EXPECT_EQ(FindNumber(run.GetBlock(0).Outputs, "EffectiveFidelityWeight"), weight);
  settings.AutomaticFidelity = false;
  settings.FidelityWeight = 17.0;
  StateOf(run, { data.Input.Block() }, settings);
  EXPECT_DOUBLE_EQ(FindNumber(run.GetBlock(0).Outputs, "EffectiveFidelityWeight"), 17.0);
  settings.Blur.FWHM = 0.0;
  settings.FidelityWeight = ModelSettings().FidelityWeight;
  StateOf(run, { data.Input.Block() }, settings);
  EXPECT_DOUBLE_EQ(
    FindNumber(run.GetBlock(0).Outputs, "EffectiveFidelityWeight"), settings.FidelityWeight);
}

} // namespace

TEST(AutomaticWeight, IsTheDefaultOfTotalVariationDeblurring)
{
  ExpectFoundWeight<TotalVariationSettings>(TotalVariationMode::SteadyState, 0.6);
}

TEST(AutomaticWeight, CanBeTurnedOffToUseTheDefaultWeightOfTotalVariation)
{
  constexpr double width = 0.3;
  const Noisy data = BlurredCap(3, width, 0.02);
  TotalVariationSettings settings;
  settings.Mode = TotalVariationMode::SteadyState;
  settings.Blur.FWHM = width;
  settings.AutomaticBlurFidelity = false;
  SurfaceDiffusion::Run run(SerialFor());
  const Values given = StateOf(run, { data.Input.Block() }, settings);
  EXPECT_EQ(
    FindNumber(run.GetBlock(0).Outputs, "EffectiveFidelityWeight"), settings.FidelityWeight);
  settings.AutomaticBlurFidelity = true;
  EXPECT_GT((StateOf(run, { data.Input.Block() }, settings) - given).norm(), 0.1);
  EXPECT_GT(FindNumber(run.GetBlock(0).Outputs, "EffectiveFidelityWeight"), 10.0);
}

TEST(AutomaticWeight, IsTheDefaultOfTikhonovDeblurring)
{
  ExpectFoundWeight<HeatSettings>(HeatMode::SteadyState, 0.85);
}

// One with edges of .3 of the other's and a tenth of its noise: no search starts from means over both.
TEST(AutomaticWeight, AComponentHasTheResultThatItHasAlone)
{
  const Testing::Surface coarse = Testing::Icosphere(3);
  const Testing::Surface fine =
    Testing::Moved(Testing::Icosphere(4, 0.6), Eigen::RowVector3d(3.0, 0.0, 0.0));
  const auto whole = [](const Testing::Surface& s)
  { return std::vector<char>(static_cast<std::size_t>(s.Vertices.rows()), 1); };
  const Noisy ofCoarse = MakeNoisy(coarse, whole(coarse), 0.2, 0.0, true);
  const Noisy ofFine = MakeNoisy(fine, whole(fine), 0.02, 0.0, true);
  const Testing::Surface both = Testing::Joined(coarse, fine);
  Noisy together = MakeNoisy(both, whole(both), 0.0, 0.0, true);
  together.Input.Data.Data.Values << ofCoarse.Input.Data.Data.Values, ofFine.Input.Data.Data.Values;

  const auto result = [](const Noisy& data, const auto& settings)
  {
    SurfaceDiffusion::Run run(SerialFor());
    const Values u = StateOf(run, { data.Input.Block() }, settings);
    const Surface& surface = *run.GetBlock(0).Surface;
    Vector ofPoints(data.Clean.size());
    for (Eigen::Index i = 0; i < ofPoints.size(); ++i)
    {
      ofPoints[i] = u(surface.VertexOf(static_cast<Index>(i)), 0);
    }
    return ofPoints;
  };
  const auto difference = [&](auto settings)
  {
    settings.AutomaticFidelity = true;
    Vector apart(together.Clean.size());
    apart << result(ofCoarse, settings), result(ofFine, settings);
    return (result(together, settings) - apart).cwiseAbs().maxCoeff();
  };
  HeatSettings heat;
  heat.Mode = HeatMode::SteadyState;
  heat.Tolerance = 1e-10;
  EXPECT_LT(difference(heat), 1e-7);
  TotalVariationSettings tv;
  tv.Mode = TotalVariationMode::SteadyState;
  tv.Units = UnitsMode::Absolute;
  // Up to the tolerance of its minimisers.
  EXPECT_LT(difference(tv), 5e-3);
}

} // namespace SurfaceDiffusion
