// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Statistics/NoiseLevel.h"
#include "Core/Statistics/WeightSearch.h"
#include "Heat.h"
#include "Meshes.h"

#include <gtest/gtest.h>

using namespace SurfaceDiffusion;
using namespace SurfaceDiffusion::Testing;

namespace
{

/// Gaussian random numbers of standard deviation 1 (Box and Muller).
Values GaussianNoise(const TriangleMesh& mesh, Eigen::Index columns)
{
  Values u(mesh.NumberOfVertices(), columns);
  for (Index i = 0; i < mesh.NumberOfVertices(); ++i)
  {
    for (Eigen::Index k = 0; k < columns; ++k)
    {
      const double r = std::sqrt(-2.0 * std::log(1.0 - UniformRandom(1, 2 * k, i)));
      u(i, k) = r * std::cos(2.0 * Pi * UniformRandom(1, 2 * k + 1, i));
    }
  }
  return u;
}

double Level(const Surface& s, const Assembler& assembler, const PointData& data)
{
  return EstimateNoise(assembler, s.Vertices, data).Level();
}

/// Smooth parts and edges, values in 0 .. 1.
Values Picture(const TriangleMesh& mesh, const Surface& s)
{
  return Sample(mesh, s,
    [](const Eigen::RowVector3d& p)
    { return (p[0] > 0.3 ? 1.0 : 0.2) * (0.7 + 0.3 * std::sin(3.0 * p[1])); });
}

} // namespace

TEST(NoiseLevel, IsEstimatedWithinFivePercentUnderAPicture)
{
  const Surface s = Icosphere(5);
  const auto assembler = MakeAssembler(s);
  const TriangleMesh& mesh = assembler->Mesh();
  for (const double sigma : { 0.05, 0.25 })
  {
    Values f = sigma * GaussianNoise(mesh, 1);
    f += Picture(mesh, s);
    EXPECT_NEAR(Level(s, *assembler, PointData::FromValues(f)), sigma, 0.05 * sigma);
  }
}

TEST(NoiseLevel, IsTheRootMeanSquareOverTheColumns)
{
  const Surface s = Icosphere(5);
  const auto assembler = MakeAssembler(s);
  Values f = GaussianNoise(assembler->Mesh(), 2);
  f.col(1) *= 7.0;
  EXPECT_NEAR(Level(s, *assembler, PointData::FromValues(f)), 5.0, 0.25);
}

TEST(NoiseLevel, MissingValuesAreNotLookedAt)
{
  const Surface s = Icosphere(5);
  const auto assembler = MakeAssembler(s);
  PointData data = PointData::FromValues(GaussianNoise(assembler->Mesh(), 1));
  for (Index i = 0; i < assembler->Mesh().NumberOfVertices(); i += 20)
  {
    data.Missing[i] = true;
    data.Given(i, 0) = 1e9;
  }
  EXPECT_NEAR(Level(s, *assembler, data), 1.0, 0.06);
}

TEST(NoiseLevel, IsZeroWhereNothingCanBeSaid)
{
  const Surface s = Icosphere(2);
  const auto assembler = MakeAssembler(s);
  PointData data = PointData::FromValues(Values::Constant(162, 2, 4.0));
  EXPECT_EQ(Level(s, *assembler, data), 0.0);
  data.Missing.fill(true);
  EXPECT_EQ(Level(s, *assembler, data), 0.0);
  const auto empty =
    std::make_shared<Assembler>(std::make_shared<TriangleMesh>(Points(0, 3), Triangles(0, 3)));
  EXPECT_EQ(EstimateNoise(*empty, Points(0, 3), PointData::FromValues(Values(0, 1))).Level(), 0.0);
}

// The three others around a corner of a tetrahedron determine no linear fit.
TEST(NoiseLevel, IsUndeterminedWithFactorsWhereNoPlacesDetermineAFit)
{
  const Surface s = Tetrahedron();
  const auto assembler = MakeAssembler(s);
  PointData data = PointData::FromValues(Values(Vector::LinSpaced(4, 0.0, 1.0)));
  data.FidelityFactors = Vector::LinSpaced(4, 1.0, 2.0);
  const NoiseEstimate found =
    EstimateNoise(*assembler, assembler->Pattern(), s.Vertices, data, { 0, 4 }, true);
  EXPECT_EQ(found.Level(), 0.0);
  EXPECT_TRUE(found.IsUndetermined);
}

TEST(NoiseLevel, DiscrepancyIsTheWeightedRootMeanSquareOfWhatIsKnown)
{
  const auto mesh = MakeMesh(Icosphere(2));
  PointData data = PointData::FromValues(Values::Zero(162, 2));
  Values u = Values::Constant(162, 2, 3.0);
  u.col(1).setConstant(4.0);
  EXPECT_NEAR(Discrepancy(*mesh, data, u), std::sqrt(12.5), 1e-13);
  data.Missing.head(80) = true;
  u.topRows(80).setConstant(1e9);
  EXPECT_NEAR(Discrepancy(*mesh, data, u), std::sqrt(12.5), 1e-13);
  data.Missing.fill(true);
  EXPECT_EQ(Discrepancy(*mesh, data, u), 0.0);
}

TEST(NoiseLevel, SlopesOnIrregularMeshesAreNoNoise)
{
  const Surface s = Jittered(Strip(100, 100), 0.35 / 100.0, 0.001, 0.999, 0.001, 0.999);
  const auto assembler = MakeAssembler(s);
  const TriangleMesh& mesh = assembler->Mesh();
  for (const double sigma : { 0.001, 0.01 })
  {
    Values f = sigma * GaussianNoise(mesh, 1);
    f += Sample(mesh, s, [](const Eigen::RowVector3d& x) { return 0.5 * x[0] - 0.2 * x[1]; });
    const NoiseEstimate noise = EstimateNoise(*assembler, s.Vertices, PointData::FromValues(f));
    EXPECT_FALSE(noise.IsCorrelated());
    EXPECT_NEAR(noise.Level(), sigma, 0.05 * sigma);
  }
}

TEST(NoiseLevel, CorrelatedNoiseIsFoundOrMeasuredAcrossItsCorrelation)
{
  const Surface s = Icosphere(5);
  const auto assembler = MakeAssembler(s);
  const TriangleMesh& mesh = assembler->Mesh();
  const double h = mesh.TotalEdgeLength() / mesh.NumberOfEdges() * mesh.LengthUnit();
  for (const double c : { 0.0, 0.1, 0.3, 1.0, 3.0 }) // one heat step of c h^2
  {
    Values f = GaussianNoise(mesh, 1);
    if (c > 0.0)
    {
      f = Diffuse(assembler, PointData::FromValues(f), c * h * h, 1, 0.0, Scheme::BackwardEuler);
    }
    f /= RootMeanSquare(mesh, f);
    const NoiseEstimate noise = EstimateNoise(*assembler, s.Vertices, PointData::FromValues(f));
    EXPECT_EQ(noise.IsCorrelated(), c >= 0.3) << c << ' ' << noise.BetweenNeighbours;
    EXPECT_NEAR(noise.Level(), 1.0, 0.1) << c << ' ' << noise.BetweenNeighbours;
  }
}

TEST(NoiseLevel, IsThatOfThePartThatIsNotConstant)
{
  const Surface s = Icosphere(4);
  const auto assembler = MakeAssembler(s);
  const TriangleMesh& mesh = assembler->Mesh();
  const Values noise = GaussianNoise(mesh, 1);
  for (const double limit : { -0.6, 0.0, 0.6, 0.8 })
  {
    const Values inside =
      Sample(mesh, s, [&](const Eigen::RowVector3d& x) { return x[2] > limit ? 1.0 : 0.0; });
    for (const double background : { 0.0, 3.7 })
    {
      const Values f = (noise.array() * inside.array() + background).matrix();
      EXPECT_NEAR(Level(s, *assembler, PointData::FromValues(f)), 1.0, 0.12) << limit;
    }
    EXPECT_EQ(Level(s, *assembler, PointData::FromValues(inside)), 0.0) << "a mask has no noise";
  }
}

TEST(NoiseLevel, SmoothSignalsAreNoCorrelatedNoise)
{
  const Surface s = Icosphere(5);
  const auto assembler = MakeAssembler(s);
  const TriangleMesh& mesh = assembler->Mesh();
  for (const double frequency : { 2.0, 4.0, 8.0 })
  {
    const double sigma = 0.05;
    const Values wave =
      Sample(mesh, s, [&](const Eigen::RowVector3d& x) { return std::sin(frequency * x[2]); });
    const NoiseEstimate noise = EstimateNoise(
      *assembler, s.Vertices, PointData::FromValues(wave + sigma * GaussianNoise(mesh, 1)));
    EXPECT_FALSE(noise.IsCorrelated()) << frequency;
    EXPECT_NEAR(noise.Level(), sigma, 0.1 * sigma) << frequency;
  }
}

/// In a disk of slices, all vertices are near to each other through the middle.
TEST(NoiseLevel, RingsHaveASizeInProportionAroundVerticesOfMany)
{
  const Index count = 2000;
  Surface fan{ Points(count + 1, 3), Triangles(count, 3) };
  for (Index i = 0; i < count; ++i)
  {
    const double angle = 2.0 * Pi * i / count;
    fan.Vertices.row(i) << std::cos(angle), std::sin(angle), 0.0;
    fan.Faces.row(i) << i, (i + 1) % count, count;
  }
  fan.Vertices.row(count).setZero();
  const auto assembler = MakeAssembler(fan);
  const SparsePattern pattern = assembler->Pattern();
  Rings rings(pattern, { 0, count + 1 });
  std::size_t all = 0;
  std::size_t largest = 0;
  for (Index i = 0; i <= count; ++i)
  {
    const std::size_t size = rings.FindDisk(i, 4).size();
    all += size;
    largest = std::max(largest, size);
  }
  EXPECT_LT(all, 500U * static_cast<std::size_t>(count));
  EXPECT_EQ(largest, static_cast<std::size_t>(count) + 1); // of the middle
}
