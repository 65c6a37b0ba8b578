// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Models/Harmonic/UnitVectors.h"
#include "HarmonicMaps.h"

#include <gtest/gtest.h>

#include <limits>
#include <numeric>

using namespace SurfaceDiffusion;
using namespace SurfaceDiffusion::Testing;

namespace
{

const double NaN = std::numeric_limits<double>::quiet_NaN();

std::vector<std::int64_t> Ids(const TriangleMesh& mesh)
{
  std::vector<std::int64_t> ids(mesh.NumberOfVertices());
  std::iota(ids.begin(), ids.end(), 0);
  return ids;
}

} // namespace

TEST(UnitVectors, VectorsOfAnySizeAreNormalised)
{
  const auto mesh = MakeMesh(Tetrahedron());
  Values f(4, 3);
  f << 3e-200, 4e-200, 0.0, 3e200, 0.0, 4e200, 0.0, -2.0, 0.0, 5e-324, 0.0, 0.0;
  auto data = PointData::FromValues(f);
  FillMissingUnitVectors(*mesh, data, false, InitialFill::Mean, 0, Ids(*mesh));
  EXPECT_FALSE(data.Missing.any());
  Values expected(4, 3);
  expected << 0.6, 0.8, 0.0, 0.6, 0.0, 0.8, 0.0, -1.0, 0.0, 1.0, 0.0, 0.0;
  EXPECT_LT((data.Given - expected).cwiseAbs().maxCoeff(), 1e-15);
  EXPECT_EQ(data.Start, data.Given);
}

TEST(UnitVectors, ZeroAndNaNAreMissingAndTakeTheMeanDirection)
{
  const auto mesh = MakeMesh(Icosphere(2));
  Values f(mesh->NumberOfVertices(), 3);
  f.rowwise() = Eigen::RowVector3d(0.0, 2.0, 0.0);
  f.row(3).setZero();
  f.row(7) << 1.0, NaN, 0.0;
  auto data = PointData::FromValues(f);
  FillMissingUnitVectors(*mesh, data, false, InitialFill::Mean, 0, Ids(*mesh));
  EXPECT_EQ(data.Missing.count(), 2);
  EXPECT_TRUE(data.Missing[3] && data.Missing[7]);
  EXPECT_TRUE(data.Given.allFinite());
  for (const Index i : { 3, 7 })
  {
    EXPECT_LT((data.Start.row(i) - Eigen::RowVector3d(0.0, 1.0, 0.0)).norm(), 1e-15);
  }
}

/// The lines of a rim are the same whichever of two opposite vectors stands for each of them.
TEST(UnitVectors, LinesSpreadWithoutRegardToTheirSigns)
{
  const auto mesh = MakeMesh(Disk(4));
  const Eigen::RowVector3d line(0.6, 0.0, 0.8);
  for (std::int64_t seed = 0; seed < 20; ++seed)
  {
    Values u(mesh->NumberOfVertices(), 3);
    Flags known(mesh->NumberOfVertices());
    for (Index i = 0; i < mesh->NumberOfVertices(); ++i)
    {
      known[i] = mesh->InputVertex()[i] >= 7; // all but the inner hexagon
      u.row(i) = (UniformRandom(seed, 0, i) < 0.5 ? -1.0 : 1.0) * line;
      u.row(i) *= known[i] ? 1.0 : 0.0;
    }
    SpreadUnitVectors(*mesh, u, known, true);
    EXPECT_TRUE(known.all());
    EXPECT_LT(((u * line.transpose()).array().abs() - 1.0).abs().maxCoeff(), 1e-14);
  }
}

// The normals of a closed surface add up to nothing: a hole is filled from its rim.
TEST(UnitVectors, WhereNoDirectionPrevailsTheRimSpreadsInwards)
{
  const Surface s = Icosphere(3);
  const auto mesh = MakeMesh(s);
  const Values normals = SampleUnit(*mesh, s, 3, [](const Eigen::RowVector3d& x) { return x; });
  Values f = normals;
  for (Index i = 0; i < mesh->NumberOfVertices(); ++i)
  {
    if (normals(i, 2) > 0.9)
    {
      f.row(i).setZero();
    }
  }
  auto data = PointData::FromValues(f);
  FillMissingUnitVectors(*mesh, data, false, InitialFill::Mean, 0, Ids(*mesh));
  EXPECT_GT(data.Missing.count(), 20);
  for (Index i = 0; i < mesh->NumberOfVertices(); ++i)
  {
    EXPECT_NEAR(data.Start.row(i).norm(), 1.0, 1e-15);
    EXPECT_GT(data.Start.row(i).dot(normals.row(i)), 0.85); // within 30 degrees
  }
}

TEST(UnitVectors, OppositeLinesDoNotCancel)
{
  const auto mesh = MakeMesh(Icosphere(2));
  Values f(mesh->NumberOfVertices(), 2);
  for (Index i = 0; i < f.rows(); ++i)
  {
    f.row(i) = (i % 2 == 0 ? 1.0 : -1.0) * Eigen::RowVector2d(0.6, 0.8);
  }
  f.row(5).setZero();
  auto data = PointData::FromValues(f);
  FillMissingUnitVectors(*mesh, data, true, InitialFill::Mean, 0, Ids(*mesh));
  EXPECT_NEAR(std::abs(data.Start.row(5).dot(Eigen::RowVector2d(0.6, 0.8))), 1.0, 1e-12);
}

TEST(UnitVectors, ComponentsWithoutKnownVectorsStillGetAUnitVector)
{
  const auto mesh =
    MakeMesh(Joined(Icosphere(1), Moved(Icosphere(1), Eigen::RowVector3d(5.0, 0.0, 0.0))));
  ASSERT_EQ(mesh->NumberOfComponents(), 2);
  Values f = Values::Zero(mesh->NumberOfVertices(), 4);
  f.topRows(mesh->ComponentsBegin()[1]).col(2).setConstant(1.0);
  auto data = PointData::FromValues(f);
  FillMissingUnitVectors(*mesh, data, false, InitialFill::Mean, 0, Ids(*mesh));
  EXPECT_LT(LargestLengthError(data.Start), 1e-15);
  EXPECT_TRUE(data.Given.allFinite());
}

TEST(UnitVectors, NoiseAndInputFillAsTheySay)
{
  const auto mesh = MakeMesh(Icosphere(3));
  Values f = RandomUnitVectors(*mesh, 3);
  auto data = PointData::FromValues(f);
  for (Index i = 0; i < mesh->NumberOfVertices(); i += 2)
  {
    data.Missing[i] = true;
  }
  data.Given.row(0).setConstant(NaN);
  auto noise = data;
  FillMissingUnitVectors(*mesh, noise, false, InitialFill::Noise, 1, Ids(*mesh));
  auto input = data;
  FillMissingUnitVectors(*mesh, input, false, InitialFill::Input, 1, Ids(*mesh));
  Eigen::RowVector3d mean = Eigen::RowVector3d::Zero();
  for (Index i = 0; i < mesh->NumberOfVertices(); i += 2)
  {
    EXPECT_NEAR(noise.Start.row(i).norm(), 1.0, 1e-15);
    mean += noise.Start.row(i) / (0.5 * mesh->NumberOfVertices());
    if (i > 0)
    {
      EXPECT_EQ(input.Start.row(i), input.Given.row(i));
    }
  }
  EXPECT_LT(mean.norm(), 0.15); // random directions
  EXPECT_TRUE(input.Start.allFinite() && input.Given.allFinite());
}
