// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
//
// Interpolation where the energy and the values leave slopes open, and where it changes in between.
#include "Interpolation.h"

#include <Eigen/Dense>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

using namespace SurfaceDiffusion;
using namespace SurfaceDiffusion::Testing;

namespace
{

Interpolation::Settings FreeSettings(Choice choice, double noise = 0.0)
{
  Interpolation::Settings settings = InterpolationSettings(choice);
  settings.Rim = RimCondition::Automatic;
  settings.ComputeError = true;
  settings.NoiseLevel = noise;
  return settings;
}

} // namespace

/// On a square of 21 x 21 points and on a bowl, whose curvature lets constants alone have no energy.
TEST(InterpolationSlopes, ThatValuesLeaveOpenHaveInfiniteErrors)
{
  const Surface flat = Strip(20, 20);
  Surface bowl = Disk(12);
  for (auto x : bowl.Vertices.rowwise())
  {
    x[2] = 0.5 * x.squaredNorm();
  }
  const auto f = [](const Eigen::RowVector3d& x) { return std::sin(3.0 * x[0]) + x[1] * x[1]; };
  struct Case
  {
    std::vector<Index> Known;
    bool IsOpen;
    bool IsLine; ///< the row of points 210 to 230
    Index Determined; ///< of the functions without energy
  };
  for (const Case& c :
    std::vector<Case>{ { { 210 }, true, false, 1 }, { { 210, 214 }, true, true, 2 },
      { { 210, 214, 217, 221, 228 }, true, true, 2 }, { { 5, 215, 300 }, false, false, 3 },
      { { 5, 215, 300, 120 }, false, false, 3 }, { { 5, 215, 300, 120, 77 }, false, false, 3 } })
  {
    const auto count = static_cast<Index>(c.Known.size());
    SCOPED_TRACE(count);
    const auto isKnown = [&](Index i)
    { return std::find(c.Known.begin(), c.Known.end(), i) != c.Known.end(); };
    for (const Choice choice : { Choice::Exact, Choice::Automatic, Choice::NoiseLevel })
    {
      SCOPED_TRACE(static_cast<int>(choice));
      const Interpolation::Settings settings =
        FreeSettings(choice, choice == Choice::NoiseLevel ? 0.1 : 0.0);
      const auto assembler = MakeAssembler(flat);
      const TriangleMesh& mesh = assembler->Mesh();
      const Interpolation::Result result =
        Interpolate(assembler, ValuesAt(mesh, Sample(mesh, flat, f), isKnown), settings);
      const bool isFewer =
        choice == Choice::Automatic && count < std::max<Index>(3, c.Determined + 2);
      EXPECT_EQ(result.PartsWithTooFewValues, isFewer ? 1 : 0);
      EXPECT_EQ(result.IsFlattest, c.IsOpen);
      EXPECT_EQ(result.HasInfiniteError, c.IsOpen);
      const bool isUnknown = choice != Choice::NoiseLevel && count <= c.Determined;
      EXPECT_EQ(result.HasUnknownError, isUnknown);
      for (Index i = 0; i < mesh.NumberOfVertices(); ++i)
      {
        const Index point = mesh.InputVertex()[i];
        const bool isDetermined = c.IsLine ? point / 21 == 10 : !c.IsOpen || isKnown(point);
        EXPECT_EQ(std::isinf(result.Error(i, 0)), !isDetermined) << point;
        EXPECT_EQ(std::isnan(result.Error(i, 0)), isDetermined && isUnknown) << point;
        EXPECT_TRUE(!std::isfinite(result.Error(i, 0)) || result.Error(i, 0) < 10.0) << point;
      }

      const auto curved = MakeAssembler(bowl);
      const Values field = Sample(curved->Mesh(), bowl, f);
      const Interpolation::Result onBowl =
        Interpolate(curved, ValuesAt(curved->Mesh(), field, isKnown), settings);
      EXPECT_FALSE(onBowl.IsFlattest);
      EXPECT_FALSE(onBowl.HasInfiniteError);
      EXPECT_EQ(onBowl.HasUnknownError, choice != Choice::NoiseLevel && count < 2);
    }
  }
}

TEST(InterpolationSlopes, AreOpenInTrianglesThatShareNoEdge)
{
  Surface bowTie;
  bowTie.Vertices.resize(5, 3);
  bowTie.Vertices << 0, 0, 0, 1, 0, 0, 1, 1, 0, -1, 0.2, 0.3, -1, -0.8, 0;
  bowTie.Faces.resize(2, 3);
  bowTie.Faces << 0, 1, 2, 0, 3, 4;
  const Values field = (Values(5, 1) << 3.0, 38.0, 23.0, 8.0, 43.0).finished();
  Values expected;
  for (const double angle : { 0.0, 0.7, 2.0 })
  {
    const auto assembler = MakeAssembler(Rotated(bowTie, angle));
    const TriangleMesh& mesh = assembler->Mesh();
    Values own(5, 1);
    for (Index i = 0; i < 5; ++i)
    {
      own.row(i) = field.row(mesh.InputVertex()[i]);
    }
    const auto data = ValuesAt(mesh, own, [](Index i) { return i == 1 || i == 3; });
    const Interpolation::Result result = Interpolate(assembler, data, FreeSettings(Choice::Exact));
    EXPECT_TRUE(result.IsFlattest);
    const Values u = ToInput(mesh, result.U, 5);
    EXPECT_GE(u.minCoeff(), 8.0 - 1e-6);
    EXPECT_LE(u.maxCoeff(), 38.0 + 1e-6);
    expected = angle == 0.0 ? u : expected;
    EXPECT_LT((u - expected).cwiseAbs().maxCoeff(), 1e-6);
  }
}

/// Around the middle of a ruffle the energy has functions of negative energy. Determinants of energies with
/// and without these do not compare.
TEST(InterpolationSlopes, AroundCoarseSaddlesHaveDegreesOfFreedomOfOneEnergy)
{
  for (const Index count : { 6, 14 })
  {
    Surface ruffle;
    ruffle.Vertices = Points::Zero(count + 1, 3);
    ruffle.Faces.resize(count, 3);
    for (Index i = 0; i < count; ++i)
    {
      const double angle = 2.0 * Pi * i / count;
      ruffle.Vertices.row(i) << std::cos(angle), std::sin(angle), i % 2 == 0 ? 1.0 : -1.0;
      ruffle.Faces.row(i) << i, (i + 1) % count, count;
    }
    const auto assembler = MakeAssembler(ruffle);
    const TriangleMesh& mesh = assembler->Mesh();
    const Index n = mesh.NumberOfVertices();
    const Values field =
      Sample(mesh, ruffle, [](const Eigen::RowVector3d& x) { return x[1] + x[2] * x[2]; });
    SmoothnessEnergy energy(*assembler, CotanWeights(mesh), 0.0, RimCondition::Free);
    energy.DropNegativeCurvature();
    for (const Index values : { 100, 400 }) // eigenvalues, and determinants
    {
      const ScatteredValues data = ValuesInTriangles(mesh, field, values);
      Eigen::MatrixXd coordinates = Eigen::MatrixXd::Zero(values, n);
      for (Index i = 0; i < values; ++i)
      {
        for (int a = 0; a < 3; ++a)
        {
          coordinates(i, data.Places[i].Vertices[a]) += data.Places[i].Coordinates[a];
        }
      }
      const Eigen::MatrixXd weights = coordinates.transpose() * coordinates;
      for (double mu = 0.3; mu < 30.0; mu *= 1.05)
      {
        Interpolation::Settings settings = InterpolationSettings(Choice::Given, mu);
        settings.Rim = RimCondition::Free;
        const Interpolation::Result result = Interpolate(assembler, data, settings);
        const Eigen::MatrixXd h = weights + mu * Eigen::MatrixXd(energy.Matrix());
        const double expected = h.ldlt().solve(weights).trace();
        EXPECT_TRUE(result.DropsNegativeCurvature);
        EXPECT_NEAR(result.Columns[0].DegreesOfFreedom, expected, 0.05 * expected) << mu;
      }
    }
  }
}
