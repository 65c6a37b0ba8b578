// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Surface/Seams.h"

#include "Meshes.h"

#include <Eigen/Geometry>

#include <gtest/gtest.h>

#include <cmath>

using namespace SurfaceDiffusion;
using namespace SurfaceDiffusion::Testing;

namespace
{

/// Two sheets of n x n squares of the given size, the second moved by `gap` from the end of the first
/// and turned about the z axis.
Seams OfTwoSheets(Index n, double size, double gap, double angle, double offset)
{
  const Index rows = n + 1;
  Points points(2 * rows * rows, 3);
  Triangles triangles(4 * n * n, 3);
  const Eigen::Matrix3d turn =
    Eigen::AngleAxisd(angle, Eigen::Vector3d(1, 2, 3).normalized()).toRotationMatrix();
  Index t = 0;
  for (Index sheet = 0; sheet < 2; ++sheet)
  {
    for (Index j = 0; j <= n; ++j)
    {
      for (Index i = 0; i <= n; ++i)
      {
        const Index point = i + rows * (j + rows * sheet);
        const Eigen::Vector3d place(size * (i + n * sheet) + gap * sheet, size * j, 0.0);
        points.row(point) = (turn * place).transpose();
        points.row(point).array() += offset;
        if (i < n && j < n)
        {
          triangles.row(t++) << point, point + 1, point + 1 + rows;
          triangles.row(t++) << point, point + 1 + rows, point + rows;
        }
      }
    }
  }
  const TriangleMesh mesh(points, triangles);
  return FindSeams(mesh, points);
}

} // namespace

TEST(Seams, OfEqualPointsHaveTheDistanceZero)
{
  for (const double angle : { 0.0, 0.7 })
  {
    const Seams seams = OfTwoSheets(5, 1.0, 0.0, angle, 0.0);
    EXPECT_EQ(seams.NumberOfVertices, 12);
    EXPECT_LT(seams.Distance, 1e-14);
  }
  EXPECT_EQ(OfTwoSheets(5, 1.0, 0.0, 0.0, 0.0).Distance, 0.0);
}

TEST(Seams, AreThoseOfPointsThatRoundOffSetsApart)
{
  for (const double size : { 1e-200, 1e-6, 1.0, 1e200 })
  {
    const Seams seams = OfTwoSheets(5, size, 3.2e-8 * size, 0.7, 0.0);
    EXPECT_EQ(seams.NumberOfVertices, 12) << size;
    EXPECT_NEAR(seams.Distance / size, 4e-8, 1e-20) << size;
  }
  const Seams far = OfTwoSheets(5, 1.0, 1e-5, 0.7, 1e6);
  EXPECT_EQ(far.NumberOfVertices, 12);
  EXPECT_GE(far.Distance, 1e-5 - 1e-9);
}

TEST(Seams, AreFoundAmongVeryManyCopiesOfAPoint)
{
  constexpr Index n = 100000; // separate triangles of a cone: pairs would take minutes
  Points points(3 * n, 3);
  Triangles triangles(n, 3);
  for (Index t = 0; t < n; ++t)
  {
    const double angle = 8.0 * std::atan(1.0) * t / n;
    const double next = 8.0 * std::atan(1.0) * ((t + 1) % n) / n;
    points.row(3 * t) << 0.0, 0.0, 1.0;
    points.row(3 * t + 1) << std::cos(angle), std::sin(angle), 0.0;
    points.row(3 * t + 2) << std::cos(next), std::sin(next), 0.0;
    triangles.row(t) << 3 * t, 3 * t + 1, 3 * t + 2;
  }
  const Seams seams = FindSeams(TriangleMesh(points, triangles), points);
  EXPECT_EQ(seams.NumberOfVertices, 3 * n);
  EXPECT_EQ(seams.Distance, 0.0);
}

TEST(Seams, AreNotTheSidesOfASlit)
{
  for (const double gap : { 2e-3, 0.1, 1.0 })
  {
    EXPECT_EQ(OfTwoSheets(5, 1.0, gap, 0.7, 0.0).NumberOfVertices, 0) << gap;
  }
}

TEST(Seams, AreAbsentWhereAllPointsAreOfOneSurface)
{
  const auto sphere = Icosphere(2);
  EXPECT_EQ(
    FindSeams(TriangleMesh(sphere.Vertices, sphere.Faces), sphere.Vertices).NumberOfVertices, 0);
  // Edges of any length along the boundary
  Points points(6, 3);
  points << 0, 0, 0, 1e-6, 0, 0, 1, 0, 0, 0, 1, 0, 1e-6, 1, 0, 1, 1, 0;
  Triangles triangles(4, 3);
  triangles << 0, 1, 4, 0, 4, 3, 1, 2, 5, 1, 5, 4;
  EXPECT_EQ(FindSeams(TriangleMesh(points, triangles), points).NumberOfVertices, 0);
}
