// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Foundation/Random.h"
#include "Core/Surface/MergePoints.h"

#include <gtest/gtest.h>

using namespace SurfaceDiffusion;

namespace
{

Points RandomPoints(Index count, double size)
{
  Points points(count, 3);
  for (Index i = 0; i < count; ++i)
  {
    for (int k = 0; k < 3; ++k)
    {
      points(i, k) = size * (UniformRandom(1, k, i) - 0.5);
    }
  }
  return points;
}

} // namespace

TEST(MergePoints, EqualPointsGetTheFirstOfThem)
{
  Points points(5, 3);
  points << 1, 2, 3, 0, 0, 0, 1, 2, 3, -0.0, 0.0, -0.0, 1, 2, 3 + 1e-15;
  EXPECT_EQ(MergePoints(points, 0.0), (std::vector<Index>{ 0, 1, 0, 1, 4 }));
}

TEST(MergePoints, AToleranceMergesAsComparingAllPairsWould)
{
  const Index count = 400;
  const Points points = RandomPoints(count, 1.0);
  for (const double tolerance : { 1e-6, 0.05, 0.2, 3.0 })
  {
    std::vector<Index> expected(count, -1);
    for (Index i = 0; i < count; ++i)
    {
      for (Index j = i; j < count && (expected[i] < 0 || expected[i] == i); ++j)
      {
        if (expected[j] < 0 && (i == j || (points.row(i) - points.row(j)).norm() <= tolerance))
        {
          expected[j] = i;
        }
      }
    }
    EXPECT_EQ(MergePoints(points, tolerance), expected) << tolerance;
  }
}

TEST(MergePoints, CoordinatesOfAnySizeAreCompared)
{
  for (const double size : { 1e-200, 1e200 })
  {
    Points points = RandomPoints(50, size);
    points.row(49) = points.row(7);
    const std::vector<Index> exact = MergePoints(points, 0.0);
    const std::vector<Index> near = MergePoints(points, 1e-12 * size);
    EXPECT_EQ(exact[49], 7);
    EXPECT_EQ(near[49], 7);
    EXPECT_EQ(near[48], 48);
  }
}

TEST(JoinShortEdges, FollowsChainsOfThem)
{
  Points points(6, 3);
  points << 0, 0, 0, 1, 0, 0, 1e-16, 0, 0, 0, 1, 0, 1e-16, 1e-17, 0, 1, 1, 0;
  Triangles triangles(4, 3);
  triangles << 4, 2, 1, 2, 0, 3, 1, 5, 3, 0, 1, 3;
  EXPECT_EQ(
    JoinShortEdges(points, triangles, SerialFor()), (std::vector<Index>{ 0, 1, 0, 3, 0, 5 }));
  EXPECT_TRUE(JoinShortEdges(points, triangles.bottomRows(2), SerialFor()).empty());
}

TEST(JoinShortEdges, LeavesNeedlesOfEverySizeAndPlace)
{
  for (const double size : { 1e-200, 1.0, 1e200, 1.7e308 })
  {
    Points points(3, 3);
    points << -size, 0, 0, size, 0, 0, size, 1e-9 * size, 0;
    Triangles triangles(1, 3);
    triangles << 0, 1, 2;
    EXPECT_TRUE(JoinShortEdges(points, triangles, SerialFor()).empty()) << size;
    points(2, 1) = 1e-11 * size;
    EXPECT_EQ(JoinShortEdges(points, triangles, SerialFor()), (std::vector<Index>{ 0, 1, 1 }))
      << size;
  }
}
