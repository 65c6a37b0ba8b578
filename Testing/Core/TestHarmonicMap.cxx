// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "HarmonicMaps.h"
#include "Heat.h"

#include <gtest/gtest.h>

#include <cstdio>
#include <utility>

using namespace SurfaceDiffusion;
using namespace SurfaceDiffusion::Testing;

// Exact solutions of (20), (21) and of the exponents between.

TEST(HarmonicMap, GreatCircleObeysTheHeatEquationForExponentTwo)
{
  // psi = z is an eigenfunction of the sphere with eigenvalue 2.
  const double time = 0.3;
  double coarser = 0.0;
  for (int subdivisions = 3; subdivisions <= 4; ++subdivisions)
  {
    const Surface s = Icosphere(subdivisions);
    const auto assembler = MakeAssembler(s);
    const TriangleMesh& mesh = assembler->Mesh();
    const auto psi = [](const Eigen::RowVector3d& x) { return 0.8 * x[2]; };
    const int steps = subdivisions == 3 ? 30 : 120; // dt ~ h^2
    const auto map = MakeMap(assembler, PointData::FromValues(SampleGreatCircle(mesh, s, psi)),
      MapSettings(mesh, 2.0, time / steps));
    Advance(*map, steps);
    const Values exact = std::exp(-2.0 * time) * Sample(mesh, s, psi);
    const double error =
      RootMeanSquare(mesh, Angles(map->State()) - exact) / RootMeanSquare(mesh, exact);
    std::printf("%d subdivisions: error %.2e\n", subdivisions, error);
    EXPECT_LT(map->State().col(2).cwiseAbs().maxCoeff(), 1e-12);
    if (coarser > 0.0)
    {
      EXPECT_NEAR(ObservedOrder(coarser, error), 2.0, 0.2);
      EXPECT_LT(error, 2e-3);
    }
    coarser = error;
  }
}

namespace
{

/// Error, in percent, of the plateaus of (21) started from psi = jump inside theta < 60 degrees on
/// the unit sphere and 0 outside: those of the total variation flow, jump - t cot(30 deg) and
/// t tan(30 deg), taken at least 0.25 rad from the edge.
std::pair<double, double> CapErrors(MapScheme scheme, double time, int steps)
{
  const double edge = Pi / 3.0;
  const double jump = 0.2;
  const Surface s = Icosphere(4);
  const auto assembler = MakeAssembler(s);
  const TriangleMesh& mesh = assembler->Mesh();
  const auto theta = [](const Eigen::RowVector3d& x) { return std::acos(x[2] / x.norm()); };
  const auto map = MakeMap(assembler,
    PointData::FromValues(SampleGreatCircle(
      mesh, s, [&](const Eigen::RowVector3d& x) { return theta(x) < edge ? jump : 0.0; })),
    MapSettings(mesh, 1.0, time / steps, 1e-8, scheme));
  Advance(*map, steps);
  const Values psi = Angles(map->State());
  const Values distance = Sample(mesh, s, theta);
  double sums[2] = { 0.0, 0.0 };
  int counts[2] = { 0, 0 };
  for (Index i = 0; i < mesh.NumberOfVertices(); ++i)
  {
    const int side = distance(i, 0) < edge ? 0 : 1;
    if (std::abs(distance(i, 0) - edge) > 0.25)
    {
      sums[side] += psi(i, 0);
      ++counts[side];
    }
  }
  const double inside = jump - time / std::tan(0.5 * edge);
  const double outside = time * std::tan(0.5 * edge);
  return { 100.0 * (sums[0] / counts[0] / inside - 1.0),
    100.0 * (sums[1] / counts[1] / outside - 1.0) };
}

} // namespace

TEST(HarmonicMap, GreatCircleObeysTheTotalVariationFlowForExponentOne)
{
  // The rest is the error of P1 elements at a jump that cuts across triangles, measured for
  // total variation itself at -2 % / +4 % with 100 lagged steps, -1.3 % / +2.4 % without lag.
  const double time = 0.04;
  const auto lagged = CapErrors(MapScheme::TangentPlane, time, 40);
  const auto full = CapErrors(MapScheme::MinimizingMovement, time, 1);
  std::printf("plateaus, error in %%: lagged %.2f / %.2f, minimising movements %.2f / %.2f\n",
    lagged.first, lagged.second, full.first, full.second);
  EXPECT_LT(std::abs(lagged.first), 4.0);
  EXPECT_LT(std::abs(lagged.second), 7.0);
  EXPECT_LT(std::abs(full.first), 3.0);
  EXPECT_LT(std::abs(full.second), 5.0);
}

TEST(HarmonicMap, IdentityOfTheSphereRestsAndHasEnergyFourPi)
{
  double coarser = 0.0;
  for (int subdivisions = 3; subdivisions <= 5; ++subdivisions)
  {
    const Surface s = Icosphere(subdivisions);
    const auto assembler = MakeAssembler(s);
    const TriangleMesh& mesh = assembler->Mesh();
    const Values identity = SampleUnit(mesh, s, 3, [](const Eigen::RowVector3d& x) { return x; });
    const auto map =
      MakeMap(assembler, PointData::FromValues(identity), MapSettings(mesh, 2.0, 0.1));
    const double error = std::abs(map->Energy() / (4.0 * Pi) - 1.0);
    Advance(*map, 5);
    const double motion = (map->State() - identity).rowwise().norm().maxCoeff();
    std::printf("%d subdivisions: energy error %.2e, motion %.2e\n", subdivisions, error, motion);
    EXPECT_LT(motion, error);
    if (coarser > 0.0)
    {
      EXPECT_NEAR(ObservedOrder(coarser, error), 2.0, 0.1);
    }
    coarser = error;
  }
  EXPECT_LT(coarser, 1e-3);
}

TEST(HarmonicMap, PerturbedIdentityDecaysAtTheEigenvalueOfTheJacobiOperator)
{
  // |grad u|^2 = 2 for the identity, so that its energy is 4 pi 2^(p/2) / p. The second variation
  // of the energy in the direction of the gradient of a harmonic of degree l has the eigenvalue
  // 2^(p/2 - 1) (l (l + 1) - 2 + (p/2 - 1) l (l + 1)). For p = 2 it is 0 for l = 1, the directions
  // of the conformal maps, all of which have the same energy; for p < 2 they grow.
  const double size = 1e-3;
  const double time = 0.2;
  const int steps = 100;
  const Surface s = Icosphere(3);
  const auto assembler = MakeAssembler(s);
  const TriangleMesh& mesh = assembler->Mesh();
  const auto identity = [](const Eigen::RowVector3d& x) { return x; };
  for (const auto& [degree, exponent] : { std::pair{ 1, 2.0 }, std::pair{ 2, 2.0 },
         std::pair{ 1, 1.5 }, std::pair{ 2, 1.5 }, std::pair{ 2, 1.2 }, std::pair{ 2, 1.0 } })
  {
    const bool first = degree == 1;
    const auto gradient = [&](const Eigen::RowVector3d& x)
    {
      const Eigen::RowVector3d g =
        first ? Eigen::RowVector3d(0.0, 0.0, 1.0) : Eigen::RowVector3d(x[1], x[0], 0.0);
      return Eigen::RowVector3d(g - g.dot(x) * x);
    };
    const Values rest = SampleUnit(mesh, s, 3, identity);
    const auto settings = MapSettings(mesh, exponent, time / steps);
    const auto still = MakeMap(assembler, PointData::FromValues(rest), settings);
    const auto moved = MakeMap(assembler,
      PointData::FromValues(SampleUnit(mesh, s, 3,
        [&](const Eigen::RowVector3d& x) { return Eigen::RowVector3d(x + size * gradient(x)); })),
      settings);
    const double before = RootMeanSquare(mesh, moved->State() - still->State());
    Advance(*still, steps);
    Advance(*moved, steps);
    const double after = RootMeanSquare(mesh, moved->State() - still->State());
    const double rate = std::log(before / after) / time;
    const double half = 0.5 * exponent;
    const double l = degree * (degree + 1.0);
    const double exact = std::pow(2.0, half - 1.0) * (l - 2.0 + (half - 1.0) * l);
    std::printf("p = %.1f, degree %d: rate %.4f, exact %.4f\n", exponent, degree, rate, exact);
    EXPECT_NEAR(rate, exact, 0.1);
    EXPECT_NEAR(still->Energy() * std::pow(mesh.LengthUnit(), 2.0 - exponent),
      4.0 * Pi * std::pow(2.0, half) / exponent, 0.02 * 4.0 * Pi);
  }
}

TEST(HarmonicMap, PerturbedGreatCircleDecaysAtTheRateOfItsExponent)
{
  // psi = n phi + small cos(q z) on a cylinder of radius 1: grad psi is n around, so that the
  // perturbation along the axis decays at n^(p-2) q^2.
  const int winding = 3;
  const double length = 2.0;
  const double q = Pi / length;
  const double size = 1e-3;
  const double time = 0.3;
  const int steps = 30;
  const Surface s = Cylinder(96, 48, 1.0, length);
  const auto assembler = MakeAssembler(s);
  const TriangleMesh& mesh = assembler->Mesh();
  const auto around = [&](const Eigen::RowVector3d& x) { return winding * std::atan2(x[1], x[0]); };
  for (const double exponent : { 1.0, 1.3, 2.0 })
  {
    const auto run = [&](double amplitude)
    {
      const auto map = MakeMap(assembler,
        PointData::FromValues(SampleUnit(mesh, s, 2,
          [&](const Eigen::RowVector3d& x)
          {
            const double psi = around(x) + amplitude * std::cos(q * x[2]);
            return Eigen::RowVector2d(std::cos(psi), std::sin(psi));
          })),
        MapSettings(mesh, exponent, time / steps));
      Advance(*map, steps);
      return map->State();
    };
    const Values difference = run(size) - run(0.0);
    const double left =
      RootMeanSquare(mesh, difference) * std::sqrt(2.0) / size; // a cosine's mean square is 1/2
    // The step x in the tangent spaces, which turn with u, has |grad(x)|^2 = (q^2 + n^2) x^2: the
    // scheme's factor per step is known too, and tends to exp(-rate dt).
    const double dt = time / steps;
    const double g = std::pow(winding, exponent - 2.0);
    const double factor = 1.0 - dt * g * q * q / (1.0 + dt * g * (q * q + winding * winding));
    const double rate = -std::log(left) / time;
    std::printf("p = %.1f: rate %.4f, of the scheme %.4f, of the equation %.4f\n", exponent, rate,
      -std::log(factor) / dt, g * q * q);
    EXPECT_NEAR(rate, -std::log(factor) / dt, 0.01 * rate);
    EXPECT_NEAR(rate, g * q * q, dt * g * g * q * q * (q * q + winding * winding));
  }
}

// The behaviour of the paper's splitting, known from its equations.

TEST(HarmonicMap, ExplicitReactionSolvesThePrintedEquations)
{
  const Surface s = Jittered(Strip(4, 3, 1.0, 0.8), 0.05, 0.01, 0.99, 0.01, 0.79);
  const auto assembler = MakeAssembler(s);
  const TriangleMesh& mesh = assembler->Mesh();
  const Index n = mesh.NumberOfVertices();
  const Values f = RandomUnitVectors(mesh, 3);
  for (const double exponent : { 1.0, 1.6, 2.0 })
  {
    for (const bool consistent : { false, true })
    {
      HarmonicMap::Settings settings;
      settings.Exponent = exponent;
      settings.TimeStep = 0.03;
      settings.Beta = 0.2;
      settings.Fidelity = 2.0;
      settings.TimeScheme = MapScheme::ExplicitReaction;
      settings.ConsistentReaction = consistent;
      const auto map = MakeMap(assembler, PointData::FromValues(f), settings);
      Advance(*map, 1);

      // The same with dense matrices, gradients from the corners' coordinates.
      Eigen::MatrixXd matrix = mesh.ControlAreas().asDiagonal();
      matrix *= 1.0 + settings.TimeStep * settings.Fidelity;
      Eigen::MatrixXd right = mesh.ControlAreas().asDiagonal() * f;
      right *= 1.0 + settings.TimeStep * settings.Fidelity;
      for (Index t = 0; t < mesh.NumberOfTriangles(); ++t)
      {
        const TriangleMesh::Shape shape = mesh.Shapes()[t];
        const auto v = mesh.TriangleVertices().row(t);
        double square = 0.0;
        for (int k = 0; k < 3; ++k)
        {
          square += Gradient(shape, f(v[0], k), f(v[1], k), f(v[2], k)).squaredNorm();
        }
        const double g = std::pow(square + settings.Beta, 0.5 * (exponent - 2.0));
        const double reaction = consistent ? g * square : std::pow(std::sqrt(square), exponent);
        for (int a = 0; a < 3; ++a)
        {
          const Eigen::Vector2d ga = Gradient(shape, a == 0, a == 1, a == 2);
          for (int b = 0; b < 3; ++b)
          {
            matrix(v[a], v[b]) += settings.TimeStep * g * shape.Area() *
              ga.dot(Gradient(shape, b == 0, b == 1, b == 2));
          }
          right.row(v[a]) += settings.TimeStep * shape.Area() / 3.0 * reaction * f.row(v[a]);
        }
      }
      Eigen::MatrixXd exact = matrix.ldlt().solve(right);
      exact.rowwise().normalize();
      EXPECT_LT((map->State() - exact).cwiseAbs().maxCoeff(), 1e-12) << "of " << n << " vertices";
    }
  }
}

TEST(HarmonicMap, LengthErrorsGrowAtRateFourWithoutProjection)
{
  // (20) near the identity of the sphere, u = (1 + d) x: d' = -2 (1 + d) + 2 (1 + d)^3.
  const double start = 1e-4;
  const double time = 0.5;
  const int steps = 500;
  const Surface s = Icosphere(3);
  const auto assembler = MakeAssembler(s);
  const TriangleMesh& mesh = assembler->Mesh();
  const Values identity = SampleUnit(mesh, s, 3, [](const Eigen::RowVector3d& x) { return x; });
  auto settings = MapSettings(mesh, 2.0, time / steps, 0.0, MapScheme::ExplicitReaction);
  settings.ProjectToSphere = false;
  const auto run = [&](double length)
  {
    const auto map = MakeMap(assembler, PointData::FromValues(length * identity), settings);
    Advance(*map, steps);
    return map->State();
  };
  const double grown = RootMeanSquare(mesh, run(1.0 + start) - run(1.0 - start)) / (2.0 * start);
  EXPECT_NEAR(std::log(grown) / time, 4.0, 0.1);
}

TEST(HarmonicMap, ConsistentReactionKeepsTheLengthWhereThePrintedOneDrifts)
{
  const Surface s = Cylinder(64, 16);
  const auto assembler = MakeAssembler(s);
  const TriangleMesh& mesh = assembler->Mesh();
  const Values start = SampleGreatCircle(
    mesh, s, [](const Eigen::RowVector3d& x) { return 0.6 * std::sin(std::atan2(x[1], x[0])); });
  double drift[2];
  for (const bool consistent : { false, true })
  {
    auto settings = MapSettings(mesh, 1.0, 1e-3, 0.1, MapScheme::ExplicitReaction);
    settings.ProjectToSphere = false;
    settings.ConsistentReaction = consistent;
    const auto map = MakeMap(assembler, PointData::FromValues(start), settings);
    Advance(*map, 200);
    drift[consistent] = LargestLengthError(map->State());
  }
  std::printf("|u| - 1: printed %.2e, consistent %.2e\n", drift[0], drift[1]);
  EXPECT_LT(drift[1], 0.1 * drift[0]);
  EXPECT_LT(drift[1], 2e-3);
}
