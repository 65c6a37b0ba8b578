// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Meshes.h"

#include <gtest/gtest.h>

#include <limits>
#include <set>

using namespace SurfaceDiffusion;
using namespace SurfaceDiffusion::Testing;

namespace
{

double SurfaceArea(const Surface& s)
{
  double area = 0.0;
  for (Index t = 0; t < s.NumberOfTriangles(); ++t)
  {
    const Eigen::RowVector3d p = s.Vertices.row(s.Faces(t, 0));
    area +=
      0.5 * (s.Vertices.row(s.Faces(t, 1)) - p).cross(s.Vertices.row(s.Faces(t, 2)) - p).norm();
  }
  return area;
}

class AnySurface : public ::testing::TestWithParam<std::pair<const char*, Surface>>
{
};

std::string NameOf(const ::testing::TestParamInfo<AnySurface::ParamType>& parameter)
{
  return parameter.param.first;
}

} // namespace

TEST_P(AnySurface, ControlCellsFillIt)
{
  const Surface& s = GetParam().second;
  const auto mesh = MakeMesh(s);
  const double unit = mesh->LengthUnit();
  EXPECT_NEAR(mesh->ControlAreas().sum() * unit * unit, SurfaceArea(s), 1e-13 * SurfaceArea(s));
  EXPECT_GT(mesh->ControlAreas().minCoeff(), 0.0);
}

TEST_P(AnySurface, ShapesKeepTheLengthsOfTheEdges)
{
  const Surface& s = GetParam().second;
  const auto mesh = MakeMesh(s);
  for (Index t = 0; t < mesh->NumberOfTriangles(); ++t)
  {
    const auto corner = [&](int a)
    { return s.Vertices.row(mesh->InputVertex()[mesh->TriangleVertices()(t, a)]); };
    const TriangleMesh::Shape shape = mesh->Shapes()[t];
    const double unit = mesh->LengthUnit();
    EXPECT_NEAR(shape.Length * unit, (corner(1) - corner(0)).norm(), 1e-14);
    EXPECT_NEAR(std::hypot(shape.X, shape.Y) * unit, (corner(2) - corner(0)).norm(), 1e-14);
    EXPECT_NEAR(
      std::hypot(shape.X - shape.Length, shape.Y) * unit, (corner(2) - corner(1)).norm(), 1e-14);
    EXPECT_GT(shape.Y, 0.0);
  }
}

TEST_P(AnySurface, RenumberingKeepsEveryTriangle)
{
  const Surface& s = GetParam().second;
  const auto mesh = MakeMesh(s);
  EXPECT_EQ(std::set<Index>(mesh->InputVertex().begin(), mesh->InputVertex().end()).size(),
    static_cast<std::size_t>(s.NumberOfVertices()));
  ASSERT_EQ(mesh->NumberOfTriangles(), s.NumberOfTriangles());
  std::set<Index> seen;
  for (Index t = 0; t < mesh->NumberOfTriangles(); ++t)
  {
    seen.insert(mesh->InputTriangle()[t]);
    for (int a = 0; a < 3; ++a)
    {
      EXPECT_EQ(
        mesh->InputVertex()[mesh->TriangleVertices()(t, a)], s.Faces(mesh->InputTriangle()[t], a));
    }
  }
  EXPECT_EQ(seen.size(), static_cast<std::size_t>(s.NumberOfTriangles()));
}

TEST_P(AnySurface, VertexCornersListEachCornerOnceAscending)
{
  const auto mesh = MakeMesh(GetParam().second);
  const auto& begin = mesh->VertexCornersBegin();
  EXPECT_EQ(begin.front(), 0);
  EXPECT_EQ(begin.back(), 3 * mesh->NumberOfTriangles());
  for (Index i = 0; i < mesh->NumberOfVertices(); ++i)
  {
    for (Index c = begin[i]; c < begin[i + 1]; ++c)
    {
      const Index corner = mesh->VertexCorners()[c];
      EXPECT_EQ(mesh->TriangleVertices()(corner / 3, corner % 3), i);
      EXPECT_TRUE(c == begin[i] || mesh->VertexCorners()[c - 1] < corner);
    }
  }
}

INSTANTIATE_TEST_SUITE_P(TriangleMesh, AnySurface,
  ::testing::Values(AnySurface::ParamType{ "Icosphere", Icosphere(3) },
    AnySurface::ParamType{ "Torus", Torus(20, 10) },
    AnySurface::ParamType{ "Tetrahedron", Tetrahedron() },
    AnySurface::ParamType{ "OneTriangle", Strip(1, 1, 2.0, 3.0) },
    AnySurface::ParamType{ "Disk", Disk(8) },
    AnySurface::ParamType{ "Cylinder", Rotated(Cylinder(20, 10)) },
    AnySurface::ParamType{ "Moebius", Moebius(31, 4) },
    AnySurface::ParamType{ "ThreeFins", ThreeFins(5) },
    AnySurface::ParamType{ "Jittered", Jittered(Strip(10, 10), 0.03, 0, 1, 0, 1) },
    AnySurface::ParamType{ "Several", Joined(Icosphere(1), Flipped(Disk(3))) }),
  NameOf);

TEST(TriangleMesh, CountsBoundaryAndNonManifoldEdges)
{
  const auto closed = MakeMesh(Torus(20, 10));
  EXPECT_EQ(closed->NumberOfVertices() - closed->NumberOfEdges() + closed->NumberOfTriangles(), 0);
  EXPECT_EQ(closed->Diagnostics().BoundaryEdges, 0);
  EXPECT_EQ(closed->Diagnostics().NonManifoldEdges, 0);

  const auto open = MakeMesh(Strip(7, 4));
  EXPECT_EQ(open->Diagnostics().BoundaryEdges, 2 * (7 + 4));

  const auto fins = MakeMesh(ThreeFins(5));
  EXPECT_EQ(fins->Diagnostics().NonManifoldEdges, 5);
  EXPECT_EQ(fins->Diagnostics().BoundaryEdges, 3 * 15);
  EXPECT_EQ(fins->NumberOfComponents(), 1);
}

TEST(TriangleMesh, MeanEdgeCountsSharedEdgesOnce)
{
  // Two right triangles on the square of side 3: four sides and one diagonal.
  const auto mesh = MakeMesh(Strip(1, 1, 3.0, 3.0));
  EXPECT_NEAR(mesh->LengthUnit() * MeanEdge(*mesh), (12.0 + 3.0 * std::sqrt(2.0)) / 5.0, 1e-14);
}

TEST(TriangleMesh, LeavesOutDegenerateTrianglesAndUnusedVertices)
{
  Surface s = Strip(4, 4);
  const Index n = s.NumberOfVertices();
  const Index m = s.NumberOfTriangles();
  Points vertices(n + 3, 3);
  vertices << s.Vertices, 9, 9, 9, 8, 8, 8, 7, 7, 7;
  Triangles faces(m + 4, 3);
  faces.topRows(m) = s.Faces;
  faces.row(m) << 0, 1, 2; // on one line
  faces.row(m + 1) << 5, 5, 6; // a corner twice
  faces.row(m + 2) << n, n, n; // a point
  faces.row(m + 3) << n, n + 1, n + 2; // on one line, of vertices used nowhere else
  const TriangleMesh mesh(vertices, faces);
  EXPECT_EQ(mesh.NumberOfTriangles(), m);
  EXPECT_EQ(mesh.NumberOfVertices(), n);
  EXPECT_EQ(mesh.Diagnostics().DegenerateTriangles, 4);
  EXPECT_EQ(mesh.Diagnostics().IsolatedVertices, 3);
  const double unit = mesh.LengthUnit();
  EXPECT_NEAR(mesh.ControlAreas().sum() * unit * unit, 1.0, 1e-13);
}

TEST(TriangleMesh, KeepsSliverTrianglesWithTheirArea)
{
  const double height = 1e-13;
  const auto mesh =
    MakeMesh(MakeSurface({ { 0, 0, 0 }, { 1, 0, 0 }, { 0.3, height, 0 } }, { { 0, 1, 2 } }));
  ASSERT_EQ(mesh->NumberOfTriangles(), 1);
  const double unit = mesh->LengthUnit();
  EXPECT_NEAR(mesh->ControlAreas().sum() * unit * unit, 0.5 * height, 1e-12 * height);
}

TEST(TriangleMesh, IsEmptyWithoutUsableTriangles)
{
  const TriangleMesh none(Points(0, 3), Triangles(0, 3));
  EXPECT_EQ(none.NumberOfVertices(), 0);
  EXPECT_EQ(none.NumberOfComponents(), 0);

  const TriangleMesh degenerate(Points(Points::Ones(3, 3)), Triangles(Triangles::Zero(2, 3)));
  EXPECT_EQ(degenerate.NumberOfVertices(), 0);
  EXPECT_EQ(degenerate.NumberOfTriangles(), 0);
  EXPECT_EQ(degenerate.Diagnostics().DegenerateTriangles, 2);
  EXPECT_EQ(degenerate.Diagnostics().IsolatedVertices, 3);
}

TEST(TriangleMesh, ComponentsHoldConsecutiveVertices)
{
  const Surface s = Joined(
    Joined(Icosphere(1), Moved(Disk(4), { 0, 0, 0.01 })), Moved(Icosphere(2), { 0.5, 0.0, 0.0 }));
  const auto mesh = MakeMesh(Renumbered(s, Permutation(s.NumberOfVertices(), 5)));
  ASSERT_EQ(mesh->NumberOfComponents(), 3);
  std::multiset<Index> sizes;
  std::vector<Index> component(mesh->NumberOfVertices());
  for (Index c = 0; c < 3; ++c)
  {
    sizes.insert(mesh->ComponentsBegin()[c + 1] - mesh->ComponentsBegin()[c]);
    std::fill(component.begin() + mesh->ComponentsBegin()[c],
      component.begin() + mesh->ComponentsBegin()[c + 1], c);
  }
  EXPECT_EQ(sizes, (std::multiset<Index>{ 42, 61, 162 }));
  for (Index t = 0; t < mesh->NumberOfTriangles(); ++t)
  {
    const auto corners = mesh->TriangleVertices().row(t);
    EXPECT_EQ(component[corners[0]], component[corners[1]]);
    EXPECT_EQ(component[corners[0]], component[corners[2]]);
  }
}

TEST(TriangleMesh, ScaleByAPowerOfTwoChangesTheUnitAlone)
{
  const Surface s = Icosphere(2);
  const auto mesh = MakeMesh(s);
  for (const int exponent : { -498, -30, 7, 498 }) // 1e-150 to 1e150
  {
    const auto scaled = MakeMesh(Scaled(s, std::ldexp(1.0, exponent)));
    EXPECT_EQ(scaled->LengthUnit(), std::ldexp(mesh->LengthUnit(), exponent));
    EXPECT_EQ(scaled->ControlAreas(), mesh->ControlAreas());
    EXPECT_EQ(scaled->TotalEdgeLength(), mesh->TotalEdgeLength());
    EXPECT_EQ(scaled->InputVertex(), mesh->InputVertex());
  }
}

TEST(TriangleMesh, TakesTheLargestAndSmallestCoordinates)
{
  // Up to the largest double, and denormal numbers of about a thousand steps.
  for (const double size : { 0.5 * std::numeric_limits<double>::max(), 1e-320 })
  {
    const auto mesh = MakeMesh(
      MakeSurface({ { -size, -size, 0 }, { size, -size, 0 }, { 0, size, 0 } }, { { 0, 1, 2 } }));
    ASSERT_EQ(mesh->NumberOfTriangles(), 1) << size;
    const TriangleMesh::Shape shape = mesh->Shapes()[0];
    EXPECT_NEAR(shape.Length * mesh->LengthUnit() / size, 2.0, 1e-2) << size;
    EXPECT_NEAR(shape.Y * mesh->LengthUnit() / size, 2.0, 1e-2) << size;
  }
  const double largest = std::numeric_limits<double>::max();
  const auto mesh = MakeMesh(MakeSurface(
    { { -largest, -largest, 0 }, { largest, -largest, 0 }, { 0, largest, 0 } }, { { 0, 1, 2 } }));
  EXPECT_EQ(mesh->NumberOfTriangles(), 1);
}

TEST(TriangleMesh, FarFromTheOriginLosesOnlyTheDigitsOfTheCoordinates)
{
  const Surface s = Icosphere(2);
  const auto far = MakeMesh(Moved(s, { 1e6, -1e6, 1e6 }));
  const double unit = far->LengthUnit();
  EXPECT_NEAR(far->ControlAreas().sum() * unit * unit, SurfaceArea(s), 1e-8);
}

TEST(TriangleMesh, UnusedVerticesDoNotChangeTheUnit)
{
  Surface s = Icosphere(1);
  const double unit = MakeMesh(s)->LengthUnit();
  s.Vertices.conservativeResize(s.NumberOfVertices() + 1, 3);
  s.Vertices.bottomRows(1) << 1e9, 0, 0;
  EXPECT_EQ(MakeMesh(s)->LengthUnit(), unit);
}

TEST(TriangleMesh, GatherVerticesPicksTheInputRows)
{
  const auto mesh = MakeMesh(Icosphere(1));
  Values input(mesh->NumberOfVertices(), 2);
  for (Index i = 0; i < mesh->NumberOfVertices(); ++i)
  {
    input.row(i) << i, -i;
  }
  const Values gathered = GatherVertices(*mesh, input);
  for (Index i = 0; i < mesh->NumberOfVertices(); ++i)
  {
    EXPECT_EQ(gathered(i, 0), mesh->InputVertex()[i]);
    EXPECT_EQ(gathered(i, 1), -mesh->InputVertex()[i]);
  }
}

TEST(TriangleMesh, StopsWhenAsked)
{
  const Surface s = Icosphere(2);
  const ProgressMonitor::Callback stop = [](double) { return false; };
  EXPECT_THROW(TriangleMesh(s.Vertices, s.Faces, SerialFor(), ProgressMonitor(stop)), Aborted);
}
