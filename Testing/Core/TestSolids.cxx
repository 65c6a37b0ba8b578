// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "BlockParts.h"

#include "Core/Geometry/Bodies.h"
#include "Core/Geometry/OpenEdges.h"
#include "Core/Geometry/ReliefSolids.h"
#include "Core/Geometry/Welding.h"
#include "Core/Surface/EdgeRefinement.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

using namespace SurfaceDiffusion;
using namespace SurfaceDiffusion::Testing;

namespace
{

/// A cube of this side around the center, with normals inwards if `turned`.
Surface CubeAt(double side, const Eigen::RowVector3d& center, bool turned = false)
{
  Surface s = Cube();
  const Eigen::RowVector3d middle =
    0.5 * (s.Vertices.colwise().maxCoeff() + s.Vertices.colwise().minCoeff());
  s.Vertices = (side * (s.Vertices.rowwise() - middle)).rowwise() + center;
  TurnOutwards(s.Vertices, s.Faces);
  if (turned)
  {
    s.Faces.col(1).swap(s.Faces.col(2));
  }
  return s;
}

Surface Both(const Surface& a, const Surface& b)
{
  Surface both;
  both.Vertices.resize(a.Vertices.rows() + b.Vertices.rows(), 3);
  both.Vertices << a.Vertices, b.Vertices;
  both.Faces.resize(a.Faces.rows() + b.Faces.rows(), 3);
  both.Faces << a.Faces, (b.Faces.array() + static_cast<Index>(a.Vertices.rows())).matrix();
  return both;
}

const Eigen::RowVector3d Origin(0.0, 0.0, 0.0);

} // namespace

TEST(Solids, CavitiesBelongToTheirBodiesWhateverTheOrderOfShells)
{
  for (const Surface& s : { Both(CubeAt(4, Origin), CubeAt(2, Origin, true)),
         Both(CubeAt(2, Origin, true), CubeAt(4, Origin)) })
  {
    const Bodies found = FindBodies(s.Vertices, s.Faces);
    ASSERT_EQ(found.Table.size(), 1U);
    EXPECT_NEAR(found.Table[0].Volume, 64.0 - 8.0, 1e-12);
    EXPECT_NEAR(found.Table[0].Area, 96.0 + 24.0, 1e-12);
    EXPECT_TRUE(found.Table[0].IsClosed);
    EXPECT_EQ(found.Overlaps, 0);
  }
}

TEST(Solids, ShellsInsideOutAreTurnedWithTheirCavities)
{
  const Surface wanted = Both(Both(CubeAt(4, Origin), CubeAt(2, Origin, true)), CubeAt(1, Origin));
  Surface s = wanted;
  s.Faces.col(1).swap(s.Faces.col(2));
  s = Both(s, CubeAt(4, { 9.0, 0.0, 0.0 }));
  TurnOutwards(s.Vertices, s.Faces);
  const Bodies found = FindBodies(s.Vertices, s.Faces);
  ASSERT_EQ(found.Table.size(), 3U);
  EXPECT_NEAR(found.Table[0].Volume, 56.0, 1e-12);
  EXPECT_NEAR(found.Table[1].Volume, 1.0, 1e-12);
  EXPECT_NEAR(found.Table[2].Volume, 64.0, 1e-12);
  EXPECT_EQ(found.Edges.Misoriented, 0);
}

TEST(Solids, BarsThatCrossWithoutAVertexInOneAnotherOverlap)
{
  Surface bar = CubeAt(1, Origin);
  bar.Vertices.col(0) *= 10.0;
  Surface other = CubeAt(1, { 0.0, 0.0, 0.25 });
  other.Vertices.col(1) *= 10.0;
  const Surface s = Both(bar, other);
  EXPECT_EQ(FindBodies(s.Vertices, s.Faces).Overlaps, 1);
  Surface apart = s;
  apart.Vertices.bottomRows(other.Vertices.rows()).col(2).array() += 0.75; // they touch
  EXPECT_EQ(FindBodies(apart.Vertices, apart.Faces).Overlaps, 0);
}

TEST(Solids, NoTriangleLosesACornerByJoining)
{
  Points points(5, 3);
  points << 0, 0, 0, 1, 0, 0, 1, 1e-6, 0, 0, 1e-6, 0, 0, 1, 0;
  Triangles faces(3, 3);
  faces << 0, 1, 2, 0, 2, 3, 3, 2, 4;
  const std::vector<Index> joined = JoinOpenEdges(points, faces, 1e-5);
  for (Index i = 0; i < 5; ++i)
  {
    EXPECT_EQ(joined[i], i);
  }
  EXPECT_EQ(WeldSurface(points, faces, 1e-5).Faces.rows(), 3);
}

TEST(Solids, AnEdgeIsSplitAtAllVerticesOnIt)
{
  // Three triangles beside one long edge.
  Points points(7, 3);
  points << 0, 0, 0, 3, 0, 0, 1, 2, 0, 1, 1e-7, 0, 2, -1e-7, 0, 0, -1, 0, 3, -1, 0;
  Triangles faces(4, 3);
  faces << 0, 1, 2, 0, 5, 3, 3, 5, 4, 4, 6, 1;
  const WeldedSurface welded = WeldSurface(points, faces, 1e-5);
  EXPECT_EQ(welded.Split, 2);
  EXPECT_EQ(welded.Faces.rows(), 6);
  EXPECT_EQ(FindEdgeDefects(welded.Faces, 7).NonManifold, 0);
  EXPECT_EQ(FindEdgeDefects(welded.Faces, 7).Open, 6);
  EXPECT_EQ(WeldSurface(points, faces, 0.0).Split, 0);
}

TEST(Solids, PartAndPatternAreClosedAndAddUpToTheRelief)
{
  const Surface cube = CubeAt(4, Origin);
  const RefinedSurface fine = RefineEdges(cube.Vertices, cube.Faces, 0.4, 1 << 20);
  const auto n = static_cast<Index>(fine.Vertices.rows());
  Points after = fine.Vertices;
  Vector levels(n);
  for (Index i = 0; i < n; ++i)
  {
    const Eigen::RowVector3d x = fine.Vertices.row(i);
    levels[i] = std::sin(3.0 * x[0]) + std::sin(3.0 * x[1] + 1.0) + std::sin(3.0 * x[2] + 2.0);
    after.row(i) *= 1.0 + 0.02 * std::max(0.0, levels[i] + 1.0); // some do not move
  }
  const ReliefSolids solids = DivideRelief(fine.Vertices, after, fine.Faces, levels);
  double sum = 0.0;
  for (const char isRaised : { 0, 1 })
  {
    std::vector<Index> rows;
    for (Index t = 0; t < static_cast<Index>(solids.Faces.rows()); ++t)
    {
      if (solids.IsRaised[t] == isRaised)
      {
        rows.push_back(t);
      }
    }
    const Triangles faces = solids.Faces(rows, Eigen::all);
    const Bodies found = FindBodies(solids.Places, faces);
    EXPECT_EQ(found.Edges.Open, 0);
    EXPECT_EQ(found.Edges.NonManifold, 0);
    EXPECT_EQ(found.Edges.Misoriented, 0);
    for (const Body& body : found.Table)
    {
      EXPECT_GT(body.Volume, 0.0);
      sum += body.Volume;
    }
    EXPECT_GT(found.Table.size(), isRaised ? 1U : 0U);
  }
  const double whole = FindBodies(after, fine.Faces).Table[0].Volume;
  EXPECT_NEAR(sum / whole, 1.0, 1e-12);
}
