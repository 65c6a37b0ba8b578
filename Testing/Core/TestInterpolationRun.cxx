// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Geometry/NearestPoints.h"
#include "Meshes.h"
#include "Run/Solve.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>
#include <numeric>
#include <string>

using namespace SurfaceDiffusion;
using Testing::Icosphere;
using Testing::Joined;
using Testing::Moved;
using Testing::Strip;
using TestSurface = Testing::Surface;

namespace
{

constexpr double NaN = std::numeric_limits<double>::quiet_NaN();

double Field(const Eigen::RowVector3d& x)
{
  return 3.0 + x[2] * x[2] + 0.5 * x[0];
}

Values FieldAt(const TestSurface& s)
{
  Values f(s.Vertices.rows(), 1);
  for (Eigen::Index i = 0; i < f.rows(); ++i)
  {
    f(i, 0) = Field(s.Vertices.row(i));
  }
  return f;
}

/// The field at every `step`-th point, and NaN elsewhere.
Values Sparse(const TestSurface& s, Eigen::Index step)
{
  Values f = FieldAt(s);
  for (Eigen::Index i = 0; i < f.rows(); ++i)
  {
    f(i, 0) = i % step == 0 ? f(i, 0) : NaN;
  }
  return f;
}

/// The field at these points.
Fields SamplesOf(const Points& places)
{
  auto samples = std::make_shared<PointSamples>();
  samples->Places = places;
  samples->Name = "Probe";
  samples->Given.resize(places.rows(), 1);
  for (Eigen::Index i = 0; i < places.rows(); ++i)
  {
    samples->Given(i, 0) = Field(places.row(i));
  }
  Fields fields;
  fields.Samples = std::move(samples);
  return fields;
}

InterpolationSettings Exact()
{
  InterpolationSettings settings;
  settings.Exact = true;
  return settings;
}

Solution Fitted(const TestSurface& s, const Fields& fields, const InterpolationSettings& settings)
{
  return Interpolate(s.Vertices, s.Faces, fields, settings);
}

std::string ErrorOf(
  const TestSurface& s, const Fields& fields, const InterpolationSettings& settings)
{
  try
  {
    Fitted(s, fields, settings);
  }
  catch (const std::runtime_error& error)
  {
    return error.what();
  }
  return "";
}

bool Warns(const Solution& solution, const std::string& text)
{
  return std::any_of(solution.Warnings.begin(), solution.Warnings.end(),
    [&](const std::string& warning) { return warning.find(text) != std::string::npos; });
}

} // namespace

TEST(InterpolationRun, HoldsTheKnownValuesOfPoints)
{
  const TestSurface s = Icosphere(3);
  const Values f = FieldAt(s);
  const Values sparse = Sparse(s, 9);
  const Solution solution = Interpolate(s.Vertices, s.Faces, sparse, Exact());
  ASSERT_EQ(solution.Result.rows(), f.rows());
  for (Eigen::Index i = 0; i < f.rows(); i += 9)
  {
    EXPECT_NEAR(solution.Result(i, 0), f(i, 0), 1e-12);
  }
  EXPECT_LT((solution.Result - f).cwiseAbs().maxCoeff(), 0.03);
  EXPECT_EQ(solution.Numbers.at("NumberOfValues")(0, 0), (f.rows() + 8) / 9);
  EXPECT_EQ(solution.Numbers.at("EffectiveSmoothing")(0, 0), 0.0);
  EXPECT_TRUE(solution.Warnings.empty());
}

TEST(InterpolationRun, HoldsSamplesAtTheirNearestPoints)
{
  const TestSurface s = Icosphere(3);
  Points places(60, 3);
  for (Eigen::Index i = 0; i < places.rows(); ++i)
  {
    const double z = -0.98 + 1.96 * static_cast<double>(i) / 59.0;
    const double r = std::sqrt(1.0 - z * z);
    places.row(i) << 1.2 * r * std::cos(2.4 * i), 1.2 * r * std::sin(2.4 * i), 1.2 * z;
  }
  const Fields fields = SamplesOf(places);
  const Solution solution = Fitted(s, fields, Exact());
  const NearestPoints nearest(s.Vertices, s.Faces);
  for (Eigen::Index i = 0; i < places.rows(); ++i)
  {
    const NearestPoint found = nearest.Find(places.row(i));
    double u = 0.0;
    for (int a = 0; a < 3; ++a)
    {
      u += found.Coordinates[static_cast<std::size_t>(a)] *
        solution.Result(s.Faces(found.Triangle, a), 0);
    }
    EXPECT_NEAR(u, fields.Samples->Given(i, 0), 1e-9);
  }
  EXPECT_EQ(solution.Arrays.count("Interpolated"), 1U);
}

TEST(InterpolationRun, GivesSamplesAtPointsTheBitsOfData)
{
  const TestSurface s = Icosphere(3);
  Points places(0, 3);
  for (Eigen::Index i = 0; i < s.Vertices.rows(); i += 7)
  {
    places.conservativeResize(places.rows() + 1, 3);
    places.row(places.rows() - 1) = s.Vertices.row(i);
  }
  for (const bool exact : { true, false })
  {
    InterpolationSettings settings = Exact();
    settings.Exact = exact;
    EXPECT_EQ(Fitted(s, SamplesOf(places), settings).Result,
      Interpolate(s.Vertices, s.Faces, Sparse(s, 7), settings).Result);
  }
}

TEST(InterpolationRun, HoldsTheValuesOfTriangles)
{
  const TestSurface s = Icosphere(3);
  Fields fields;
  fields.Data.OnCells = true;
  fields.Data.Values = Values::Constant(s.Faces.rows(), 1, NaN);
  for (Eigen::Index t = 0; t < s.Faces.rows(); t += 11)
  {
    const Eigen::RowVector3d middle =
      (s.Vertices.row(s.Faces(t, 0)) + s.Vertices.row(s.Faces(t, 1)) +
        s.Vertices.row(s.Faces(t, 2))) /
      3.0;
    fields.Data.Values(t, 0) = Field(middle);
  }
  const Solution solution = Fitted(s, fields, Exact());
  ASSERT_EQ(solution.Result.rows(), s.Faces.rows());
  EXPECT_TRUE(solution.Result.allFinite());
  for (Eigen::Index t = 0; t < s.Faces.rows(); t += 11)
  {
    EXPECT_NEAR(solution.Result(t, 0), fields.Data.Values(t, 0), 1e-9);
  }
}

TEST(InterpolationRun, HoldsLinearFunctionsOnPolygonsHoweverTheyAreCut)
{
  TestSurface s{ Points(36, 3), Triangles(50, 3) };
  Fields fields;
  fields.Data.OnCells = true;
  fields.NumberOfCells = 25;
  fields.Data.Values.resize(25, 1);
  for (Index i = 0; i < 36; ++i)
  {
    const double y = i % 6 * (1.0 + 0.3 * (i / 6));
    s.Vertices.row(i) << i / 6, y, 0.5 * y;
  }
  for (Index c = 0; c < 25; ++c)
  {
    const Index a = 6 * (c / 5) + c % 5;
    const bool turned = c % 2 == 1;
    s.Faces.row(2 * c) << a, a + 6, (turned ? a + 1 : a + 7);
    s.Faces.row(2 * c + 1) << (turned ? a + 6 : a), a + 7, a + 1;
    fields.Cells.insert(fields.Cells.end(), 2, c);
    Eigen::RowVector3d moment = Eigen::RowVector3d::Zero();
    double area = 0.0;
    for (Index t = 2 * c; t < 2 * c + 2; ++t)
    {
      const Points p = s.Vertices(s.Faces.row(t), Eigen::all);
      const double size = (p.row(1) - p.row(0)).cross(p.row(2) - p.row(0)).norm();
      moment += size * p.colwise().mean();
      area += size;
    }
    fields.Data.Values(c, 0) = moment[0] / area + 2.0 * moment[1] / area;
  }
  InterpolationSettings settings = Exact();
  settings.Boundary = RimCondition::Free;
  const Values found = Fitted(s, fields, settings).Result;
  EXPECT_LT((found - fields.Data.Values).cwiseAbs().maxCoeff(), 1e-8);
  fields.GivenCells.resize(25); // as if they had been cut
  std::iota(fields.GivenCells.begin(), fields.GivenCells.end(), 0);
  EXPECT_EQ(Fitted(s, fields, settings).Result, found);
}

TEST(InterpolationRun, WeighsTheValuesOfTrianglesByFactorsOfPointsToo)
{
  const TestSurface s = Icosphere(2);
  Fields fields;
  fields.Data.OnCells = true;
  fields.Data.Values = Values::Constant(s.Faces.rows(), 1, 1.0);
  fields.Data.Values.topRows(s.Faces.rows() / 2).setConstant(5.0);
  InterpolationSettings settings;
  settings.AutomaticSmoothing = false;
  settings.Smoothing = 0.1;
  const Values plain = Fitted(s, fields, settings).Result;
  fields.FidelityFactors.Values.assign(static_cast<std::size_t>(s.Vertices.rows()), 4.0);
  settings.Smoothing = 0.4; // the same minimum
  EXPECT_LT((Fitted(s, fields, settings).Result - plain).cwiseAbs().maxCoeff(), 1e-9);
}

TEST(InterpolationRun, CountsFarSamplesAndLeavesThemOut)
{
  const TestSurface s = Icosphere(2);
  Points places(6, 3);
  places << s.Vertices.topRows(5), 9.0, 0.0, 0.0;
  InterpolationSettings settings = Exact();
  settings.MaximumDistance = 0.5;
  const Solution solution = Fitted(s, SamplesOf(places), settings);
  EXPECT_EQ(solution.Numbers.at("NumberOfFarValues")(0, 0), 1.0);
  EXPECT_EQ(solution.Numbers.at("NumberOfValues")(0, 0), 5.0);
  EXPECT_TRUE(Warns(solution, "1 value is farther from the surface than MaximumDistance 0.5"));
  EXPECT_EQ(solution.Result, Fitted(s, SamplesOf(places.topRows(5)), Exact()).Result);
  EXPECT_NE(ErrorOf(s, SamplesOf(places.bottomRows(1)), settings).find("MaximumDistance 0.5"),
    std::string::npos);
}

TEST(InterpolationRun, LeavesOutSamplesOutsideOfTheMask)
{
  const TestSurface s = Icosphere(3);
  Fields fields = SamplesOf(s.Vertices.topRows(30));
  Index inside = 0;
  for (Eigen::Index i = 0; i < s.Vertices.rows(); ++i)
  {
    fields.Mask.Values.push_back(s.Vertices(i, 2) < 0.0);
    inside += i < 30 && s.Vertices(i, 2) >= 0.0;
  }
  InterpolationSettings settings = Exact();
  settings.MaskMode = MaskMode::Exclude;
  const Solution solution = Fitted(s, fields, settings);
  EXPECT_GT(inside, 5);
  EXPECT_LT(solution.Numbers.at("NumberOfValues")(0, 0), 30.0);
  EXPECT_TRUE(Warns(solution, "excludes the surface, and left out"));
  for (Eigen::Index i = 0; i < s.Vertices.rows(); ++i)
  {
    EXPECT_EQ(std::isnan(solution.Result(i, 0)), s.Vertices(i, 2) < 0.0);
  }
}

TEST(InterpolationRun, IsNaNOnComponentsWithoutValues)
{
  const TestSurface ball = Icosphere(2);
  const TestSurface s = Joined(ball, Moved(Icosphere(1), { 5.0, 0.0, 0.0 }));
  InterpolationSettings settings = Exact();
  settings.ComputeError = true;
  const Solution solution = Fitted(s, SamplesOf(ball.Vertices.topRows(9)), settings);
  const Eigen::Index n = ball.Vertices.rows();
  for (const char* const name : { "Interpolated", "Error" })
  {
    const Values& found = solution.Arrays.at(name);
    EXPECT_TRUE(found.topRows(n).allFinite()) << name;
    EXPECT_TRUE(found.bottomRows(s.Vertices.rows() - n).array().isNaN().all()) << name;
  }
  EXPECT_TRUE(Warns(solution, "1 connected component has no known value"));
}

TEST(InterpolationRun, HasNoStandardErrorWhereTheValuesDoNotShowOne)
{
  const TestSurface s = Icosphere(2);
  const auto errorOf = [&](const Fields& fields, InterpolationSettings settings)
  {
    settings.ComputeError = true;
    const Solution solution = Fitted(s, fields, settings);
    const Values& error = solution.Arrays.at("Error");
    const bool isKnown = error.allFinite() && error.maxCoeff() > 0.0;
    EXPECT_TRUE(isKnown || error.array().isNaN().any());
    EXPECT_NE(isKnown, Warns(solution, "the standard errors are NaN"));
    return isKnown;
  };
  Fields constant = SamplesOf(s.Vertices.topRows(9));
  auto alike = std::make_shared<PointSamples>(*constant.Samples);
  alike->Given.setConstant(7.3);
  constant.Samples = alike;
  const Fields one = SamplesOf(s.Vertices.topRows(1));
  const Fields nine = SamplesOf(s.Vertices.topRows(9));
  InterpolationSettings smooth;
  smooth.AutomaticSmoothing = false;
  InterpolationSettings noisy;
  noisy.NoiseLevel = 0.1;
  EXPECT_FALSE(errorOf(one, Exact()));
  EXPECT_FALSE(errorOf(one, smooth));
  EXPECT_FALSE(errorOf(constant, Exact()));
  EXPECT_FALSE(errorOf(constant, InterpolationSettings()));
  EXPECT_FALSE(errorOf(constant, smooth));
  EXPECT_TRUE(errorOf(one, noisy));
  EXPECT_TRUE(errorOf(constant, noisy));
  EXPECT_TRUE(errorOf(nine, Exact()));
  EXPECT_TRUE(errorOf(nine, smooth));
  smooth.Smoothing = 1e-12; // as good as exact, and nothing is left of the values
  EXPECT_FALSE(errorOf(nine, smooth));
  auto light = std::make_shared<PointSamples>(*nine.Samples);
  light->Weights.assign(9, 1e-26);
  Fields weighted = nine;
  weighted.Samples = light;
  EXPECT_TRUE(errorOf(weighted, InterpolationSettings()));
  const Fields all = SamplesOf(s.Vertices);
  InterpolationSettings exact = Exact();
  exact.ComputeError = true;
  EXPECT_TRUE(Fitted(s, all, exact).Arrays.at("Error").isZero(0.0)); // known everywhere
}

TEST(InterpolationRun, WarnsOfPointsInAnotherUnit)
{
  const TestSurface s = Icosphere(2);
  const Points near = 1.1 * s.Vertices.topRows(9);
  EXPECT_FALSE(Warns(Fitted(s, SamplesOf(near), Exact()), "their unit or origin"));
  for (const double unit : { 0.001, 1000.0 })
  {
    EXPECT_TRUE(Warns(Fitted(s, SamplesOf(unit * near), Exact()), "their unit or origin"));
    InterpolationSettings filtered = Exact();
    filtered.MaximumDistance = 1e6;
    EXPECT_FALSE(Warns(Fitted(s, SamplesOf(unit * near), filtered), "their unit or origin"));
  }
}

TEST(InterpolationRun, ReportsHowFarPointsAreAndByWhichShift)
{
  const Points places = 25.0 * Icosphere(2).Vertices.topRows(60);
  for (const Eigen::RowVector3d& by :
    { Eigen::RowVector3d(30.0, 0.0, 0.0), Eigen::RowVector3d(-10.0, 8.0, 12.0) })
  {
    TestSurface s = Icosphere(4);
    s.Vertices *= 25.0;
    EXPECT_FALSE(Warns(Fitted(s, SamplesOf(places), Exact()), "from the surface"));
    const Solution shifted = Fitted(s, SamplesOf(places.rowwise() + by), Exact());
    EXPECT_TRUE(Warns(shifted, "set MaximumDistance to leave out those beyond it"));
    EXPECT_TRUE(Warns(shifted, "; a shift by ("));
    EXPECT_GT(shifted.Numbers.at("MedianDistance")(0, 0), 3.0);
    EXPECT_GT(shifted.Numbers.at("LargestDistance")(0, 0), 0.9 * by.norm());
  }
  const TestSurface s = Icosphere(3);
  Points one(11, 3);
  one << s.Vertices.topRows(10), 51.0, 0.0, 0.0;
  const Solution far = Fitted(s, SamplesOf(one), Exact());
  EXPECT_TRUE(Warns(far, "1 of 11 points with values is farther than"));
  EXPECT_FALSE(Warns(far, "a shift by"));
  EXPECT_NEAR(far.Numbers.at("LargestDistance")(0, 0), 50.0, 0.01);
  EXPECT_LT(far.Numbers.at("MedianDistance")(0, 0), 1e-12);
}

TEST(InterpolationRun, AsksForNumbersThatStandForNoValue)
{
  const TestSurface s = Icosphere(3);
  for (const double sentinel :
    { -10000.0, -9999.0, -999.0, 1e20, 9.969209968386869e36, static_cast<double>(9.96921e36F) })
  {
    Fields points = SamplesOf(s.Vertices.topRows(40));
    auto samples = std::make_shared<PointSamples>(*points.Samples);
    samples->Given(3, 0) = samples->Given(17, 0) = sentinel;
    points.Samples = samples;
    EXPECT_TRUE(Warns(Fitted(s, points, Exact()), "2 values of the points are ")) << sentinel;
    samples = std::make_shared<PointSamples>(*samples);
    samples->Given(3, 0) = samples->Given(17, 0) = NaN;
    points.Samples = samples;
    const Solution withNaN = Fitted(s, points, Exact());
    EXPECT_TRUE(withNaN.Warnings.empty());
    samples = std::make_shared<PointSamples>(*samples);
    samples->Given(3, 0) = samples->Given(17, 0) = sentinel;
    points.Samples = samples;
    InterpolationSettings missing = Exact();
    missing.MissingValue = { 7.5, sentinel };
    const Solution withMissing = Fitted(s, points, missing);
    EXPECT_TRUE(withMissing.Warnings.empty());
    EXPECT_EQ(withMissing.Result, withNaN.Result);
    Values f = FieldAt(s);
    f(5, 0) = sentinel;
    const Solution heat = Heat(s.Vertices, s.Faces, f, HeatSettings());
    EXPECT_TRUE(Warns(heat, "1 value of Data is ")) << sentinel;
    EXPECT_TRUE(
      Warns(Derivative(s.Vertices, s.Faces, f, DerivativesSettings()), "1 value of Data is "))
      << sentinel;
  }
  Values depths = 6000.0 * FieldAt(s); // a value among others
  depths.array() -= 22000.0;
  depths(5, 0) = -9999.0;
  EXPECT_FALSE(Warns(Interpolate(s.Vertices, s.Faces, depths, Exact()), "stands for no value"));
}

TEST(InterpolationRun, WarnsOfCorrelatedNoiseAndNotOfSmoothFunctions)
{
  const TestSurface s = Icosphere(4);
  const Eigen::Index most = 640;
  const std::vector<Index> order = Testing::Permutation(s.NumberOfVertices(), 3);
  Points places(most, 3);
  Values white(most, 1);
  Values correlated(most, 1);
  Values wave(most, 1);
  for (Eigen::Index i = 0; i < most; ++i)
  {
    places.row(i) = s.Vertices.row(order[static_cast<std::size_t>(i)]);
    white(i, 0) = 0.6 * UniformRandom(5, 0, i);
    wave(i, 0) = std::sin(3.0 * places(i, 0) + places(i, 1));
    correlated(i, 0) = 0.0;
    for (Eigen::Index j = 0; j < s.Vertices.rows(); ++j) // over some distances of values
    {
      const double square = (places.row(i) - s.Vertices.row(j)).squaredNorm();
      correlated(i, 0) +=
        0.05 * std::exp(-0.5 * square / std::pow(0.12, 2)) * (UniformRandom(6, 0, j) - 0.5);
    }
  }
  const auto fitted =
    [&](const Values& added, const InterpolationSettings& settings, Eigen::Index count)
  {
    Fields fields = SamplesOf(places.topRows(count));
    auto samples = std::make_shared<PointSamples>(*fields.Samples);
    samples->Given += added.topRows(count);
    fields.Samples = samples;
    return Fitted(s, fields, settings);
  };
  const std::string text = "NoiseLevel: the data show no white noise but are smooth over about ";
  InterpolationSettings settings;
  EXPECT_TRUE(Warns(fitted(correlated, settings, most), text));
  EXPECT_TRUE(Warns(fitted(correlated, settings, most), "(set NoiseLevel, or turn Exact on"));
  EXPECT_FALSE(Warns(fitted(correlated, Exact(), most), text));
  for (const Eigen::Index count : { Eigen::Index(20), Eigen::Index(60), Eigen::Index(200), most })
  {
    EXPECT_FALSE(Warns(fitted(Values::Zero(most, 1), settings, count), text)) << count;
    EXPECT_FALSE(Warns(fitted(wave, settings, count), text)) << count;
    EXPECT_FALSE(Warns(fitted(white, settings, count), text)) << count;
  }
  settings.NoiseLevel = 0.1;
  EXPECT_FALSE(Warns(fitted(correlated, settings, most), text));
}

TEST(InterpolationRun, ReportsEachKindOfBadValuesInOneLine)
{
  const TestSurface s = Icosphere(2);
  EXPECT_NE(
    ErrorOf(s, SamplesOf(Points(0, 3)), Exact()).find("no value is known"), std::string::npos);
  Fields fields;
  fields.Data.Values = Values::Constant(s.Vertices.rows(), 1, NaN);
  EXPECT_NE(ErrorOf(s, fields, Exact()).find("Data has no known value"), std::string::npos);

  fields.Data.Values(3, 0) = fields.Data.Values(8, 0) = fields.Data.Values(12, 0) = 4.0;
  const Solution equal = Fitted(s, fields, InterpolationSettings());
  EXPECT_TRUE(Warns(equal, "all known values are equal"));
  EXPECT_LT((equal.Result.array() - 4.0).abs().maxCoeff(), 1e-12);

  fields.Data.Values(12, 0) = NaN;
  fields.Data.Values(8, 0) = 5.0;
  EXPECT_TRUE(
    Warns(Fitted(s, fields, InterpolationSettings()), "fewer than 3 places have a value"));

  Points twice(8, 3);
  twice << s.Vertices.topRows(7), s.Vertices.row(2);
  Fields repeated = SamplesOf(twice);
  auto samples = std::make_shared<PointSamples>(*repeated.Samples);
  samples->Given(7, 0) += 2.0;
  samples->Weights = { 1.0, 1.0, 3.0, 1.0, 1.0, 1.0, 1.0, 1.0 };
  repeated.Samples = samples;
  const Solution mean = Fitted(s, repeated, Exact());
  EXPECT_TRUE(Warns(mean, "1 place has different values: their weighted mean counts"));
  EXPECT_NEAR(mean.Result(2, 0), samples->Given(2, 0) + 0.5, 1e-12);

  samples = std::make_shared<PointSamples>(*samples);
  samples->Weights[1] = -1.0;
  repeated.Samples = samples;
  EXPECT_NE(ErrorOf(s, repeated, Exact()).find("is -1 at point 1 of the values; allowed"),
    std::string::npos);
  samples = std::make_shared<PointSamples>(*samples);
  samples->Weights[1] = 1.0;
  samples->Given(4, 0) = std::numeric_limits<double>::infinity();
  repeated.Samples = samples;
  EXPECT_NE(
    ErrorOf(s, repeated, Exact()).find("a value is infinite at point 4"), std::string::npos);
}

TEST(InterpolationRun, HasTheSameResultInAllUnits)
{
  const TestSurface s = Icosphere(3);
  const double size = 1e3;
  const double unit = 1e-5;
  InterpolationSettings settings;
  settings.AutomaticSmoothing = false;
  settings.Smoothing = 2.0;
  settings.ComputeError = true;
  const Solution natural = Interpolate(s.Vertices, s.Faces, Sparse(s, 5), settings);
  const Solution large =
    Interpolate(Points(size * s.Vertices), s.Faces, Values(unit * Sparse(s, 5)), settings);
  EXPECT_LT((large.Result / unit - natural.Result).cwiseAbs().maxCoeff(), 1e-9);
  EXPECT_LT(
    (large.Arrays.at("Error") / unit - natural.Arrays.at("Error")).cwiseAbs().maxCoeff(), 1e-9);
  EXPECT_NEAR(natural.Columns.at("Smoothing")(0, 0), 2.0, 1e-12);
  settings.Units = UnitsMode::Absolute;
  settings.Smoothing = 2.0 * std::pow(natural.Numbers.at("MeanEdgeLength")(0, 0), 2);
  const Solution absolute = Interpolate(s.Vertices, s.Faces, Sparse(s, 5), settings);
  EXPECT_LT((absolute.Result - natural.Result).cwiseAbs().maxCoeff(), 1e-12);
}

TEST(InterpolationRun, ReturnsToTheMeanBeyondTheCorrelationLength)
{
  const TestSurface s = Strip(60, 10, 60.0, 10.0);
  Values f = Values::Constant(s.Vertices.rows(), 1, NaN);
  for (Eigen::Index i = 0; i < f.rows(); ++i)
  {
    const double x = s.Vertices(i, 0);
    f(i, 0) = x < 5.0 ? 1.0 + 0.2 * x : NaN; // a trend
  }
  InterpolationSettings settings = Exact();
  const auto last = [&]
  { return Interpolate(s.Vertices, s.Faces, f, settings).Result(f.rows() - 1, 0); };
  EXPECT_GT(last(), 1.6); // continues
  settings.CorrelationLength = 3.0;
  EXPECT_NEAR(last(), 1.4, 0.01); // of 1, 1.2, ... 1.8
}

TEST(InterpolationRun, TakesPolesWhosePointsCoincideUpToRoundOff)
{
  // The last rows of a parametric sphere are at one pole.
  constexpr double pi = 3.14159265358979323846;
  TestSurface s = Strip(30, 30, 2.0 * pi, 1.0);
  for (auto x : s.Vertices.rowwise())
  {
    const double angle = pi * std::min(1.0, 1.2 * x[1]);
    const double radius = std::sin(angle) + 1e-16 * x[1];
    x = Eigen::RowVector3d(radius * std::cos(x[0]), radius * std::sin(x[0]), std::cos(angle));
  }
  Fields fields;
  fields.Data.Values = Sparse(s, 7);
  EXPECT_EQ(ErrorOf(s, fields, InterpolationSettings()), "");
}

TEST(InterpolationRun, RefusesSettingsThatExcludeEachOther)
{
  const TestSurface s = Icosphere(2);
  Fields fields;
  fields.Data.Values = Sparse(s, 4);
  InterpolationSettings settings;
  settings.AlongDiffusivity = 4.0;
  EXPECT_NE(ErrorOf(s, fields, settings).find("Directions is not set"), std::string::npos);
  settings.AcrossDiffusivity = 4.0;
  settings.Boundary = RimCondition::Free;
  EXPECT_NE(ErrorOf(s, fields, settings).find("Boundary is Free"), std::string::npos);
  settings = InterpolationSettings();
  settings.AutomaticSmoothing = false;
  settings.Smoothing = 0.0;
  EXPECT_NE(ErrorOf(s, fields, settings).find("Smoothing"), std::string::npos);
}
