// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "BlockParts.h"

#include "Core/Geometry/Relief.h"
#include "Core/Geometry/SelfIntersections.h"
#include "Core/Geometry/TriangleStars.h"
#include "Core/Surface/EdgeRefinement.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <tuple>

using namespace SurfaceDiffusion;
using namespace SurfaceDiffusion::Testing;

namespace
{

using Row3 = Eigen::RowVector3d;

Surface Refined(const Surface& s, double length)
{
  const RefinedSurface refined = RefineEdges(s.Vertices, s.Faces, length, 1 << 22);
  return { refined.Vertices, refined.Faces };
}

/// A box from the origin.
Surface Box(double x, double y, double z)
{
  Surface s = Cube();
  s.Vertices.array().rowwise() *= Eigen::Array<double, 1, 3>(x, y, z);
  return s;
}

/// Uniform random heights from `low` to `high`: the roughest relief that the mesh has.
Vector RoughHeights(const Surface& s, double low, double high)
{
  Vector heights(s.NumberOfVertices());
  for (Index i = 0; i < s.NumberOfVertices(); ++i)
  {
    heights[i] = low + (high - low) * UniformRandom(3, 0, i);
  }
  return heights;
}

/// Waves of the given length, from 0 to 1.
Vector Waves(const Surface& s, double wavelength)
{
  const double k = 2.0 * Pi / wavelength;
  Vector waves(s.NumberOfVertices());
  for (Index i = 0; i < s.NumberOfVertices(); ++i)
  {
    const Row3 x = k * s.Vertices.row(i);
    waves[i] = 0.5 + (std::sin(x[0]) + std::sin(x[1]) + std::sin(x[2])) / 6.0;
  }
  return waves;
}

double Integral(const Surface& s, const Vector& heights)
{
  double integral = 0.0;
  for (Index t = 0; t < s.NumberOfTriangles(); ++t)
  {
    const auto f = s.Faces.row(t);
    integral +=
      AreaOf(s.Vertices, s.Faces.row(t)) * (heights[f[0]] + heights[f[1]] + heights[f[2]]) / 3.0;
  }
  return integral;
}

int CountOpenEdges(const Triangles& faces)
{
  int count = 0;
  for (const auto& [edge, triangles] : EdgesOf(faces))
  {
    count += triangles == 1;
  }
  return count;
}

} // namespace

TEST(Relief, OfConstantHeightOnABoxIsABox)
{
  const Surface box = Refined(Rotated(Box(20.0, 30.0, 10.0)), 1.5);
  for (const double height : { 1.0, 0.01 })
  {
    const Relief relief =
      MakeRelief(box.Vertices, box.Faces, Vector::Constant(box.NumberOfVertices(), height));
    const double volume = (20.0 + 2.0 * height) * (30.0 + 2.0 * height) * (10.0 + 2.0 * height);
    EXPECT_NEAR(VolumeOf(relief.Places, relief.Faces), volume, 1e-11 * volume);
    EXPECT_EQ(0, relief.LoweredVertices);
    EXPECT_EQ(0, relief.CrossingTriangles);
    EXPECT_EQ(0, relief.OpenEdges);
    EXPECT_NEAR(relief.SmallestWall, 10.0 + 2.0 * height, 1e-11);
  }
}

/// Merging leaves triangles of two points, as many as there were edges without length.
TEST(Relief, CollapsedTrianglesHaveNoEdges)
{
  const Surface box = Refined(Box(20.0, 30.0, 10.0), 3.0);
  Surface merged = box;
  merged.Faces.conservativeResize(merged.Faces.rows() + 20, 3);
  for (Index t = 0; t < 20; ++t)
  {
    merged.Faces.row(box.Faces.rows() + t) << box.Faces(7 * t, 0), box.Faces(7 * t, 1),
      box.Faces(7 * t, 0);
  }
  const Vector heights = Vector::Constant(box.NumberOfVertices(), 0.5);
  const Relief expected = MakeRelief(box.Vertices, box.Faces, heights);
  const Relief relief = MakeRelief(merged.Vertices, merged.Faces, heights);
  EXPECT_EQ(0, relief.NonManifoldEdges);
  EXPECT_EQ(0, relief.OpenEdges);
  EXPECT_EQ(0, relief.LoweredVertices);
  EXPECT_LT((relief.Places - expected.Places).cwiseAbs().maxCoeff(), 1e-12);
}

TEST(Relief, ChangesTheVolumeByItsIntegral)
{
  const std::vector<std::pair<const char*, Surface>> parts = { { "cube", Cube(40.0) },
    { "frame", Scaled(Frame(), 20.0) }, { "bracket", Scaled(Bracket(), 20.0) },
    { "cylinder", ClosedCylinder(120, 15.0, 40.0) } };
  for (const auto& [name, part] : parts)
  {
    SCOPED_TRACE(name);
    const Surface s = Refined(Rotated(part), 1.6);
    for (const double height : { 0.1, -0.1 })
    {
      const Relief relief = MakeRelief(s.Vertices, s.Faces, height * Waves(s, 16.0));
      const double change = VolumeOf(relief.Places, relief.Faces) - VolumeOf(s.Vertices, s.Faces);
      const double integral = Integral(s, relief.Heights);
      EXPECT_NEAR(change, integral, 0.01 * std::abs(integral)) << height;
      // Near inner edges of a height of 0.1, relief is lower: a part of the area.
      EXPECT_NEAR(integral, Integral(s, height * Waves(s, 16.0)), 0.05 * std::abs(integral));
      EXPECT_EQ(0, relief.CrossingTriangles);
      EXPECT_EQ(0, CountOpenEdges(relief.Faces));
    }
  }
}

TEST(Relief, OfATenthOfTheThicknessDoesNotCrossItself)
{
  const std::vector<std::pair<const char*, Surface>> parts = { { "plate", Box(10.0, 8.0, 2.0) },
    { "bracket", Scaled(Bracket(), 2.0) }, { "frame", Scaled(Frame(), 2.0) },
    { "cylinder", ClosedCylinder(60, 1.0, 8.0) } };
  for (const auto& [name, part] : parts)
  {
    SCOPED_TRACE(name);
    const Surface s = Refined(Rotated(part), 0.35);
    const Vector heights = RoughHeights(s, -0.2, 0.2);
    const Relief relief = MakeRelief(s.Vertices, s.Faces, heights);
    EXPECT_EQ(0, relief.CrossingTrianglesBefore);
    EXPECT_EQ(0, relief.CrossingTriangles);
    const auto crosses = FindSelfIntersections(relief.Places, relief.Faces);
    EXPECT_EQ(0, std::count(crosses.begin(), crosses.end(), 1));
    EXPECT_EQ(0, CountOpenEdges(relief.Faces));
    EXPECT_GT(relief.SmallestWall, 2.0 - 2.0 * 0.2 - 1e-9);
    for (Index i = 0; i < s.NumberOfVertices(); ++i)
    {
      EXPECT_LE(std::abs(relief.Heights[i]), std::abs(heights[i]));
    }
  }
}

TEST(Relief, IsWholeAwayFromEdgesOfAWall)
{
  const double thickness = 2.0;
  const Surface s = Refined(Box(20.0, 20.0, thickness), 0.4);
  const Vector heights = RoughHeights(s, -0.1 * thickness, 0.1 * thickness);
  const Relief relief = MakeRelief(s.Vertices, s.Faces, heights);
  for (Index i = 0; i < s.NumberOfVertices(); ++i)
  {
    const Row3 x = s.Vertices.row(i);
    if (std::min({ x[0], x[1], 20.0 - x[0], 20.0 - x[1] }) > 0.2 * thickness)
    {
      EXPECT_EQ(heights[i], relief.Heights[i]);
      const double side = x[2] > 0.5 * thickness ? 1.0 : -1.0;
      EXPECT_NEAR(0.0, (relief.Places.row(i) - x - heights[i] * Row3(0, 0, side)).norm(), 1e-12);
    }
  }
}

TEST(Relief, DeeperThanTheWallIsLoweredToAQuarter)
{
  const Surface s = Refined(Box(10.0, 10.0, 1.0), 0.3);
  const Relief relief =
    MakeRelief(s.Vertices, s.Faces, Vector::Constant(s.NumberOfVertices(), -0.8));
  EXPECT_GT(relief.LoweredVertices, 0);
  EXPECT_EQ(0, relief.CrossingTriangles);
  EXPECT_NEAR(relief.SmallestWall, 0.5, 1e-6);
  EXPECT_NEAR(relief.Heights.minCoeff(), -0.25, 1e-6);
}

TEST(Relief, FadesNearAnInnerEdge)
{
  // The inner edge of the bracket is x = y = 10. A ball that touches a leg at the distance s from
  // it touches the other leg, too, if its radius is s.
  const Surface s = Refined(Scaled(Bracket(), 10.0), 0.5);
  const Relief relief =
    MakeRelief(s.Vertices, s.Faces, Vector::Constant(s.NumberOfVertices(), 1.0));
  EXPECT_EQ(0, relief.CrossingTriangles);
  Index tested = 0;
  for (Index i = 0; i < s.NumberOfVertices(); ++i)
  {
    const Row3 x = s.Vertices.row(i);
    if (x[1] == 10.0 && x[0] > 10.0 && x[0] < 20.0 && x[2] > 2.0 && x[2] < 8.0)
    {
      EXPECT_NEAR(relief.Heights[i], std::min(1.0, 0.5 * (x[0] - 10.0)), 1e-5) << x;
      ++tested;
    }
  }
  EXPECT_GT(tested, 50);
}

TEST(Relief, RimsAndNonManifoldEdgesStay)
{
  for (const Surface& s : { Refined(Cylinder(20, 4), 0.2), Refined(ThreeFins(2), 0.2) })
  {
    const Relief relief =
      MakeRelief(s.Vertices, s.Faces, Vector::Constant(s.NumberOfVertices(), 0.05));
    Index pinned = 0;
    std::vector<char> isPinned(s.NumberOfVertices(), 0);
    for (const auto& [edge, triangles] : EdgesOf(s.Faces))
    {
      if (triangles != 2)
      {
        isPinned[edge.first] = isPinned[edge.second] = 1;
      }
    }
    for (Index i = 0; i < s.NumberOfVertices(); ++i)
    {
      const double moved = (relief.Places.row(i) - s.Vertices.row(i)).norm();
      EXPECT_TRUE(isPinned[i] ? moved == 0.0 : moved > 0.0) << i;
      pinned += isPinned[i];
    }
    EXPECT_GT(pinned, 0);
    EXPECT_EQ(CountOpenEdges(s.Faces), relief.OpenEdges);
  }
  const Surface fins = ThreeFins(2);
  EXPECT_EQ(2,
    MakeRelief(fins.Vertices, fins.Faces, Vector::Zero(fins.NumberOfVertices())).NonManifoldEdges);
}

TEST(Relief, GoesOutwardsWhateverTheOrientation)
{
  const Surface s = Refined(Rotated(Bracket()), 0.2);
  const Vector heights = 0.05 * Waves(s, 1.0);
  const Relief relief = MakeRelief(s.Vertices, s.Faces, heights);
  EXPECT_GT(VolumeOf(relief.Places, relief.Faces), 5.0);
  Surface mixed = Flipped(s);
  for (Index t = 0; t < mixed.NumberOfTriangles(); t += 3)
  {
    std::swap(mixed.Faces(t, 0), mixed.Faces(t, 1));
  }
  for (const Surface& other : { Flipped(s), mixed })
  {
    const Relief same = MakeRelief(other.Vertices, other.Faces, heights);
    EXPECT_LT((relief.Places - same.Places).cwiseAbs().maxCoeff(), 1e-13);
    EXPECT_GT(VolumeOf(same.Places, same.Faces), 5.0);
  }
}

TEST(Relief, WorksOnASurfaceThatCrossesItself)
{
  const Surface cube = Cube(2.0);
  const Surface s = Refined(Joined(cube, Moved(Rotated(cube, 0.4), { 0.9, 0.7, 0.8 })), 0.2);
  const Relief relief = MakeRelief(s.Vertices, s.Faces, 0.02 * Waves(s, 1.0));
  EXPECT_GT(relief.CrossingTrianglesBefore, 0);
  EXPECT_GT(relief.CrossingTriangles, 0);
  EXPECT_GT(VolumeOf(relief.Places, relief.Faces), VolumeOf(s.Vertices, s.Faces) + 0.2);
}

TEST(ReliefHeights, AreLinearOrOfTwoLevelsWithAFlank)
{
  const Surface s = Rotated(Strip(40, 8, 2.0, 0.4));
  const Surface flat = Strip(40, 8, 2.0, 0.4);
  const Vector values = 0.3 * flat.Vertices.col(0); // 0 to 0.6, the threshold 0.5 at x = 5/3
  ReliefProfile profile;
  profile.Height = -0.4;
  profile.Base = 0.1;
  const Vector smooth = ReliefHeights(s.Vertices, s.Faces, values, profile);
  profile.TwoLevels = true;
  profile.Flank = 0.5;
  const Vector sloped = ReliefHeights(s.Vertices, s.Faces, values, profile);
  profile.Flank = 0.0;
  const Vector stepped = ReliefHeights(s.Vertices, s.Faces, values, profile);
  for (Index i = 0; i < s.NumberOfVertices(); ++i)
  {
    const double distance = flat.Vertices(i, 0) - 5.0 / 3.0;
    EXPECT_NEAR(smooth[i], 0.1 - 0.4 * values[i], 1e-14);
    EXPECT_NEAR(sloped[i], 0.1 - 0.4 * std::clamp(0.5 + distance / 0.5, 0.0, 1.0), 1e-12);
    EXPECT_EQ(stepped[i], distance > 0.0 ? 0.1 - 0.4 : 0.1);
  }
}

TEST(SelfIntersections, AreFoundAndTouchingIsNone)
{
  // A needle through the middle of a triangle, and one that ends in it
  const auto pierced = [](double tip)
  {
    return Rotated(MakeSurface(
      { { 0, 0, 0 }, { 3, 0, 0 }, { 0, 3, 0 }, { 1, 1, tip }, { 1, 1, 1 }, { 1, 1.1, 1 } },
      { { 0, 1, 2 }, { 3, 4, 5 } }));
  };
  for (const double tip : { -1.0, -1e-6 })
  {
    const Surface s = pierced(tip);
    EXPECT_EQ(std::vector<char>({ 1, 1 }), FindSelfIntersections(s.Vertices, s.Faces)) << tip;
  }
  for (const double tip : { 0.0, 1e-15, 1e-6 })
  {
    const Surface s = pierced(tip);
    EXPECT_EQ(std::vector<char>({ 0, 0 }), FindSelfIntersections(s.Vertices, s.Faces)) << tip;
  }
  // Two cubes: apart, with a face at the same place, and one in the other
  const Surface cube = Refined(Cube(), 0.3);
  for (const double offset : { 1.5, 1.0, 0.5 })
  {
    const Surface two = Rotated(Joined(cube, Moved(cube, { offset, 0.05, 0.03 })));
    const auto crosses = FindSelfIntersections(two.Vertices, two.Faces);
    EXPECT_EQ(offset<1.0, std::count(crosses.begin(), crosses.end(), 1)> 0) << offset;
  }
  // A vertex that two triangles share, of which one passes through the other there
  const Surface fan = MakeSurface(
    { { 0, 0, 0 }, { 2, -1, 0 }, { 2, 1, 0 }, { 1, 0, -1 }, { 1, 0, 1 }, { 3, 0, 1 }, { 3, 0, 2 } },
    { { 0, 1, 2 }, { 0, 3, 4 }, { 0, 5, 6 } });
  EXPECT_EQ(std::vector<char>({ 1, 1, 0 }), FindSelfIntersections(fan.Vertices, fan.Faces));
}

namespace
{

/// A roof of two triangles with the ridge along x at `height`, its eaves `depth` below; the ends are
/// open.
Surface Roof(double height, double depth, double shift = 0.0)
{
  return MakeSurface({ { shift, 0, height }, { shift + 2, 0, height },
                       { shift + 1, 1, height - depth }, { shift + 1, -1, height - depth } },
    { { 0, 1, 2 }, { 1, 0, 3 } });
}

Index CountCrossing(const Surface& s)
{
  const auto crosses = FindSelfIntersections(s.Vertices, s.Faces);
  return static_cast<Index>(std::count(crosses.begin(), crosses.end(), 1));
}

} // namespace

TEST(SelfIntersections, AlongSidesOfTrianglesAreThoseWhereTheSurfacePassesThrough)
{
  const Surface ground = MakeSurface({ { -9, -9, 0 }, { 9, -9, 0 }, { 0, 9, 0 } }, { { 0, 1, 2 } });
  const Surface slope = MakeSurface(
    { { 0, 0, 0 }, { 2, 0, 0 }, { 1, 1, 1 }, { 1, -1, -1 } }, { { 0, 1, 2 }, { 1, 0, 3 } });
  const Surface wall = MakeSurface(
    { { -1, 0, 0 }, { 4, 0, 0 }, { 1, 0, 1 }, { 1, 0, -1 } }, { { 0, 1, 2 }, { 1, 0, 3 } });
  const std::vector<std::tuple<const char*, Surface, Index>> cases = {
    { "a ridge on the ground", Joined(ground, Roof(0.0, 1.0)), 0 },
    { "a valley on the ground", Joined(ground, Roof(0.0, -1.0)), 0 },
    { "a slope through the ground", Joined(ground, slope), 3 },
    { "its upper half on the ground", Joined(ground, { slope.Vertices, slope.Faces.topRows(1) }),
      0 },
    { "ridges in one line", Joined(Roof(0.0, 1.0), Roof(0.0, -1.0, 0.5)), 0 },
    { "a flatter ridge in a ridge", Joined(Roof(0.0, 1.0), Roof(0.0, 2.0, 0.5)), 0 },
    { "a ridge through a wall", Joined(wall, Roof(0.0, 1.0)), 4 },
    { "a slope through a wall", Joined(wall, slope), 4 },
    { "ridges in one line, apart", Joined(wall, Moved(slope, { 5.0, 0.0, 0.0 })), 0 },
  };
  for (const auto& [name, surface, count] : cases)
  {
    SCOPED_TRACE(name);
    for (const double angle : { 0.0, 0.7, 2.0 })
    {
      const Surface s = Moved(Scaled(Rotated(surface, angle), 10.0), { 3.0, -5.0, 1.0 });
      EXPECT_EQ(CountCrossing(s), count);
      EXPECT_EQ(CountCrossing(Flipped(s)), count);
      EXPECT_EQ(CountCrossing(Renumbered(s, Permutation(s.NumberOfVertices(), 3))), count);
    }
  }
}

TEST(SelfIntersections, AlongMeshLinesOfBothBodiesAreFound)
{
  const Surface cube = Refined(Cube(20.0), 5.1);
  for (const double angle : { 0.0, 0.7 })
  {
    const auto beside = [&](const Row3& offset)
    { return CountCrossing(Rotated(Joined(cube, Moved(cube, offset)), angle)); };
    EXPECT_GT(beside({ 10.0, 7.0, 5.0 }), 50);
    EXPECT_GT(beside({ 10.0, 5.0, 5.0 }), 50);
    EXPECT_EQ(beside({ 20.0, 5.0, 5.0 }), 0); // faces touch
    EXPECT_EQ(beside({ 20.0, 20.0, 5.0 }), 0); // edges touch
    EXPECT_EQ(beside({ 20.0, 20.0, 20.0 }), 0); // corners touch
    EXPECT_EQ(beside({ 21.0, 5.0, 5.0 }), 0);
  }
}

namespace
{

/// Slices of a cone around its tip with the given number of triangles: its rim is uneven.
Surface Cone(Index count)
{
  Surface s{ Points(count + 1, 3), Triangles(count, 3) };
  s.Vertices.row(count) << 0.0, 0.0, 1.0;
  for (Index i = 0; i < count; ++i)
  {
    const double angle = 2.0 * Pi * i / count;
    const double radius = 1.0 + 0.3 * UniformRandom(5, 0, i);
    s.Vertices.row(i) << radius * std::cos(angle), radius * std::sin(angle), 0.0;
    s.Faces.row(i) << i, (i + 1) % count, count;
  }
  return Rotated(s);
}

/// Pages of one triangle around an edge.
Surface Book(Index count)
{
  Surface s{ Points(count + 2, 3), Triangles(count, 3) };
  s.Vertices.row(count) << 0.0, 0.0, 0.0;
  s.Vertices.row(count + 1) << 0.0, 0.0, 1.0;
  for (Index i = 0; i < count; ++i)
  {
    const double angle = 2.0 * Pi * i / count;
    s.Vertices.row(i) << std::cos(angle), std::sin(angle), 0.5;
    s.Faces.row(i) << count, count + 1, i;
  }
  return Rotated(s);
}

/// Calls VisitMeeting() for triangle t. see(box): called for each box that is looked at.
template <typename See, typename Visitor>
void VisitMeeting(
  const TriangleStars& stars, const Surface& s, Index t, const See& see, const Visitor& visit)
{
  TriangleStars::Box box;
  Slabs::Corners corners;
  for (std::size_t a = 0; a < 3; ++a)
  {
    corners[a] = s.Vertices.row(s.Faces(t, static_cast<int>(a))).transpose();
    box.extend(corners[a]);
  }
  const auto enters = [&](const TriangleStars::Box& other)
  {
    see(other);
    return box.intersects(other);
  };
  stars.VisitMeeting(t, corners, enters, visit);
}

/// Two cones, the second one turned by the angle, with its tip moved.
Surface TwoCones(Index count, double angle, const Row3& tip)
{
  const Surface cone = Cone(count);
  Surface turned = Rotated(cone, angle);
  const Row3 move = cone.Vertices.row(count) + tip - turned.Vertices.row(count);
  return Joined(cone, Moved(turned, move));
}

/// The tips on both sides of one rim, which has two vertices at each place.
Surface TwoConesAtARim(Index count)
{
  Surface other = Cone(count);
  const Row3 middle = other.Vertices.topRows(count).colwise().mean();
  other.Vertices.row(count) = 2.0 * middle - other.Vertices.row(count);
  return Joined(Cone(count), other);
}

} // namespace

TEST(TriangleStars, LeaveFewPairsOfTrianglesAroundVerticesOrAnEdge)
{
  const Index count = 5000;
  const Index few = 1250; // uneven rims are near to many others
  for (const Surface& s :
    { Cone(count), Book(count), Joined(Cone(count), Moved(Book(count), { 9, 9, 9 })),
      TwoConesAtARim(few), TwoCones(few, 0.0, { 0, 0, 0 }), TwoCones(few, 0.6, { 0, 0, 0 }),
      TwoCones(few, 0.6, { 0.01, 0.02, 0 }), TwoCones(few, 0.6, { 0.3, 0.1, -0.2 }),
      Joined(Cone(few), Rotated(Moved(Plate(25, 1.0), { 0, 0, 0.5 }))) })
  {
    const TriangleStars stars(s.Vertices, s.Faces);
    Index pairs = 0;
    Index all = 0;
    for (Index t = 0; t < s.NumberOfTriangles(); ++t)
    {
      VisitMeeting(
        stars, s, t, [](const TriangleStars::Box&) {}, [&](Index) { ++pairs; });
    }
    stars.Visit([](const TriangleStars::Box&) { return true; }, [&](Index) { ++all; });
    EXPECT_EQ(all, s.NumberOfTriangles());
    EXPECT_LT(pairs, 100 * s.NumberOfTriangles());
  }
}

TEST(TriangleStars, AreNotAllVisitedForEachTriangle)
{
  const Index size = 130;
  Surface s = Cone(size);
  for (double offset = 3.0; offset < 500.0; offset *= 2.0)
  {
    s = Joined(s, Moved(s, { offset, 0.0, 0.0 }));
  }
  const Index count = s.NumberOfTriangles() / size;
  EXPECT_EQ(count, 256);
  const TriangleStars stars(s.Vertices, s.Faces);
  Index boxes = 0;
  for (Index t = 0; t < s.NumberOfTriangles(); t += size)
  {
    VisitMeeting(
      stars, s, t, [&](const TriangleStars::Box&) { ++boxes; }, [](Index) {});
  }
  EXPECT_LT(boxes, 50 * count);
}

/// The star of a vertex with folds, and two of them: the same triangles cross in stars that are
/// large and in pairs of triangles that are none.
TEST(TriangleStars, HaveAllTrianglesThatCross)
{
  const Index count = 300;
  Surface folded = Cone(count);
  for (Index i = 0; i < count; i += 10) // the slice beside it is folded over its neighbours
  {
    folded.Vertices.row(i) = folded.Vertices.row((i + 17) % count) * 1.01 + Row3(0.01, 0.02, 0.015);
  }
  const Index half = 150;
  for (const Surface& s :
    { folded, TwoCones(half, 0.6, { 0.01, 0.02, 0 }), TwoCones(half, 0.6, { 0.3, 0.1, -0.2 }),
      Joined(Cone(half), Rotated(Moved(Plate(8, 1.0), { 0, 0, 0.5 }))) })
  {
    const auto crosses = FindSelfIntersections(s.Vertices, s.Faces);
    Index found = 0;
    Surface two{ s.Vertices, Triangles(2, 3) };
    for (Index t = 0; t < s.NumberOfTriangles(); ++t)
    {
      bool any = false;
      for (Index u = 0; u < s.NumberOfTriangles() && !any; ++u)
      {
        two.Faces.row(0) = s.Faces.row(t);
        two.Faces.row(1) = s.Faces.row(u);
        any = u != t && FindSelfIntersections(two.Vertices, two.Faces)[0];
      }
      EXPECT_EQ(static_cast<bool>(crosses[t]), any) << t;
      found += any;
    }
    EXPECT_GT(found, 30);
  }
}

TEST(Relief, RepeatedTrianglesCountOnce)
{
  const Surface box = Refined(Box(20.0, 30.0, 10.0), 3.0);
  Surface twice = Joined(box, box);
  twice.Faces.bottomRows(box.Faces.rows()) = box.Faces;
  for (Index t = 0; t < box.NumberOfTriangles(); t += 3) // opposite ones
  {
    std::swap(
      twice.Faces(box.NumberOfTriangles() + t, 0), twice.Faces(box.NumberOfTriangles() + t, 2));
  }
  twice.Vertices = box.Vertices;
  const Vector heights = Vector::Constant(box.NumberOfVertices(), 0.5);
  const Relief expected = MakeRelief(box.Vertices, box.Faces, heights);
  const Relief relief = MakeRelief(twice.Vertices, twice.Faces, heights);
  EXPECT_EQ(expected.RepeatedTriangles, 0);
  EXPECT_EQ(relief.RepeatedTriangles, box.NumberOfTriangles());
  EXPECT_EQ(relief.NonManifoldEdges, 0);
  EXPECT_EQ(relief.OpenEdges, 0);
  EXPECT_EQ(relief.Places, expected.Places);
  EXPECT_EQ(relief.VolumeChange, expected.VolumeChange);
  EXPECT_EQ(relief.Faces.rows(), 2 * box.NumberOfTriangles());
  EXPECT_NEAR(
    VolumeOf(relief.Places, relief.Faces), 2.0 * VolumeOf(expected.Places, expected.Faces), 1e-8);
}
