// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "BlockParts.h"
#include "Hubs.h"

#include "Core/Surface/EdgeRefinement.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <limits>
#include <string>
#include <tuple>

using namespace SurfaceDiffusion;
using namespace SurfaceDiffusion::Testing;

namespace
{

using Row3 = Eigen::RowVector3d;

constexpr Index NoLimit = std::numeric_limits<Index>::max();

struct Case
{
  const char* Name;
  Surface Given;
  double Length;
};

std::vector<Case> Cases()
{
  Surface twoCubes = BlockPart({ { 0, 0, 0 }, { 1, 1, 0 } }); // with one edge in common
  return { { "cube", Rotated(Cube(20.0)), 0.7 }, { "cylinder", ClosedCylinder(60, 5.0, 40.0), 0.6 },
    { "frame", Rotated(Frame(), 0.3), 0.05 }, { "bracket", Bracket(), 0.1 },
    { "edge of four triangles", Rotated(twoCubes), 0.07 }, { "fins", Rotated(ThreeFins(1)), 0.06 },
    { "all edges equal", Tetrahedron(), 0.2 },
    { "needle", MakeSurface({ { 0, 0, 0 }, { 100, 0, 0 }, { 37, 0.01, 0 } }, { { 0, 1, 2 } }),
      0.5 } };
}

int EulerCharacteristic(const Points& points, const Triangles& faces)
{
  return static_cast<int>(points.rows()) - static_cast<int>(EdgesOf(faces).size()) +
    static_cast<int>(faces.rows());
}

double SmallestAngle(const Row3& a, const Row3& b, const Row3& c)
{
  const auto angle = [](const Row3& at, const Row3& p, const Row3& q)
  { return std::atan2((p - at).cross(q - at).norm(), (p - at).dot(q - at)); };
  return std::min({ angle(a, b, c), angle(b, c, a), angle(c, a, b) });
}

double SmallestAngle(const Points& points, const Triangles& faces, Eigen::Index t)
{
  return SmallestAngle(points.row(faces(t, 0)), points.row(faces(t, 1)), points.row(faces(t, 2)));
}

/// The places of the triangles' corners, in an order of their own.
std::vector<std::array<std::array<double, 3>, 3>> SortedPlaces(const RefinedSurface& refined)
{
  std::vector<std::array<std::array<double, 3>, 3>> triangles;
  for (Eigen::Index t = 0; t < refined.Faces.rows(); ++t)
  {
    std::array<std::array<double, 3>, 3> corners{};
    for (int a = 0; a < 3; ++a)
    {
      const Row3 place = refined.Vertices.row(refined.Faces(t, a));
      corners[a] = { place[0], place[1], place[2] };
    }
    std::rotate(corners.begin(), std::min_element(corners.begin(), corners.end()), corners.end());
    triangles.push_back(corners);
  }
  std::sort(triangles.begin(), triangles.end());
  return triangles;
}

} // namespace

TEST(EdgeRefinement, NoEdgeIsLongerAndTheShapeStays)
{
  for (const Case& c : Cases())
  {
    SCOPED_TRACE(c.Name);
    const RefinedSurface refined = RefineEdges(c.Given.Vertices, c.Given.Faces, c.Length, NoLimit);
    EXPECT_FALSE(refined.LimitReached);
    EXPECT_LE(refined.LongestEdge, c.Length);
    double longest = 0.0;
    for (const auto& [edge, count] : EdgesOf(refined.Faces))
    {
      longest = std::max(
        longest, (refined.Vertices.row(edge.first) - refined.Vertices.row(edge.second)).norm());
    }
    EXPECT_NEAR(longest, refined.LongestEdge, 1e-14 * longest);
    // An edge is bisected because it is longer, so that none is shorter than it has to be.
    EXPECT_GT(refined.LongestEdge, 0.5 * c.Length);
    const double area = AreaOf(c.Given.Vertices, c.Given.Faces);
    EXPECT_NEAR(AreaOf(refined.Vertices, refined.Faces), area, 1e-14 * area);
    const double volume = VolumeOf(c.Given.Vertices, c.Given.Faces);
    const double scale = area * std::sqrt(area);
    EXPECT_NEAR(VolumeOf(refined.Vertices, refined.Faces), volume, 1e-14 * scale);
    EXPECT_EQ(EulerCharacteristic(c.Given.Vertices, c.Given.Faces),
      EulerCharacteristic(refined.Vertices, refined.Faces));
  }
}

TEST(EdgeRefinement, TrianglesLieInTheirsAndKeepHalfOfTheSmallestAngle)
{
  for (const Case& c : Cases())
  {
    SCOPED_TRACE(c.Name);
    const RefinedSurface refined = RefineEdges(c.Given.Vertices, c.Given.Faces, c.Length, NoLimit);
    std::vector<double> areas(c.Given.Faces.rows(), 0.0);
    ASSERT_EQ(refined.Faces.rows(), static_cast<Eigen::Index>(refined.InputTriangle.size()));
    const double size = c.Given.Vertices.cwiseAbs().maxCoeff();
    for (Eigen::Index t = 0; t < refined.Faces.rows(); ++t)
    {
      const Index from = refined.InputTriangle[t];
      EXPECT_GE(SmallestAngle(refined.Vertices, refined.Faces, t),
        0.5 * SmallestAngle(c.Given.Vertices, c.Given.Faces, from) * (1.0 - 1e-6));
      const auto normal = [](const Points& points, const Triangles& faces, Eigen::Index f)
      {
        const Row3 a = points.row(faces(f, 0));
        return Row3((Row3(points.row(faces(f, 1))) - a).cross(Row3(points.row(faces(f, 2))) - a));
      };
      const Row3 whole = normal(c.Given.Vertices, c.Given.Faces, from);
      const Row3 part = normal(refined.Vertices, refined.Faces, t);
      areas[from] += 0.5 * part.norm();
      EXPECT_GT(part.dot(whole), 0.0); // the orientation stays
      for (int a = 0; a < 3; ++a)
      {
        const Row3 place =
          refined.Vertices.row(refined.Faces(t, a)) - c.Given.Vertices.row(c.Given.Faces(from, 0));
        EXPECT_LE(std::abs(place.dot(whole.normalized())), 1e-14 * size);
      }
    }
    for (std::size_t f = 0; f < areas.size(); ++f)
    {
      const double area = AreaOf(c.Given.Vertices, c.Given.Faces.row(f));
      EXPECT_NEAR(areas[f], area, 1e-13 * area);
    }
  }
}

TEST(EdgeRefinement, EveryEdgeHasTheTrianglesOfTheEdgeThatItIsPartOf)
{
  // No crack and no vertex within an edge: an edge has as many triangles as before, within a
  // triangle two. Counts of edges with one, three and four triangles are those of the lengths.
  for (const Case& c : Cases())
  {
    SCOPED_TRACE(c.Name);
    std::map<int, double> before, after;
    for (const auto& [edge, count] : EdgesOf(c.Given.Faces))
    {
      before[count] +=
        (c.Given.Vertices.row(edge.first) - c.Given.Vertices.row(edge.second)).norm();
    }
    const RefinedSurface refined = RefineEdges(c.Given.Vertices, c.Given.Faces, c.Length, NoLimit);
    for (const auto& [edge, count] : EdgesOf(refined.Faces))
    {
      after[count] += (refined.Vertices.row(edge.first) - refined.Vertices.row(edge.second)).norm();
    }
    before.erase(2);
    after.erase(2);
    ASSERT_EQ(before.size(), after.size());
    for (const auto& [count, length] : before)
    {
      EXPECT_NEAR(after[count], length, 1e-13 * length) << "edges of " << count << " triangles";
    }
  }
}

TEST(EdgeRefinement, LinearDataAndOldVerticesAreKept)
{
  for (const Case& c : Cases())
  {
    SCOPED_TRACE(c.Name);
    const RefinedSurface refined = RefineEdges(c.Given.Vertices, c.Given.Faces, c.Length, NoLimit);
    EXPECT_EQ(c.Given.Vertices, refined.Vertices.topRows(c.Given.Vertices.rows()));
    const Values values = InterpolateAtVertices(refined, Values(c.Given.Vertices));
    EXPECT_EQ(Values(refined.Vertices), values);
  }
}

TEST(EdgeRefinement, NumberingDoesNotMatter)
{
  for (const Case& c : Cases())
  {
    SCOPED_TRACE(c.Name);
    const Surface other = Renumbered(c.Given, Permutation(c.Given.NumberOfVertices(), 5));
    const auto places =
      SortedPlaces(RefineEdges(c.Given.Vertices, c.Given.Faces, c.Length, NoLimit));
    EXPECT_EQ(places, SortedPlaces(RefineEdges(other.Vertices, other.Faces, c.Length, NoLimit)));
  }
}

TEST(EdgeRefinement, SizeOfCoordinatesDoesNotMatter)
{
  const Surface cube = Rotated(Cube());
  const RefinedSurface refined = RefineEdges(cube.Vertices, cube.Faces, 0.1, NoLimit);
  for (const int exponent : { -480, -30, 30, 480 })
  {
    const double factor = std::ldexp(1.0, exponent);
    const RefinedSurface scaled =
      RefineEdges(cube.Vertices * factor, cube.Faces, 0.1 * factor, NoLimit);
    EXPECT_EQ(refined.Faces, scaled.Faces) << exponent;
    EXPECT_EQ(Points(refined.Vertices * factor), scaled.Vertices) << exponent;
  }
}

TEST(EdgeRefinement, StopsAtTheLimitWithTheLongestEdgesDone)
{
  const Surface cube = Cube();
  const RefinedSurface refined = RefineEdges(cube.Vertices, cube.Faces, 1e-9, 5000);
  EXPECT_TRUE(refined.LimitReached);
  EXPECT_LE(refined.Faces.rows(), 5000);
  EXPECT_GT(refined.Faces.rows(), 4990);
  // 5000 halves of squares of side s have the area 6: the longest edge is below a diagonal of twice
  // this area.
  EXPECT_LE(refined.LongestEdge, std::sqrt(2.0 * 2.0 * 2.0 * 6.0 / 5000.0));
  const RefinedSurface untouched = RefineEdges(cube.Vertices, cube.Faces, 1e-9, 3);
  EXPECT_TRUE(untouched.LimitReached);
  EXPECT_EQ(cube.Faces, untouched.Faces);
  const RefinedSurface fine = RefineEdges(cube.Vertices, cube.Faces, 2.0, 3);
  EXPECT_FALSE(fine.LimitReached);
  EXPECT_EQ(cube.Faces, fine.Faces);
}

TEST(EdgeRefinement, OddTrianglesDoNoHarm)
{
  // A vertex twice, the same triangle twice, a triangle of no area, and a vertex without triangle
  const Surface odd =
    MakeSurface({ { 0, 0, 0 }, { 1, 0, 0 }, { 0, 1, 0 }, { 0.5, 0, 0 }, { 9, 9, 9 } },
      { { 0, 0, 1 }, { 0, 1, 2 }, { 0, 1, 2 }, { 0, 3, 1 } });
  const RefinedSurface refined = RefineEdges(odd.Vertices, odd.Faces, 0.1, NoLimit);
  EXPECT_LE(refined.LongestEdge, 0.1);
  EXPECT_EQ(0, std::count(refined.InputTriangle.begin(), refined.InputTriangle.end(), 0));
  EXPECT_NEAR(1.0, AreaOf(refined.Vertices, refined.Faces), 1e-14);
  // The same triangle twice stays the same twice: without it there are the same vertices.
  Triangles once(3, 3);
  once << odd.Faces.row(0), odd.Faces.row(1), odd.Faces.row(3);
  EXPECT_EQ(RefineEdges(odd.Vertices, once, 0.1, NoLimit).Vertices, refined.Vertices);
  const RefinedSurface none = RefineEdges(Points(0, 3), Triangles(0, 3), 0.1, NoLimit);
  EXPECT_EQ(0, none.Faces.rows());
  EXPECT_EQ(0.0, none.LongestEdge);
}

/// Each page is taken from the list of an edge of all, at a cost that does not grow with them.
TEST(EdgeRefinement, AnEdgeCanHaveTwentyThousandTriangles)
{
  const Surface book = TrianglesAtAnEdge(20000);
  const RefinedSurface refined = RefineEdges(book.Vertices, book.Faces, 0.4, NoLimit);
  EXPECT_LE(refined.LongestEdge, 0.4);
  EXPECT_EQ(refined.Faces.rows(), 24 * book.NumberOfTriangles());
  const double area = AreaOf(book.Vertices, book.Faces);
  EXPECT_NEAR(AreaOf(refined.Vertices, refined.Faces), area, 1e-10 * area);
}
