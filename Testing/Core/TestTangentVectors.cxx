// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Surface/TangentVectors.h"
#include "Meshes.h"

#include <gtest/gtest.h>

#include <limits>

using namespace SurfaceDiffusion;
using namespace SurfaceDiffusion::Testing;

namespace
{

const double Infinity = std::numeric_limits<double>::infinity();
const double NotANumber = std::numeric_limits<double>::quiet_NaN();

/// The tangent vector of triangle t in space.
Eigen::RowVector3d InSpace(
  const TriangleMesh& mesh, const Surface& s, const TangentVectors& lines, Index t)
{
  const auto corner = [&](int a) -> Eigen::RowVector3d
  { return s.Vertices.row(mesh.InputVertex()[mesh.TriangleVertices()(t, a)]); };
  const Eigen::RowVector3d x = (corner(1) - corner(0)).normalized();
  const Eigen::RowVector3d e = corner(2) - corner(0);
  const Eigen::RowVector3d y = (e - e.dot(x) * x).normalized();
  return lines(t, 0) * x + lines(t, 1) * y;
}

/// Whether both hold the same lines: the sign of a tangent vector does not matter.
void ExpectSameLines(const TangentVectors& a, const TangentVectors& b)
{
  ASSERT_EQ(a.rows(), b.rows());
  for (Eigen::Index t = 0; t < a.rows(); ++t)
  {
    EXPECT_NEAR(std::abs(a.row(t).dot(b.row(t))), 1.0, 1e-14);
  }
}

Eigen::RowVector3d NormalOf(const Surface& s, Index t)
{
  const Eigen::RowVector3d p = s.Vertices.row(s.Faces(t, 0));
  return (s.Vertices.row(s.Faces(t, 1)) - p).cross(s.Vertices.row(s.Faces(t, 2)) - p).normalized();
}

} // namespace

TEST(TangentVectors, TriangleVectorsAreProjectedAndNormalised)
{
  const Surface s = Icosphere(2);
  const auto mesh = MakeMesh(s);
  const Eigen::RowVector3d d(0.2, -3.0, 1.0);
  const Points vectors = d.replicate(s.NumberOfTriangles(), 1);
  const TangentVectors lines =
    TangentVectorsFromTriangleVectors(*mesh, s.Vertices, s.Faces, vectors);
  for (Index t = 0; t < mesh->NumberOfTriangles(); ++t)
  {
    const Eigen::RowVector3d n = NormalOf(s, mesh->InputTriangle()[t]);
    const Eigen::RowVector3d expected = (d - d.dot(n) * n).normalized();
    EXPECT_NEAR(lines.row(t).norm(), 1.0, 1e-14);
    EXPECT_NEAR(std::abs(InSpace(*mesh, s, lines, t).dot(expected)), 1.0, 1e-12);
  }
}

TEST(TangentVectors, OppositePointVectorsAgree)
{
  const Surface s = Strip(4, 3);
  const auto mesh = MakeMesh(s);
  Points vectors(s.NumberOfVertices(), 3);
  for (Index i = 0; i < s.NumberOfVertices(); ++i)
  {
    vectors.row(i) = (i % 2 == 0 ? 1.0 : -0.1) * Eigen::RowVector3d(1.0, 2.0, 0.0);
  }
  const TangentVectors lines = TangentVectorsFromPointVectors(*mesh, s.Vertices, s.Faces, vectors);
  const Eigen::RowVector3d expected = Eigen::RowVector3d(1.0, 2.0, 0.0).normalized();
  for (Index t = 0; t < mesh->NumberOfTriangles(); ++t)
  {
    EXPECT_NEAR(std::abs(InSpace(*mesh, s, lines, t).dot(expected)), 1.0, 1e-14);
  }
}

TEST(TangentVectors, NormalZeroAndInfiniteVectorsGiveNoDirection)
{
  const Surface s = Strip(1, 3);
  const auto mesh = MakeMesh(s);
  Points vectors(6, 3);
  vectors << 0, 0, 0, NotANumber, 1, 0, Infinity, 0, 0, 0, 0, 5, 0, 0, -1e200, 1, 0, 0;
  const TangentVectors lines =
    TangentVectorsFromTriangleVectors(*mesh, s.Vertices, s.Faces, vectors);
  for (Index t = 0; t < 6; ++t)
  {
    EXPECT_NEAR(lines.row(t).norm(), mesh->InputTriangle()[t] == 5 ? 1.0 : 0.0, 1e-15);
  }
}

TEST(TangentVectors, PointVectorsInAllDirectionsGiveNone)
{
  const double h = 0.5 * std::sqrt(3.0);
  const Surface s = MakeSurface({ { 0, 0, 0 }, { 1, 0, 0 }, { 0.5, h, 0 } }, { { 0, 1, 2 } });
  const auto mesh = MakeMesh(s);
  Points vectors(3, 3);
  vectors << 1, 0, 0, -0.5, h, 0, -0.5, -h, 0;
  EXPECT_TRUE(TangentVectorsFromPointVectors(*mesh, s.Vertices, s.Faces, vectors).isZero(0.0));
}

TEST(TangentVectors, SizeOfTheVectorsAndOfTheSurfaceDoesNotMatter)
{
  const Surface s = Icosphere(1);
  const auto mesh = MakeMesh(s);
  const Points vectors = Eigen::RowVector3d(0.3, 0.1, -0.8).replicate(s.NumberOfTriangles(), 1);
  const TangentVectors lines =
    TangentVectorsFromTriangleVectors(*mesh, s.Vertices, s.Faces, vectors);
  for (const double size : { 1e-300, 1e-150, 1e150, 1e300 })
  {
    ExpectSameLines(
      TangentVectorsFromTriangleVectors(*mesh, s.Vertices, s.Faces, size * vectors), lines);
  }
  for (const int exponent : { -498, 498 }) // 1e-150, 1e150
  {
    const Surface scaled = Scaled(s, std::ldexp(1.0, exponent));
    ExpectSameLines(
      TangentVectorsFromTriangleVectors(*MakeMesh(scaled), scaled.Vertices, scaled.Faces, vectors),
      lines);
  }
}
