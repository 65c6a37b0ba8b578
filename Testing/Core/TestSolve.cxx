// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
//
// Every model in one call, for arrays.
#include "CellRun.h"
#include "RunInput.h"

#include "Core/Foundation/ThreadPool.h"
#include "Run/Solve.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>
#include <string>

using namespace SurfaceDiffusion;
using namespace SurfaceDiffusion::Testing;

namespace
{

const RunInput& Sphere()
{
  static const RunInput sphere(Testing::Icosphere(3));
  return sphere;
}

std::string ErrorOf(const Fields& fields, const HeatSettings& settings)
{
  try
  {
    Heat(Sphere().Vertices, Sphere().Faces, fields, settings);
  }
  catch (const std::runtime_error& error)
  {
    return error.what();
  }
  return "";
}

} // namespace

TEST(Solve, HeatDecaysASphericalHarmonicAtItsEigenvalue)
{
  const Values z = Sphere().Vertices.col(2);
  HeatSettings settings;
  settings.FWHM = 0.5;
  const Solution solution = Heat(Sphere().Vertices, Sphere().Faces, z, settings);
  const double time = settings.FWHM * settings.FWHM / (16.0 * std::log(2.0));
  const Values exact = std::exp(-2.0 * time) * z;
  EXPECT_LT((solution.Result - exact).cwiseAbs().maxCoeff(), 2e-3);
  EXPECT_EQ(solution.Arrays.at("Diffused"), solution.Result);
  EXPECT_EQ(solution.Steps.Time.size(), 11U);
  EXPECT_TRUE(solution.Warnings.empty()) << solution.Warnings.front();
}

TEST(Solve, ThreadsDoNotChangeABit)
{
  const RunInput fine(Testing::Icosphere(5));
  const ThreadPool threads(3);
  EXPECT_EQ(Heat(fine.Vertices, fine.Faces, fine.Data.Data.Values).Result,
    Heat(fine.Vertices, fine.Faces, fine.Data.Data.Values, {}, threads).Result);
}

TEST(Solve, EveryModelHasItsResults)
{
  const Points& points = Sphere().Vertices;
  const Triangles& triangles = Sphere().Faces;
  const Fields& fields = Sphere().Data;
  const Eigen::Index n = points.rows();

  TotalVariationSettings denoising;
  denoising.AutomaticFidelity = true;
  const Solution denoised = IntrinsicTV(points, triangles, fields, denoising);
  EXPECT_GT(denoised.Numbers.at("EffectiveFidelityWeight")(0, 0), 0.0);
  EXPECT_EQ(denoised.Result.rows(), n);

  const Solution map = HarmonicMapFlow(points, triangles, points);
  EXPECT_LT((map.Result.rowwise().norm().array() - 1.0).abs().maxCoeff(), 1e-12);

  TextureSettings texture;
  texture.NumberOfTimeSteps = 20;
  const Solution pattern = TuringTexture(points, triangles, texture);
  EXPECT_EQ(pattern.Result, pattern.Arrays.at("u1"));
  EXPECT_EQ(pattern.Arrays.at("u2").rows(), n);

  // A cap, whose boundary is a circle
  const Values cap = (points.col(2).array() > 0.4).cast<double>();
  const Solution edges = MumfordShahEdges(points, triangles, cap);
  EXPECT_LT((edges.Result - cap).cwiseAbs().mean(), 0.1);
  EXPECT_GT(edges.Arrays.at("Edges").maxCoeff(), 0.5);
  EXPECT_EQ(edges.Arrays.at("Edges").rows(), n);

  const Solution regions = Segment(points, triangles, cap);
  ASSERT_EQ(regions.Arrays.count("RegionId"), 1U);
  const Values& labels = regions.Arrays.at("RegionId");
  for (Eigen::Index i = 0; i < n; ++i)
  {
    EXPECT_EQ(labels(i, 0), cap(i, 0) > 0.5 ? labels.maxCoeff() : labels.minCoeff());
  }
  EXPECT_EQ(regions.Curves.size(), 1U);

  const Solution axes = TensorDiffusion(points, triangles, fields);
  EXPECT_EQ(axes.Result.rows(), n);

  const Solution lines = DirectionField(points, triangles);
  EXPECT_EQ(lines.Result.rows(), triangles.rows());
  EXPECT_EQ(lines.Result.cols(), 3);

  RunInput rough = Sphere();
  for (Eigen::Index i = 0; i < n; ++i)
  {
    rough.Vertices.row(i) *= 1.0 + 0.02 * std::cos(7.0 * i);
  }
  const Solution smooth = DenoiseMesh(rough.Vertices, triangles);
  const auto roughness = [](const Values& of)
  {
    const Vector radius = of.rowwise().norm();
    return std::sqrt((radius.array() - radius.mean()).square().mean());
  };
  EXPECT_LT(roughness(smooth.Result), 0.5 * roughness(rough.Vertices));
  EXPECT_EQ(smooth.Arrays.at("Points"), smooth.Result);
}

TEST(Solve, NoiseIsSmoothedToTheWidthThatIsWanted)
{
  const RunInput s(Testing::Icosphere(4));
  Values noise(s.Vertices.rows(), 20);
  for (Eigen::Index i = 0; i < noise.size(); ++i)
  {
    noise.data()[i] = UniformRandom(1, 0, i) - 0.5;
  }
  const Values smooth = SmoothToFWHM(s.Vertices, s.Faces, noise, 0.4);
  const Values centred = smooth.colwise() - Vector(smooth.rowwise().mean());
  const SmoothnessEstimate found = EstimateFWHM(s.Vertices, s.Faces, centred);
  EXPECT_NEAR(found.OfAll, 0.4, 0.006);
  EXPECT_EQ(found.OfColumns.size(), 20U);
  EXPECT_LT(EstimateFWHM(s.Vertices, s.Faces, noise).OfAll, 0.1);
  EXPECT_THROW(SmoothToFWHM(s.Vertices, s.Faces, smooth, 0.2), std::runtime_error);
}

TEST(Solve, DataOnTrianglesGiveResultsOnTriangles)
{
  Fields fields;
  fields.Data.Values = Values::Random(Sphere().Faces.rows(), 2);
  fields.Data.OnCells = true;
  const Solution solution = Heat(Sphere().Vertices, Sphere().Faces, fields);
  EXPECT_EQ(solution.Result.rows(), Sphere().Faces.rows());
  EXPECT_LT(solution.Result.cwiseAbs().maxCoeff(), 1.01);
  HeatSettings onPoints;
  onPoints.ResultOnCells = false;
  EXPECT_EQ(Heat(Sphere().Vertices, Sphere().Faces, fields, onPoints).Result.rows(),
    Sphere().Vertices.rows());
}

TEST(Solve, ExcludedPointsKeepTheirValueAndNothingFlowsAcross)
{
  Fields fields = SurfaceData((Sphere().Vertices.col(2).array() > 0.0).cast<double>());
  for (Eigen::Index i = 0; i < Sphere().Vertices.rows(); ++i)
  {
    fields.Mask.Values.push_back(std::abs(Sphere().Vertices(i, 2)) < 0.2);
  }
  HeatSettings settings;
  settings.MaskMode = MaskMode::Exclude;
  const Solution solution = Heat(Sphere().Vertices, Sphere().Faces, fields, settings);
  EXPECT_LT((solution.Result - fields.Data.Values).cwiseAbs().maxCoeff(), 1e-12);
  EXPECT_GT(
    (Heat(Sphere().Vertices, Sphere().Faces, fields.Data.Values).Result - fields.Data.Values)
      .cwiseAbs()
      .maxCoeff(),
    0.1);
}

TEST(Solve, ErrorsNameTheSettingOrTheArray)
{
  HeatSettings negative;
  negative.FWHM = -1.0;
  EXPECT_EQ(ErrorOf(Sphere().Data, negative), "FWHM is -1; allowed: finite numbers, 0 or more");
  Fields fields = Sphere().Data;
  fields.Mask.Values.assign(5, 0);
  EXPECT_EQ(ErrorOf(fields, {}), "Mask has 5 rows; allowed: 642, one per point");
  fields.Mask.Values.clear();
  EXPECT_EQ(ErrorOf(Fields(), {}), "Data has 0 values; allowed: a row for each point or cell");
  fields.Data.Values(7, 0) = std::numeric_limits<double>::infinity();
  EXPECT_EQ(ErrorOf(fields, {}), "Data is infinite at point 7; allowed: finite values and NaN");
}
