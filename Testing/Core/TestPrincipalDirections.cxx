// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Geometry/PrincipalDirections.h"
#include "Core/Surface/TangentVectors.h"
#include "Meshes.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>

using namespace SurfaceDiffusion;
using namespace SurfaceDiffusion::Testing;

namespace
{

struct Result
{
  Points Directions; ///< per input triangle
  Vector Difference; ///< per triangle of the mesh, in 1/coordinate unit
  std::shared_ptr<const Assembler> Operators;
};

Result Find(const Surface& s, double fwhm = 0.0)
{
  Result result;
  result.Operators = MakeAssembler(s);
  const TriangleMesh& mesh = result.Operators->Mesh();
  const auto solver = MakeCholeskySolver();
  const PrincipalDirections found = FindPrincipalDirections(
    *result.Operators, s.Vertices, s.Faces, fwhm / mesh.LengthUnit(), *solver);
  result.Directions = VectorsInSpace(mesh, s.Vertices, s.Faces, found.MinimumCurvature);
  result.Difference = found.Difference / mesh.LengthUnit();
  return result;
}

Eigen::RowVector3d Middle(const Surface& s, Index t)
{
  return (s.Vertices.row(s.Faces(t, 0)) + s.Vertices.row(s.Faces(t, 1)) +
           s.Vertices.row(s.Faces(t, 2))) /
    3.0;
}

/// Root mean square over the triangles of the sine of the angle to the circles around the z axis,
/// the minimum-curvature lines of a torus.
double ErrorOnTorus(const Surface& s, double fwhm = 0.0)
{
  const Points directions = Find(s, fwhm).Directions;
  double sum = 0.0;
  for (Index t = 0; t < s.NumberOfTriangles(); ++t)
  {
    const Eigen::RowVector3d p = Middle(s, t);
    const Eigen::RowVector3d exact = Eigen::RowVector3d(-p[1], p[0], 0.0).normalized();
    sum += directions.row(t).cross(exact).squaredNorm();
  }
  return std::sqrt(sum / s.NumberOfTriangles());
}

} // namespace

TEST(PrincipalDirections, OfATorusConvergeToItsCircles)
{
  const double coarse = ErrorOnTorus(Torus(40, 20));
  const double fine = ErrorOnTorus(Torus(80, 40));
  std::printf("torus: error %.4f, %.4f\n", coarse, fine);
  EXPECT_LT(fine, 0.02);
  EXPECT_LT(fine, 0.6 * coarse);
}

TEST(PrincipalDirections, DifferenceIsThatOfTheCurvatures)
{
  const Surface s = Torus(80, 40);
  const Result result = Find(s);
  const TriangleMesh& mesh = result.Operators->Mesh();
  for (Index t = 0; t < mesh.NumberOfTriangles(); ++t)
  {
    const Eigen::RowVector3d p = Middle(s, mesh.InputTriangle()[t]);
    const double fromAxis = std::hypot(p[0], p[1]);
    const double exact = 1.0 - std::abs((fromAxis - 2.0) / fromAxis);
    EXPECT_NEAR(result.Difference[t], exact, 0.06);
  }
}

TEST(PrincipalDirections, OfACylinderAreItsAxis)
{
  const Surface s = Rotated(Cylinder(32, 16, 0.5));
  const Surface axis = Rotated(MakeSurface({ { 0.0, 0.0, 1.0 } }, {}));
  const Result result = Find(s, 0.2);
  EXPECT_GT((result.Directions * axis.Vertices.row(0).transpose()).cwiseAbs().minCoeff(), 0.9999);
  EXPECT_NEAR(result.Difference.minCoeff(), 2.0, 0.1);
  EXPECT_NEAR(result.Difference.maxCoeff(), 2.0, 0.1);
}

TEST(PrincipalDirections, PlanesInSinglePrecisionHaveNone)
{
  for (const double angle : { 0.3, 1.0, 2.2 })
  {
    Surface s = Rotated(Jittered(Plate(20, 1.0), 0.03, -0.99, 0.99, -0.99, 0.99), angle);
    s.Vertices = s.Vertices.cast<float>().cast<double>().eval();
    for (const double fwhm : { 0.0, 0.4 })
    {
      EXPECT_EQ(Find(s, fwhm).Directions.cwiseAbs().maxCoeff(), 0.0) << angle << ' ' << fwhm;
    }
  }
  Surface torus = Torus(80, 40);
  torus.Vertices = torus.Vertices.cast<float>().cast<double>().eval();
  EXPECT_LT(ErrorOnTorus(torus), 0.02);
}

TEST(PrincipalDirections, OfASphereDifferLittle)
{
  const double coarse = Find(Icosphere(3)).Difference.mean();
  const double fine = Find(Icosphere(4)).Difference.mean();
  EXPECT_LT(fine, 0.08); // of a curvature of 1, and falling
  EXPECT_LT(fine, 0.75 * coarse);
}

TEST(PrincipalDirections, SmoothingMakesThemRobustToNoise)
{
  Surface s = Torus(80, 40);
  for (Index i = 0; i < s.NumberOfVertices(); ++i)
  {
    for (int k = 0; k < 3; ++k)
    {
      s.Vertices(i, k) += 0.01 * (2.0 * UniformRandom(5, k, i) - 1.0);
    }
  }
  const double raw = ErrorOnTorus(s);
  const double smoothed = ErrorOnTorus(s, 0.8);
  std::printf("noisy torus: error %.3f raw, %.3f smoothed\n", raw, smoothed);
  EXPECT_LT(smoothed, 0.1);
  EXPECT_LT(smoothed, 0.3 * raw);
}

TEST(PrincipalDirections, OrientationDoesNotMatter)
{
  const Surface s = Torus(40, 20);
  Surface flipped = s;
  for (Index t = 0; t < s.NumberOfTriangles(); t += 3)
  {
    std::swap(flipped.Faces(t, 1), flipped.Faces(t, 2));
  }
  EXPECT_NEAR(ErrorOnTorus(flipped), ErrorOnTorus(s), 1e-9);
}
