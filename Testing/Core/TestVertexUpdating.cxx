// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "BlockParts.h"
#include "Core/Geometry/VertexUpdating.h"
#include "HarmonicMaps.h"

#include <gtest/gtest.h>

#include <cstdio>

using namespace SurfaceDiffusion;
using namespace SurfaceDiffusion::Testing;

namespace
{

Eigen::RowVector3d FaceNormal(const Surface& s, Index t)
{
  const Eigen::RowVector3d a = s.Vertices.row(s.Faces(t, 0));
  const Eigen::RowVector3d b = s.Vertices.row(s.Faces(t, 1));
  const Eigen::RowVector3d c = s.Vertices.row(s.Faces(t, 2));
  return (b - a).cross(c - a).normalized();
}

/// Mean angle, in degrees, between the triangles of two surfaces.
double MeanAngle(const Surface& a, const Surface& b)
{
  double sum = 0.0;
  for (Index t = 0; t < a.NumberOfTriangles(); ++t)
  {
    sum += std::acos(std::min(1.0, FaceNormal(a, t).dot(FaceNormal(b, t))));
  }
  return sum / a.NumberOfTriangles() * 180.0 / Pi;
}

Surface Noisy(Surface s, double amount)
{
  for (Index i = 0; i < s.NumberOfVertices(); ++i)
  {
    for (int k = 0; k < 3; ++k)
    {
      s.Vertices(i, k) += amount * (2.0 * UniformRandom(5, k, i) - 1.0);
    }
  }
  return s;
}

/// The means of the normals around the vertices.
Values VertexNormals(const TriangleMesh& mesh, const Surface& s)
{
  Values normals = Values::Zero(mesh.NumberOfVertices(), 3);
  for (Index t = 0; t < mesh.NumberOfTriangles(); ++t)
  {
    for (int a = 0; a < 3; ++a)
    {
      normals.row(mesh.TriangleVertices()(t, a)) += FaceNormal(s, mesh.InputTriangle()[t]);
    }
  }
  normals.rowwise().normalize();
  return normals;
}

/// No vectors before: the triangles turn to those after.
PointData Unknown(Index count)
{
  PointData before = PointData::FromValues(Values::Zero(count, 3));
  before.Missing.setConstant(true);
  return before;
}

} // namespace

TEST(VertexUpdating, NoisyPlaneWithExactNormalsBecomesFlat)
{
  const Surface flat = Rotated(Strip(20, 20));
  const Surface s = Noisy(flat, 0.01);
  const TriangleMesh mesh(s.Vertices, s.Faces);
  Values normals(mesh.NumberOfVertices(), 3);
  normals.rowwise() = FaceNormal(flat, 0);
  VertexMotion motion;
  Surface fitted = s;
  fitted.Vertices = UpdateVerticesFromNormals(
    mesh, s.Vertices, Unknown(mesh.NumberOfVertices()), normals, 10.0, motion);
  EXPECT_GT(MeanAngle(s, flat), 5.0);
  EXPECT_LT(MeanAngle(fitted, flat), 1e-2);
  // No vertex moves along the plane, and the mean plane stays.
  const Points moved = fitted.Vertices - s.Vertices;
  const Eigen::Vector3d normal = normals.row(0).transpose();
  EXPECT_LT((moved - (moved * normal) * normal.transpose()).cwiseAbs().maxCoeff(), 1e-11);
  EXPECT_LT(motion.MaximumDisplacement, 0.05);
  EXPECT_EQ(motion.VolumeBefore, 0.0); // open
}

/// A noisy strip whose points follow normals that it does not have: many iterations.
struct TiltedStrip
{
  const Surface Noise = Noisy(Strip(20, 20), 0.01);
  const TriangleMesh Mesh{ Noise.Vertices, Noise.Faces };

  Points Update(VertexMotion& motion, const IterationLimits& limits = IterationLimits(),
    bool factorize = true) const
  {
    Values normals(this->Mesh.NumberOfVertices(), 3);
    normals.rowwise() = Eigen::RowVector3d(0.0, 0.6, 0.8);
    return UpdateVerticesFromNormals(this->Mesh, this->Noise.Vertices,
      Unknown(this->Mesh.NumberOfVertices()), normals, 10.0, motion, limits, factorize);
  }
};

TEST(VertexUpdating, ReportsThatItDidNotConverge)
{
  const TiltedStrip strip;
  VertexMotion motion;
  EXPECT_THROW(strip.Update(motion, { 1e-12, 2 }, false), NotConverged);
}

TEST(VertexUpdating, FactorisesIfConjugateGradientsDoNotConverge)
{
  const TiltedStrip strip;
  VertexMotion motion;
  const Points iterated = strip.Update(motion);
  EXPECT_EQ(motion.MissedResidual, 0.0);
  const Points factorised = strip.Update(motion, { 1e-10, 2 });
  EXPECT_EQ(motion.MissedResidual, 0.0);
  EXPECT_LT((factorised - iterated).cwiseAbs().maxCoeff(), 1e-7);
}

TEST(VertexUpdating, TakesAnAnswerWithinTenTimesTheTolerance)
{
  const TiltedStrip strip;
  VertexMotion motion;
  // The first number of iterations after which the residual is near enough.
  double missed = 0.0;
  for (int iterations = 2; missed == 0.0 && iterations < 500; ++iterations)
  {
    try
    {
      strip.Update(motion, { 1e-8, iterations }, false);
      missed = motion.MissedResidual;
      ASSERT_GT(missed, 0.0) << "it converged before an answer was taken";
    }
    catch (const NotConverged&)
    {
      continue;
    }
  }
  EXPECT_GT(missed, 1e-8);
  EXPECT_LE(missed, 1e-7);
}

TEST(VertexUpdating, NoisySphereIsSmoothedAtConstantVolume)
{
  const Surface clean = Icosphere(4);
  const Surface s = Noisy(clean, 0.02);
  const TriangleMesh mesh(s.Vertices, s.Faces);
  const Values normals = SampleUnit(mesh, clean, 3, [](const Eigen::RowVector3d& x) { return x; });
  VertexMotion motion;
  Surface fitted = s;
  fitted.Vertices = UpdateVerticesFromNormals(mesh, s.Vertices, Unknown(mesh.NumberOfVertices()),
    normals, 5.0 * MeanEdge(mesh) * mesh.LengthUnit(), motion);
  std::printf("angle %.2f -> %.2f degrees, volume %.4f -> %.4f, moved %.4f (mean), %.4f (most)\n",
    MeanAngle(s, clean), MeanAngle(fitted, clean), motion.VolumeBefore, motion.VolumeAfter,
    motion.MeanDisplacement, motion.MaximumDisplacement);
  EXPECT_LT(MeanAngle(fitted, clean), 0.15 * MeanAngle(s, clean));
  EXPECT_NEAR(motion.VolumeBefore, 4.0 / 3.0 * Pi, 0.03);
  EXPECT_NEAR(motion.VolumeAfter / motion.VolumeBefore, 1.0, 1e-3);
  EXPECT_LT(motion.MeanDisplacement, motion.MaximumDisplacement);
  EXPECT_LT(motion.MaximumDisplacement, 0.06);
  double largest = 0.0;
  for (Index i = 0; i < s.NumberOfVertices(); ++i)
  {
    largest = std::max(largest, (fitted.Vertices.row(i) - s.Vertices.row(i)).norm());
  }
  EXPECT_NEAR(motion.MaximumDisplacement, largest, 1e-15);
}

/// Shapes whose corners have normals that are far apart.
TEST(VertexUpdating, VectorsThatHaveNotChangedMoveNothing)
{
  for (const Surface& shape : { Tetrahedron(), Icosphere(0), Cube(), Bracket(), Frame(), Disk(1),
         ThreeFins(2), Moebius(5, 1), Noisy(Icosphere(2), 0.1) })
  {
    const Surface s = Scaled(Rotated(shape), 1e3);
    const TriangleMesh mesh(s.Vertices, s.Faces);
    Values normals = VertexNormals(mesh, s);
    const PointData before = PointData::FromValues(normals);
    VertexMotion motion;
    EXPECT_EQ(
      UpdateVerticesFromNormals(mesh, s.Vertices, before, normals, 1e3, motion), s.Vertices);
    EXPECT_EQ(motion.MaximumDisplacement, 0.0);
    // Signs that differ are those of lines: points move by round-off only.
    normals.row(0) *= -1.0;
    UpdateVerticesFromNormals(mesh, s.Vertices, before, normals, 1e3, motion);
    EXPECT_LT(motion.MaximumDisplacement, 1e-9);
  }
}

TEST(VertexUpdating, AFitThatMissesTheToleranceIsReported)
{
  const Surface s = Noisy(Icosphere(2), 0.03);
  const TriangleMesh mesh(s.Vertices, s.Faces);
  VertexMotion motion;
  UpdateVerticesFromNormals(mesh, s.Vertices, Unknown(mesh.NumberOfVertices()),
    VertexNormals(mesh, s), 0.7, motion, { 1e-30, 5 });
  EXPECT_GT(motion.MissedResidual, 0.0);
  EXPECT_LT(motion.MissedResidual, 1e-9); // that of the factorisation
}

// By a small angle, at which r is nearly 1.
TEST(VertexUpdating, TrianglesTurnAsTheirVectorsDo)
{
  const Surface s = Noisy(Icosphere(2), 0.05);
  const TriangleMesh mesh(s.Vertices, s.Faces);
  const Eigen::Matrix3d turn =
    Eigen::AngleAxisd(1e-4, Eigen::Vector3d(1.0, 2.0, 3.0).normalized()).toRotationMatrix();
  const Values normals = VertexNormals(mesh, s);
  VertexMotion motion;
  Surface moved = s;
  moved.Vertices = UpdateVerticesFromNormals(
    mesh, s.Vertices, PointData::FromValues(normals), normals * turn.transpose(), 1e3, motion);
  Surface rotated = s;
  rotated.Vertices = s.Vertices * turn.transpose();
  EXPECT_LT(MeanAngle(moved, rotated), 0.2 * MeanAngle(s, rotated));
}

TEST(VertexUpdating, DoesNotDependOnPlaceSizeOrOrientation)
{
  const Surface s = Noisy(Icosphere(2), 0.03);
  const auto fit = [](const Surface& surface, double scale, const Eigen::RowVector3d& centre)
  {
    const TriangleMesh mesh(surface.Vertices, surface.Faces);
    const Values normals = SampleUnit(mesh, surface, 3,
      [&](const Eigen::RowVector3d& x) { return Eigen::RowVector3d(x - centre); });
    VertexMotion motion;
    return UpdateVerticesFromNormals(
      mesh, surface.Vertices, Unknown(mesh.NumberOfVertices()), normals, 0.7 * scale, motion);
  };
  const Eigen::RowVector3d origin = Eigen::RowVector3d::Zero();
  const Eigen::RowVector3d away(300.0, -200.0, 50.0);
  const Points reference = fit(s, 1.0, origin);
  EXPECT_LT((fit(Scaled(s, 1e-6), 1e-6, origin) * 1e6 - reference).cwiseAbs().maxCoeff(), 1e-8);
  EXPECT_LT(
    ((fit(Moved(s, away), 1.0, away)).rowwise() - away - reference).cwiseAbs().maxCoeff(), 1e-8);
  EXPECT_LT((fit(Flipped(s), 1.0, origin) - reference).cwiseAbs().maxCoeff(), 1e-8);
}
