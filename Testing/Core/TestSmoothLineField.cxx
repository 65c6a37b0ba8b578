// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Foundation/SymmetricModes.h"
#include "Core/Geometry/SmoothLineField.h"
#include "Core/Surface/TangentVectors.h"
#include "Meshes.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>

using namespace SurfaceDiffusion;
using namespace SurfaceDiffusion::Testing;

namespace
{

struct Field
{
  std::shared_ptr<const TriangleMesh> Mesh;
  Points Vectors;
  double Eigenvalue; ///< in coordinate units
};

/// The smoothest field, started from the lines along `axis` (zero: from noise).
Field Smoothest(const Surface& s, const Eigen::RowVector3d& axis = Eigen::RowVector3d::Zero())
{
  Field field;
  field.Mesh = MakeMesh(s);
  const LineFieldOperator lines(field.Mesh);
  const Points along = axis.replicate(s.NumberOfTriangles(), 1);
  const TangentVectors start =
    TangentVectorsFromTriangleVectors(*field.Mesh, s.Vertices, s.Faces, along);
  const auto solver = MakeCholeskySolver();
  LineFieldReport report;
  const TangentVectors tangents = SmoothestLineField(lines, start,
    Vector::Ones(field.Mesh->NumberOfTriangles()), *solver, ProgressMonitor(), &report);
  field.Eigenvalue = report.Lambda / (field.Mesh->LengthUnit() * field.Mesh->LengthUnit());
  field.Vectors = VectorsInSpace(*field.Mesh, s.Vertices, s.Faces, tangents);
  return field;
}

/// Every third triangle with the opposite orientation.
Surface PartlyFlipped(Surface s)
{
  for (Index t = 0; t < s.NumberOfTriangles(); t += 3)
  {
    std::swap(s.Faces(t, 1), s.Faces(t, 2));
  }
  return s;
}

} // namespace

TEST(SmoothLineField, IsConstantOnFlatSurfaces)
{
  for (const Surface& s : { Strip(7, 5, 2.0), Jittered(Plate(8, 1.0), 0.1, -0.9, 0.9, -0.9, 0.9),
         PartlyFlipped(Disk(5)) })
  {
    const Field field = Smoothest(Rotated(s));
    EXPECT_LT(field.Eigenvalue, 1e-9);
    const Vector alike = (field.Vectors * field.Vectors.row(0).transpose()).cwiseAbs();
    EXPECT_GT(alike.minCoeff(), 1.0 - 1e-9);
  }
}

TEST(SmoothLineField, FollowsItsStartWhereAllDirectionsAreEquallySmooth)
{
  const Surface s = Cylinder(24, 12); // developable: every constant angle is as smooth as any
  const Field axial = Smoothest(s, { 0.0, 0.0, 1.0 });
  EXPECT_LT(axial.Eigenvalue, 1e-9);
  EXPECT_GT(axial.Vectors.col(2).cwiseAbs().minCoeff(), 1.0 - 1e-4);
}

TEST(SmoothLineField, SmallestEigenvalueOfTheUnitSphereIsTwo)
{
  // Lines are sections of spin weight 2: l (l + 1) - 2^2 with l >= 2.
  double coarser = 0.0;
  for (const int subdivisions : { 2, 3, 4 })
  {
    const double error = std::abs(Smoothest(Icosphere(subdivisions)).Eigenvalue - 2.0);
    std::printf("%d subdivisions: error of the eigenvalue %.2e\n", subdivisions, error);
    if (coarser > 0.0)
    {
      EXPECT_NEAR(ObservedOrder(coarser, error), 2.0, 0.3);
    }
    coarser = error;
  }
  EXPECT_NEAR(Smoothest(Icosphere(3, 5.0)).Eigenvalue, 2.0 / 25.0, 0.002);
}

TEST(SmoothLineField, IsTheEigenvectorOnEveryTriangle)
{
  Surface ellipsoid = Icosphere(2);
  ellipsoid.Vertices.col(1) *= 1.1;
  ellipsoid.Vertices.col(2) *= 1.3;
  Surface bumpy = Icosphere(2);
  for (Index i = 0; i < bumpy.NumberOfVertices(); ++i)
  {
    const Eigen::RowVector3d v = bumpy.Vertices.row(i);
    bumpy.Vertices.row(i) *=
      1.0 + 0.35 * std::sin(6.0 * v[0] + 1.0) * std::sin(4.0 * v[1]) * std::cos(3.0 * v[2]);
  }
  for (const Surface& s : { ellipsoid, bumpy })
  {
    const Field field = Smoothest(s, { 1.0, 1.0, 1.0 });
    const LineFieldOperator lines(field.Mesh);
    const Vector roots = lines.Mass().cwiseSqrt().cwiseInverse(); // the mass matrix is diagonal
    const SymmetricModes modes(
      roots.asDiagonal() * Eigen::MatrixXd(lines.Stiffness()) * roots.asDiagonal());
    // Two modes: all lines may be turned by the same angle.
    ASSERT_GT(modes.Eigenvalues[2], 1.05 * modes.Eigenvalues[1]);
    const Points along = Eigen::RowVector3d(1.0, 1.0, 1.0).replicate(s.NumberOfTriangles(), 1);
    Vector load, diagonal;
    lines.Project(TangentVectorsFromTriangleVectors(*field.Mesh, s.Vertices, s.Faces, along),
      Vector::Ones(s.NumberOfTriangles()), load, diagonal);
    const Eigen::MatrixXd lowest = roots.asDiagonal() * modes.Vectors.leftCols(2);
    const Points exact = VectorsInSpace(
      *field.Mesh, s.Vertices, s.Faces, lines.Lines(Vector(lowest * (lowest.transpose() * load))));
    for (Index t = 0; t < s.NumberOfTriangles(); ++t)
    {
      const double cosine =
        std::abs(exact.row(t).normalized().dot(field.Vectors.row(t).normalized()));
      EXPECT_GT(cosine, std::cos(0.01)) << t;
    }
  }
}

/// Lines in planes through an axis, on spheres of two meshes: five modes are equally smooth.
TEST(SmoothLineField, FollowsItsStartOnSpheresOfAnyMesh)
{
  const Eigen::RowVector3d axis(0.3, -0.5, 0.8);
  const Surface even = Icosphere(3);
  Surface uneven = Jittered(even, 0.03, -2.0, 2.0, -2.0, 2.0);
  uneven.Vertices.rowwise().normalize();
  const Points a = Smoothest(even, axis).Vectors;
  const Points b = Smoothest(uneven, axis).Vectors;
  int different = 0;
  for (Index t = 0; t < even.NumberOfTriangles(); ++t)
  {
    const double cosine = std::abs(a.row(t).normalized().dot(b.row(t).normalized()));
    different += cosine < std::cos(0.2) ? 1 : 0;
  }
  std::printf("%d of %d lines differ\n", different, even.NumberOfTriangles());
  EXPECT_LT(different, even.NumberOfTriangles() / 50); // at singularities
}

/// Small parts of scans have the accuracy of large ones.
TEST(SmoothLineField, SettlesOnComponentsOfAnySize)
{
  const Surface ball = Icosphere(3);
  for (const Surface& part : { Strip(3, 3), Tetrahedron(), Icosphere(1) })
  {
    for (const double size : { 1e-1, 1e-3, 1e-5 })
    {
      const Surface s = Joined(ball, Moved(Scaled(part, size), { 3.0, 0.0, 0.0 }));
      const auto mesh = MakeMesh(s);
      const auto solver = MakeCholeskySolver();
      LineFieldReport report;
      SmoothestLineField(LineFieldOperator(mesh), TangentVectors::Ones(s.NumberOfTriangles(), 2),
        Vector::Ones(s.NumberOfTriangles()), *solver, ProgressMonitor(), &report);
      EXPECT_EQ(report.UnsettledChange, 0.0) << size;
      EXPECT_EQ(report.MissedResidual, 0.0) << size;
    }
  }
}

TEST(SmoothLineField, OrientationDoesNotMatter)
{
  const Surface s = Icosphere(2);
  EXPECT_NEAR(Smoothest(PartlyFlipped(s)).Eigenvalue, Smoothest(s).Eigenvalue, 1e-3);
  const Surface flat = Strip(6, 6);
  const Points a = Smoothest(flat, { 1.0, 0.5, 0.0 }).Vectors;
  const Points b = Smoothest(PartlyFlipped(flat), { 1.0, 0.5, 0.0 }).Vectors;
  for (Index t = 0; t < flat.NumberOfTriangles(); ++t)
  {
    EXPECT_NEAR(std::abs(a.row(t).dot(b.row(t))), 1.0, 1e-9);
  }
}

TEST(SmoothLineField, AnySurfaceGetsUnitTangents)
{
  for (const Surface& s :
    { Moebius(40, 4), ThreeFins(4), Tetrahedron(), Joined(Torus(20, 12), Disk(4)) })
  {
    const Field field = Smoothest(s);
    for (Index t = 0; t < s.NumberOfTriangles(); ++t)
    {
      const Eigen::RowVector3d v = field.Vectors.row(t);
      const Eigen::RowVector3d e1 = s.Vertices.row(s.Faces(t, 1)) - s.Vertices.row(s.Faces(t, 0));
      const Eigen::RowVector3d e2 = s.Vertices.row(s.Faces(t, 2)) - s.Vertices.row(s.Faces(t, 0));
      EXPECT_NEAR(v.norm(), 1.0, 1e-12);
      EXPECT_NEAR(v.dot(e1.cross(e2)), 0.0, 1e-12);
    }
  }
}

TEST(SmoothLineField, HintsAreJoinedByAHarmonicField)
{
  // z = exp(2 i angle) is linear from 1 (angle 0) to i (45 degrees).
  const Surface s = Strip(40, 10, 4.0);
  const auto mesh = MakeMesh(s);
  Points hints = Points::Zero(s.NumberOfTriangles(), 3);
  const auto middle = [&](Index t)
  {
    return Eigen::RowVector3d((s.Vertices.row(s.Faces(t, 0)) + s.Vertices.row(s.Faces(t, 1)) +
                                s.Vertices.row(s.Faces(t, 2))) /
      3.0);
  };
  for (Index t = 0; t < s.NumberOfTriangles(); ++t)
  {
    if (middle(t)[0] < 0.1)
    {
      hints.row(t) << -2.0, 0.0, 0.0;
    }
    else if (middle(t)[0] > 3.9)
    {
      hints.row(t) << 1.0, 1.0, 0.0;
    }
  }
  const LineFieldOperator lines(mesh);
  const auto solver = MakeCholeskySolver();
  const TangentVectors tangents =
    LineFieldFromHints(lines, TangentVectorsFromTriangleVectors(*mesh, s.Vertices, s.Faces, hints),
      Vector::Constant(mesh->NumberOfTriangles(), 1e8), *solver);
  const Points vectors = VectorsInSpace(*mesh, s.Vertices, s.Faces, tangents);
  for (Index t = 0; t < s.NumberOfTriangles(); ++t)
  {
    const double x = std::clamp((middle(t)[0] - 0.1) / 3.8, 0.0, 1.0);
    const double angle = 0.5 * std::atan2(x, 1.0 - x);
    const Eigen::RowVector3d exact(std::cos(angle), std::sin(angle), 0.0);
    EXPECT_NEAR(std::abs(vectors.row(t).dot(exact)), 1.0, 1e-4);
  }
}

TEST(SmoothLineField, ComponentsWithoutHintsGetNone)
{
  const Surface s = Joined(Strip(4, 4), Moved(Strip(4, 4), { 3.0, 0.0, 0.0 }));
  const auto mesh = MakeMesh(s);
  Points hints = Points::Zero(s.NumberOfTriangles(), 3);
  hints.row(0) << 1.0, 2.0, 0.0;
  const LineFieldOperator lines(mesh);
  const auto solver = MakeCholeskySolver();
  const TangentVectors tangents =
    LineFieldFromHints(lines, TangentVectorsFromTriangleVectors(*mesh, s.Vertices, s.Faces, hints),
      Vector::Ones(mesh->NumberOfTriangles()), *solver);
  const Points vectors = VectorsInSpace(*mesh, s.Vertices, s.Faces, tangents);
  const Eigen::RowVector3d hint = Eigen::RowVector3d(1.0, 2.0, 0.0).normalized();
  for (Index t = 0; t < s.NumberOfTriangles(); ++t)
  {
    const double expected = t < s.NumberOfTriangles() / 2 ? 1.0 : 0.0;
    EXPECT_NEAR(std::abs(vectors.row(t).dot(hint)), expected, 1e-9);
  }
}
