// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Geometry/DisplacementStatistics.h"
#include "Interpolation.h"
#include "Meshes.h"

#include <gtest/gtest.h>

#include <cmath>

using namespace SurfaceDiffusion;
using namespace SurfaceDiffusion::Testing;

namespace
{

Vector WhiteNoise(Index count)
{
  Vector noise(count);
  for (Index i = 0; i < count; ++i)
  {
    noise[i] = Gaussian(7, 0, i);
  }
  return noise;
}

/// Replaces numbers by the means over each vertex and its neighbours.
Vector Averaged(const TriangleMesh& mesh, const Vector& values)
{
  Vector means(values.size());
  for (Index i = 0; i < mesh.NumberOfVertices(); ++i)
  {
    double sum = values[i];
    const Index begin = mesh.VertexCornersBegin()[i];
    const Index end = mesh.VertexCornersBegin()[i + 1];
    for (Index k = begin; k < end; ++k)
    {
      sum += values[mesh.OtherCorner(mesh.VertexCorners()[k], 1)]; // closed: each neighbour once
    }
    means[i] = sum / (1.0 + end - begin);
  }
  return means;
}

} // namespace

TEST(DisplacementStatistics, IndependentNoiseHasWhitenessOne)
{
  for (const Surface& surface : { Icosphere(5), Torus(120, 60), Strip(100, 80) })
  {
    const TriangleMesh mesh(surface.Vertices, surface.Faces);
    const DisplacementStatistics statistics(mesh, {});
    const Vector noise = WhiteNoise(mesh.NumberOfVertices());
    const double deviation = statistics.WhitenessDeviation();
    EXPECT_LT(deviation, 0.05);
    EXPECT_NEAR(statistics.Whiteness(noise), 1.0, 3.0 * deviation);
    EXPECT_NEAR(statistics.Whiteness(1e-30 * noise), statistics.Whiteness(noise), 1e-12);
    EXPECT_NEAR(statistics.LocalWhiteness(noise).mean(), 1.0, 0.05);
  }
}

/// Sums of equal numbers are m d, so that R is the mean of m.
TEST(DisplacementStatistics, EqualDisplacementsHaveTheMeanNumberOfNeighboursAsWhiteness)
{
  const Surface torus = Torus(60, 30); // six neighbours on average, four or eight of each vertex
  const TriangleMesh mesh(torus.Vertices, torus.Faces);
  const DisplacementStatistics statistics(mesh, {});
  const Vector equal = Vector::Constant(mesh.NumberOfVertices(), -0.3);
  EXPECT_NEAR(statistics.Whiteness(equal), 7.0, 1e-12);
  EXPECT_GT(statistics.LocalWhiteness(equal).minCoeff(), 6.0);
  EXPECT_LT(statistics.LocalWhiteness(equal).maxCoeff(), 8.0);
  EXPECT_NEAR(statistics.LocalMeans(equal).maxCoeff(), -0.3, 1e-15);
  EXPECT_EQ(statistics.Whiteness(Vector::Zero(mesh.NumberOfVertices())), 0.0);
  EXPECT_EQ(statistics.LocalWhiteness(Vector::Zero(mesh.NumberOfVertices())).maxCoeff(), 0.0);
}

TEST(DisplacementStatistics, NoiseWithoutItsSmoothPartIsLessAndSmoothNoiseMoreThanWhite)
{
  const Surface torus = Torus(120, 60);
  const TriangleMesh mesh(torus.Vertices, torus.Faces);
  const DisplacementStatistics statistics(mesh, {});
  const Vector noise = WhiteNoise(mesh.NumberOfVertices());
  const Vector smooth = Averaged(mesh, noise);
  EXPECT_LT(statistics.Whiteness(noise - smooth), 0.4);
  EXPECT_GT(statistics.Whiteness(smooth), 2.0);
  EXPECT_GT(statistics.Whiteness(noise + smooth), 1.2);
}

/// One half of a torus has smooth noise, the other white noise.
TEST(DisplacementStatistics, LocalWhitenessIsThatOfTheVerticesAround)
{
  const Surface torus = Torus(160, 80);
  const TriangleMesh mesh(torus.Vertices, torus.Faces);
  const DisplacementStatistics statistics(mesh, {});
  Vector noise = WhiteNoise(mesh.NumberOfVertices());
  const Vector smooth = Averaged(mesh, noise);
  for (Index i = 0; i < mesh.NumberOfVertices(); ++i)
  {
    noise[i] = torus.Vertices(mesh.InputVertex()[i], 0) > 0.0 ? smooth[i] : noise[i];
  }
  const Vector whiteness = statistics.LocalWhiteness(noise);
  for (Index i = 0; i < mesh.NumberOfVertices(); ++i)
  {
    const double x = torus.Vertices(mesh.InputVertex()[i], 0);
    if (std::abs(x) > 0.8) // farther from the other half than sums reach
    {
      EXPECT_EQ(whiteness[i] > 1.7, x > 0.0) << x << " " << whiteness[i];
    }
  }
}

TEST(DisplacementStatistics, FixedVerticesTakeNoPart)
{
  const Surface torus = Torus(120, 60);
  const TriangleMesh mesh(torus.Vertices, torus.Faces);
  std::vector<char> fixed(static_cast<std::size_t>(mesh.NumberOfVertices()), 0);
  Vector noise = WhiteNoise(mesh.NumberOfVertices());
  for (Index i = 0; i < mesh.NumberOfVertices(); ++i)
  {
    fixed[i] = UniformRandom(5, 0, i) < 0.5;
    noise[i] = fixed[i] ? 0.0 : noise[i];
  }
  const DisplacementStatistics free(mesh, fixed);
  EXPECT_NEAR(free.Whiteness(noise), 1.0, 3.0 * free.WhitenessDeviation());
  EXPECT_LT(free.WhitenessDeviation(), 0.05);
}
