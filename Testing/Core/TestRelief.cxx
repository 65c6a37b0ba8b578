// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "BlockParts.h"
#include "ThreadedFor.h"

#include "Core/Geometry/Relief.h"
#include "Core/Geometry/SelfIntersections.h"
#include "Core/Surface/EdgeRefinement.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

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

TEST(Relief, HasTheSameBitsOnAnyNumberOfThreads)
{
  const Surface s = Refined(Bracket(), 0.05);
  const Vector heights = RoughHeights(s, -0.3, 0.3);
  const Relief serial = MakeRelief(s.Vertices, s.Faces, heights);
  const Relief threaded = MakeRelief(s.Vertices, s.Faces, heights, ThreadedFor(3));
  EXPECT_EQ(serial.Places, threaded.Places);
  EXPECT_EQ(serial.SmallestWall, threaded.SmallestWall);
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
