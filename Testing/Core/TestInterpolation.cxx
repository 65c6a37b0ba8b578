// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Surface/TangentVectors.h"
#include "EveryMeshFile.h"
#include "Heat.h"
#include "Interpolation.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <functional>
#include <vector>

using namespace SurfaceDiffusion;
using namespace SurfaceDiffusion::Testing;

namespace
{

constexpr Index OfSphere = 162; // vertices of the icosahedron subdivided twice, in all finer ones

/// Harmonic interpolation of the same values.
Values Harmonic(const std::shared_ptr<const Assembler>& assembler, const ScatteredValues& data)
{
  const Index n = assembler->Mesh().NumberOfVertices();
  PointData known = PointData::FromValues(Values::Zero(n, data.Given.cols()));
  for (Index i = 0; i < data.Count(); ++i)
  {
    known.Start.row(data.Places[i].Vertex()) = data.Given.row(i);
    known.Fixed[data.Places[i].Vertex()] = true;
  }
  LinearDiffusion::Settings settings;
  settings.TimeScheme = Scheme::SteadyState;
  const auto heat = MakeHeat(assembler, std::move(known), settings);
  heat->Advance(ProgressMonitor());
  return heat->State();
}

double LargestDifference(const Values& a, const Values& b)
{
  return (a - b).cwiseAbs().maxCoeff();
}

} // namespace

TEST(Interpolation, OfExactValuesConvergesWhereHarmonicInterpolationDiverges)
{
  double last = 0.03;
  double lastHarmonic = 0.0;
  for (int subdivisions = 3; subdivisions <= 6; ++subdivisions)
  {
    const Surface s = Icosphere(subdivisions);
    const auto assembler = MakeAssembler(s);
    const TriangleMesh& mesh = assembler->Mesh();
    const Values field = Sample(mesh, s, SeaTemperature);
    const ScatteredValues data = ValuesAt(mesh, field, [](Index i) { return i < OfSphere; });
    ASSERT_EQ(data.Count(), OfSphere);
    const Values u = Interpolate(assembler, data, InterpolationSettings(Choice::Exact)).U;
    const double error = RootMeanSquare(mesh, u - field);
    const double harmonic = RootMeanSquare(mesh, Harmonic(assembler, data) - field);
    std::printf("%6d vertices: error %.4f, of harmonic interpolation %.3f\n",
      mesh.NumberOfVertices(), error, harmonic);
    for (Index i = 0; i < data.Count(); ++i)
    {
      EXPECT_NEAR(u(data.Places[i].Vertex(), 0), data.Given(i, 0), 1e-13);
    }
    EXPECT_LT(error, last);
    EXPECT_GT(harmonic, lastHarmonic + 0.2);
    last = error;
    lastHarmonic = harmonic;
  }
}

TEST(Interpolation, HoldsValuesInsideTrianglesToo)
{
  const Surface s = Torus(40, 24);
  const auto assembler = MakeAssembler(s);
  const TriangleMesh& mesh = assembler->Mesh();
  const auto f = [](const Eigen::RowVector3d& x)
  { return 100.0 + std::sin(x[0]) * x[2] + 0.3 * x[1]; };
  const Values field = Sample(mesh, s, f);
  const ScatteredValues data = ValuesInTriangles(mesh, field, 150);
  for (const double kappa : { 0.0, 0.7 })
  {
    Interpolation::Settings settings = InterpolationSettings(Choice::Exact);
    settings.Kappa = kappa * mesh.LengthUnit();
    const Values u = Interpolate(assembler, data, settings).U;
    for (Index i = 0; i < data.Count(); ++i)
    {
      double value = 0.0;
      for (int a = 0; a < 3; ++a)
      {
        value += data.Places[i].Coordinates[a] * u(data.Places[i].Vertices[a], 0);
      }
      EXPECT_NEAR(value, data.Given(i, 0), 1e-10);
    }
    EXPECT_LT(RootMeanSquare(mesh, u - field), 0.1);
  }
}

TEST(Interpolation, OfConstantValuesIsTheConstant)
{
  for (const Surface& s : { Icosphere(3), Disk(8), Moebius(20, 4), ThreeFins(6) })
  {
    const auto assembler = MakeAssembler(s);
    const TriangleMesh& mesh = assembler->Mesh();
    const Values field = Values::Constant(mesh.NumberOfVertices(), 1, 37.3);
    for (const Choice choice : { Choice::Exact, Choice::Automatic })
    {
      for (const RimCondition rim : { RimCondition::Natural, RimCondition::Free })
      {
        Interpolation::Settings settings = InterpolationSettings(choice);
        settings.Rim = rim;
        for (const Index step : { 9, 1000000 }) // many values, and one
        {
          const auto data = ValuesAt(mesh, field, [&](Index i) { return i % step == 0; });
          const Interpolation::Result result = Interpolate(assembler, data, settings);
          EXPECT_LT(LargestDifference(result.U, field), 1e-10);
          EXPECT_EQ(
            result.PartsWithTooFewValues > 0, choice == Choice::Automatic && data.Count() < 3);
        }
      }
    }
  }
}

TEST(Interpolation, AcrossEdgesOfThreeTrianglesDoesNotDependOnTheAxes)
{
  const auto f = [](const Eigen::RowVector3d& x)
  { return std::sin(3.0 * x[0]) + x[1] * x[1] - 2.0 * x[2]; };
  for (const Index cells : { 1, 5 })
  {
    const Surface s = ThreeFins(cells);
    Values expected;
    for (const double angle : { 0.0, 0.7, 2.0, 4.0 })
    {
      const Surface turned = Rotated(s, angle);
      const auto assembler = MakeAssembler(turned);
      const TriangleMesh& mesh = assembler->Mesh();
      const Values field = Sample(mesh, s, f);
      const auto data = ValuesAt(mesh, field, [&](Index i) { return i % 3 != 1; });
      Interpolation::Settings settings = InterpolationSettings(Choice::Given, 1e-3);
      settings.Rim = RimCondition::Free;
      const Values u =
        ToInput(mesh, Interpolate(assembler, data, settings).U, s.NumberOfVertices());
      expected = angle == 0.0 ? u : expected;
      EXPECT_LT(LargestDifference(u, expected), 1e-9) << cells;
    }
  }
}

TEST(Interpolation, SlopesThatBalanceAtAnEdgeHaveNoFreeEnergy)
{
  const Surface s = ThreeFins(4);
  const auto assembler = MakeAssembler(s);
  const TriangleMesh& mesh = assembler->Mesh();
  const SmoothnessEnergy energy(*assembler, CotanWeights(mesh), 0.0, RimCondition::Free);
  const auto slopes = [&](double first, double second, double third)
  {
    return Sample(mesh, s,
      [=](const Eigen::RowVector3d& x)
      {
        const double y = std::hypot(x[1], x[2]);
        return x[0] + y * (x[2] > 1e-9 ? second : x[2] < -1e-9 ? third : first);
      });
  };
  EXPECT_LT(energy.Squares(slopes(1.0, 2.0, -3.0))[0], 1e-12);
  EXPECT_GT(energy.Squares(slopes(1.0, 2.0, 0.0))[0], 0.1);
}

TEST(Interpolation, TakesTheWeightedMeanOfValuesAtOnePlace)
{
  const auto assembler = MakeAssembler(Icosphere(2));
  ScatteredValues repeated;
  ScatteredValues single;
  const auto add = [](ScatteredValues& data, Index vertex, double value, double weight)
  {
    const Eigen::Index row = data.Count();
    data.Places.push_back(SurfacePoint::AtVertex(vertex));
    data.Given.conservativeResize(row + 1, 1);
    data.Weights.conservativeResize(row + 1);
    data.Given(row, 0) = value;
    data.Weights[row] = weight;
  };
  for (Index i = 0; i < 160; i += 20)
  {
    const double value = std::sin(i);
    add(single, i, value + (i == 40 ? 0.75 : 0.0), i == 40 ? 4.0 : i == 60 ? 2.0 : 1.0);
    add(repeated, i, value, 1.0);
    if (i == 40)
    {
      add(repeated, i, value + 1.0, 3.0);
    }
    if (i == 60)
    {
      add(repeated, i, value, 1.0);
    }
  }
  for (const auto& settings :
    { InterpolationSettings(Choice::Exact), InterpolationSettings(Choice::Given, 0.01) })
  {
    const Interpolation::Result result = Interpolate(assembler, repeated, settings);
    EXPECT_EQ(result.RepeatedValues, 2);
    EXPECT_EQ(result.ContradictingPlaces, 1);
    EXPECT_LT(LargestDifference(result.U, Interpolate(assembler, single, settings).U), 1e-12);
  }
}

TEST(Interpolation, TakesTheMeanOfValuesAtPlacesThatAreAllButOne)
{
  const Surface sphere = Icosphere(3);
  const auto assembler = MakeAssembler(sphere);
  const TriangleMesh& mesh = assembler->Mesh();
  for (const double shift : { 1e-15, 1e-12, 1e-9, 1e-7, 1e-5 })
  {
    ScatteredValues data = ValuesInTriangles(mesh, Sample(mesh, sphere, SeaTemperature), 20);
    const Index count = data.Count();
    data.Places[0].Coordinates = { 1.0, 0.0, 0.0 };
    data.Places[1].Coordinates = { 0.5 - shift, 0.5, shift };
    data.Given.conservativeResize(2 * count, 1);
    data.Weights = Vector::Ones(2 * count);
    for (Index i = 0; i < count; ++i)
    {
      SurfacePoint beside = data.Places[i];
      beside.Coordinates[0] -= shift;
      beside.Coordinates[1] += shift;
      if (i == 1) // beyond the edge
      {
        const auto corners = mesh.TriangleVertices().rowwise();
        const auto has = [](const auto& triangle, Index v)
        { return (triangle.array() == v).any(); };
        const auto& [a, b, c] = data.Places[i].Vertices;
        for (const auto triangle : corners)
        {
          if (has(triangle, a) && has(triangle, b) && !has(triangle, c))
          {
            beside = { { a, b, triangle.sum() - a - b }, data.Places[i].Coordinates };
          }
        }
        ASSERT_NE(beside.Vertices[2], c);
      }
      data.Places.push_back(beside);
      data.Given(count + i, 0) = data.Given(i, 0) + Gaussian(4, 0, i);
    }
    for (const Choice choice : { Choice::Automatic, Choice::Exact })
    {
      const Interpolation::Result found =
        Interpolate(assembler, data, InterpolationSettings(choice));
      EXPECT_EQ(found.RepeatedValues, count) << shift;
      EXPECT_EQ(found.ContradictingPlaces, count) << shift;
      // Without steep slopes from one to the other
      EXPECT_LT(found.U.cwiseAbs().maxCoeff(), 2.0 * data.Given.cwiseAbs().maxCoeff()) << shift;
    }
  }
}

TEST(Interpolation, RefusesSmoothingAndNoiseThatAreNotPositive)
{
  const auto assembler = MakeAssembler(Icosphere(1));
  const Values field = Values::Random(assembler->Mesh().NumberOfVertices(), 1);
  const auto data = ValuesAt(assembler->Mesh(), field, [](Index) { return true; });
  for (const Choice choice : { Choice::Given, Choice::NoiseLevel })
  {
    EXPECT_THROW(
      Interpolate(assembler, data, InterpolationSettings(choice, 0.0)), std::invalid_argument);
  }
}

/// r K_1(r) by the trapezoidal rule for the integral of exp(-r cosh t) cosh t, to round-off.
/// libc++ has no std::cyl_bessel_k.
static double MaternCorrelation(double r)
{
  const double step = 1.0 / 16.0;
  double sum = 0.5 * std::exp(-r);
  for (double t = step; t < 12.0; t += step)
  {
    sum += std::exp(-r * std::cosh(t)) * std::cosh(t);
  }
  return r * step * sum;
}

TEST(Interpolation, OfOneValueDecaysAsTheMaternCorrelation)
{
  // The value at the middle against a far one at zero weight in the mean: two values of opposite
  // signs, each beyond the reach of the other.
  const Index cells = 240;
  const double half = 6.0; // kappa = 1: half of the side is six correlation lengths
  const Surface s = Moved(Strip(2 * cells, cells, 4.0 * half, 2.0 * half), { -half, -half, 0.0 });
  const auto assembler = MakeAssembler(s);
  const TriangleMesh& mesh = assembler->Mesh();
  const auto f = [&](const Eigen::RowVector3d& x) { return x[0] < half ? 1.0 : -1.0; };
  const Index row = 2 * cells + 1;
  const Index middle = cells / 2 * row + cells / 2;
  const Index far = middle + cells;
  const auto data =
    ValuesAt(mesh, Sample(mesh, s, f), [&](Index i) { return i == middle || i == far; });
  Interpolation::Settings settings = InterpolationSettings(Choice::Exact);
  settings.Kappa = mesh.LengthUnit();
  const Values u = Interpolate(assembler, data, settings).U;
  double worst = 0.0;
  for (Index i = 0; i < mesh.NumberOfVertices(); ++i)
  {
    const double r = Eigen::RowVector3d(s.Vertices.row(mesh.InputVertex()[i])).norm();
    if (r > 0.0 && r < 4.0)
    {
      worst = std::max(worst, std::abs(u(i, 0) - MaternCorrelation(r)));
    }
  }
  std::printf("largest difference from the Matern correlation %.4f\n", worst);
  EXPECT_LT(worst, 0.02);
}

TEST(Interpolation, FollowsTheDirectionOfStrongDiffusion)
{
  // D = diag(16, 1): the energy of u(x / 4, y) is that of u(x, y) without D, up to a factor.
  const Surface wide = Strip(48, 24, 4.0, 1.0);
  const Surface square = Strip(48, 24, 1.0, 1.0);
  const auto ofWide = MakeAssembler(wide);
  const auto ofSquare = MakeAssembler(square);
  const auto f = [](const Eigen::RowVector3d& x) { return std::sin(4.0 * x[1]); };
  const auto known = [](Index i) { return i % 37 == 0; };
  const TriangleMesh& mesh = ofWide->Mesh();
  Points along = Points::Zero(wide.Faces.rows(), 3);
  along.col(0).setOnes();
  const CornerWeights weights = AnisotropicWeights(mesh, CotanWeights(mesh),
    TangentVectorsFromTriangleVectors(mesh, wide.Vertices, wide.Faces, along), 16.0, 1.0);
  const Interpolation::Settings settings = InterpolationSettings(Choice::Exact);
  const Values u =
    Interpolation(ofWide, weights, settings).Fit(ValuesAt(mesh, Sample(mesh, wide, f), known)).U;
  const Values v = Interpolate(
    ofSquare, ValuesAt(ofSquare->Mesh(), Sample(ofSquare->Mesh(), square, f), known), settings)
                     .U;
  EXPECT_LT(LargestDifference(ToInput(mesh, u, wide.NumberOfVertices()),
              ToInput(ofSquare->Mesh(), v, square.NumberOfVertices())),
    1e-9);
}

TEST(Interpolation, KeepsTheRangeOfTheValues)
{
  const Surface s = Icosphere(4);
  const auto assembler = MakeAssembler(s);
  const TriangleMesh& mesh = assembler->Mesh();
  const auto f = [](const Eigen::RowVector3d& x) { return x[2] > 0.3 ? 7.0 : 2.0; };
  const Values field = Sample(mesh, s, f);
  const auto data = ValuesAt(mesh, field, [](Index i) { return i < OfSphere; });
  for (const Choice choice : { Choice::Exact, Choice::Automatic })
  {
    Interpolation::Settings settings = InterpolationSettings(choice);
    const Values without = Interpolate(assembler, data, settings).U;
    EXPECT_GT(without.maxCoeff(), 7.2); // the overshoot of the energy of fourth order
    EXPECT_LT(without.minCoeff(), 1.8);
    settings.KeepRange = true;
    const Interpolation::Result kept = Interpolate(assembler, data, settings);
    EXPECT_TRUE(kept.RangeIsOptimal);
    EXPECT_LE(kept.U.maxCoeff() - 7.0, 1e-12);
    EXPECT_GE(kept.U.minCoeff(), 2.0 - 1e-12);
    std::printf("range without bounds %.3f .. %.3f, changed by %.3f\n", without.minCoeff(),
      without.maxCoeff(), RootMeanSquare(mesh, kept.U - without));
    // The minimum under bounds is at most that of the clamped function, and smooth inside.
    const SmoothnessEnergy energy(*assembler, CotanWeights(mesh), 0.0, RimCondition::Natural);
    const auto cost = [&](const Values& u)
    {
      double misfit = 0.0;
      for (Index i = 0; i < data.Count(); ++i)
      {
        misfit += std::pow(u(data.Places[i].Vertex(), 0) - data.Given(i, 0), 2);
      }
      return misfit + kept.Columns[0].Mu * energy.Squares(u)[0];
    };
    const Values clamped = without.cwiseMax(2.0).cwiseMin(7.0);
    if (choice == Choice::Automatic)
    {
      EXPECT_LT(cost(kept.U), cost(clamped));
    }
    else
    {
      EXPECT_LT(energy.Squares(kept.U)[0], energy.Squares(clamped)[0]);
    }
  }
}

TEST(Interpolation, KeepsTheRangeOfAColumnWithTheBitsThatItHasAlone)
{
  const Surface s = Icosphere(3);
  const auto assembler = MakeAssembler(s);
  const TriangleMesh& mesh = assembler->Mesh();
  const auto f = [](const Eigen::RowVector3d& x) { return x[2] > 0.3 ? 7.0 : 2.0; };
  const Values field = Sample(mesh, s, f);
  Values twice(field.rows(), 2);
  twice << field, field;
  const auto data = ValuesAt(mesh, twice, [](Index i) { return i < OfSphere; });
  Interpolation::Settings settings = InterpolationSettings(Choice::Automatic);
  settings.KeepRange = true;
  const Values u = Interpolate(assembler, data, settings).U;
  EXPECT_GT((u.col(0).array() == 7.0).count(), OfSphere / 4); // an active set
  EXPECT_EQ(u.col(0), u.col(1));
}

TEST(Interpolation, KeepsTheRangeOfExactValuesInsideTriangles)
{
  // An extreme value inside a triangle holds at all three vertices: its multiplier has no bound.
  const Surface s = Icosphere(4);
  const auto assembler = MakeAssembler(s);
  const TriangleMesh& mesh = assembler->Mesh();
  const std::vector<std::function<double(const Eigen::RowVector3d&)>> fields = {
    [](const Eigen::RowVector3d& x) { return x[2] * x[2]; },
    [](const Eigen::RowVector3d& x) { return x[0] > 0.2 ? 1.0 : x[1]; },
    [](const Eigen::RowVector3d& x) { return 1e3 + std::sin(5.0 * x[0]) * x[1]; },
  };
  for (std::size_t f = 0; f < fields.size(); ++f)
  {
    for (const std::int64_t seed : { 1, 2, 3 })
    {
      const ScatteredValues data = ValuesInTriangles(mesh, Sample(mesh, s, fields[f]), 60, seed);
      Interpolation::Settings settings = InterpolationSettings(Choice::Exact);
      settings.KeepRange = true;
      const Interpolation::Result kept = Interpolate(assembler, data, settings);
      EXPECT_TRUE(kept.RangeIsOptimal) << f << ", seed " << seed;
      EXPECT_LE(kept.U.maxCoeff(), data.Given.maxCoeff());
      EXPECT_GE(kept.U.minCoeff(), data.Given.minCoeff());
      const double range = data.Given.maxCoeff() - data.Given.minCoeff();
      EXPECT_LT(kept.Columns[0].Residual, 1e-9 * range) << f << ", seed " << seed;
    }
  }
}

TEST(Interpolation, KeepsTheRangeAroundABumpInAPlain)
{
  // Nearly all of the surface is at the bound.
  const Surface s = Icosphere(4);
  const auto assembler = MakeAssembler(s);
  const TriangleMesh& mesh = assembler->Mesh();
  const auto f = [](const Eigen::RowVector3d& x)
  { return std::exp(-40.0 * (x - Eigen::RowVector3d(0.0, 0.0, 1.0)).squaredNorm()); };
  const auto data = ValuesAt(mesh, Sample(mesh, s, f), [](Index i) { return i < OfSphere; });
  for (const Choice choice : { Choice::Exact, Choice::Automatic })
  {
    Interpolation::Settings settings = InterpolationSettings(choice);
    EXPECT_LT(Interpolate(assembler, data, settings).U.minCoeff(), -0.005);
    settings.KeepRange = true;
    const Interpolation::Result kept = Interpolate(assembler, data, settings);
    EXPECT_TRUE(kept.RangeIsOptimal);
    EXPECT_GE(kept.U.minCoeff(), data.Given.minCoeff());
    EXPECT_LE(kept.U.maxCoeff(), data.Given.maxCoeff());
  }
}

TEST(Interpolation, IsSmoothAcrossFlatSheetsWhoseSlopeValuesLeaveOpen)
{
  const Surface s = Strip(20, 20);
  const auto assembler = MakeAssembler(s);
  const TriangleMesh& mesh = assembler->Mesh();
  Interpolation::Settings settings = InterpolationSettings(Choice::Exact);
  settings.Rim = RimCondition::Free;
  const Values field = Sample(mesh, s, [](const Eigen::RowVector3d& x) { return 3.0 * x[0]; });
  // Along a line: the slope across it is open, and the flattest function has none.
  const auto data = ValuesAt(mesh, field, [](Index i) { return i / 21 == 10 && i % 5 == 0; });
  const Interpolation::Result result = Interpolate(assembler, data, settings);
  EXPECT_TRUE(result.IsFlattest);
  EXPECT_LT(LargestDifference(result.U, field), 1e-3);
}

TEST(Interpolation, KeepsSlopesThatValuesDetermineWhateverTheSmoothing)
{
  const Surface s = Strip(20, 20);
  const auto assembler = MakeAssembler(s);
  const TriangleMesh& mesh = assembler->Mesh();
  const Values field =
    Sample(mesh, s, [](const Eigen::RowVector3d& x) { return 2.0 * x[0] - 3.0 * x[1]; });
  // Four on a line and one beside it
  const auto data =
    ValuesAt(mesh, field, [](Index i) { return i == 205 || (i / 21 == 10 && i % 5 == 0); });
  Interpolation::Settings settings = InterpolationSettings(Choice::NoiseLevel);
  settings.Rim = RimCondition::Free;
  settings.NoiseLevel = 0.1;
  for (const double mu : { 0.0, 1e12, 1e100 })
  {
    settings.Smoothing = mu > 0.0 ? Choice::Given : Choice::NoiseLevel;
    settings.Mu = mu;
    const Interpolation::Result result = Interpolate(assembler, data, settings);
    EXPECT_FALSE(result.IsFlattest) << mu;
    EXPECT_LT(LargestDifference(result.U, field), 1e-4) << mu;
  }
}

TEST(Interpolation, WithFreeBoundaryGivesRampsBackOnFlatMeshes)
{
  const auto ramp = [](const Eigen::RowVector3d& x) { return 2.0 * x[0] - 3.0 * x[1] + 0.5; };
  const Surface surfaces[] = { Strip(30, 20, 1.5, 1.0), Disk(14),
    Jittered(Strip(24, 24), 0.008, 0.01, 0.99, 0.01, 0.99),
    Joined(Disk(6), Moved(Disk(9), { 4.0, 0.0, 0.0 })) };
  for (const Surface& s : surfaces)
  {
    const auto assembler = MakeAssembler(s);
    const TriangleMesh& mesh = assembler->Mesh();
    const Values field = Sample(mesh, s, ramp);
    Interpolation::Settings settings = InterpolationSettings(Choice::Exact);
    const auto data = ValuesAt(mesh, field, [](Index i) { return i % 53 == 7; });
    const double natural = LargestDifference(Interpolate(assembler, data, settings).U, field);
    settings.Rim = RimCondition::Free;
    const Interpolation::Result result = Interpolate(assembler, data, settings);
    const double free = LargestDifference(result.U, field);
    std::printf("%d values: natural %.3f, free %.1e\n", data.Count(), natural, free);
    EXPECT_FALSE(result.IsFlattest);
    EXPECT_LT(free, 1e-9);
    EXPECT_GT(natural, 0.1);
    settings.Smoothing = Choice::Automatic;
    EXPECT_LT(LargestDifference(Interpolate(assembler, data, settings).U, field), 1e-6);
  }
}

TEST(Interpolation, WithFreeBoundaryHasTheNaturalSolutionOnClosedSurfaces)
{
  double last = 0.0;
  for (int subdivisions = 3; subdivisions <= 4; ++subdivisions)
  {
    const Surface s = Icosphere(subdivisions);
    const auto assembler = MakeAssembler(s);
    const TriangleMesh& mesh = assembler->Mesh();
    const Values field = Sample(mesh, s, SeaTemperature);
    Interpolation::Settings settings = InterpolationSettings(Choice::Exact);
    settings.Rim = RimCondition::Free;
    const Values u =
      Interpolate(assembler, ValuesAt(mesh, field, [](Index i) { return i < OfSphere; }), settings)
        .U;
    const double error = RootMeanSquare(mesh, u - field);
    std::printf("%d subdivisions: error %.4f\n", subdivisions, error);
    EXPECT_LT(error, 0.05);
    // The energy of Y_1 is 2^2 of the mean square.
    const SmoothnessEnergy energy(*assembler, CotanWeights(mesh), 0.0, RimCondition::Free);
    const Values z = Sample(mesh, s, [](const Eigen::RowVector3d& x) { return x[2]; });
    const double area = mesh.LengthUnit() * mesh.LengthUnit();
    const double square = area * mesh.ControlAreas().dot(z.col(0).cwiseAbs2());
    const double excess = energy.Squares(z)[0] / area / (4.0 * square) - 1.0;
    std::printf("relative error of the energy of Y_1 %.5f\n", excess);
    if (last > 0.0)
    {
      EXPECT_LT(std::abs(excess), 0.5 * last);
    }
    last = std::abs(excess);
  }
}

TEST(Interpolation, ReportsItsProgressAndEndsWhenItIsAborted)
{
  const Surface s = Icosphere(4);
  const auto assembler = MakeAssembler(s);
  const TriangleMesh& mesh = assembler->Mesh();
  const Values field = Sample(mesh, s, SeaTemperature);
  for (const Index step : { 20, 3 }) // few values, and many
  {
    const auto data = ValuesAt(mesh, field + Noise(mesh), [&](Index i) { return i % step == 0; });
    Interpolation::Settings settings;
    settings.ComputeError = true;
    settings.KeepRange = true;
    const Interpolation model(assembler, CotanWeights(mesh), settings);
    std::vector<double> reports;
    const ProgressMonitor::Callback note = [&](double fraction)
    {
      reports.push_back(fraction);
      return true;
    };
    const Values expected = model.Fit(data, ProgressMonitor(note)).U;
    ASSERT_GE(reports.size(), 10U);
    EXPECT_TRUE(std::is_sorted(reports.begin(), reports.end()));
    EXPECT_EQ(reports.back(), 1.0);
    for (const double end : { 0.05, 0.3, 0.6, 0.9 })
    {
      const ProgressMonitor::Callback stop = [&](double fraction) { return fraction < end; };
      EXPECT_THROW(model.Fit(data, ProgressMonitor(stop)), Aborted);
    }
    EXPECT_EQ(model.Fit(data).U, expected);
  }
}

TEST(Interpolation, StaysNearTheFieldOnEveryMeshFile)
{
  ForEachMeshFile(
    [](const Surface& s)
    {
      const auto assembler = MakeAssembler(s);
      const TriangleMesh& mesh = assembler->Mesh();
      const Eigen::RowVector3d low = s.Vertices.colwise().minCoeff();
      const double size = (s.Vertices.rowwise() - low).maxCoeff();
      const auto f = [&](const Eigen::RowVector3d& x)
      {
        const Eigen::RowVector3d y = (x - low) / size;
        return 1e4 + std::sin(3.0 * y[0] + 1.0) + 2.0 * y[1] * y[2];
      };
      const Values field = Sample(mesh, s, f);
      const double share = std::max(0.05, 20.0 / mesh.NumberOfVertices());
      const auto data = ValuesAt(mesh, field,
        [&](Index i) { return i == mesh.InputVertex()[0] || UniformRandom(5, 0, i) < share; });
      for (const RimCondition rim : { RimCondition::Natural, RimCondition::Free })
      {
        for (const Choice choice : { Choice::Exact, Choice::Automatic })
        {
          Interpolation::Settings settings = InterpolationSettings(choice);
          settings.Rim = rim;
          const Interpolation::Result result = Interpolate(assembler, data, settings);
          EXPECT_LT(((result.U - field).array().isNaN())
                      .select(0.0, result.U - field)
                      .cwiseAbs()
                      .maxCoeff(),
            20.0);
          EXPECT_EQ(result.U.array().isNaN().any(), result.UndeterminedComponents > 0);
          if (choice == Choice::Automatic && result.Parts == 1 && !result.IsFlattest &&
            !result.DropsNegativeCurvature && result.PartsWithTooFewValues == 0)
          {
            // The factor of the first mu gives what that of this one does, also on bad triangles.
            Interpolation::Settings given =
              InterpolationSettings(Choice::Given, result.Columns[0].Mu);
            given.Rim = rim;
            const Values own = Interpolate(assembler, data, given).U;
            EXPECT_LT(
              (result.U - own).array().isNaN().select(0.0, result.U - own).cwiseAbs().maxCoeff(),
              1e-10);
          }
          for (Index i = 0; i < data.Count() && choice == Choice::Exact; ++i)
          {
            EXPECT_NEAR(result.U(data.Places[i].Vertex(), 0), data.Given(i, 0), 1e-11);
          }
        }
      }
    });
}

/// Noise gets the largest smoothing parameter, which the first factor resolves for some columns alone.
TEST(Interpolation, OfAColumnAmongOthersIsThatOfItAloneOnEveryMeshFile)
{
  ForEachMeshFile(
    [](const Surface& s)
    {
      const auto assembler = MakeAssembler(s);
      const TriangleMesh& mesh = assembler->Mesh();
      Values field(mesh.NumberOfVertices(), 5);
      for (Index i = 0; i < mesh.NumberOfVertices(); ++i)
      {
        const Index point = mesh.InputVertex()[i];
        const double x = s.Vertices(point, 0) / (1.0 + s.Vertices.cwiseAbs().maxCoeff());
        field.row(i) << x, UniformRandom(1, 0, point), UniformRandom(1, 1, point),
          1e3 * UniformRandom(1, 2, point), UniformRandom(1, 3, point);
      }
      const double share = std::max(0.05, 20.0 / mesh.NumberOfVertices());
      const auto data = ValuesAt(mesh, field,
        [&](Index i) { return i == mesh.InputVertex()[0] || UniformRandom(5, 0, i) < share; });
      const Interpolation::Settings settings = InterpolationSettings(Choice::Automatic);
      const Interpolation::Result all = Interpolate(assembler, data, settings);
      if (all.IsFlattest || all.DropsNegativeCurvature)
      {
        return; // all columns have one energy
      }
      for (Eigen::Index c = 0; c < field.cols(); ++c)
      {
        ScatteredValues column = data;
        column.Given = data.Given.col(c);
        const Values alone = Interpolate(assembler, column, settings).U;
        EXPECT_TRUE(((all.U.col(c) - alone).array() == 0.0 || alone.array().isNaN()).all()) << c;
      }
    });
}
