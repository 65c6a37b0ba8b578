// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Interpolation.h"

#include "Core/Models/Interpolation/InfluenceSpectrum.h"
#include "Core/Models/Interpolation/SmoothFit.h"

#include <Eigen/Dense>
#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>
#include <ctime>

using namespace SurfaceDiffusion;
using namespace SurfaceDiffusion::Testing;

namespace
{

double ProcessSeconds()
{
  return static_cast<double>(std::clock()) / CLOCKS_PER_SEC;
}

Values WithNoise(const TriangleMesh& mesh, Values field, double deviation, std::int64_t seed)
{
  for (Index i = 0; i < mesh.NumberOfVertices(); ++i)
  {
    field(i, 0) += deviation * Gaussian(seed, 0, mesh.InputVertex()[i]);
  }
  return field;
}

} // namespace

TEST(Smoothing, DampsSphericalHarmonicsAtTheirEigenvalues)
{
  // Weights A_i, data everywhere: the factor is 1 / (1 + mu (l (l + 1) / R^2 + kappa^2)^2).
  const double radius = 2.0;
  for (const RimCondition rim : { RimCondition::Natural, RimCondition::Free })
  {
    double coarser = 0.0;
    for (int subdivisions = 3; subdivisions <= 5; ++subdivisions)
    {
      const Surface s = Icosphere(subdivisions, radius);
      const auto assembler = MakeAssembler(s);
      const TriangleMesh& mesh = assembler->Mesh();
      const double unit = mesh.LengthUnit();
      double worst = 0.0;
      for (const double kappa : { 0.0, 0.8 })
      {
        const double mu = 0.3;
        const auto harmonic = [](const Eigen::RowVector3d& x)
        { return Eigen::RowVector3d(x[0] * x[1] * x[2], x[0] * x[0] - x[1] * x[1], x[2]); };
        Values field(mesh.NumberOfVertices(), 3);
        for (Index i = 0; i < mesh.NumberOfVertices(); ++i)
        {
          field.row(i) = harmonic(s.Vertices.row(mesh.InputVertex()[i]));
        }
        auto data =
          ScatteredValues::AtVertices(field, Flags::Constant(mesh.NumberOfVertices(), true));
        data.Weights = mesh.ControlAreas() * unit * unit;
        Interpolation::Settings settings = InterpolationSettings(Choice::Given, mu / (unit * unit));
        settings.Kappa = kappa * unit;
        settings.Rim = rim;
        const Values u = Interpolate(assembler, data, settings).U;
        for (int l = 1; l <= 3; ++l)
        {
          const Eigen::Index column = 3 - l;
          const double factor =
            u.col(column).dot(field.col(column)) / field.col(column).squaredNorm();
          const double operation = l * (l + 1) / (radius * radius) + kappa * kappa;
          worst = std::max(worst, std::abs(factor * (1.0 + mu * operation * operation) - 1.0));
        }
      }
      std::printf("%d subdivisions: %.2e\n", subdivisions, worst);
      if (coarser > 0.0)
      {
        // Gradients of linear elements at edges, of Free, are of first order where the mesh is
        // irregular: at the twelve vertices of the icosahedron.
        EXPECT_GT(ObservedOrder(coarser, worst), rim == RimCondition::Natural ? 1.8 : 0.6);
      }
      coarser = worst;
    }
    EXPECT_LT(coarser, 2e-3);
  }
}

TEST(Smoothing, ByCrossValidationComesNearTheBestOnNoisyValues)
{
  // The mean over ten draws of noise 1.0; a single one depends on the draw.
  for (int subdivisions = 3; subdivisions <= 4; ++subdivisions)
  {
    const Surface s = Icosphere(subdivisions);
    const auto assembler = MakeAssembler(s);
    const TriangleMesh& mesh = assembler->Mesh();
    const Values field = Sample(mesh, s, SeaTemperature);
    const int draws = 10;
    double automatic = 0.0, known = 0.0, level = 0.0;
    for (int draw = 0; draw < draws; ++draw)
    {
      const auto data =
        ValuesAt(mesh, WithNoise(mesh, field, 1.0, draw), [](Index i) { return i < 162; });
      Interpolation::Settings settings;
      const auto result = Interpolate(assembler, data, settings);
      automatic += RootMeanSquare(mesh, result.U - field) / draws;
      level += result.Columns[0].NoiseLevel / draws;
      settings.Smoothing = Choice::NoiseLevel;
      settings.NoiseLevel = 1.0;
      known += RootMeanSquare(mesh, Interpolate(assembler, data, settings).U - field) / draws;
    }
    std::printf("%6d vertices: error %.3f, with the noise level %.3f, estimated level %.3f\n",
      mesh.NumberOfVertices(), automatic, known, level);
    EXPECT_LT(automatic, 0.55);
    EXPECT_LT(known, 0.55);
    EXPECT_NEAR(level, 1.0, 0.2);
  }
}

TEST(Smoothing, MeasuresAreThoseOfTheInfluenceMatrix)
{
  const Surface s = Torus(24, 14);
  const auto assembler = MakeAssembler(s);
  const TriangleMesh& mesh = assembler->Mesh();
  const Values field = WithNoise(
    mesh, Sample(mesh, s, [](const Eigen::RowVector3d& x) { return x[0] * x[2]; }), 0.3, 4);
  ScatteredValues data = ValuesInTriangles(mesh, field, 60);
  for (Index i = 0; i < data.Count(); ++i)
  {
    data.Weights[i] = 0.5 + UniformRandom(8, 0, i);
  }
  const SmoothnessEnergy energy(*assembler, CotanWeights(mesh), 0.0, RimCondition::Natural);
  SmoothFit fit(energy, data, false, SerialFor());
  const Flags none = Flags::Constant(mesh.NumberOfVertices(), false);
  fit.Prepare(0.02, none, false, ProgressMonitor());
  const InfluenceSpectrum spectrum(fit, data, InfluenceSpectrum::Determinant());
  Eigen::MatrixXd b = Eigen::MatrixXd::Zero(data.Count(), mesh.NumberOfVertices());
  for (Index i = 0; i < data.Count(); ++i)
  {
    for (int a = 0; a < 3; ++a)
    {
      b(i, data.Places[i].Vertices[a]) += data.Places[i].Coordinates[a];
    }
  }
  const Eigen::MatrixXd weighted = b.transpose() * data.Weights.asDiagonal();
  for (const double mu : { 1e-5, 1e-2, 0.02, 3.0 })
  {
    const Eigen::MatrixXd h = weighted * b + mu * Eigen::MatrixXd(energy.Matrix());
    const Eigen::MatrixXd influence = b * h.inverse() * weighted;
    const Vector left = data.Given - influence * data.Given;
    const double residual = data.Weights.dot(left.cwiseAbs2());
    const double trace = influence.trace();
    EXPECT_NEAR(spectrum.DegreesOfFreedom(mu), trace, 1e-6 * trace);
    EXPECT_NEAR(spectrum.Residual(mu, 0), residual, 1e-6 * residual);
    EXPECT_NEAR(
      spectrum.Score(mu, 0), 60.0 * residual / std::pow(60.0 - trace, 2), 1e-6 * residual);
  }
}

TEST(Smoothing, OfManyValuesIsTheBestInAllUnitsAndDirections)
{
  const Surface s = Icosphere(4);
  const auto assembler = MakeAssembler(s);
  const TriangleMesh& mesh = assembler->Mesh();
  const Values field = Sample(mesh, s, SeaTemperature);
  for (const double noise : { 0.2, 1.0, 5.0 })
  {
    const auto data =
      ValuesAt(mesh, WithNoise(mesh, field, noise, 2), [](Index i) { return i % 2 == 0; });
    ASSERT_GT(data.Count(), InfluenceSpectrum::FewValues);
    Interpolation::Settings settings;
    const auto result = Interpolate(assembler, data, settings);
    // The same values on a copy, large and turned
    const auto moved = MakeAssembler(Scaled(Rotated(s, 2.0), 1e3));
    const Values expected = ToInput(mesh, result.U, s.NumberOfVertices());
    Values noisy = Values::Zero(s.NumberOfVertices(), 1);
    for (Index i = 0; i < data.Count(); ++i)
    {
      noisy.row(mesh.InputVertex()[data.Places[i].Vertex()]) = data.Given.row(i);
    }
    const auto again = Interpolate(moved,
      ValuesAt(
        moved->Mesh(), GatherVertices(moved->Mesh(), noisy), [](Index i) { return i % 2 == 0; }),
      settings);
    const double difference =
      (ToInput(moved->Mesh(), again.U, s.NumberOfVertices()) - expected).cwiseAbs().maxCoeff();
    EXPECT_LT(difference, 1e-9 * 30.0); // of the field's range
    // Errors of the best of all mu, which the truth gives.
    double best = 1e300;
    settings.Smoothing = Choice::Given;
    for (double factor = 1e-3; factor < 1e3; factor *= 1.6)
    {
      settings.Mu = factor * result.Columns[0].Mu;
      best = std::min(best, RootMeanSquare(mesh, Interpolate(assembler, data, settings).U - field));
    }
    const double error = RootMeanSquare(mesh, result.U - field);
    std::printf("noise %.1f: error %.4f, best %.4f, mu %.2e, freedom %.1f, difference %.1e\n",
      noise, error, best, result.Columns[0].Mu, result.Columns[0].DegreesOfFreedom, difference);
    EXPECT_LT(error, 1.1 * best);
    EXPECT_NEAR(result.Columns[0].NoiseLevel, noise, 0.08 * noise);
  }
}

TEST(Smoothing, TreatsComponentsOfDifferentSizesAlone)
{
  const Surface s = Icosphere(3);
  const auto assembler = MakeAssembler(s);
  const TriangleMesh& mesh = assembler->Mesh();
  const Values first = WithNoise(mesh, Sample(mesh, s, SeaTemperature), 1.0, 1);
  const Values second = WithNoise(
    mesh, Sample(mesh, s, [](const Eigen::RowVector3d& x) { return 1e-6 * x[2]; }), 1e-6, 2);
  Values both(first.rows(), 2);
  both << first, second;
  const auto known = [](Index i) { return i < 162; };
  Interpolation::Settings settings;
  settings.ComputeError = true;
  const auto together = Interpolate(assembler, ValuesAt(mesh, both, known), settings);
  for (Eigen::Index c = 0; c < 2; ++c)
  {
    const Values column = both.col(c);
    const auto alone = Interpolate(assembler, ValuesAt(mesh, column, known), settings);
    EXPECT_EQ(together.Columns[static_cast<std::size_t>(c)].Mu, alone.Columns[0].Mu);
    EXPECT_EQ(Values(together.U.col(c)), alone.U);
    EXPECT_EQ(Values(together.Error.col(c)), alone.Error);
  }
}

TEST(Smoothing, ByCrossValidationTakesAtMostFourTimesOneSolve)
{
  const Surface s = Icosphere(5);
  const auto assembler = MakeAssembler(s);
  const TriangleMesh& mesh = assembler->Mesh();
  const Values field = WithNoise(mesh, Sample(mesh, s, SeaTemperature), 1.0, 6);
  for (const Index step : { 64, 2 }) // 161 values, and 5,121
  {
    const auto data = ValuesAt(mesh, field, [&](Index i) { return i % step == 0; });
    const auto seconds = [&](const Interpolation::Settings& settings)
    {
      double least = 1e300; // of three, since other work on the machine disturbs them
      for (int i = 0; i < 3; ++i)
      {
        const double start = ProcessSeconds();
        Interpolate(assembler, data, settings);
        least = std::min(least, ProcessSeconds() - start);
      }
      return least;
    };
    const double exact = seconds(InterpolationSettings(Choice::Exact));
    const double automatic = seconds(InterpolationSettings(Choice::Automatic));
    std::printf("%d values: exact %.3f s, automatic %.3f s\n", data.Count(), exact, automatic);
    EXPECT_LT(automatic, 4.0 * exact);
  }
}

TEST(Smoothing, HasStandardErrorsThatCoverTheTruth)
{
  // Fields of the model itself: its precision is mu Q, of values with the noise 0.3.
  const Surface s = Icosphere(3);
  const auto assembler = MakeAssembler(s);
  const TriangleMesh& mesh = assembler->Mesh();
  const Index n = mesh.NumberOfVertices();
  const double kappa = 2.0 * mesh.LengthUnit();
  const double mu = 0.02;
  const double noise = 0.3;
  const SmoothnessEnergy energy(*assembler, CotanWeights(mesh), kappa, RimCondition::Natural);
  const Eigen::LLT<Eigen::MatrixXd> factor(mu / (noise * noise) * Eigen::MatrixXd(energy.Matrix()));
  const Index fields = 1000;
  Values truth(n, fields);
  for (Index i = 0; i < n; ++i)
  {
    for (Index f = 0; f < fields; ++f)
    {
      truth(i, f) = Gaussian(11, f, i);
    }
  }
  truth = Values(factor.matrixU().solve(Eigen::MatrixXd(truth)));
  Values measured = truth;
  for (Index i = 0; i < n; ++i)
  {
    for (Index f = 0; f < fields; ++f)
    {
      measured(i, f) += noise * Gaussian(12, f, i);
    }
  }
  const auto known = [](Index i) { return i < 162; };
  Interpolation::Settings settings = InterpolationSettings(Choice::Given, mu);
  settings.Kappa = kappa;
  settings.NoiseLevel = noise;
  settings.ComputeError = true;
  const auto result = Interpolate(assembler, ValuesAt(mesh, measured, known), settings);
  constexpr double quantile = 1.6448536269514722; // of 90 %, on both sides
  const auto covered = [&](const Interpolation::Result& r, Index first, Index count)
  {
    return ((r.U - truth.middleCols(first, count)).cwiseAbs().array() <= quantile * r.Error.array())
      .cast<double>()
      .mean();
  };
  const double given = covered(result, 0, fields);
  // With mu and the noise from the data, on some of the fields
  settings = Interpolation::Settings();
  settings.Kappa = kappa;
  settings.ComputeError = true;
  const Index some = 40;
  const auto automatic =
    Interpolate(assembler, ValuesAt(mesh, measured.leftCols(some), known), settings);
  const double found = covered(automatic, 0, some);
  std::printf("within the band of 90 %%: %.2f %%; with the model of the data %.2f %%\n",
    100.0 * given, 100.0 * found);
  EXPECT_NEAR(given, 0.9, 0.03);
  EXPECT_NEAR(found, 0.9, 0.06);
}

TEST(Smoothing, StandardErrorsAreThoseOfTheDenseMatrix)
{
  const Surface s = Disk(6);
  const auto assembler = MakeAssembler(s);
  const TriangleMesh& mesh = assembler->Mesh();
  const Values field = Noise(mesh);
  for (const RimCondition rim : { RimCondition::Natural, RimCondition::Free })
  {
    Interpolation::Settings settings = InterpolationSettings(Choice::Given, 0.01);
    settings.Rim = rim;
    settings.NoiseLevel = 0.5;
    settings.ComputeError = true;
    const auto data = ValuesAt(mesh, field, [](Index i) { return i % 4 == 0; });
    const SmoothnessEnergy energy(*assembler, CotanWeights(mesh), 0.0, rim);
    Eigen::MatrixXd h = 0.01 * Eigen::MatrixXd(energy.Matrix());
    for (Index i = 0; i < data.Count(); ++i)
    {
      h(data.Places[i].Vertex(), data.Places[i].Vertex()) += 1.0;
    }
    const Vector expected = 0.5 * h.inverse().diagonal().cwiseSqrt();
    const Vector error = Interpolate(assembler, data, settings).Error.col(0);
    EXPECT_LT((error - expected).norm(), 1e-8 * expected.norm());
  }
}

/// The errors of the linear predictor L of the fit and its mean: the diagonal of
/// (L B - 1) C (L B - 1)^T + L W^-1 L^T s^2, with the covariance C of the field.
TEST(Smoothing, StandardErrorsContainThatOfTheMean)
{
  const Surface s = Joined(Disk(5), Moved(Icosphere(1, 0.4), { 3.0, 0.0, 0.0 }));
  const auto assembler = MakeAssembler(s);
  const TriangleMesh& mesh = assembler->Mesh();
  const Index n = mesh.NumberOfVertices();
  ScatteredValues data = ValuesInTriangles(mesh, Noise(mesh), 12);
  const Index d = data.Count();
  data.Given = Values::Identity(d, d); // the columns of L
  for (Index i = 0; i < d; ++i)
  {
    data.Weights[i] = 1.0 + 0.2 * (i % 4);
  }
  Eigen::MatrixXd b = Eigen::MatrixXd::Zero(d, n);
  for (Index i = 0; i < d; ++i)
  {
    for (std::size_t a = 0; a < 3; ++a)
    {
      b(i, data.Places[i].Vertices[a]) += data.Places[i].Coordinates[a];
    }
  }
  const double noise = 0.7;
  for (const Choice choice : { Choice::Given, Choice::Exact })
  {
    for (const RimCondition rim : { RimCondition::Natural, RimCondition::Free })
    {
      for (const double length : { 0.1, 0.5, 5.0 })
      {
        Interpolation::Settings settings = InterpolationSettings(choice, 0.02);
        settings.Rim = rim;
        settings.Kappa = mesh.LengthUnit() / length;
        settings.ComputeError = true;
        settings.NoiseLevel = noise;
        const Interpolation::Result result = Interpolate(assembler, data, settings);
        const SmoothnessEnergy energy(*assembler, CotanWeights(mesh), settings.Kappa, rim);
        const Eigen::MatrixXd field = Eigen::MatrixXd(energy.Matrix()).inverse();
        const Eigen::MatrixXd error = result.U * b - Eigen::MatrixXd::Identity(n, n);
        const Vector variance = (error * field * error.transpose()).diagonal();
        const Vector ofNoise =
          (result.U * data.Weights.cwiseInverse().asDiagonal() * result.U.transpose()).diagonal();
        for (Eigen::Index c = 0; c < d; ++c)
        {
          const bool isExact = choice == Choice::Exact;
          // Exact values that are alike on a part say nothing of the variance of the field there.
          const auto isKnown = (result.Error.col(c).array() >= 0.0).eval();
          ASSERT_TRUE(isExact ? isKnown.any() : isKnown.all());
          const Vector expected = isKnown.select(
            isExact ? variance : Vector(noise * noise * (variance / 0.02 + ofNoise)), 0.0);
          const Vector found = isKnown.select(result.Error.col(c).cwiseAbs2(), 0.0);
          // Exact values hold by a penalty, and their errors are up to the variance of the field.
          const double scale = isExact ? found.maxCoeff() / expected.maxCoeff() : 1.0;
          const double difference = (found - scale * expected).cwiseAbs().maxCoeff();
          if (isExact)
          {
            EXPECT_LT(difference, 2e-3 * found.maxCoeff()) << length;
          }
          else
          {
            EXPECT_LT(difference, 1e-9 * found.maxCoeff()) << length;
          }
        }
      }
    }
  }
}

/// Far from the values, beside those of another component.
TEST(Smoothing, EveryComponentReturnsToItsOwnMean)
{
  const Surface s = Joined(Plate(20, 1.0), Moved(Plate(12, 1.0), { 5.0, 0.0, 0.0 }));
  const auto assembler = MakeAssembler(s);
  const TriangleMesh& mesh = assembler->Mesh();
  const auto isFirst = [&](Index i) { return s.Vertices(mesh.InputVertex()[i], 0) < 2.5; };
  Values field(mesh.NumberOfVertices(), 1);
  for (Index i = 0; i < mesh.NumberOfVertices(); ++i)
  {
    const double y = s.Vertices(mesh.InputVertex()[i], 1);
    field(i, 0) = isFirst(i) ? 100.0 + y : -y;
  }
  const Vector y = s.Vertices.col(1);
  const auto data = ValuesAt(mesh, field, [&](Index i) { return y[i] < y.minCoeff() + 0.2; });
  for (const Choice choice : { Choice::Exact, Choice::Given })
  {
    for (const bool keepRange : { false, true })
    {
      Interpolation::Settings settings = InterpolationSettings(choice, 1e-6);
      settings.Kappa = 25.0 * mesh.LengthUnit();
      settings.KeepRange = keepRange;
      const Interpolation::Result result = Interpolate(assembler, data, settings);
      double means[2] = { 0.0, 0.0 };
      double counts[2] = { 0.0, 0.0 };
      for (const SurfacePoint& place : data.Places)
      {
        means[isFirst(place.Vertices[0])] += field(place.Vertices[0], 0);
        counts[isFirst(place.Vertices[0])] += 1.0;
      }
      for (Index i = 0; i < mesh.NumberOfVertices(); ++i)
      {
        if (y[mesh.InputVertex()[i]] > y.maxCoeff() - 0.1)
        {
          EXPECT_NEAR(result.U(i, 0), means[isFirst(i)] / counts[isFirst(i)], 1e-3);
        }
      }
    }
  }
}

TEST(Smoothing, TendsToTheExactValuesAndToTheirMean)
{
  const Surface s = Icosphere(3);
  const auto assembler = MakeAssembler(s);
  const TriangleMesh& mesh = assembler->Mesh();
  const auto data =
    ValuesAt(mesh, Sample(mesh, s, SeaTemperature), [](Index i) { return i < 162; });
  const Values exact = Interpolate(assembler, data, InterpolationSettings(Choice::Exact)).U;
  const double mean = data.Given.mean();
  for (const double small : { 1e-12, 1e-30, 1e-200 })
  {
    const auto result = Interpolate(assembler, data, InterpolationSettings(Choice::Given, small));
    EXPECT_LT((result.U - exact).cwiseAbs().maxCoeff(), 1e-8);
  }
  for (const double large : { 1e9, 1e30, 1e200 })
  {
    Interpolation::Settings settings = InterpolationSettings(Choice::Given, large);
    settings.ComputeError = true;
    settings.NoiseLevel = 2.0;
    const auto result = Interpolate(assembler, data, settings);
    EXPECT_LT((result.U.array() - mean).abs().maxCoeff(), 1e-4);
    EXPECT_LT((result.Error.array() - 2.0 / std::sqrt(162.0)).abs().maxCoeff(), 1e-3);
    EXPECT_FALSE(result.IsFlattest);
  }
}
