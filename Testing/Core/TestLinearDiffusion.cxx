// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Operators/DirichletEnergy.h"
#include "Core/Operators/MeanCorrection.h"
#include "Heat.h"
#include "Meshes.h"

#include <gtest/gtest.h>

#include <cstdio>

using namespace SurfaceDiffusion;
using namespace SurfaceDiffusion::Testing;

namespace
{

/// Spherical harmonics of the unit sphere, up to a factor: degree 1, 2, 3.
double Harmonic(int degree, const Eigen::RowVector3d& p)
{
  const double z = p[2] / p.norm();
  const double x = p[0] / p.norm();
  const double y = p[1] / p.norm();
  switch (degree)
  {
    case 1:
      return x;
    case 2:
      return x * y + 0.5 * (3.0 * z * z - 1.0);
    default:
      return x * (5.0 * z * z - 1.0);
  }
}

/// Root mean square error, relative to that of the exact solution, of Y_lm on a sphere of radius R
/// after the time `time` in `steps` steps.
double HarmonicError(
  int subdivisions, int degree, double radius, double time, int steps, Scheme scheme)
{
  const Surface s = Icosphere(subdivisions, radius);
  const auto assembler = MakeAssembler(s);
  const TriangleMesh& mesh = assembler->Mesh();
  const Values start =
    Sample(mesh, s, [&](const Eigen::RowVector3d& p) { return Harmonic(degree, p); });
  const Values exact = std::exp(-degree * (degree + 1) * time / (radius * radius)) * start;
  const Values u = Diffuse(assembler, PointData::FromValues(start), time, steps, 0.0, scheme);
  return RootMeanSquare(mesh, u - exact) / RootMeanSquare(mesh, exact);
}

} // namespace

TEST(LinearDiffusion, SphericalHarmonicsDecayAtTheirEigenvalueToSecondOrderInSpace)
{
  for (int degree = 1; degree <= 3; ++degree)
  {
    const double radius = 1.5;
    const double time = 0.3 * radius * radius / degree / (degree + 1);
    double coarser = 0.0;
    for (int subdivisions = 3; subdivisions <= 5; ++subdivisions)
    {
      const double error = HarmonicError(subdivisions, degree, radius, time, 40, Scheme::SDIRK2);
      if (coarser > 0.0)
      {
        const double order = ObservedOrder(coarser, error);
        std::printf("degree %d, %d subdivisions: error %.2e, order in h %.3f\n", degree,
          subdivisions, error, order);
        EXPECT_NEAR(order, 2.0, 0.1);
      }
      coarser = error;
    }
    EXPECT_LT(coarser, 5e-4);
  }
}

namespace
{

/// Observed order in the time step, against a run of many small steps on the same mesh.
void ExpectOrderInTime(Scheme scheme, double expected)
{
  const Surface s = Icosphere(3);
  const auto assembler = MakeAssembler(s);
  const TriangleMesh& mesh = assembler->Mesh();
  Values start = Sample(mesh, s, [](const Eigen::RowVector3d& p) { return Harmonic(2, p); });
  start += Sample(mesh, s, [](const Eigen::RowVector3d& p) { return Harmonic(3, p); });
  const double time = 0.2;
  const Values exact =
    Diffuse(assembler, PointData::FromValues(start), time, 4096, 0.0, Scheme::SDIRK2);
  double coarser = 0.0;
  for (int steps = 8; steps <= 64; steps *= 2)
  {
    const Values u = Diffuse(assembler, PointData::FromValues(start), time, steps, 0.0, scheme);
    const double error = RootMeanSquare(mesh, u - exact) / RootMeanSquare(mesh, exact);
    if (coarser > 0.0)
    {
      const double order = ObservedOrder(coarser, error);
      std::printf("%d steps: error %.2e, order in dt %.3f\n", steps, error, order);
      EXPECT_NEAR(order, expected, 0.1);
    }
    coarser = error;
  }
}

} // namespace

TEST(LinearDiffusion, BackwardEulerIsOfFirstOrderInTime)
{
  ExpectOrderInTime(Scheme::BackwardEuler, 1.0);
}

TEST(LinearDiffusion, SDIRK2IsOfSecondOrderInTime)
{
  ExpectOrderInTime(Scheme::SDIRK2, 2.0);
}

// One mode of the matrices themselves: the factor of one step is known exactly.
TEST(LinearDiffusion, OneStepMultipliesAnEigenvectorByTheSchemesFactor)
{
  const Surface s = Strip(1, 1); // two triangles: (-1, 1, -1, 1) around the square is a mode
  const auto assembler = MakeAssembler(s);
  const TriangleMesh& mesh = assembler->Mesh();
  // Vertices on the diagonal have area 1/3, the others 1/6; K = 1/2 (2, -1, -1) per corner.
  const Values start =
    Sample(mesh, s, [](const Eigen::RowVector3d& p) { return p[0] == p[1] ? 1.0 : -2.0; });
  const double eigenvalue = 9.0;
  const double dt = 0.17;
  const double z = eigenvalue * dt;
  const double g = 1.0 - std::sqrt(0.5);
  const Values euler =
    Diffuse(assembler, PointData::FromValues(start), dt, 1, 0.0, Scheme::BackwardEuler);
  EXPECT_LT((euler - start / (1.0 + z)).cwiseAbs().maxCoeff(), 1e-15);
  const Values second =
    Diffuse(assembler, PointData::FromValues(start), dt, 1, 0.0, Scheme::SDIRK2);
  const double factor = (1.0 - (1.0 - 2.0 * g) * z) / ((1.0 + g * z) * (1.0 + g * z));
  EXPECT_LT((second - factor * start).cwiseAbs().maxCoeff(), 1e-15);
  const Values exponential =
    Diffuse(assembler, PointData::FromValues(start), dt, 1, 0.0, Scheme::Exponential);
  EXPECT_LT((exponential - SeriesAt(z) * start).cwiseAbs().maxCoeff(), 1e-14);
}

TEST(LinearDiffusion, SeriesIsTheBestForWhiteNoiseOfThoseOfTheRightVariance)
{
  EXPECT_NEAR(SeriesAt(0.0), 1.0, 1e-15);
  EXPECT_NEAR((SeriesAt(1e-4) - SeriesAt(-1e-4)) / 2e-4, -1.0, 1e-7);
  EXPECT_LT(std::abs(SeriesAt(1e12)), 1e-10);
  // 2 int (p - exp(-z))^2 dz is the relative error; with z = (1/y - 1)/s, dz = dy/(s y^2).
  const auto squareError = [](double perturbation, int power)
  {
    constexpr int intervals = 20000;
    double sum = 0.0;
    for (int i = 0; i < intervals; ++i)
    {
      const double y = (i + 0.5) / intervals;
      const double z = (1.0 / y - 1.0) / ExponentialSeries::Step;
      const double p = SeriesAt(z) + perturbation * y * std::pow(1.0 - y, power);
      sum += 2.0 * std::pow((p - std::exp(-z)) / y, 2) / ExponentialSeries::Step / intervals;
    }
    return sum;
  };
  const double least = squareError(0.0, 2);
  EXPECT_NEAR(std::sqrt(least), 0.0046, 0.0001);
  for (const int power : { 2, 3, 4, 5 }) // those of degree 6 that keep the conditions
  {
    EXPECT_GT(squareError(1e-4, power), least) << power;
    EXPECT_GT(squareError(-1e-4, power), least) << power;
  }
  for (double z = 0.0; z < 100.0; z += 0.01)
  {
    EXPECT_LT(std::abs(SeriesAt(z) - std::exp(-z)), 0.0014) << z;
  }
}

TEST(LinearDiffusion, OneExponentialStepSmoothsWhiteNoiseExactlyEnoughAtAnyWidth)
{
  const auto assembler = MakeAssembler(Icosphere(5));
  const TriangleMesh& mesh = assembler->Mesh();
  const PointData data = PointData::FromValues(Noise(mesh, 2));
  for (const double edges : { 3.0, 8.0, 20.0 })
  {
    const double width = edges * mesh.MeanEdgeLength() * mesh.LengthUnit();
    const double time = width * width / (16.0 * std::log(2.0));
    const Values exact = Diffuse(assembler, data, time, 200);
    const auto error = [&](int steps, Scheme scheme)
    {
      return RootMeanSquare(mesh, Diffuse(assembler, data, time, steps, 0.0, scheme) - exact) /
        RootMeanSquare(mesh, exact);
    };
    EXPECT_LT(error(1, Scheme::Exponential), 0.006) << edges;
    if (edges > 3.0) // with as many solves
    {
      EXPECT_GT(error(3, Scheme::SDIRK2), 0.03) << edges;
    }
  }
}

/// The steady state of fidelity and fixed values is not computed: the series is one of steps that
/// lead to it.
TEST(LinearDiffusion, ExponentialStepsAgreeWithManyOfSecondOrderWithFidelityAndFixedValues)
{
  const auto assembler = MakeAssembler(Icosphere(4));
  const TriangleMesh& mesh = assembler->Mesh();
  PointData data = PointData::FromValues(Noise(mesh, 3));
  data.Start = Noise(mesh, 3, 8).array() + 100.0;
  for (Index i = 0; i < mesh.NumberOfVertices(); i += 7)
  {
    data.Fixed[i] = i % 2 == 0;
    data.Missing[i] = i % 3 == 0;
  }
  for (const double lambda : { 0.0, 4.0 })
  {
    for (const int steps : { 1, 2 })
    {
      const Values exact = Diffuse(assembler, data, 0.1, 2000, lambda);
      const Values u = Diffuse(assembler, data, 0.1, steps, lambda, Scheme::Exponential);
      EXPECT_LT((u - exact).cwiseAbs().maxCoeff(), 0.2) << lambda; // of differences of 100
      for (Index i = 0; i < mesh.NumberOfVertices(); ++i)
      {
        EXPECT_TRUE(!data.Fixed[i] || u.row(i) == data.Start.row(i));
      }
    }
  }
}

TEST(LinearDiffusion, CosineOnAStripDecaysWithInsulatedEnds)
{
  const double length = 2.0;
  for (const int k : { 1, 2 })
  {
    double coarser = 0.0;
    for (const Index columns : { 16, 32, 64 })
    {
      const Surface s = Rotated(Strip(columns, columns / 4, length, 0.5));
      const Surface flat = Strip(columns, columns / 4, length, 0.5);
      const auto assembler = MakeAssembler(s);
      const TriangleMesh& mesh = assembler->Mesh();
      const double wave = k * Pi / length;
      const Values start =
        Sample(mesh, flat, [&](const Eigen::RowVector3d& p) { return std::cos(wave * p[0]); });
      const double time = 0.5 / (wave * wave);
      const Values exact = std::exp(-0.5) * start;
      const Values u = Diffuse(assembler, PointData::FromValues(start), time, 50);
      const double error = RootMeanSquare(mesh, u - exact) / RootMeanSquare(mesh, exact);
      if (coarser > 0.0)
      {
        const double order = ObservedOrder(coarser, error);
        std::printf("k = %d, %d columns: error %.2e, order in h %.3f\n", k, columns, error, order);
        EXPECT_NEAR(order, 2.0, 0.1);
      }
      coarser = error;
    }
  }
}

TEST(LinearDiffusion, VarianceOfAGaussianGrowsByTwiceTheTimeInEachDirection)
{
  const Surface s = Plate(110, 9.0); // far boundary: the tails of backward Euler are long
  const auto assembler = MakeAssembler(s);
  const TriangleMesh& mesh = assembler->Mesh();
  const double width = 0.6;
  const Values start = Sample(mesh, s,
    [&](const Eigen::RowVector3d& p)
    { return std::exp(-p.squaredNorm() / (2.0 * width * width)); });
  const double time = 0.3;
  const auto moment = [&](const Values& u, int axis)
  {
    double sum = 0.0;
    double total = 0.0;
    for (Index i = 0; i < mesh.NumberOfVertices(); ++i)
    {
      const double x = s.Vertices(mesh.InputVertex()[i], axis);
      sum += mesh.ControlAreas()[i] * u(i, 0) * x * x;
      total += mesh.ControlAreas()[i] * u(i, 0);
    }
    return sum / total;
  };
  for (const Scheme scheme : { Scheme::BackwardEuler, Scheme::SDIRK2, Scheme::Exponential })
  {
    const Values u = Diffuse(assembler, PointData::FromValues(start), time, 10, 0.0, scheme);
    for (const int axis : { 0, 1 })
    {
      // Exact even for large steps: all schemes integrate quadratic polynomials exactly.
      EXPECT_NEAR(moment(u, axis) - moment(start, axis), 2.0 * time, 1e-6);
    }
  }
}

TEST(LinearDiffusion, GaussianOfARequestedWidthIsRealised)
{
  // FWHM = 4 sqrt(t ln 2) from a point: the shape after the time is the Gaussian of that width.
  const Surface s = Plate(80, 4.0);
  const auto assembler = MakeAssembler(s);
  const TriangleMesh& mesh = assembler->Mesh();
  const double fwhm = 2.0;
  const double before = 1.0;
  const auto time = [](double width) { return width * width / (16.0 * std::log(2.0)); };
  const auto gaussian = [&](double width)
  {
    const double t = time(width);
    return Sample(mesh, s,
      [&](const Eigen::RowVector3d& p) { return std::exp(-p.squaredNorm() / (4.0 * t)) / t; });
  };
  // Widths add in squares: from FWHM 1 by FWHM 2 to FWHM sqrt(5).
  const Values u = Diffuse(assembler, PointData::FromValues(gaussian(before)), time(fwhm), 16);
  const Values exact = gaussian(std::sqrt(fwhm * fwhm + before * before));
  EXPECT_LT(RootMeanSquare(mesh, u - exact) / RootMeanSquare(mesh, exact), 0.01);
}

TEST(LinearDiffusion, FidelityLeadsToTheWeightedSteadyState) // (16)
{
  const double lambda = 5.0;
  double coarser = 0.0;
  for (int subdivisions = 2; subdivisions <= 4; ++subdivisions)
  {
    const Surface s = Icosphere(subdivisions);
    const auto assembler = MakeAssembler(s);
    const TriangleMesh& mesh = assembler->Mesh();
    const Values f = Sample(mesh, s, [](const Eigen::RowVector3d& p) { return Harmonic(2, p); });
    const Values exact = lambda / (lambda + 6.0) * f;
    const Values limit =
      Diffuse(assembler, PointData::FromValues(f), 1.0, 1, lambda, Scheme::SteadyState);
    const double error = RootMeanSquare(mesh, limit - exact) / RootMeanSquare(mesh, exact);
    for (const Scheme scheme : { Scheme::BackwardEuler, Scheme::SDIRK2, Scheme::Exponential })
    {
      const Values u = Diffuse(assembler, PointData::FromValues(f), 20.0, 40, lambda, scheme);
      EXPECT_LT((u - limit).cwiseAbs().maxCoeff(), 1e-11);
    }
    if (coarser > 0.0)
    {
      const double order = ObservedOrder(coarser, error);
      std::printf("%d subdivisions: error %.2e, order in h %.3f\n", subdivisions, error, order);
      EXPECT_NEAR(order, 2.0, 0.1);
    }
    coarser = error;
  }
}

TEST(LinearDiffusion, FidelityOnTheWayIsOfTheSchemesOrder)
{
  // u = y(t) Y_2 with y' = -6 y + lambda (1 - y), on the discrete eigenvector closely enough.
  const Surface s = Icosphere(3);
  const auto assembler = MakeAssembler(s);
  const TriangleMesh& mesh = assembler->Mesh();
  PointData data = PointData::FromValues(
    Sample(mesh, s, [](const Eigen::RowVector3d& p) { return Harmonic(2, p); }));
  data.Start.setZero(); // another start than f: fidelity pulls it up
  const double lambda = 4.0;
  const double time = 0.2;
  const Values exact = Diffuse(assembler, data, time, 4096, lambda);
  for (const Scheme scheme : { Scheme::BackwardEuler, Scheme::SDIRK2 })
  {
    const auto error = [&](int steps)
    { return RootMeanSquare(mesh, Diffuse(assembler, data, time, steps, lambda, scheme) - exact); };
    EXPECT_NEAR(ObservedOrder(error(16), error(32)), scheme == Scheme::SDIRK2 ? 2.0 : 1.0, 0.1);
  }
}

/// Diffusion changes no mean, so that the mean follows y' = lambda (f - y) and its scheme alone,
/// however inexact the solver is: the mean of every solve is corrected, and that of the first
/// stage before the second stage takes it.
TEST(LinearDiffusion, MeanFollowsTheSchemeOfTheFidelityWithAnySolver)
{
  const auto assembler = MakeAssembler(Icosphere(4));
  const TriangleMesh& mesh = assembler->Mesh();
  PointData data = PointData::FromValues(Noise(mesh, 2));
  data.Start = Noise(mesh, 2, 8).array() + 0.5;
  const double lambda = 2.0, dt = 0.4;
  const double z = lambda * dt;
  const double g = 1.0 - std::sqrt(0.5);
  const double second = (1.0 - (1.0 - 2.0 * g) * z) / ((1.0 + g * z) * (1.0 + g * z));
  for (const auto& [scheme, factor] : { std::pair(Scheme::BackwardEuler, 1.0 / (1.0 + z)),
         std::pair(Scheme::SDIRK2, second), std::pair(Scheme::Exponential, SeriesAt(z)) })
  {
    const std::shared_ptr<LinearSolver> solver = MakeConjugateGradientSolver();
    solver->SetLimits({ 0.05, 1000 });
    const auto heat = MakeHeat(assembler, data, HeatSettings(mesh, dt, lambda, scheme), solver);
    heat->Advance(ProgressMonitor());
    for (int k = 0; k < 2; ++k)
    {
      const double given = Total(mesh, data.Given, k);
      const double expected = given + factor * (Total(mesh, data.Start, k) - given);
      EXPECT_NEAR(Total(mesh, heat->State(), k), expected, 1e-12 * mesh.ControlAreas().sum());
    }
  }
}

TEST(LinearDiffusion, FixedEndsOfAStripGiveALineBetweenThem)
{
  const double length = 3.0;
  const Surface flat = Jittered(Strip(24, 8, length, 1.0), 0.03, 0, length, 0, 1);
  const auto assembler = MakeAssembler(Rotated(flat));
  const TriangleMesh& mesh = assembler->Mesh();
  const Values exact =
    Sample(mesh, flat, [&](const Eigen::RowVector3d& p) { return 2.0 - 3.0 * p[0] / length; });
  PointData data = PointData::FromValues(Noise(mesh));
  for (Index i = 0; i < mesh.NumberOfVertices(); ++i)
  {
    const double x = flat.Vertices(mesh.InputVertex()[i], 0);
    data.Fixed[i] = x == 0.0 || x == length;
    if (data.Fixed[i])
    {
      data.Start(i, 0) = exact(i, 0);
    }
  }
  const Values limit = Diffuse(assembler, data, 1.0, 1, 0.0, Scheme::SteadyState);
  EXPECT_LT((limit - exact).cwiseAbs().maxCoeff(), 1e-12);
  for (const Scheme scheme : { Scheme::BackwardEuler, Scheme::SDIRK2, Scheme::Exponential })
  {
    const Values u = Diffuse(assembler, data, 200.0, 100, 0.0, scheme);
    EXPECT_LT((u - exact).cwiseAbs().maxCoeff(), 1e-9);
  }
}

TEST(LinearDiffusion, MissingValuesAreFilledHarmonicallyAndNeverRead) // (18)
{
  // Flat, f linear: the only solution that keeps known values is the line itself.
  const Surface s = Jittered(Strip(20, 20), 0.012, 0, 1, 0, 1);
  const auto assembler = MakeAssembler(s);
  const TriangleMesh& mesh = assembler->Mesh();
  const Values exact =
    Sample(mesh, s, [](const Eigen::RowVector3d& p) { return p[0] - 2.0 * p[1]; });
  PointData data = PointData::FromValues(exact);
  for (Index i = 0; i < mesh.NumberOfVertices(); ++i)
  {
    const Eigen::RowVector3d p = s.Vertices.row(mesh.InputVertex()[i]);
    if ((p - Eigen::RowVector3d(0.5, 0.5, 0.0)).norm() < 0.3)
    {
      data.Missing[i] = true;
      data.Given(i, 0) = 1e6; // must not be looked at
      data.Start(i, 0) = 0.0;
    }
  }
  // Held outside: harmonic inpainting reproduces the line.
  PointData held = data;
  held.Fixed = !data.Missing;
  const Values filled = Diffuse(assembler, held, 1.0, 1, 0.0, Scheme::SteadyState);
  EXPECT_LT((filled - exact).cwiseAbs().maxCoeff(), 1e-12);
  // Strong fidelity outside: nearly so.
  const Values u = Diffuse(assembler, data, 10.0, 20, 1e5);
  EXPECT_LT((u - exact).cwiseAbs().maxCoeff(), 0.01);
}

TEST(LinearDiffusion, EnergyOfAHarmonicIsItsEigenvalueTimesItsNorm)
{
  const Surface s = Icosphere(5);
  const auto assembler = MakeAssembler(s);
  const TriangleMesh& mesh = assembler->Mesh();
  const Values f = Sample(mesh, s, [](const Eigen::RowVector3d& p) { return Harmonic(2, p); });
  const auto energy = [&](double lambda)
  {
    PointData data = PointData::FromValues(f);
    data.Given.setZero();
    return MakeHeat(assembler, data, HeatSettings(mesh, 1.0, lambda))->Energy();
  };
  const double norm = 4.0 * Pi * std::pow(RootMeanSquare(mesh, f), 2);
  EXPECT_NEAR(energy(0.0), 0.5 * 6.0 * norm, 2e-3 * energy(0.0));
  EXPECT_NEAR(energy(7.0) - energy(0.0), 0.5 * 7.0 * norm, 2e-3 * energy(0.0));
}

/// The sum of the energy is taken in parts of 524,288 triangles.
TEST(LinearDiffusion, EnergyOfALinearFunctionIsExactOnAnyNumberOfTriangles)
{
  Surface s = Strip(740, 360, 2.0, 1.0);
  s.Vertices.col(1) = s.Vertices.col(1).array().square().eval(); // uneven weights
  const auto assembler = MakeAssembler(s);
  const TriangleMesh& mesh = assembler->Mesh();
  ASSERT_GT(mesh.NumberOfTriangles(), 256 * BlockSize);
  const Values f =
    Sample(mesh, s, [](const Eigen::RowVector3d& x) { return 3.0 * x[0] - 4.0 * x[1]; });
  const double exact = 0.5 * 2.0 * 25.0;
  EXPECT_NEAR(DirichletEnergy(mesh, CotanWeights(mesh), f, SerialFor()), exact, 1e-9 * exact);
  EXPECT_NEAR(DirichletEnergy(mesh, CornerWeights(), f, SerialFor()), exact, 1e-9 * exact);
}

TEST(LinearDiffusion, ColumnsTogetherHaveTheBitsThatTheyHaveAlone)
{
  for (const Eigen::Index columns : { 2, 3, 5 })
  {
    const auto assembler = MakeAssembler(Icosphere(3));
    Values f = Noise(assembler->Mesh(), columns);
    f.col(1).array() += 3.0;
    PointData all = PointData::FromValues(f);
    all.Missing.head(30) = true;
    all.Fixed.tail(20) = true;
    const auto run = [&](const PointData& data)
    {
      const auto heat = MakeHeat(
        assembler, data, HeatSettings(assembler->Mesh(), 0.01, 5.0), MakeConjugateGradientSolver());
      Advance(*heat, 4);
      return heat->State();
    };
    const Values together = run(all);
    for (Eigen::Index k = 0; k < columns; ++k)
    {
      PointData one = all;
      one.Given = all.Given.col(k).eval();
      one.Start = all.Start.col(k).eval();
      EXPECT_TRUE(run(one).col(0) == together.col(k)) << k << " of " << columns;
    }
  }
}
