// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Meshes.h"
#include "Run/Solve.h"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

using namespace SurfaceDiffusion;
using namespace SurfaceDiffusion::Testing;

namespace
{

using Shape = Testing::Surface;

SurfaceDisk Around(const Shape& s, const SurfacePlace& center, double radius)
{
  return DiskAround(s.Vertices, s.Faces, center, radius);
}

SurfacePlace Near(double x, double y, double z)
{
  SurfacePlace place{ "center" };
  place.Coordinates = { x, y, z };
  return place;
}

double LengthOf(const Points& curve)
{
  double sum = 0.0;
  for (Eigen::Index k = 1; k < curve.rows(); ++k)
  {
    sum += (curve.row(k) - curve.row(k - 1)).norm();
  }
  return sum;
}

Shape UnitCube()
{
  return MakeSurface({ { 0, 0, 0 }, { 1, 0, 0 }, { 1, 1, 0 }, { 0, 1, 0 }, { 0, 0, 1 }, { 1, 0, 1 },
                       { 1, 1, 1 }, { 0, 1, 1 } },
    { { 0, 2, 1 }, { 0, 3, 2 }, { 4, 5, 6 }, { 4, 6, 7 }, { 0, 1, 5 }, { 0, 5, 4 }, { 1, 2, 6 },
      { 1, 6, 5 }, { 2, 3, 7 }, { 2, 7, 6 }, { 3, 0, 4 }, { 3, 4, 7 } });
}

TEST(GeodesicDisk, InAPlaneIsACircle)
{
  for (const Index cells : { 1, 4, 40 })
  {
    const Shape plate = Plate(cells, 1.0);
    const Eigen::RowVector3d center(0.13, 0.07, 0.0);
    for (const double radius : { 1e-3, 0.05, 0.3, 0.8 })
    {
      const SurfaceDisk disk = Around(plate, Near(center[0], center[1], 0.0), radius);
      EXPECT_NEAR(disk.Area / (Pi * radius * radius), 1.0, 2e-3) << cells << ", " << radius;
      ASSERT_EQ(disk.Boundary.size(), 1u);
      const Points& curve = disk.Boundary[0];
      EXPECT_LE((curve.row(0) - curve.bottomRows(1)).norm(), 1e-12);
      EXPECT_NEAR(LengthOf(curve) / (2.0 * Pi * radius), 1.0, 2e-3);
      const auto distances = (curve.rowwise() - center).rowwise().norm();
      EXPECT_LE((distances.array() / radius - 1.0).abs().maxCoeff(), 1e-3);
    }
  }
}

// Around a place on the edge of a cube the disk is bent and no smaller; at a corner a quarter is missing.
TEST(GeodesicDisk, OnACubeIsThatOfItsNet)
{
  const Shape cube = UnitCube();
  for (const double radius : { 0.01, 0.2, 0.45 })
  {
    const double area = Pi * radius * radius;
    EXPECT_NEAR(Around(cube, Near(0.5, 0.5, 0.0), radius).Area / area, 1.0, 2e-3);
    EXPECT_NEAR(Around(cube, Near(0.5, 0.0, 0.0), radius).Area / area, 1.0, 2e-3);
    EXPECT_NEAR(Around(cube, Near(0.0, 0.0, 0.0), radius).Area / area, 0.75, 2e-3);
  }
  // Beyond the edges of a side, around its centre: a cross of the net that bends at the corners
  const SurfaceDisk all = Around(cube, Near(0.5, 0.5, 0.0), 3.0);
  EXPECT_NEAR(all.Area, 6.0, 1e-12);
  EXPECT_TRUE(all.Boundary.empty());
}

TEST(GeodesicDisk, OnASphereIsACap)
{
  const Shape ball = Icosphere(5);
  for (const double radius : { 0.1, 0.5, 1.5, 3.0 })
  {
    const SurfaceDisk disk = Around(ball, Near(0.0, 0.0, 1.0), radius);
    EXPECT_NEAR(disk.Area / (2.0 * Pi * (1.0 - std::cos(radius))), 1.0, 5e-3) << radius;
    ASSERT_EQ(disk.Boundary.size(), 1u);
    EXPECT_NEAR(LengthOf(disk.Boundary[0]) / (2.0 * Pi * std::sin(radius)), 1.0, 1e-2) << radius;
  }
}

// At a saddle that joins k squares the disk has k quarters.
TEST(GeodesicDisk, AtASaddleHasMoreThanACircle)
{
  std::vector<Eigen::RowVector3d> points{ { 0, 0, 0 } };
  std::vector<std::array<Index, 3>> faces;
  const std::vector<Eigen::RowVector3d> axes{ { 1, 0, 0 }, { 0, 1, 0 }, { 0, 0, 1 }, { -1, 0, 0 },
    { 0, -1, 0 }, { 0, 0, -1 } };
  // x, y, z, -x, -y, -z and back: six right angles around the origin
  points.insert(points.end(), axes.begin(), axes.end());
  for (Index k = 0; k < 6; ++k)
  {
    faces.push_back({ 0, 1 + k, 1 + (k + 1) % 6 });
  }
  const Shape saddle = MakeSurface(points, faces);
  const SurfaceDisk disk = Around(saddle, { "center", 0 }, 0.6);
  EXPECT_NEAR(disk.Area / (1.5 * Pi * 0.36), 1.0, 2e-3);
}

// A disk that meets itself around the tube of a torus has two boundaries, and ends at a boundary of the
// surface have one point each.
TEST(GeodesicDisk, HasABoundaryOfSeveralCurves)
{
  const SurfaceDisk ring = Around(Torus(60, 30, 3.0, 0.5), Near(3.5, 0.0, 0.0), 2.5);
  EXPECT_EQ(ring.Boundary.size(), 2u);
  for (const Points& curve : ring.Boundary)
  {
    EXPECT_LE((curve.row(0) - curve.bottomRows(1)).norm(), 1e-12);
  }
  const SurfaceDisk cut = Around(Plate(10, 1.0), Near(0.9, 0.0, 0.0), 0.5);
  ASSERT_EQ(cut.Boundary.size(), 1u);
  EXPECT_NEAR(cut.Boundary[0](0, 0), 1.0, 1e-12);
  EXPECT_NEAR(cut.Boundary[0].bottomRows(1)(0, 0), 1.0, 1e-12);
  const double half = std::acos(0.2); // between the axis and the ends
  EXPECT_NEAR(cut.Area / (0.25 * (Pi - half) + 0.1 * std::sqrt(0.24)), 1.0, 2e-3);
}

} // namespace
