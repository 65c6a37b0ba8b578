// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "MeshFiles.h"
#include "NeedleMeshes.h"
#include "PathsOn.h"
#include "Run/Solve.h"

#include <gtest/gtest.h>

#include <cmath>
#include <utility>
#include <vector>

using namespace SurfaceDiffusion;
using namespace SurfaceDiffusion::Testing;

namespace
{

using Shape = Testing::Surface;

/// A box of few triangles, of the given lengths of its edges.
Shape Box(double length, double width, double height)
{
  std::vector<Eigen::RowVector3d> points;
  for (const double z : { 0.0, height })
  {
    points.insert(
      points.end(), { { 0, 0, z }, { length, 0, z }, { length, width, z }, { 0, width, z } });
  }
  return MakeSurface(points,
    { { 0, 2, 1 }, { 0, 3, 2 }, { 4, 5, 6 }, { 4, 6, 7 }, { 0, 1, 5 }, { 0, 5, 4 }, { 1, 2, 6 },
      { 1, 6, 5 }, { 2, 3, 7 }, { 2, 7, 6 }, { 3, 0, 4 }, { 3, 4, 7 } });
}

Shape Rough(int subdivisions, double amount)
{
  Shape s = Icosphere(subdivisions);
  for (Index i = 0; i < s.NumberOfVertices(); ++i)
  {
    s.Vertices.row(i) *= 1.0 + amount * UniformRandom(3, 0, i);
  }
  return s;
}

/// A place within a triangle, or on its edge.
MeshPlace RandomPlace(const PathsOn& on, std::int64_t seed, Index k)
{
  const auto t = static_cast<Index>(UniformRandom(seed, 0, k) * on.NumberOfTriangles());
  double a = UniformRandom(seed, 1, k), b = k % 3 == 0 ? 0.0 : UniformRandom(seed, 2, k);
  if (a + b > 1.0)
  {
    a = 1.0 - a;
    b = 1.0 - b;
  }
  return { t, { a, b, 1.0 - a - b } };
}

/// That a path is one, and that it is straight.
void ExpectStraight(const PathsOn::Found& path)
{
  EXPECT_TRUE(path.IsFollowed);
  EXPECT_LE(path.Gap, 1e-12 * path.Length);
  EXPECT_NEAR(path.Drawn, path.Length, 1e-11 * path.Length);
  EXPECT_LE(path.Bend, 1e-5);
  EXPECT_LE(path.Lack, 1e-5);
}

/// Paths between vertices have the length of ExactDistance, and those between other places that of the
/// way back.
void TestPaths(const Shape& s, Index count)
{
  PathsOn on(s);
  Index tried = 0;
  for (Index k = 0; k < count; ++k)
  {
    const auto n = static_cast<double>(s.NumberOfVertices());
    const auto i = static_cast<Index>(UniformRandom(5, k / 4, 0) * n);
    const auto j = static_cast<Index>(UniformRandom(6, k, 0) * n);
    if (on.Has(i) && on.Has(j) && i != j && std::isfinite(on.Distance(i, j)))
    {
      const double distance = on.Distance(i, j);
      const PathsOn::Found path = on.Find(on.At(j), on.At(i));
      ASSERT_NEAR(path.Length, distance, 1e-12 * distance) << j << " to " << i;
      ExpectStraight(path);
      ++tried;
    }
    const MeshPlace a = RandomPlace(on, 7, k), b = RandomPlace(on, 8, k);
    const PathsOn::Found path = on.Find(a, b), back = on.Find(b, a);
    if (std::isfinite(path.Length))
    {
      ASSERT_NEAR(path.Length, back.Length, 1e-11 * path.Length) << "places " << k;
      ExpectStraight(path);
      ExpectStraight(back);
      ++tried;
    }
  }
  EXPECT_GT(tried, 0);
}

TEST(GeodesicPath, IsAsLongAsTheExactDistanceAndStraight)
{
  for (const Shape& s :
    { Icosphere(0), Icosphere(3), Tetrahedron(), Torus(24, 16), Plate(12, 1.0), Strip(30, 4),
      Disk(8), Cylinder(16, 12), Moebius(30, 4), ThreeFins(4), Rough(2, 0.4), Rough(2, 4.0),
      LatitudeLongitudeSphere(40, 20), CylinderWithFans(40, 8), Box(30, 12, 12), Box(1, 1, 1) })
  {
    TestPaths(s, 24);
  }
}

TEST(GeodesicPath, OfRealMeshesIsAsLongAsTheExactDistanceAndStraight)
{
  if (!HaveMeshFiles())
  {
    GTEST_SKIP() << "no mesh files";
  }
  for (const char* const name :
    { "anchor", "cylinder", "pinion_small", "mask_cone", "couplingdown" })
  {
    TestPaths(ReadMeshFile(name), 12);
  }
}

/// From points to the nearest of points and straight pieces of lines, also along edges, which are met at a
/// right angle or at an end.
TEST(GeodesicPath, ToTheNearestOfPointsAndLinesIsAsLongAsTheExactDistanceAndStraight)
{
  for (const Shape& s : { Icosphere(0), Icosphere(3), Tetrahedron(), Torus(24, 16), Plate(12, 1.0),
         Strip(30, 4), Disk(8), Cylinder(16, 12), Moebius(30, 4), ThreeFins(4), Rough(2, 0.4),
         LatitudeLongitudeSphere(40, 20), CylinderWithFans(40, 8), Box(30, 12, 12) })
  {
    PathsOn on(s);
    for (Index round = 0; round < 6; ++round)
    {
      std::vector<SourcePiece> pieces;
      for (Index k = 0; k < (round < 3 ? 1 : 5); ++k)
      {
        const MeshPlace a = RandomPlace(on, 17 + round, 3 * k + round);
        const MeshPlace b = RandomPlace(on, 18 + round, 3 * k + round);
        pieces.push_back({ a.Triangle, a.At, (round + k) % 4 == 3 ? a.At : b.At });
      }
      std::vector<Index> points;
      for (Index k = 0; k < 12; ++k)
      {
        const auto point = static_cast<Index>(UniformRandom(19, round, k) * s.NumberOfVertices());
        if (on.Has(point))
        {
          points.push_back(point);
        }
      }
      std::vector<double> distances;
      const std::vector<PathsOn::Found> paths = on.FindAll(points, pieces, distances);
      for (std::size_t k = 0; k < paths.size(); ++k)
      {
        if (std::isfinite(distances[k]))
        {
          EXPECT_NEAR(paths[k].Length, distances[k], 1e-12 * distances[k]) << round << " " << k;
          ExpectStraight(paths[k]);
        }
      }
    }
  }
}

// The spider and the fly in a room of 30 x 12 x 12, 1 from the ceiling and 1 from the floor in the middle
// of the end walls (H. Dudeney, 1903): over five of the six sides the way is 40, straight down and up 42.
TEST(GeodesicPath, OfTheSpiderToTheFlyGoesOverFiveSides)
{
  const Shape room = Box(30, 12, 12);
  SurfacePlace spider{ "spider" }, fly{ "fly" };
  spider.Coordinates = { 0.0, 6.0, 11.0 };
  fly.Coordinates = { 30.0, 6.0, 1.0 };
  const SurfacePath path = ShortestPath(room.Vertices, room.Faces, { spider, fly });
  EXPECT_NEAR(path.Length, 40.0, 1e-12);
  std::vector<Index> sides;
  for (const Index t : path.Triangles)
  {
    if (sides.empty() || sides.back() != t / 2)
    {
      sides.push_back(t / 2);
    }
  }
  EXPECT_EQ(sides.size(), 5u);
  ASSERT_EQ(path.Points.rows(), static_cast<Eigen::Index>(path.Triangles.size()) + 1);
  double drawn = 0.0;
  for (Eigen::Index k = 1; k < path.Points.rows(); ++k)
  {
    drawn += (path.Points.row(k) - path.Points.row(k - 1)).norm();
  }
  EXPECT_NEAR(drawn, 40.0, 1e-12);
}

TEST(GeodesicPath, WithinATriangleAndOfAPlaceFromItself)
{
  PathsOn on(Icosphere(2));
  const PathsOn::Found within = on.Find({ 5, { 0.2, 0.3, 0.5 } }, { 5, { 0.6, 0.3, 0.1 } });
  EXPECT_EQ(within.Faces.size(), 1u);
  ExpectStraight(within);
  for (const MeshPlace& place :
    { MeshPlace{ 5, { 0.2, 0.3, 0.5 } }, MeshPlace{ 5, { 0.5, 0.5, 0.0 } }, on.At(7) })
  {
    const PathsOn::Found none = on.Find(place, place);
    EXPECT_EQ(none.Length, 0.0);
    EXPECT_EQ(none.Faces.size(), 0u);
  }
}

// On a cone of slant height 1 whose circle of base unrolls to the angle a, places at half of the height
// on opposite sides are 2 (1/2) sin(a / 4) apart.
TEST(GeodesicPath, OverAConeIsAChordOfItsSector)
{
  constexpr Index around = 40;
  std::vector<Eigen::RowVector3d> points{ { 0, 0, 1.5 } };
  std::vector<std::array<Index, 3>> faces;
  for (Index k = 0; k < around; ++k)
  {
    points.emplace_back(std::cos(2.0 * Pi * k / around), std::sin(2.0 * Pi * k / around), 0.0);
    faces.push_back({ 0, 1 + k, 1 + (k + 1) % around });
  }
  const Shape cone = MakeSurface(points, faces);
  const double slant = (points[1] - points[0]).norm();
  const double angle =
    around * std::acos((points[1] - points[0]).dot(points[2] - points[0]) / (slant * slant));
  const SurfacePath path = ShortestPath(cone.Vertices, cone.Faces,
    { { "start", -1, 0, { 0.5, 0.5, 0.0 } }, { "end", -1, around / 2, { 0.5, 0.5, 0.0 } } });
  EXPECT_NEAR(path.Length, slant * std::sin(0.25 * angle), 1e-12);
  EXPECT_EQ(path.Triangles.size(), static_cast<std::size_t>(around / 2));
}

// Around a hole a path is tight: it turns at its corners, and slides along what bulges.
TEST(GeodesicPath, SlidesAlongTheBoundary)
{
  Shape s = Plate(20, 1.0);
  std::vector<std::array<Index, 3>> kept;
  for (Index t = 0; t < s.NumberOfTriangles(); ++t)
  {
    Eigen::RowVector3d middle = Eigen::RowVector3d::Zero();
    for (int a = 0; a < 3; ++a)
    {
      middle += s.Vertices.row(s.Faces(t, a)) / 3.0;
    }
    if (middle.norm() > 0.5)
    {
      kept.push_back({ s.Faces(t, 0), s.Faces(t, 1), s.Faces(t, 2) });
    }
  }
  s.Faces.resize(static_cast<Index>(kept.size()), 3);
  for (std::size_t t = 0; t < kept.size(); ++t)
  {
    s.Faces.row(static_cast<Index>(t)) << kept[t][0], kept[t][1], kept[t][2];
  }
  PathsOn on(s);
  const auto nearest = [&](double x, double y)
  {
    Index best = 0;
    (s.Vertices.rowwise() - Eigen::RowVector3d(x, y, 0.0)).rowwise().norm().minCoeff(&best);
    return best;
  };
  const Index from = nearest(-1.0, 0.0), to = nearest(1.0, 0.0);
  const PathsOn::Found path = on.Find(on.At(from), on.At(to));
  EXPECT_NEAR(path.Length, on.Distance(from, to), 1e-12);
  EXPECT_GE(path.Vertices, 3);
  ExpectStraight(path);
}

TEST(GeodesicPath, ToAPartThatIsNotConnectedIsNone)
{
  const Shape s = Joined(Icosphere(1), Moved(Icosphere(1), { 5.0, 0.0, 0.0 }));
  PathsOn on(s);
  const PathsOn::Found path = on.Find(on.At(0), on.At(s.NumberOfVertices() - 1));
  EXPECT_EQ(path.Length, Never);
  EXPECT_TRUE(path.Faces.empty());
  // and the next one is as if there had been none
  EXPECT_NEAR(on.Find(on.At(0), on.At(20)).Length, on.Distance(0, 20), 1e-12);
  SurfacePlace a{ "start", 0 }, b{ "end", s.NumberOfVertices() - 1 };
  try
  {
    ShortestPath(s.Vertices, s.Faces, { a, b });
    FAIL();
  }
  catch (const std::runtime_error& error)
  {
    const std::string text = error.what();
    EXPECT_NE(text.find("no path leads from start to end"), std::string::npos) << text;
    EXPECT_NE(text.find("MergeCoincidentPoints"), std::string::npos) << text;
  }
}

TEST(GeodesicPath, IsStoppedByAbort)
{
  const Shape s = Icosphere(4);
  const TriangleMesh mesh(s.Vertices, s.Faces);
  const EdgeFrames frames(mesh);
  GeodesicPath paths(mesh, frames);
  const ProgressMonitor::Callback stop = [](double) { return false; };
  EXPECT_THROW(paths.Find({ 0, { 1.0, 0.0, 0.0 } },
                 { mesh.NumberOfTriangles() - 1, { 0.0, 0.0, 1.0 } }, ProgressMonitor(stop)),
    Aborted);
}

} // namespace
