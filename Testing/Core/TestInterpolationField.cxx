// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
//
// Interpolation as the mean of a Gaussian field, and its smoothing of noise.
#include "Core/Models/Interpolation/SlopeSquares.h"
#include "Core/Models/Interpolation/SmoothnessEnergy.h"
#include "Interpolation.h"

#include <Eigen/SparseCholesky>
#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>
#include <functional>

using namespace SurfaceDiffusion;
using namespace SurfaceDiffusion::Testing;

namespace
{

constexpr Index OfSphere = 162; // vertices of the icosahedron subdivided twice, in all finer ones

struct Harmonic
{
  int Degree;
  std::function<double(const Eigen::RowVector3d&)> At;
};

/// The surface with one more vertex, at 1/aspect of an edge of its first triangle from an end of it.
Surface WithNeedles(const Surface& s, double aspect)
{
  const Index a = s.Faces(0, 0);
  const Index b = s.Faces(0, 1);
  const auto added = static_cast<Index>(s.Vertices.rows());
  Surface split = s;
  split.Vertices.conservativeResize(added + 1, 3);
  split.Vertices.row(added) = s.Vertices.row(a) + (s.Vertices.row(b) - s.Vertices.row(a)) / aspect;
  for (Eigen::Index t = 0; t < s.Faces.rows(); ++t)
  {
    for (int k = 0; k < 3; ++k)
    {
      const Index from = s.Faces(t, k);
      const Index to = s.Faces(t, (k + 1) % 3);
      if ((from == a && to == b) || (from == b && to == a))
      {
        const Index opposite = s.Faces(t, (k + 2) % 3);
        const Eigen::Index last = split.Faces.rows();
        split.Faces.conservativeResize(last + 1, 3);
        split.Faces.row(t) << from, added, opposite;
        split.Faces.row(last) << added, to, opposite;
      }
    }
  }
  return split;
}

} // namespace

TEST(InterpolationField, SphericalHarmonicsDecayByTheirEigenvalue)
{
  const double mu = 0.02;
  const double kappa = 1.5;
  const Harmonic harmonics[] = { { 1, [](const Eigen::RowVector3d& x) { return x[2]; } },
    { 2, [](const Eigen::RowVector3d& x) { return x[0] * x[1]; } },
    { 4, [](const Eigen::RowVector3d& x) {
       return 35.0 * std::pow(x[2], 4) - 30.0 * x[2] * x[2] + 3.0;
     } } };
  for (const Harmonic& harmonic : harmonics)
  {
    const double eigenvalue = harmonic.Degree * (harmonic.Degree + 1.0) + kappa * kappa;
    const double factor = 1.0 / (1.0 + mu * eigenvalue * eigenvalue);
    double last = 0.0;
    for (int subdivisions = 3; subdivisions <= 5; ++subdivisions)
    {
      const Surface s = Icosphere(subdivisions);
      const auto assembler = MakeAssembler(s);
      const TriangleMesh& mesh = assembler->Mesh();
      const Values field = Sample(mesh, s, harmonic.At);
      ScatteredValues data = ValuesAt(mesh, field, [](Index) { return true; });
      data.Weights = mesh.ControlAreas(); // the integral of the square
      const double unit = mesh.LengthUnit();
      Interpolation::Settings settings =
        InterpolationSettings(Choice::Given, mu / std::pow(unit, 4));
      settings.Kappa = kappa * unit;
      const Values u = Interpolate(assembler, data, settings).U;
      const double largest = field.cwiseAbs().maxCoeff();
      const double error = (u - factor * field).cwiseAbs().maxCoeff() / (factor * largest);
      std::printf("degree %d, %6d vertices: factor %.4f, relative error %.5f\n", harmonic.Degree,
        mesh.NumberOfVertices(), factor, error);
      if (subdivisions > 3)
      {
        EXPECT_LT(error, 0.55 * last); // at least of order 1, as the Laplacian at vertices has
      }
      last = error;
    }
    EXPECT_LT(last, 0.01);
  }
}

TEST(InterpolationField, SmoothsNoiseOnEveryMesh)
{
  for (int subdivisions = 3; subdivisions <= 5; ++subdivisions)
  {
    const Surface s = Icosphere(subdivisions);
    const auto assembler = MakeAssembler(s);
    const TriangleMesh& mesh = assembler->Mesh();
    const Values field = Sample(mesh, s, SeaTemperature);
    Values noisy = field;
    for (Index i = 0; i < mesh.NumberOfVertices(); ++i)
    {
      noisy(i, 0) += Gaussian(1, 0, mesh.InputVertex()[i]);
    }
    const auto data = ValuesAt(mesh, noisy, [](Index i) { return i < OfSphere; });
    const Interpolation::Result result =
      Interpolate(assembler, data, InterpolationSettings(Choice::Automatic));
    const double error = RootMeanSquare(mesh, result.U - field);
    const Interpolation::Result exact =
      Interpolate(assembler, data, InterpolationSettings(Choice::Exact));
    std::printf("%6d vertices: error %.3f, with exact values %.3f, noise estimated as %.3f\n",
      mesh.NumberOfVertices(), error, RootMeanSquare(mesh, exact.U - field),
      result.Columns[0].NoiseLevel);
    EXPECT_LE(error, 0.55);
    EXPECT_GT(RootMeanSquare(mesh, exact.U - field), 1.4 * error);
    // Three standard deviations of an estimate with so many degrees of freedom.
    const double free = OfSphere - result.Columns[0].DegreesOfFreedom;
    EXPECT_NEAR(result.Columns[0].NoiseLevel, 1.0, 3.0 / std::sqrt(2.0 * free));
  }
}

/// Values with half the deviation of the field as noise must not be taken for exact ones.
TEST(InterpolationField, SeldomTakesFewNoisyValuesForExactOnes)
{
  constexpr double noise = 4.5;
  constexpr int samples = 100;
  const Surface s = Icosphere(3);
  const auto assembler = MakeAssembler(s);
  const TriangleMesh& mesh = assembler->Mesh();
  const Values field = Sample(mesh, s, SeaTemperature);
  for (const auto& [count, most] : { std::pair(15, 0.1), std::pair(20, 0.1), std::pair(40, 0.05) })
  {
    int exact = 0;
    double misfitOfExact = 0.0;
    for (int sample = 0; sample < samples; ++sample)
    {
      ScatteredValues data = ValuesInTriangles(mesh, field, count, sample);
      const Interpolation::Settings settings = InterpolationSettings(Choice::Automatic);
      const double misfit = Interpolate(assembler, data, settings).Columns[0].Residual;
      misfitOfExact = std::max(misfitOfExact, count < 40 ? 0.0 : misfit);
      for (Index i = 0; i < count; ++i)
      {
        data.Given(i, 0) += noise * Gaussian(sample, 0, i);
      }
      exact += Interpolate(assembler, data, settings).Columns[0].NoiseLevel < 0.1 * noise;
    }
    std::printf("%d values: %d of %d samples as exact; misfit of exact ones %.2g\n", count, exact,
      samples, misfitOfExact);
    EXPECT_LE(exact, most * samples) << count;
    EXPECT_LT(misfitOfExact, 0.1) << count;
  }
}

TEST(InterpolationField, SmoothsNoiseBesideNeedlesAsWithoutThem)
{
  const Surface s = Icosphere(4);
  const auto n = static_cast<Index>(s.Vertices.rows());
  for (const RimCondition rim : { RimCondition::Natural, RimCondition::Free })
  {
    Interpolation::Settings settings = InterpolationSettings(Choice::Automatic);
    settings.Rim = rim;
    settings.ComputeError = true;
    Values expected(n, 2); // u and its standard error, by input number
    double mu = 0.0;
    for (const double aspect : { 1e2, 1e4, 1e6, 1e8, 1e10 })
    {
      const auto assembler = MakeAssembler(WithNeedles(s, aspect));
      const TriangleMesh& mesh = assembler->Mesh();
      ASSERT_EQ(mesh.NumberOfVertices(), n + 1);
      Values noisy(n + 1, 1);
      for (Index i = 0; i <= n; ++i)
      {
        const Index input = mesh.InputVertex()[i];
        noisy(i, 0) =
          input == n ? 0.0 : SeaTemperature(s.Vertices.row(input)) + Gaussian(1, 0, input);
      }
      const auto data = ValuesAt(mesh, noisy, [](Index i) { return i < OfSphere; });
      const Interpolation::Result result = Interpolate(assembler, data, settings);
      Values found(n, 2);
      double ofNeedle = 0.0;
      for (Index i = 0; i <= n; ++i)
      {
        const Index input = mesh.InputVertex()[i];
        if (input < n)
        {
          found.row(input) << result.U(i, 0), result.Error(i, 0);
        }
        else
        {
          ofNeedle = result.U(i, 0);
        }
      }
      const double length = std::pow(mesh.LengthUnit(), 2);
      if (aspect == 1e2)
      {
        expected = found;
        mu = result.Columns[0].Mu * length;
        continue;
      }
      const double difference = (found - expected).cwiseAbs().maxCoeff();
      std::printf("aspect %.0e: mu %.6g of %.6g, difference %.2e, along the short edge %.2e\n",
        aspect, result.Columns[0].Mu * length, mu, difference, ofNeedle - found(s.Faces(0, 0), 0));
      EXPECT_NEAR(result.Columns[0].Mu * length, mu, 0.01 * mu);
      EXPECT_LT(difference, 5e-3); // of values with the deviation 9 and noise of 1
      EXPECT_NEAR(ofNeedle, found(s.Faces(0, 0), 0), 1e-3);
    }
  }
}

/// One factor serves all columns, whose mu differ: each must have the minimiser of its own.
TEST(InterpolationField, IsTheMinimiserOfEveryColumnAtItsOwnSmoothing)
{
  const Surface sphere = Icosphere(4);
  const auto assembler = std::make_shared<const Assembler>(
    std::make_shared<TriangleMesh>(sphere.Vertices, sphere.Faces));
  const TriangleMesh& mesh = assembler->Mesh();
  Values field(mesh.NumberOfVertices(), 6);
  for (Index i = 0; i < mesh.NumberOfVertices(); ++i)
  {
    const auto x = sphere.Vertices.row(mesh.InputVertex()[i]);
    field.row(i).setConstant(x[0] * x[1] + 3.0 * x[2] * x[2]);
  }
  ScatteredValues data = ValuesInTriangles(mesh, field, 150);
  for (Index i = 0; i < data.Count(); ++i)
  {
    double noise = 1e-5;
    for (Eigen::Index c = 0; c < data.Given.cols(); ++c, noise *= 20.0)
    {
      data.Given(i, c) += noise * (UniformRandom(7, c, i) - 0.5);
    }
  }
  for (const double kappa : { 0.0, 2.0 })
  {
    Interpolation::Settings settings = InterpolationSettings(Choice::Automatic);
    settings.Kappa = kappa;
    const Interpolation::Result all = Interpolate(assembler, data, settings);
    double least = std::numeric_limits<double>::infinity();
    double most = 0.0;
    for (Eigen::Index c = 0; c < data.Given.cols(); ++c)
    {
      const double mu = all.Columns[static_cast<std::size_t>(c)].Mu;
      least = std::min(least, mu);
      most = std::max(most, mu);
      Interpolation::Settings given = InterpolationSettings(Choice::Given, mu);
      given.Kappa = kappa;
      ScatteredValues column = data;
      column.Given = data.Given.col(c);
      const Interpolation::Result alone = Interpolate(assembler, column, given);
      EXPECT_LT((all.U.col(c) - alone.U.col(0)).cwiseAbs().maxCoeff(), 1e-12) << mu;
      EXPECT_NEAR(all.Columns[static_cast<std::size_t>(c)].Residual, alone.Columns[0].Residual,
        1e-9 * alone.Columns[0].Residual + 1e-13);
      const Interpolation::Result found = Interpolate(assembler, column, settings);
      EXPECT_EQ(all.U.col(c), found.U.col(0));
    }
    EXPECT_GT(most, 1e6 * least);
    std::printf("kappa %g: mu %.3g to %.3g\n", kappa, least, most);
  }
}

TEST(InterpolationField, NinetyPercentOfTruthsAreInsideTheBandOfTheirError)
{
  // Fields of the prior, u = s (mu Q)^(-1/2) x, and values of them with noise s. The mean of values,
  // from which they are measured, is near that of the fields on a sphere of many correlation lengths.
  constexpr int fields = 250;
  const double noise = 0.5;
  const double kappa = 8.0;
  const double deviation = 1.0; // of the field
  const Surface s = Icosphere(4);
  const auto assembler = MakeAssembler(s);
  const TriangleMesh& mesh = assembler->Mesh();
  const Index n = mesh.NumberOfVertices();
  const double unit = mesh.LengthUnit();
  Interpolation::Settings settings = InterpolationSettings(Choice::Given);
  settings.Kappa = kappa * unit;
  // The variance of the field is noise^2/(4 pi kappa^2 mu).
  settings.Mu = std::pow(noise / deviation, 2) / (4.0 * Pi * settings.Kappa * settings.Kappa);
  settings.NoiseLevel = noise;
  settings.ComputeError = true;

  SparseMatrix root(n, n);
  assembler->TakePattern(root, SerialFor());
  assembler->Fill(root, settings.Kappa * settings.Kappa * mesh.ControlAreas(), 1.0,
    CotanWeights(mesh), nullptr, SerialFor());
  const Eigen::SimplicialLDLT<SparseMatrix, Eigen::Lower, Eigen::AMDOrdering<Index>> factor(root);
  Eigen::MatrixXd truths(n, fields);
  for (Index i = 0; i < n; ++i)
  {
    for (int f = 0; f < fields; ++f)
    {
      truths(i, f) = std::sqrt(mesh.ControlAreas()[i]) * Gaussian(11, f, i);
    }
  }
  truths = (noise / std::sqrt(settings.Mu) * factor.solve(truths)).eval();
  Values noisy = truths;
  for (Index i = 0; i < n; ++i)
  {
    for (int f = 0; f < fields; ++f)
    {
      noisy(i, f) += noise * Gaussian(12, f, i);
    }
  }
  const auto data = ValuesAt(mesh, noisy, [](Index i) { return i % 4 == 0; });
  const Interpolation::Result result = Interpolate(assembler, data, settings);
  // Slopes of the difference have the deviation that is expected.
  const double ofSlopes = SlopeSquares(mesh, SerialFor())
                            .Of(result.U - truths, Vector::Constant(fields, 1.0 / fields))
                            .cwiseQuotient(result.SlopeError.col(0).cwiseAbs2())
                            .mean();
  EXPECT_NEAR(ofSlopes, 1.0, 0.05);
  constexpr double band = 1.6449; // of 90 %
  const auto isInside = ((result.U - truths).cwiseAbs().array() <= band * result.Error.array());
  const double share = static_cast<double>(isInside.count()) / static_cast<double>(truths.size());
  std::printf("%.2f %% inside, deviation of the fields %.3f, mean error %.3f\n", 100.0 * share,
    std::sqrt(truths.squaredNorm() / static_cast<double>(truths.size())), result.Error.mean());
  EXPECT_NEAR(share, 0.90, 0.03);
  // The error is less at values than between them, and at most the deviation of the field.
  EXPECT_LT(result.Error.col(0).minCoeff(), 0.45 * deviation);
  EXPECT_LT(result.Error.col(0).maxCoeff(), 1.1 * deviation);
}

/// Neither the noise nor the smoothness is given: few values say little of both.
TEST(InterpolationField, NinetyPercentOfTruthsAreInsideTheBandsOfFewValues)
{
  constexpr int fields = 100;
  constexpr double noise = 0.2; // of values with a deviation of about 0.3
  const Surface s = Icosphere(3);
  const auto assembler = MakeAssembler(s);
  const TriangleMesh& mesh = assembler->Mesh();
  const Index n = mesh.NumberOfVertices();
  const double kappa = 0.3 * mesh.LengthUnit(); // nearly the prior, without its infinite variance
  SparseMatrix root(n, n);
  assembler->TakePattern(root, SerialFor());
  assembler->Fill(
    root, kappa * kappa * mesh.ControlAreas(), 1.0, CotanWeights(mesh), nullptr, SerialFor());
  const Eigen::SimplicialLDLT<SparseMatrix, Eigen::Lower, Eigen::AMDOrdering<Index>> factor(root);
  const double area = mesh.ControlAreas().sum();
  Interpolation::Settings settings = InterpolationSettings(Choice::Automatic);
  settings.ComputeError = true;
  for (const Index count : { 6, 10, 20, 60, 200, 400 })
  {
    double inside = 0.0;
    double square = 0.0;
    for (int f = 0; f < fields; ++f)
    {
      Eigen::VectorXd truth(n);
      for (Index i = 0; i < n; ++i)
      {
        truth[i] = std::sqrt(mesh.ControlAreas()[i]) * Gaussian(21 + f, 0, i);
      }
      truth = (factor.solve(truth) * std::sqrt(4.0 * Pi / area)).eval();
      truth.array() -= truth.dot(mesh.ControlAreas()) / area;
      square += truth.cwiseAbs2().dot(mesh.ControlAreas()) / area / fields;
      ScatteredValues data = ValuesInTriangles(mesh, truth, count, 100 + f);
      for (Index i = 0; i < count; ++i)
      {
        data.Given(i, 0) += noise * Gaussian(300 + f, 0, i);
      }
      const Interpolation::Result result = Interpolate(assembler, data, settings);
      ASSERT_FALSE(result.HasUnknownError);
      for (Index i = 0; i < n; ++i)
      {
        const bool isInside = std::abs(result.U(i, 0) - truth[i]) <= 1.6449 * result.Error(i, 0);
        inside += isInside ? mesh.ControlAreas()[i] / area / fields : 0.0;
      }
    }
    std::printf(
      "%d values: %.3f inside, deviation of the fields %.2f\n", count, inside, std::sqrt(square));
    EXPECT_GT(inside, 0.85) << count;
    EXPECT_LT(inside, 0.95) << count;
  }
}

TEST(InterpolationField, RepeatsAtAPlaceShowTheNoise)
{
  constexpr Index places = 20;
  constexpr double noise = 0.1;
  const Surface s = Icosphere(3);
  const auto assembler = MakeAssembler(s);
  const TriangleMesh& mesh = assembler->Mesh();
  const Values field = Sample(mesh, s, SeaTemperature);
  Interpolation::Settings settings = InterpolationSettings(Choice::Automatic);
  settings.ComputeError = true;
  for (const Index repeats : { 3, 50 })
  {
    ScatteredValues data = ValuesInTriangles(mesh, field, places);
    ScatteredValues twice = data;
    const Values at = data.Given;
    data.Given.resize(places * repeats, 1);
    data.Weights = Vector::Ones(places * repeats);
    for (Index i = 0; i < places * repeats; ++i)
    {
      data.Given(i, 0) = at(i % places, 0) + noise * Gaussian(31, 0, i);
      if (i >= places)
      {
        data.Places.push_back(data.Places[i % places]);
      }
    }
    const Interpolation::Result result = Interpolate(assembler, data, settings);
    const double level = result.Columns[0].NoiseLevel;
    std::printf("%d places x %d values: noise %.4f\n", places, repeats, level);
    EXPECT_NEAR(level, noise, 3.0 * noise / std::sqrt(2.0 * places * (repeats - 1)));
    // A copy of each value is no second measurement.
    for (Index i = 0; i < places; ++i)
    {
      twice.Given(i, 0) += noise * Gaussian(32, 0, i);
    }
    const double once = Interpolate(assembler, twice, settings).Columns[0].NoiseLevel;
    twice.Given = twice.Given.replicate(2, 1).eval();
    twice.Weights = Vector::Constant(2 * places, 0.5);
    const std::vector<SurfacePoint> again = twice.Places;
    twice.Places.insert(twice.Places.end(), again.begin(), again.end());
    EXPECT_NEAR(Interpolate(assembler, twice, settings).Columns[0].NoiseLevel, once, 1e-9);
  }
}
