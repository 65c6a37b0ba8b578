// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "RunInput.h"

#include "Run/DirectionFieldRun.h"
#include "Run/DistanceRun.h"
#include "Run/HarmonicMapSettings.h"
#include "Run/HeatSettings.h"
#include "Run/MumfordShahSettings.h"
#include "Run/RandomFieldRun.h"
#include "Run/ReliefRun.h"
#include "Run/TensorDiffusionSettings.h"
#include "Run/TextureSettings.h"
#include "Run/TotalVariationSettings.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <string>
#include <vector>

// An iteration that ends before it has converged is one warning, with figures.

namespace SurfaceDiffusion
{

namespace
{

using Testing::Alone;
using Testing::RunInput;
using Testing::StateOf;

/// A noisy sphere whose data are its noisy normals.
RunInput NoisyNormals()
{
  RunInput input(Testing::Icosphere(3));
  input.Data.Data.Values = Values(input.Vertices.rows(), 3);
  for (Eigen::Index i = 0; i < input.Vertices.rows(); ++i)
  {
    for (int k = 0; k < 3; ++k)
    {
      input.Data.Data.Values(i, k) = input.Vertices(i, k) + std::cos(37.0 * (3.0 * i + k));
    }
  }
  return input;
}

template <typename ModelSettings>
std::vector<Sentence> WarningsOf(const RunInput& input, const ModelSettings& settings)
{
  SurfaceDiffusion::Run run(SerialFor());
  StateOf(run, { input.Block() }, settings);
  WarningLog log;
  std::vector<Sentence> warnings = log.Report(run.FindWarnings(Alone));
  run.Seek(0, ProgressMonitor());
  run.Seek(settings.NumberOfTimeSteps + 1, ProgressMonitor());
  EXPECT_TRUE(log.Report(run.FindWarnings(Alone)).empty()) << "warned twice";
  return warnings;
}

void ExpectOne(const std::vector<Sentence>& warnings, const std::vector<std::string>& parts)
{
  ASSERT_EQ(warnings.size(), 1u) << (warnings.size() > 1 ? warnings[1].Text() : "no warning");
  for (const std::string& part : parts)
  {
    EXPECT_NE(warnings[0].Text().find(part), std::string::npos)
      << warnings[0] << "\nlacks: " << part;
  }
}

/// A plane strip between two rows of points, as a fan around one end of the upper row and one
/// around an end of the lower row: its Delaunay triangulation is of the order of points^2 flips
/// away.
Testing::Surface FanStrip(Index points)
{
  Testing::Surface s{ Points(2 * points, 3), Triangles(2 * points - 2, 3) };
  for (Index i = 0; i < points; ++i)
  {
    s.Vertices.row(i) << i, 0.0, 0.0;
    s.Vertices.row(points + i) << i, 1.0, 0.0;
  }
  for (Index i = 0; i + 1 < points; ++i)
  {
    s.Faces.row(i) << i, i + 1, points;
    s.Faces.row(points - 1 + i) << points - 1, points + i + 1, points + i;
  }
  return s;
}

} // namespace

TEST(RunWarnings, AFactorisationAboveTheToleranceIsReported)
{
  HeatSettings settings;
  settings.Solver = SolverMethod::Direct;
  settings.Tolerance = 1e-30;
  ExpectOne(WarningsOf(RunInput(Testing::Icosphere(3)), settings),
    { "linear solver missed its tolerance in 10 of 10 steps", "largest relative residual" });
}

TEST(RunWarnings, TangentSpacesInWhichNeitherPreconditionerConvergesAreReported)
{
  HarmonicMapSettings settings;
  settings.NumberOfTimeSteps = 2;
  settings.TimeStep = 10.0;
  settings.MaximumNumberOfIterations = 2;
  ExpectOne(
    WarningsOf(NoisyNormals(), settings), { "linear solver missed its tolerance", "2 of 2 steps" });
}

TEST(RunWarnings, AStepOfMinimizingMovementThatDoesNotSettleIsReported)
{
  HarmonicMapSettings settings;
  settings.Scheme = HarmonicMap::Scheme::MinimizingMovement;
  settings.NumberOfTimeSteps = 1;
  settings.TimeStep = 10.0;
  settings.MaximumNumberOfRepetitions = 2;
  ExpectOne(WarningsOf(NoisyNormals(), settings),
    { "repetitions ended at their largest number in 1 of 1 steps", "%" });
}

TEST(RunWarnings, AFillThatMissesTheToleranceIsReported)
{
  HarmonicMapSettings settings;
  settings.NumberOfTimeSteps = 0;
  settings.InitialFill = InitialFill::Harmonic;
  settings.Tolerance = 1e-30;
  settings.MaximumNumberOfIterations = 5;
  RunInput input = NoisyNormals();
  input.Data.Data.Values.topRows(100).setZero(); // missing
  ExpectOne(WarningsOf(input, settings),
    { "linear solver missed its tolerance in filling in missing values or moving vertices",
      "largest relative residual" });
}

TEST(RunWarnings, ASmoothestFieldThatDoesNotSettleIsReported)
{
  RunInput input(Testing::Icosphere(3));
  DirectionFieldSettings settings;
  settings.Method = DirectionMethod::Smooth;
  DirectionFieldRun run(SerialFor());
  run.Update(input.Block(), settings, ProgressMonitor());
  EXPECT_TRUE(run.FindWarnings().empty());

  settings.MaximumNumberOfSteps = 1;
  DirectionFieldRun unfinished(SerialFor());
  unfinished.Update(input.Block(), settings, ProgressMonitor());
  WarningLog log;
  ExpectOne(log.Report(unfinished.FindWarnings()),
    { "largest number of steps", "changed the field by", "%" });
}

TEST(RunWarnings, EdgesLeftByTheIntrinsicDelaunayTriangulationAreReported)
{
  HeatSettings settings;
  settings.IntrinsicDelaunay = true;
  settings.NumberOfTimeSteps = 1;
  settings.Units = UnitsMode::Absolute; // half of the edges are a thirtieth of the others
  settings.TimeStep = 1e-2;
  settings.Tolerance = 1e-8; // the needles that are left are ill-conditioned
  EXPECT_TRUE(WarningsOf(RunInput(FanStrip(50)), settings).empty());
  ExpectOne(WarningsOf(RunInput(FanStrip(1500)), settings),
    { "edges of the intrinsic Delaunay triangulation could not be flipped" });
}

TEST(RunWarnings, SettingsWithoutEffectOrOutsideTheirRangeAreReported)
{
  RunInput input = NoisyNormals();
  input.Data.FidelityFactors.Values.assign(static_cast<std::size_t>(input.Vertices.rows()), 2.0);
  HeatSettings heat;
  ExpectOne(WarningsOf(input, heat), { "FidelityArray has no effect", "FidelityWeight is 0" });

  input.Data.FidelityFactors.Values.clear();
  heat.Mode = HeatMode::SteadyState;
  heat.FidelityWeight = 1.0;
  heat.Blur.FWHM = 4.0;
  ExpectOne(WarningsOf(input, heat), { "BlurFWHM is 4", "from 2 to 8 mean edge lengths" });
}

TEST(RunWarnings, WidthsInAnotherUnitThanTheCoordinatesAreReported)
{
  const RunInput input = NoisyNormals(); // of radius 1, with edges of 0.15
  HeatSettings heat;
  for (const double good : { 0.24, 0.4, 3.0 })
  {
    heat.FWHM = good;
    EXPECT_TRUE(WarningsOf(input, heat).empty()) << good;
  }
  heat.FWHM = 0.21;
  ExpectOne(WarningsOf(input, heat), { "FWHM is 0.21, below 1.5 mean edge lengths of 0.15" });
  heat.FWHM = 1e-3;
  ExpectOne(WarningsOf(input, heat), { "FWHM is 0.001", "the mean edge length, 0.15" });
  heat.FWHM = 1e3;
  ExpectOne(WarningsOf(input, heat), { "FWHM is 1000, but the surface is 3.4" });
}

TEST(RunWarnings, LengthsInEdgesOfComponentsThatAreUnlikeAreReported)
{
  const auto pair = [](double factor)
  {
    RunInput input(Testing::Joined(Testing::Icosphere(3),
      Testing::Moved(Testing::Scaled(Testing::Icosphere(2), factor), { 5.0, 0.0, 0.0 })));
    input.Data.Data = {};
    return input;
  };
  TextureSettings texture;
  texture.NumberOfTimeSteps = 1;
  texture.DiffusionRate1 = 22.0; // the default rates have a size of the surface on coarse ones
  EXPECT_TRUE(WarningsOf(pair(0.5), texture).empty());
  ExpectOne(
    WarningsOf(pair(0.01), texture), { "mean edge lengths of connected components go from" });
  texture.FeatureSize = 0.5;
  for (const Sentence& warning : WarningsOf(pair(0.01), texture))
  {
    EXPECT_EQ(warning.Text().find("connected components go from"), std::string::npos) << warning;
  }

  RandomFieldSettings field;
  RandomFieldRun alike(SerialFor());
  alike.Update(pair(0.5).Block(), field, ProgressMonitor());
  EXPECT_TRUE(alike.FindWarnings().empty());
  RandomFieldRun unlike(SerialFor());
  unlike.Update(pair(0.01).Block(), field, ProgressMonitor());
  WarningLog log;
  ExpectOne(log.Report(unlike.FindWarnings()), { "lengths are in h" });
}

// Fill values such as that of netCDF are positive, and no test of a range finds them.
TEST(RunWarnings, ANumberThatStandsForNoValueIsAskedForInEachArray)
{
  const double fill = 9.969209968386869e36;
  RunInput input(Testing::Icosphere(3));
  const auto points = static_cast<std::size_t>(input.Vertices.rows());
  const auto triangles = static_cast<std::size_t>(input.Faces.rows());
  input.Data.NumberOfCells = static_cast<Index>(triangles);
  for (Index t = 0; t < input.Data.NumberOfCells; ++t)
  {
    input.Data.Cells.push_back(t);
  }
  const Fields good = input.Data;

  HeatSettings heat;
  heat.FidelityWeight = 1.0;
  input.Data.FidelityFactors.Values.assign(points, 1.0);
  EXPECT_TRUE(WarningsOf(input, heat).empty());
  input.Data.FidelityFactors.Values[7] = fill;
  ExpectOne(WarningsOf(input, heat),
    { "1 value of FidelityArray is 9.96921e+36", "far from all others", "set 0 in its place" });
  input.Data = good;
  input.Data.Directions = { Points::Ones(input.Vertices.rows(), 3), false };
  heat.AlongDiffusivity = 2.0;
  heat.FidelityWeight = 0.0;
  EXPECT_TRUE(WarningsOf(input, heat).empty());
  input.Data.Directions.Values.row(3).setConstant(-9999.0);
  ExpectOne(WarningsOf(input, heat), { "1 value of DirectionArray is -9999", "set NaN" });

  TextureSettings texture;
  texture.NumberOfTimeSteps = 1;
  input.Data = good;
  input.Data.Data = {};
  input.Data.Rates = Values::Constant(input.Faces.rows(), 4, 20.0);
  for (const bool isFill : { false, true })
  {
    input.Data.Rates.row(4).setConstant(isFill ? 1e20 : 20.0);
    const std::vector<Sentence> warnings = WarningsOf(input, texture);
    EXPECT_EQ(std::count_if(warnings.begin(), warnings.end(),
                [](const Sentence& warning) {
                  return warning.Text().find("1 value of DiffusionRateArray is 1e+20") !=
                    std::string::npos;
                }),
      isFill ? 1 : 0);
  }

  const auto warningsOfDistance = [&]
  {
    DistanceSettings settings;
    DistanceRun run(SerialFor());
    run.Update(input.Block(), settings, ProgressMonitor());
    WarningLog log;
    return log.Report(run.FindWarnings());
  };
  for (const bool onCells : { false, true })
  {
    input.Data = good;
    input.Data.Data.Values.setZero();
    input.Data.Data.Values(0, 0) = 1.0;
    input.Data.Speeds = { std::vector<double>(onCells ? triangles : points, 1.0), onCells };
    EXPECT_TRUE(warningsOfDistance().empty());
    input.Data.Speeds.Values[5] = input.Data.Speeds.Values[9] = fill;
    ExpectOne(warningsOfDistance(),
      { "2 values of SpeedArray are 9.96921e+36",
        "set 0 in its place, which is a barrier, or mask" });
  }
  input.Data.Speeds = {};
  input.Data.StartTimes.assign(points, -9999.0); // of points that are no sources
  input.Data.StartTimes[0] = 3.0;
  EXPECT_TRUE(warningsOfDistance().empty());
  input.Data.Data.Values(1, 0) = 2.0;
  ExpectOne(warningsOfDistance(), { "1 value of SourceTimes is -9999", "let it be no source" });
  input.Data.StartTimes.clear();
  input.Data.Data.Values(9, 0) = -9999.0; // a source
  ExpectOne(warningsOfDistance(), { "1 value of InputArray is -9999", "set NaN in its place" });
  auto shapes = std::make_shared<SourceShapes>();
  shapes->OfPoints = { 0, 5 };
  shapes->Places = Points::Zero(2, 3);
  shapes->StartTimes = { 0.0, -9999.0 };
  input.Data.Data = {};
  input.Data.Sources = shapes;
  ExpectOne(warningsOfDistance(), { "1 value of SourceTimes is -9999" });

  input.Data = good;
  input.Data.Data.Values(6, 0) = -9999.0;
  ReliefSettings relief;
  relief.Height = 1e-5;
  ReliefRun run(SerialFor());
  run.Update(input.Block(), relief, ProgressMonitor());
  WarningLog log;
  ExpectOne(log.Report(run.FindWarnings()), { "1 value of InputArray is -9999", "set a number" });
}

TEST(RunWarnings, OfAStepThatIsShownHoldsForThatStepAndIsReportedOnce)
{
  RunInput input = NoisyNormals();
  input.Vertices.col(0) *= 3.0;
  input.Vertices.col(2) *= 0.5;
  HarmonicMapSettings settings;
  settings.MoveVertices = true;
  settings.TimeStep = 1.0;
  settings.NumberOfTimeSteps = 6;
  SurfaceDiffusion::Run run(SerialFor());
  StateOf(run, { input.Block() }, settings);
  WarningLog log;
  ExpectOne(log.Report(run.FindWarnings(Alone)), { "MoveVertices changes the volume by" });
  run.Seek(5, ProgressMonitor()); // with another figure
  EXPECT_EQ(run.FindWarnings(Alone).size(), 1u);
  EXPECT_TRUE(log.Report(run.FindWarnings(Alone)).empty());

  RunInput coarse(Testing::Subdivided(Testing::Tetrahedron(), 2));
  coarse.Data.Data = {};
  TextureSettings texture;
  texture.FeatureSize = 40.0; // of a surface of about 3
  texture.NumberOfTimeSteps = 40;
  StateOf(run, { coarse.Block() }, texture);
  const auto isSaid = [&]
  {
    const std::vector<Warning> warnings = run.FindWarnings(Alone);
    return std::any_of(warnings.begin(), warnings.end(),
      [](const Warning& warning)
      { return warning.Sentence.Text().find("no pattern has grown") != std::string::npos; });
  };
  EXPECT_TRUE(isSaid());
  run.Seek(20, ProgressMonitor()); // it may grow yet
  EXPECT_FALSE(isSaid());
}

TEST(RunWarnings, ColumnsOfUnlikeNoiseUnderOneNormAreReported)
{
  RunInput input = NoisyNormals();
  const auto isSaid = [&](const auto& settings, const std::string& apart)
  {
    for (const Sentence& warning : WarningsOf(input, settings))
    {
      if (warning.Text().find("the noise of the columns of InputArray goes from") !=
        std::string::npos)
      {
        EXPECT_NE(warning.Text().find(apart), std::string::npos) << warning;
        return true;
      }
    }
    return false;
  };
  TotalVariationSettings joint, each;
  joint.NumberOfTimeSteps = each.NumberOfTimeSteps = 1;
  each.ChannelCoupling = ChannelCoupling::PerChannel;
  MumfordShahSettings edges;
  edges.NumberOfTimeSteps = 1;
  TensorDiffusionSettings tensor;
  tensor.NumberOfTimeSteps = 1;
  for (const double scale : { 1.0, 3.0, 1e3, 1e-3 })
  {
    input.Data.Data.Values.col(1) *= scale;
    const bool isUnlike = scale == 1e3 || scale == 1e-3;
    EXPECT_EQ(isSaid(joint, "set ChannelCoupling to PerChannel"), isUnlike) << scale;
    EXPECT_FALSE(isSaid(each, "")) << scale;
    EXPECT_EQ(isSaid(edges, "process each alone"), isUnlike) << scale;
    EXPECT_EQ(isSaid(tensor, "process each alone"), isUnlike) << scale;
    input.Data.Data.Values.col(1) /= scale;
  }
  input.Data.Data.Values.col(2).setZero(); // vectors in a plane
  EXPECT_FALSE(isSaid(joint, ""));
  input.Data.Data.Values.col(2) = 1e-15 * input.Data.Data.Values.col(0);
  EXPECT_FALSE(isSaid(joint, ""));
}

} // namespace SurfaceDiffusion
