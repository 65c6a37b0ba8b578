// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "CellRun.h"
#include "RunInput.h"

#include "Core/Surface/EdgeLengths.h"
#include "Run/HeatSettings.h"
#include "Run/MumfordShahSettings.h"
#include "Run/SegmentationSettings.h"
#include "Run/TextureSettings.h"
#include "Run/TotalVariationSettings.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

// Units and defaults that are found from the surface and the data mean something on any of them.

namespace SurfaceDiffusion
{

namespace
{

using Testing::Alone;
using Testing::RunInput;
using Testing::StateOf;

double Gaussian(Index i, int seed)
{
  const double r = std::sqrt(-2.0 * std::log(1.0 - UniformRandom(seed, 0, i)));
  return r * std::cos(2.0 * Testing::Pi * UniformRandom(seed, 1, i));
}

Testing::Surface Spiky(int level, const Eigen::RowVector3d& spike)
{
  Testing::Surface s = Testing::Icosphere(level);
  s.Vertices.row(20) = spike;
  return s;
}

/// The state at the input's points.
template <typename ModelSettings>
Values AtPoints(SurfaceDiffusion::Run& run, const RunInput& input, const ModelSettings& settings)
{
  const Values u = StateOf(run, { input.Block() }, settings);
  const TriangleMesh& mesh = run.GetBlock(0).Surface->Mesh();
  return Testing::ToInput(mesh, u, static_cast<Index>(input.Vertices.rows()));
}

template <typename ModelSettings>
Values AtPoints(const RunInput& input, const ModelSettings& settings)
{
  SurfaceDiffusion::Run run(SerialFor());
  return AtPoints(run, input, settings);
}

/// How many warnings of a run have these words.
int Count(const SurfaceDiffusion::Run& run, const std::string& words)
{
  int count = 0;
  for (const Warning& warning : run.FindWarnings(Alone))
  {
    count += warning.Sentence.Text().find(words) != std::string::npos;
  }
  return count;
}

/// At points that are not near point 20.
double LargestDifference(const Points& points, const Values& a, const Values& b)
{
  double largest = 0.0;
  for (Eigen::Index i = 0; i < a.rows(); ++i)
  {
    const bool isNear = (points.row(i) - points.row(20)).norm() < 0.5;
    largest = std::max(largest, isNear ? 0.0 : (a.row(i) - b.row(i)).cwiseAbs().maxCoeff());
  }
  return largest;
}

double RootMeanSquare(const Values& u)
{
  return u.norm() / std::sqrt(static_cast<double>(u.size()));
}

} // namespace

//------------------------------------------------------------------------------------------------
TEST(DefaultUnits, MeanEdgeLengthIsThatOfTheSurfaceWithoutItsSpikes)
{
  for (const int level : { 2, 4 })
  {
    const TriangleMesh even(Testing::Icosphere(level).Vertices, Testing::Icosphere(level).Faces);
    const double h = even.MeanEdgeLength() * even.LengthUnit();
    EXPECT_EQ(CountLongEdges(even), 0.0);
    EXPECT_EQ(even.NumberOfEdges(), even.NumberOfTriangles() * 3 / 2);
    for (const double unit : { 1.0, 1e-3, 1e3 })
    {
      const Testing::Surface s = Testing::Scaled(Spiky(level, { 1e4, 0.0, 0.0 }), unit);
      const TriangleMesh mesh(s.Vertices, s.Faces);
      EXPECT_NEAR(mesh.MeanEdgeLength() * mesh.LengthUnit() / unit / h, 1.0, 1e-2);
      EXPECT_EQ(
        CountLongEdges(mesh), static_cast<double>(even.NumberOfEdges() - mesh.NumberOfEdges()));
      EXPECT_TRUE(CountLongEdges(mesh) == 5.0 || CountLongEdges(mesh) == 6.0);
      const Testing::Surface other =
        Testing::Renumbered(s, Testing::Permutation(static_cast<Index>(s.Vertices.rows()), 3));
      const TriangleMesh renumbered(other.Vertices, other.Faces);
      EXPECT_NEAR(renumbered.MeanEdgeLength() / mesh.MeanEdgeLength(), 1.0, 1e-13);
    }
  }
}

TEST(DefaultUnits, LongEdgesThatAreManyOrNotThirtyTimesTheMedianCount)
{
  const Testing::Surface cylinder = Testing::Cylinder(400, 3, 1.0, 30.0); // edges of .016 and 10
  const Testing::Surface spike = Spiky(4, Testing::Icosphere(4).Vertices.row(20) * 2.0);
  for (const Testing::Surface& s : { cylinder, spike })
  {
    const TriangleMesh mesh(s.Vertices, s.Faces);
    EXPECT_EQ(CountLongEdges(mesh), 0.0);
    EXPECT_EQ(MeasureEdgeLengths(mesh, Alone).Number, static_cast<double>(mesh.NumberOfEdges()));
    EXPECT_NEAR(
      MeasureEdgeLengths(mesh, Alone).Sum, mesh.TotalEdgeLength(), 1e-12 * mesh.TotalEdgeLength());
  }
}

TEST(DefaultUnits, ASpikeHardlyChangesTheRestAndIsOneWarning)
{
  RunInput even(Testing::Icosphere(4));
  RunInput spiky(Spiky(4, { 1e4, 0.0, 0.0 }));
  spiky.Data = even.Data;
  const auto compare = [&](const auto& settings, double bound)
  {
    SurfaceDiffusion::Run run(SerialFor());
    const Values without = AtPoints(even, settings);
    EXPECT_LT(LargestDifference(even.Vertices, AtPoints(run, spiky, settings), without), bound);
    EXPECT_EQ(Count(run, "longer than 30 times the median edge"), 1);
    EXPECT_EQ(run.FindWarnings(Alone).size(), 1u);
  };
  // What the spike changes nearby: it was .3 and more everywhere.
  compare(HeatSettings(), 0.1);
  TotalVariationSettings variation;
  variation.AutomaticFidelity = false; // errors count by area, of which the spike has the most
  compare(variation, 0.1);
  SurfaceDiffusion::Run run(SerialFor());
  HeatSettings absolute;
  absolute.FWHM = 0.3;
  AtPoints(run, spiky, absolute);
  EXPECT_EQ(Count(run, "longer than 30 times"), 0) << "h has no effect";
}

//------------------------------------------------------------------------------------------------
TEST(DefaultUnits, AnOutlierHardlyChangesTheRest)
{
  for (const double unit : { 1.0, 1e-4, 1e4 })
  {
    RunInput input(Testing::Icosphere(4));
    Values clean(input.Vertices.rows(), 1);
    for (Eigen::Index i = 0; i < clean.rows(); ++i)
    {
      clean(i, 0) = unit * (input.Vertices(i, 2) > 0.3 ? 1.0 : 0.0);
      input.Data.Data.Values(i, 0) = clean(i, 0) + 0.1 * unit * Gaussian(static_cast<Index>(i), 4);
    }
    const TotalVariationSettings settings;
    const Values without = AtPoints(input, settings);
    input.Data.Data.Values(20, 0) = 50.0 * unit;
    SurfaceDiffusion::Run run(SerialFor());
    const Values with = AtPoints(run, input, settings);
    EXPECT_EQ(Count(run, "the values have outliers: the range R"), 1);
    Values difference = (with - without) / unit;
    difference(20, 0) = 0.0;
    EXPECT_LT(RootMeanSquare(difference), 0.05) << unit; // .28 with the range of the outlier
  }
}

TEST(DefaultUnits, TheRangeOfAMapThatIsZeroAlmostEverywhereIsItsOwn)
{
  RunInput input(Testing::Icosphere(4));
  input.Data.Data.Values.setZero();
  input.Data.Data.Values(7, 0) = 3.0;
  SurfaceDiffusion::Run run(SerialFor());
  TotalVariationSettings settings;
  settings.AutomaticFidelity = false; // there is no noise
  StateOf(run, { input.Block() }, settings);
  EXPECT_EQ(run.Units().ValueRange, 3.0);
  EXPECT_TRUE(run.FindWarnings(Alone).empty());
}

//------------------------------------------------------------------------------------------------
TEST(DefaultUnits, TexturesOfCoarseSurfacesHaveASizeOfTheSurface)
{
  for (const double unit : { 1.0, 1e3 })
  {
    RunInput coarse(Testing::Scaled(Testing::Icosphere(3), unit)); // 25 edges across
    coarse.Data.Data.Values.resize(0, 0);
    SurfaceDiffusion::Run run(SerialFor());
    StateOf(run, { coarse.Block() }, TextureSettings());
    const std::vector<Output>& numbers = run.GetBlock(0).Result.Numbers;
    const auto found = std::find_if(numbers.begin(), numbers.end(),
      [](const Output& number) { return number.Name == "Wavelength"; });
    ASSERT_NE(found, numbers.end());
    EXPECT_NEAR(found->Rows(0, 0), unit * std::sqrt(4.0 * Testing::Pi) / 8.0, 0.02 * unit);
    EXPECT_EQ(run.FindWarnings(Alone).size(), 1u);
    EXPECT_EQ(Count(run, "RefineTo"), 1);
  }
  RunInput given(Testing::Icosphere(3));
  given.Data.Data.Values.resize(0, 0);
  TextureSettings settings;
  settings.DiffusionRate1 = 22.0; // given rates stay
  SurfaceDiffusion::Run run(SerialFor());
  StateOf(run, { given.Block() }, settings);
  EXPECT_EQ(Count(run, "RefineTo"), 0);
}

TEST(DefaultUnits, APatternThatDidNotGrowIsSaidAndItsTextureIsUniform)
{
  RunInput input(Testing::Subdivided(Testing::Tetrahedron(), 2));
  input.Data.Data.Values.resize(0, 0);
  TextureSettings settings;
  settings.FeatureSize = 40.0; // of a surface of about 3
  SurfaceDiffusion::Run run(SerialFor());
  StateOf(run, { input.Block() }, settings);
  EXPECT_EQ(Count(run, "no pattern has grown after"), 1);
  for (const Output& output : run.GetBlock(0).Outputs)
  {
    if (output.Name == "Texture")
    {
      EXPECT_EQ(output.Rows.minCoeff(), output.Rows.maxCoeff());
    }
  }
}

//------------------------------------------------------------------------------------------------
TEST(DefaultUnits, AWidthIsReachedInOneStepByDefault)
{
  RunInput input(Testing::Icosphere(4));
  input.Data.Data.Values.setZero();
  input.Data.Data.Values(30, 0) = 1.0;
  HeatSettings settings;
  settings.FWHM = 0.3;
  settings.NumberOfTimeSteps = 1;
  SurfaceDiffusion::Run run(SerialFor());
  const Values one = AtPoints(run, input, settings);
  EXPECT_TRUE(run.FindWarnings(Alone).empty());
  EXPECT_GT(one.minCoeff(), -1e-3 * one.maxCoeff());
  settings.NumberOfTimeSteps = 20;
  const Values many = AtPoints(input, settings);
  EXPECT_LT((one - many).cwiseAbs().maxCoeff(), 0.01 * many.maxCoeff());
  for (const TimeIntegrator integrator :
    { TimeIntegrator::FirstOrder, TimeIntegrator::SecondOrder })
  {
    for (const int steps : { 1, 3, 4 })
    {
      settings.TimeIntegrator = integrator;
      settings.NumberOfTimeSteps = steps;
      SurfaceDiffusion::Run few(SerialFor());
      AtPoints(few, input, settings);
      EXPECT_EQ(Count(few, "misses the blur of FWHM"), steps < 4) << steps;
    }
  }
  HeatSettings steps;
  HeatSettings secondOrder;
  secondOrder.TimeIntegrator = TimeIntegrator::SecondOrder;
  EXPECT_EQ(AtPoints(input, steps), AtPoints(input, secondOrder)) << "without a width";
}

//------------------------------------------------------------------------------------------------
namespace
{

/// Two columns, sin 3x with noise .1 and 200 sin 3x with noise 20, on two spheres of other sizes, of
/// which the second has a quarter of the noise.
struct TwoByTwo
{
  RunInput Both, First, Second;

  TwoByTwo()
    : Both(Testing::Joined(
        Testing::Icosphere(4), Testing::Moved(Testing::Icosphere(3, 0.5), { 5.0, 0.0, 0.0 })))
    , First(Testing::Icosphere(4))
    , Second(Testing::Moved(Testing::Icosphere(3, 0.5), { 5.0, 0.0, 0.0 }))
  {
    const Eigen::Index first = this->First.Vertices.rows();
    Values f(this->Both.Vertices.rows(), 2);
    for (Eigen::Index i = 0; i < f.rows(); ++i)
    {
      const double noise = i < first ? 0.1 : 0.025;
      for (int k = 0; k < 2; ++k)
      {
        f(i, k) = (k == 0 ? 1.0 : 200.0) *
          (std::sin(3.0 * this->Both.Vertices(i, 1)) + noise * Gaussian(static_cast<Index>(i), k));
      }
    }
    this->Both.Data.Data.Values = f;
    this->First.Data.Data.Values = f.topRows(first);
    this->Second.Data.Data.Values = f.bottomRows(f.rows() - first);
  }

  template <typename ModelSettings>
  void ExpectAlike(const ModelSettings& settings, double bound) const
  {
    const Values together = AtPoints(this->Both, settings);
    for (const RunInput* const part : { &this->First, &this->Second })
    {
      for (int k = 0; k < 2; ++k)
      {
        RunInput alone = *part;
        alone.Data.Data.Values = part->Data.Data.Values.col(k).eval();
        const Values u = AtPoints(alone, settings);
        const Values same = part == &this->First ? together.col(k).topRows(u.rows())
                                                 : together.col(k).bottomRows(u.rows());
        EXPECT_LT(RootMeanSquare(same - u), bound * RootMeanSquare(u))
          << (part == &this->First) << ' ' << k;
      }
    }
  }
};

} // namespace

TEST(DefaultUnits, EachColumnAndComponentHasTheWeightThatItHasAlone)
{
  const TwoByTwo data;
  HeatSettings heat;
  heat.Mode = HeatMode::SteadyState;
  heat.AutomaticFidelity = true;
  data.ExpectAlike(heat, 1e-3); // the search ends at 1 % of the weight
  heat.Mode = HeatMode::TimeSteps;
  heat.Units = UnitsMode::Absolute;
  heat.TimeStep = 0.01;
  data.ExpectAlike(heat, 1e-3);
  TotalVariationSettings tv;
  tv.Mode = TotalVariationMode::SteadyState;
  tv.AutomaticFidelity = true;
  tv.ChannelCoupling = ChannelCoupling::PerChannel;
  data.ExpectAlike(tv, 2e-3);
}

TEST(DefaultUnits, NoticesAboutWeightsOfManyComponentsAreOneLine)
{
  Testing::Surface s = Testing::Icosphere(2);
  for (int c = 1; c < 4; ++c)
  {
    s = Testing::Joined(s, Testing::Moved(Testing::Icosphere(2), { 3.0 * c, 0.0, 0.0 }));
  }
  RunInput input(s);
  input.Data.Data.Values = input.Vertices.col(2); // without noise
  HeatSettings settings;
  settings.Mode = HeatMode::SteadyState;
  settings.AutomaticFidelity = true;
  SurfaceDiffusion::Run run(SerialFor());
  StateOf(run, { input.Block() }, settings);
  EXPECT_LE(run.FindWarnings(Alone).size(), 2u);
}

//------------------------------------------------------------------------------------------------
TEST(DefaultUnits, TheWeightOfDataOnCellsDoesNotDependOnTheirOrder)
{
  const Testing::Surface s = Testing::Icosphere(4);
  TotalVariationSettings settings;
  settings.Mode = TotalVariationMode::SteadyState;
  settings.AutomaticFidelity = true;
  const auto weightOf = [&](const std::vector<Index>& order, double noiseLevel)
  {
    Testing::Surface ordered = s;
    for (Eigen::Index t = 0; t < s.Faces.rows(); ++t)
    {
      ordered.Faces.row(t) = s.Faces.row(order[static_cast<std::size_t>(t)]);
    }
    Testing::CellInput input(ordered);
    input.SetData(
      [&](Index c, const Eigen::RowVector3d& x) {
        return 0.5 * std::sin(2.0 * x[2]) + 0.3 * Gaussian(order[static_cast<std::size_t>(c)], 5);
      });
    settings.NoiseLevel = noiseLevel;
    SurfaceDiffusion::Run run(SerialFor());
    StateOf(run, { input.Block() }, settings);
    const std::vector<Output>& numbers = run.GetBlock(0).Result.Numbers;
    return std::find_if(numbers.begin(), numbers.end(),
      [](const Output& number) { return number.Name == "EffectiveFidelityWeight"; })
      ->Rows(0, 0);
  };
  const auto count = static_cast<Index>(s.Faces.rows());
  const double given = weightOf(Testing::Permutation(count, 1), 0.3);
  for (const int seed : { 1, 2, 3, 4 })
  {
    const double found = weightOf(Testing::Permutation(count, seed), 0.0);
    EXPECT_NEAR(found / given, 1.0, 0.2) << seed; // .4 to .55 with a sample of noise
    EXPECT_NEAR(found / weightOf(Testing::Permutation(count, 9), 0.0), 1.0, 0.02);
  }
}

//------------------------------------------------------------------------------------------------
TEST(DefaultUnits, RegionsUnderStrongNoiseAreThoseOfTheTrueMeans)
{
  for (const double waves : { 2.0, 3.0, 4.0 })
  {
    for (const double noise : { 0.3, 1.0, 1.5 })
    {
      RunInput input(Testing::Icosphere(5));
      const auto isHigh = [&](Eigen::Index i)
      { return std::sin(waves * input.Vertices(i, 0)) > 0.2; };
      for (Eigen::Index i = 0; i < input.Vertices.rows(); ++i)
      {
        input.Data.Data.Values(i, 0) =
          (isHigh(i) ? 1.0 : 0.0) + noise * Gaussian(static_cast<Index>(i), 6);
      }
      const auto wrongWith = [&](const SegmentationSettings& settings)
      {
        SurfaceDiffusion::Run run(SerialFor());
        const Values u = AtPoints(run, input, settings);
        EXPECT_TRUE(run.FindWarnings(Alone).empty());
        double wrong = 0.0;
        for (Eigen::Index i = 0; i < u.rows(); ++i)
        {
          wrong += (u(i, 1) > 0.5) != isHigh(i) ? 1.0 : 0.0;
        }
        return wrong / static_cast<double>(u.rows());
      };
      SegmentationSettings given;
      given.AutomaticMeans = false;
      given.Means = { 0.0, 1.0 };
      EXPECT_LT(wrongWith(SegmentationSettings()), 0.01 + 1.2 * wrongWith(given))
        << waves << ' ' << noise;
    }
  }
}

TEST(DefaultUnits, RegionsOfManySmallPartsTakeFewIterations)
{
  Testing::Surface s = Testing::Icosphere(1);
  for (int c = 1; c < 64; ++c)
  {
    s = Testing::Joined(s,
      Testing::Moved(Testing::Icosphere(1), { 3.0 * (c % 4), 3.0 * (c / 4 % 4), 3.0 * (c / 16) }));
  }
  for (const double noise : { 0.0, 0.1 })
  {
    RunInput input(s);
    for (Eigen::Index i = 0; i < input.Vertices.rows(); ++i)
    {
      const double z = input.Vertices(i, 2);
      input.Data.Data.Values(i, 0) = (z - 3.0 * std::floor(z / 3.0) > 0.3 ? 1.0 : 0.0) +
        noise * Gaussian(static_cast<Index>(i), 8);
    }
    SurfaceDiffusion::Run run(SerialFor());
    StateOf(run, { input.Block() }, SegmentationSettings());
    EXPECT_LT(run.GetBlock(0).Path->Records().back().Iterations, 3000) << noise; // 18,060
  }
}

} // namespace SurfaceDiffusion
