// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Surface/Polygons.h"

#include <Eigen/Geometry>
#include <gtest/gtest.h>

#include <cmath>
#include <set>
#include <utility>

using namespace SurfaceDiffusion;

namespace
{

using Row3 = Eigen::RowVector3d;
using Polygon = std::vector<Row3>;

Row3 DoubledNormal(const Polygon& polygon, const Corners& c)
{
  return (polygon[c[1]] - polygon[c[0]]).cross(polygon[c[2]] - polygon[c[0]]);
}

double AreaOf(const Polygon& polygon, const std::vector<Corners>& triangles)
{
  double area = 0.0;
  for (const Corners& triangle : triangles)
  {
    area += 0.5 * DoubledNormal(polygon, triangle).norm();
  }
  return area;
}

} // namespace

TEST(Polygons, QuadIsCutAlongItsShorterDiagonal)
{
  const Polygon kite = { Row3(0, 0, 0), Row3(1, -0.2, 0), Row3(2, 0, 0), Row3(1, 0.2, 0) };
  for (std::size_t first = 0; first < 4; ++first)
  {
    Polygon turned;
    for (std::size_t i = 0; i < 4; ++i)
    {
      turned.push_back(kite[(first + i) % 4]);
    }
    for (const Corners& triangle : CutPolygon(turned))
    {
      std::multiset<double> ys;
      for (const int corner : triangle)
      {
        ys.insert(turned[corner][1]);
      }
      EXPECT_EQ((std::multiset<double>{ -0.2, 0.0, 0.2 }), ys);
    }
  }
}

TEST(Polygons, ArrowheadIsCutInside)
{
  const Polygon arrow = { Row3(0, 0, 0), Row3(2, -1, 0), Row3(0.5, 0, 0), Row3(2, 1, 0) };
  EXPECT_NEAR(0.5, AreaOf(arrow, CutPolygon(arrow)), 1e-15);
}

TEST(Polygons, ConcavePolygonIsCoveredOnce)
{
  // A star in a tilted plane: every other corner is concave.
  for (const int tips : { 3, 5, 12 })
  {
    Polygon star;
    double exact = 0.0;
    for (int i = 0; i < 2 * tips; ++i)
    {
      const double angle = std::acos(-1.0) * i / tips;
      const double radius = i % 2 == 0 ? 1.0 : 0.3;
      star.emplace_back(
        radius * std::cos(angle), radius * std::sin(angle), 0.5 * radius * std::cos(angle));
    }
    for (std::size_t i = 0; i < star.size(); ++i)
    {
      exact += 0.5 * star[i].cross(star[(i + 1) % star.size()]).norm();
    }
    const auto triangles = CutPolygon(star);
    ASSERT_EQ(star.size() - 2, triangles.size());
    EXPECT_NEAR(exact, AreaOf(star, triangles), 1e-12);
    const Row3 normal = DoubledNormal(star, triangles[0]);
    for (const Corners& triangle : triangles)
    {
      EXPECT_GT(DoubledNormal(star, triangle).dot(normal), 0.0);
    }
  }
}

TEST(Polygons, AnyPolygonGivesTwoTrianglesLessThanCorners)
{
  const Polygon bow = { Row3(0, 0, 0), Row3(1, 1, 0), Row3(1, 0, 0), Row3(0, 1, 0),
    Row3(-1, 0.5, 0) };
  EXPECT_EQ(3u, CutPolygon(bow).size());
  const Polygon flat(6, Row3(1, 2, 3));
  EXPECT_EQ(4u, CutPolygon(flat).size());
  EXPECT_EQ(1u, CutPolygon({ Row3(0, 0, 0), Row3(1, 0, 0), Row3(0, 1, 0) }).size());
}

TEST(Polygons, AreCutAlikeAtAnySize)
{
  const Polygon arrow = { Row3(0, 0, 0), Row3(2, -2, 0), Row3(1, 0, 0), Row3(2, 2, 0) };
  const Polygon cross = { Row3(0, 1, 0), Row3(1, 1, 0), Row3(1, 0, 0), Row3(2, 0, 0), Row3(2, 3, 0),
    Row3(0, 3, 0) };
  for (const Polygon& polygon : { arrow, cross })
  {
    for (const double scale : { 1e-250, 1e-150, 1e150, 1e250 })
    {
      Polygon scaled;
      for (const Row3& corner : polygon)
      {
        scaled.push_back(scale * corner);
      }
      EXPECT_EQ(CutPolygon(polygon), CutPolygon(scaled)) << scale;
    }
  }
  EXPECT_TRUE(CutPolygon({ Row3(0, 0, 0), Row3(1, 0, 0) }).empty());
}
