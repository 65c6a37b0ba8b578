// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Geometry/CorrelatedVertexNoise.h"

#include "Core/Geometry/VertexNoise.h"
#include "DenoisedSurfaces.h"
#include "NoisySurfaces.h"

#include <gtest/gtest.h>

#include <cmath>
#include <utility>

using namespace SurfaceDiffusion;
using namespace SurfaceDiffusion::Testing;

TEST(CorrelatedVertexNoise, NoiseThatIsCorrelatedOverSeveralEdgesIsFoundAndRemoved)
{
  for (const Surface& surface : { Icosphere(5), Strip(80, 60, 8.0, 6.0) })
  {
    const Surface noisy = WithCorrelatedNoise(surface, 0.3, 2.0);
    const TriangleMesh mesh(noisy.Vertices, noisy.Faces);
    const double h = MeanEdge(mesh);
    EXPECT_LT(
      EstimateVertexNoise(mesh, GatherVertices(mesh, noisy.Vertices) / mesh.LengthUnit()), 0.1 * h);
    DenoisingReport report;
    const Surface result = Denoised(noisy, DenoisingSettings(), {}, &report);
    EXPECT_NEAR(report.NoiseLevel / h, 0.3, 0.1);
    EXPECT_GT(report.CorrelationLength / h, 1.0);
    EXPECT_LT(report.CorrelationLength / h, 4.0);
    EXPECT_LT(MeanAngle(result, surface), 0.25 * MeanAngle(noisy, surface));
  }
}

/// Where edges are short, quadrics through two rings follow the noise.
TEST(CorrelatedVertexNoise, NoiseIsFoundOnUnevenTriangles)
{
  Surface surface = LBlock(32);
  const Eigen::RowVector3d middle =
    0.5 * (surface.Vertices.colwise().minCoeff() + surface.Vertices.colwise().maxCoeff());
  for (Index i = 0; i < surface.NumberOfVertices(); ++i) // planes stay planes
  {
    const Eigen::Array3d x = (surface.Vertices.row(i) - middle).array();
    surface.Vertices.row(i) = (x * (0.25 + x.square())).matrix();
  }
  for (const double amount : { 0.2, 0.3 })
  {
    const Surface noisy = NoisyAlongNormals(surface, amount);
    const TriangleMesh mesh(noisy.Vertices, noisy.Faces);
    const double found =
      EstimateVertexNoise(mesh, GatherVertices(mesh, noisy.Vertices) / mesh.LengthUnit()) *
      mesh.LengthUnit() / MeanEdgeLength(surface);
    EXPECT_NEAR(found, amount, 0.3 * amount);
    EXPECT_LT(MeanAngle(Denoised(noisy), surface), 0.6 * MeanAngle(noisy, surface));
  }
}

/// Where curvature and edges of the shape add to the deviations from quadrics.
TEST(CorrelatedVertexNoise, CorrelatedNoiseIsFoundBesideTheShape)
{
  for (const Surface& surface : { LBlock(32), Torus(120, 60) })
  {
    const Surface noisy = WithCorrelatedNoise(surface, 0.3, 2.0);
    DenoisingReport report;
    const Surface result = Denoised(noisy, DenoisingSettings(), {}, &report);
    EXPECT_NEAR(report.NoiseLevel / MeanEdge(TriangleMesh(noisy.Vertices, noisy.Faces)), 0.3, 0.1);
    EXPECT_LT(MeanAngle(result, surface), 0.5 * MeanAngle(noisy, surface));
    EXPECT_EQ(report.Relief, 0.0);
  }
}

/// Noise is everywhere the same, and relief is not.
TEST(CorrelatedVertexNoise, ReliefThatResemblesNoiseStaysAndIsReported)
{
  const Surface surface = Icosphere(5);
  Surface relief = WithCorrelatedNoise(surface, 0.2, 2.0);
  for (Index i = 0; i < surface.NumberOfVertices(); ++i)
  {
    const double z = surface.Vertices(i, 2);
    relief.Vertices.row(i) = surface.Vertices.row(i) +
      std::exp(1.5 * z) * (relief.Vertices.row(i) - surface.Vertices.row(i));
  }
  DenoisingReport report;
  const Surface result = Denoised(relief, DenoisingSettings(), {}, &report);
  EXPECT_EQ(result.Vertices, relief.Vertices);
  EXPECT_EQ(report.NoiseLevel, 0.0);
  const double h = MeanEdge(TriangleMesh(relief.Vertices, relief.Faces));
  EXPECT_NEAR(report.Relief / h, 0.2, 0.1);
  EXPECT_NEAR(report.ReliefLength / h, 2.0, 1.0);
}

/// It resembles details, below the level that is given.
TEST(CorrelatedVertexNoise, CorrelatedNoiseOfAGivenLevelIsRemovedFromAllShapes)
{
  for (const Surface& surface : { LBlock(32), Torus(120, 60), Icosphere(5) })
  {
    const TriangleMesh mesh(surface.Vertices, surface.Faces);
    const double h = MeanEdgeLength(mesh);
    for (const double length : { 1.5, 2.0, 3.0 })
    {
      const Surface noisy = WithCorrelatedNoise(surface, 0.3, length);
      DenoisingSettings settings;
      settings.NoiseLevel = 0.3 * h;
      DenoisingReport report;
      const Surface result = Denoised(noisy, settings, {}, &report);
      EXPECT_NEAR(report.CorrelationLength * mesh.LengthUnit() / h, length, 0.5 * length);
      EXPECT_LT(MeanAngle(result, surface), 0.5 * MeanAngle(noisy, surface)) << length;
    }
    DenoisingSettings settings;
    settings.NoiseLevel = 0.3 * h;
    DenoisingReport report;
    Denoised(NoisyAlongNormals(surface, 0.2), settings, {}, &report);
    EXPECT_EQ(report.CorrelationLength, 0.0);
  }
}

namespace
{

/// A torus of 192 x 96 points with regular waves, this many triangles long and half an edge high.
Surface WavyTorus(int length)
{
  Surface wavy = Torus(192, 96);
  const double height = 0.5 * MeanEdgeLength(wavy);
  for (Index i = 0; i < wavy.NumberOfVertices(); ++i)
  {
    const Eigen::RowVector3d p = wavy.Vertices.row(i);
    const Eigen::RowVector3d centre = 2.0 * Eigen::RowVector3d(p[0], p[1], 0.0).normalized();
    const double around = std::atan2(p[1], p[0]);
    const double across = std::atan2(p[2], std::hypot(p[0], p[1]) - 2.0);
    wavy.Vertices.row(i) += height * std::cos(192.0 / length * around) *
      std::cos(96.0 / length * across) * (p - centre).normalized();
  }
  return wavy;
}

} // namespace

/// Waves of six triangles were taken for correlated noise.
TEST(CorrelatedVertexNoise, RegularWavesAreNoNoise)
{
  for (const int length : { 6, 8, 12, 16 })
  {
    const Surface wavy = WavyTorus(length);
    EXPECT_EQ(LargestDistance(Denoised(wavy), wavy), 0.0) << length;
    const Surface noisy = NoisyAlongNormals(wavy, 0.05);
    EXPECT_LT(MeanAngle(Denoised(noisy), wavy), 1.1 * MeanAngle(noisy, wavy)) << length;
  }
}

TEST(CorrelatedVertexNoise, NeitherWhiteNoiseNorShapeIsCorrelatedNoise)
{
  for (const Surface& surface :
    { Icosphere(5), Torus(80, 40), LBlock(32), NoisyAlongNormals(Icosphere(5), 0.3),
      NoisyAlongNormals(Torus(80, 40), 0.1), NoisyAlongNormals(LBlock(32), 0.3),
      NoisyAlongNormals(HalfRoughTorus(120), 0.2), NoisyAlongNormals(HalfRoughTorus(120), 0.3) })
  {
    const TriangleMesh mesh(surface.Vertices, surface.Faces);
    const CorrelatedNoise found =
      EstimateCorrelatedNoise(mesh, GatherVertices(mesh, surface.Vertices));
    EXPECT_EQ(found.Level, 0.0);
    EXPECT_EQ(found.Length, 0.0);
  }
}

TEST(CorrelatedVertexNoise, NoiseOfAGivenLengthIsRemovedFromAllShapes)
{
  for (const Surface& surface : { LBlock(32), Torus(120, 60), Cylinder(120, 60) })
  {
    const double h = MeanEdgeLength(surface);
    for (const double deviation : { 2.0, 4.0 })
    {
      const Surface noisy = WithCorrelatedNoise(surface, 0.3, std::sqrt(2.0) * deviation);
      DenoisingSettings settings;
      settings.NoiseLength = deviation;
      DenoisingReport report;
      const Surface result = Denoised(noisy, settings, {}, &report);
      EXPECT_LT(MeanAngle(result, surface), 0.75 * MeanAngle(noisy, surface)) << deviation;
      const double unit = TriangleMesh(noisy.Vertices, noisy.Faces).LengthUnit();
      EXPECT_NEAR(report.CorrelationLength * unit / h, std::sqrt(2.0) * deviation, 0.1 * deviation);
      EXPECT_NEAR(report.NoiseLevel * unit / h, 0.3, 0.16);
    }
  }
}
