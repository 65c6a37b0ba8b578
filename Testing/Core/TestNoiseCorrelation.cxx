// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Statistics/NoiseCorrelation.h"
#include "Core/Statistics/NoiseLevel.h"
#include "Heat.h"
#include "MeshFiles.h"
#include "Meshes.h"

#include <gtest/gtest.h>

#include <functional>
#include <string>
#include <vector>

// Smoothed noise without a signal is distinguished from white noise under any signal.

using namespace SurfaceDiffusion;
using namespace SurfaceDiffusion::Testing;

namespace
{

/// Gaussian random numbers of standard deviation 1 (Box and Muller).
Values GaussianNoise(const TriangleMesh& mesh, Eigen::Index columns, std::int64_t seed)
{
  Values u(mesh.NumberOfVertices(), columns);
  for (Index i = 0; i < mesh.NumberOfVertices(); ++i)
  {
    for (Eigen::Index k = 0; k < columns; ++k)
    {
      const double r = std::sqrt(-2.0 * std::log(1.0 - UniformRandom(seed, 2 * k, i)));
      u(i, k) = r * std::cos(2.0 * Pi * UniformRandom(seed, 2 * k + 1, i));
    }
  }
  return u;
}

double MeanEdgeLength(const TriangleMesh& mesh)
{
  return mesh.TotalEdgeLength() / mesh.NumberOfEdges() * mesh.LengthUnit();
}

/// White noise smoothed with a Gaussian kernel of a standard deviation of `edges` mean edge
/// lengths; mean 0, deviation 1.
Values Smoothed(const std::shared_ptr<const Assembler>& assembler, double edges, std::int64_t seed)
{
  const TriangleMesh& mesh = assembler->Mesh();
  const double length = edges * MeanEdgeLength(mesh);
  Values f = Diffuse(assembler, PointData::FromValues(GaussianNoise(mesh, 1, seed)),
    length * length / 2.0, 8, 0.0, Scheme::SDIRK2);
  f.array() -= f.mean();
  return f / std::sqrt(f.squaredNorm() / static_cast<double>(f.size()));
}

NeighbourVariation Measure(const Surface& s, const Assembler& assembler, const PointData& data)
{
  return MeasureVariation(
    assembler, s.Vertices, data, EstimateNoise(assembler, s.Vertices, data).BetweenNeighbours);
}

/// A curved surface of irregular triangles.
Surface Hill()
{
  Surface s = Jittered(Strip(60, 45), 0.2 / 60.0, 0.001, 0.999, 0.001, 0.999);
  for (Eigen::Index i = 0; i < s.Vertices.rows(); ++i)
  {
    s.Vertices(i, 2) = 0.2 * std::sin(3.0 * s.Vertices(i, 0)) * std::cos(4.0 * s.Vertices(i, 1));
  }
  return s;
}

std::vector<Surface> Surfaces()
{
  return { Icosphere(3), Rotated(Icosphere(4, 30.0)), Torus(90, 40), Hill() };
}

/// Of a place in a box of half diagonal sqrt(3).
using Signal = std::function<double(const Eigen::RowVector3d&)>;

std::vector<Signal> Signals()
{
  return { [](const Eigen::RowVector3d&) { return 0.0; },
    [](const Eigen::RowVector3d& x) { return 0.3 * x[0] - 0.4 * x[1]; },
    [](const Eigen::RowVector3d& x) { return 0.5 * std::sin(3.0 * x[0] + x[1]); },
    [](const Eigen::RowVector3d& x) { return std::exp(-9.0 * (x.array() - 0.4).square().sum()); },
    [](const Eigen::RowVector3d& x) { return x[1] > 0.2 ? 1.0 : 0.0; },
    [](const Eigen::RowVector3d& x)
    { return (x[0] > 0.1 ? 0.5 : 0.0) + (x[1] > -0.3 ? 0.3 : 0.0) + 0.2 * std::cos(2.0 * x[0]); },
    [](const Eigen::RowVector3d& x) { return 0.5 * std::sin(4.0 * x[0]) * std::cos(4.0 * x[1]); } };
}

Values SampleInBox(const TriangleMesh& mesh, const Surface& s, const Signal& signal)
{
  const Eigen::RowVector3d low = s.Vertices.colwise().minCoeff();
  const Eigen::RowVector3d high = s.Vertices.colwise().maxCoeff();
  const double size = 0.5 * (high - low).norm() / std::sqrt(3.0);
  return Sample(
    mesh, s, [&](const Eigen::RowVector3d& p) { return signal((p - 0.5 * (low + high)) / size); });
}

} // namespace

TEST(NoiseCorrelation, SmoothedNoiseIsSmoothAndItsWidthAndDeviationAreMeasured)
{
  for (const Surface& s : Surfaces())
  {
    const auto assembler = MakeAssembler(s);
    const TriangleMesh& mesh = assembler->Mesh();
    for (const double edges : { 3.0, 4.0, 6.0, 8.0 })
    {
      for (const std::int64_t seed : { 11, 12 })
      {
        const PointData data = PointData::FromValues(Smoothed(assembler, edges, seed));
        const NeighbourVariation variation = Measure(s, *assembler, data);
        EXPECT_TRUE(variation.IsSmooth()) << mesh.NumberOfVertices() << ' ' << edges;
        EXPECT_LT(variation.OfLinearFits, 0.06) << "the estimate alone";
        EXPECT_NEAR(variation.Deviation, 1.0, 1e-9);
        const double width = std::sqrt(8.0 * std::log(2.0)) * edges * MeanEdgeLength(mesh);
        EXPECT_NEAR(variation.Width, width, (edges < 4.0 ? 0.2 : 0.5) * width) << edges;
      }
    }
  }
}

TEST(NoiseCorrelation, NoiseThatWasSmoothedByLessIsFoundOnEqualTriangles)
{
  for (const Surface& s : { Icosphere(3), Rotated(Icosphere(4, 30.0)) })
  {
    const auto assembler = MakeAssembler(s);
    for (const double edges : { 1.5, 2.0 })
    {
      for (const std::int64_t seed : { 11, 12, 13 })
      {
        EXPECT_TRUE(Measure(s, *assembler, PointData::FromValues(Smoothed(assembler, edges, seed)))
                      .IsSmooth())
          << assembler->Mesh().NumberOfVertices() << ' ' << edges;
      }
    }
  }
}

TEST(NoiseCorrelation, SmoothSignalsLookLikeSmoothedNoise)
{
  const Surface s = Icosphere(4);
  const auto assembler = MakeAssembler(s);
  const Values wave = Sample(assembler->Mesh(), s,
    [](const Eigen::RowVector3d& x) { return std::sin(4.0 * x[0] + 2.0 * x[1]); });
  EXPECT_TRUE(Measure(s, *assembler, PointData::FromValues(wave)).IsSmooth());
  EXPECT_TRUE(
    Measure(s, *assembler, PointData::FromValues(wave + 0.1 * Smoothed(assembler, 3.0, 2)))
      .IsSmooth());
}

TEST(NoiseCorrelation, WhiteNoiseUnderSignalsIsNotSmooth)
{
  int cases = 0;
  for (const Surface& s : Surfaces())
  {
    const auto assembler = MakeAssembler(s);
    const TriangleMesh& mesh = assembler->Mesh();
    for (std::size_t k = 0; k < Signals().size(); ++k)
    {
      const Values clean = SampleInBox(mesh, s, Signals()[k]);
      for (const double sigma : { 0.01, 0.03, 0.1, 0.3 })
      {
        for (const std::int64_t seed : { 3, 4, 5 })
        {
          const Values f = clean + sigma * GaussianNoise(mesh, 1, seed);
          EXPECT_FALSE(Measure(s, *assembler, PointData::FromValues(f)).IsSmooth())
            << mesh.NumberOfVertices() << ' ' << k << ' ' << sigma << ' ' << seed;
          ++cases;
        }
      }
    }
  }
  EXPECT_EQ(cases, 336);
}

TEST(NoiseCorrelation, HoldsWithMasksConstantPartsAndSeveralColumns)
{
  for (const Surface& s : Surfaces())
  {
    const auto assembler = MakeAssembler(s);
    const TriangleMesh& mesh = assembler->Mesh();
    const Values white = 0.05 * GaussianNoise(mesh, 3, 21);
    const Values smooth = Smoothed(assembler, 3.0, 22);
    const Values inside =
      SampleInBox(mesh, s, [](const Eigen::RowVector3d& x) { return x[0] > -0.1 ? 1.0 : 0.0; });
    for (const bool isSmooth : { false, true })
    {
      const Values noise = isSmooth ? smooth : Values(white.col(0));
      PointData masked = PointData::FromValues(noise);
      for (Index i = 0; i < mesh.NumberOfVertices(); ++i)
      {
        if (inside(i, 0) == 0.0)
        {
          masked.Missing[i] = true;
          masked.Given(i, 0) = i % 2 == 0 ? 1e9 : std::nan("");
        }
      }
      EXPECT_EQ(Measure(s, *assembler, masked).IsSmooth(), isSmooth);
      const Values constant = (noise.array() * inside.array() + 0.7).matrix();
      EXPECT_EQ(Measure(s, *assembler, PointData::FromValues(constant)).IsSmooth(), isSmooth);
      Values columns(noise.rows(), 3);
      columns << noise, (isSmooth ? Values(-2.0 * noise) : Values(white.col(1))),
        Values::Zero(noise.rows(), 1);
      EXPECT_EQ(Measure(s, *assembler, PointData::FromValues(columns)).IsSmooth(), isSmooth);
    }
  }
}

TEST(NoiseCorrelation, ComponentsOfDifferentSizesAreMeasuredTogether)
{
  const Surface s = Joined(Icosphere(3), Moved(Icosphere(4, 0.2), { 3.0, 0.0, 0.0 }));
  const auto assembler = MakeAssembler(s);
  const TriangleMesh& mesh = assembler->Mesh();
  for (const double sigma : { 0.01, 0.2 })
  {
    const Values wave =
      Sample(mesh, s, [](const Eigen::RowVector3d& x) { return std::sin(2.0 * x[2]); });
    EXPECT_FALSE(
      Measure(s, *assembler, PointData::FromValues(wave + sigma * GaussianNoise(mesh, 1, 2)))
        .IsSmooth());
  }
  EXPECT_TRUE(
    Measure(s, *assembler, PointData::FromValues(Smoothed(assembler, 3.0, 2))).IsSmooth());
}

TEST(NoiseCorrelation, NoiseOfOtherDistributionsIsNotSmooth)
{
  const Surface s = Icosphere(3);
  const auto assembler = MakeAssembler(s);
  const TriangleMesh& mesh = assembler->Mesh();
  const Values wave =
    Sample(mesh, s, [](const Eigen::RowVector3d& x) { return 0.5 * std::sin(3.0 * x[0]); });
  for (const int seed : { 1, 2, 3, 4, 5 })
  {
    Values exponential(mesh.NumberOfVertices(), 1);
    Values uniform = exponential;
    Values speckled = exponential;
    for (Index i = 0; i < mesh.NumberOfVertices(); ++i)
    {
      uniform(i, 0) = UniformRandom(seed, 0, i);
      exponential(i, 0) = -std::log(1.0 - uniform(i, 0));
      speckled(i, 0) = uniform(i, 0) + (UniformRandom(seed, 1, i) < 0.1 ? 30.0 : 0.0);
    }
    for (const Values& noise : { exponential, uniform, speckled })
    {
      EXPECT_FALSE(Measure(s, *assembler, PointData::FromValues(wave + 0.02 * noise)).IsSmooth());
    }
  }
}

TEST(NoiseCorrelation, NothingIsSaidOfFewPointsAndOfDataWithoutNoise)
{
  const Surface s = Icosphere(2);
  const auto assembler = MakeAssembler(s);
  EXPECT_FALSE(
    Measure(s, *assembler, PointData::FromValues(Smoothed(assembler, 2.0, 1))).IsSmooth());
  EXPECT_FALSE(Measure(s, *assembler, PointData::FromValues(Values::Zero(162, 2))).IsSmooth());
  PointData missing = PointData::FromValues(Values::Zero(162, 1));
  missing.Missing.fill(true);
  EXPECT_FALSE(Measure(s, *assembler, missing).IsSmooth());
  const auto empty =
    std::make_shared<Assembler>(std::make_shared<TriangleMesh>(Points(0, 3), Triangles(0, 3)));
  EXPECT_FALSE(
    MeasureVariation(*empty, Points(0, 3), PointData::FromValues(Values(0, 1)), 0.0).IsSmooth());
  // Needles, at which cubic polynomials are not determined
  const Surface needles = Strip(2, 400);
  const auto ofNeedles = MakeAssembler(needles);
  EXPECT_FALSE(
    Measure(needles, *ofNeedles, PointData::FromValues(GaussianNoise(ofNeedles->Mesh(), 1, 1)))
      .IsSmooth());
}

TEST(NoiseCorrelation, VerticesNearOneOfVeryManyEdgesAreLeftOut)
{
  const Index edges = 8000;
  std::vector<Eigen::RowVector3d> vertices(1, Eigen::RowVector3d::Zero());
  std::vector<std::array<Index, 3>> faces;
  for (Index i = 0; i < edges; ++i)
  {
    const double angle = 2.0 * Pi * i / edges;
    vertices.emplace_back(std::cos(angle), std::sin(angle), 0.0);
    faces.push_back({ 0, 1 + i, 1 + (i + 1) % edges });
  }
  const Surface fan = MakeSurface(vertices, faces);
  const auto assembler = MakeAssembler(fan);
  const PointData data = PointData::FromValues(GaussianNoise(assembler->Mesh(), 1, 1));
  EXPECT_EQ(MeasureVariation(*assembler, fan.Vertices, data, 1.0).NumberOfPairs, 0.0);
}

TEST(NoiseCorrelation, IsFoundOnScannedSurfacesAndNotInTheirWhiteNoise)
{
  if (!HaveMeshFiles())
  {
    GTEST_SKIP() << "SURFACEDIFFUSION_MESH_DIR is not set";
  }
  for (const char* name : { "sphere966", "hand", "homer", "bear_bis", "mannequin-devil" })
  {
    const Surface s = ReadMeshFile(name);
    const auto assembler = MakeAssembler(s);
    const TriangleMesh& mesh = assembler->Mesh();
    for (const double edges : { 3.0, 6.0 })
    {
      EXPECT_TRUE(
        Measure(s, *assembler, PointData::FromValues(Smoothed(assembler, edges, 31))).IsSmooth())
        << name << ' ' << edges;
    }
    for (const Signal& signal : Signals())
    {
      for (const double sigma : { 0.01, 0.1 })
      {
        const Values f = SampleInBox(mesh, s, signal) + sigma * GaussianNoise(mesh, 1, 32);
        EXPECT_FALSE(Measure(s, *assembler, PointData::FromValues(f)).IsSmooth())
          << name << ' ' << sigma;
      }
    }
  }
}
