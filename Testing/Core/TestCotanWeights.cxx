// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Operators/CotanWeights.h"
#include "Meshes.h"

#include <gtest/gtest.h>

using namespace SurfaceDiffusion;
using namespace SurfaceDiffusion::Testing;

namespace
{

using Plane = Eigen::Vector2d;

/// One triangle in the plane z = 0, its corners kept in order.
Surface OneTriangle(const Plane& a, const Plane& b, const Plane& c)
{
  return MakeSurface({ { a[0], a[1], 0 }, { b[0], b[1], 0 }, { c[0], c[1], 0 } }, { { 0, 1, 2 } });
}

/// Acute, right-angled, obtuse at each corner, and thin.
const std::vector<Surface> Shapes = { OneTriangle({ 0, 0 }, { 2, 0.1 }, { 0.9, 1.5 }),
  OneTriangle({ 0, 0 }, { 3, 0 }, { 0, 1 }), OneTriangle({ 0, 0 }, { 1, 0 }, { -2, 1 }),
  OneTriangle({ 0, 0 }, { 1, 0 }, { 3, 0.5 }), OneTriangle({ 0, 0 }, { 4, 0 }, { 2.2, 0.3 }),
  OneTriangle({ 0, 0 }, { 1, 0 }, { 0.4, 1e-4 }) };

/// Interior angles at the three corners.
std::array<double, 3> Angles(const TriangleMesh::Shape& s)
{
  const std::array<Plane, 3> corner = { Plane(0, 0), Plane(s.Length, 0), Plane(s.X, s.Y) };
  std::array<double, 3> angles;
  for (int a = 0; a < 3; ++a)
  {
    const Plane u = corner[(a + 1) % 3] - corner[a];
    const Plane v = corner[(a + 2) % 3] - corner[a];
    angles[a] = std::atan2(std::abs(u[0] * v[1] - u[1] * v[0]), u.dot(v));
  }
  return angles;
}

Plane HatGradient(const TriangleMesh::Shape& s, int corner)
{
  return Gradient(s, corner == 0, corner == 1, corner == 2);
}

void ExpectClose(double value, double expected, double scale)
{
  EXPECT_NEAR(value, expected, 1e-12 * scale);
}

} // namespace

TEST(CotanWeights, GradientOfALinearFunctionIsExact)
{
  for (const Surface& s : Shapes)
  {
    const TriangleMesh::Shape shape = MakeMesh(s)->Shapes()[0];
    const auto f = [](double x, double y) { return 3.0 - 2.0 * x + 5.0 * y; };
    const Plane g = Gradient(shape, f(0, 0), f(shape.Length, 0), f(shape.X, shape.Y));
    EXPECT_NEAR(g[0], -2.0, 1e-9);
    EXPECT_NEAR(g[1], 5.0, 1e-9);
  }
}

// Theorem 1 (15): the normal integrates over the part of the boundary of C_i in a triangle, edge
// midpoint - barycentre - edge midpoint, to half the opposite edge turned by 90 degrees.
TEST(CotanWeights, NormalsIntegrateToHalfTheOppositeEdgeTurned)
{
  for (const Surface& s : Shapes)
  {
    const TriangleMesh::Shape shape = MakeMesh(s)->Shapes()[0];
    const std::array<Plane, 3> corner = { Plane(0, 0), Plane(shape.Length, 0),
      Plane(shape.X, shape.Y) };
    const Plane barycentre = (corner[0] + corner[1] + corner[2]) / 3.0;
    for (int i = 0; i < 3; ++i)
    {
      const Plane from = 0.5 * (corner[i] + corner[(i + 1) % 3]);
      const Plane to = 0.5 * (corner[i] + corner[(i + 2) % 3]);
      Plane integral(0, 0);
      for (const Plane& piece : { Plane(barycentre - from), Plane(to - barycentre) })
      {
        integral += Plane(piece[1], -piece[0]); // outward: the cell lies on the left
      }
      const Plane byGradient = -shape.Area() * HatGradient(shape, i);
      EXPECT_NEAR((integral - byGradient).norm(), 0.0, 1e-13);
      const Plane edge = corner[(i + 2) % 3] - corner[(i + 1) % 3];
      EXPECT_NEAR((integral - 0.5 * Plane(edge[1], -edge[0])).norm(), 0.0, 1e-13);
    }
  }
}

TEST(CotanWeights, AreHalfTheCotangents) // (10)
{
  for (const Surface& s : Shapes)
  {
    const auto mesh = MakeMesh(s);
    const CornerWeights c = CotanWeights(*mesh);
    const std::array<double, 3> angle = Angles(mesh->Shapes()[0]);
    for (int k = 0; k < 3; ++k)
    {
      const double expected = 0.5 * std::cos(angle[k]) / std::sin(angle[k]);
      ExpectClose(c(0, k), expected, c.cwiseAbs().maxCoeff());
    }
  }
}

// The paper's closed forms below (13), with I, J, K the angles at the corners i, j, k and theta the
// angle from grad(phi_j) to e1 in the sense i -> j -> k.
TEST(CotanWeights, DirectionalWeightsAreThePapersClosedForms)
{
  for (const Surface& s : Shapes)
  {
    const auto mesh = MakeMesh(s);
    const TriangleMesh::Shape shape = mesh->Shapes()[0];
    const std::array<double, 3> angle = Angles(shape);
    for (const double direction : { 0.0, 0.3, 1.2, 2.0, 2.9, -1.0 })
    {
      TangentVectors frame(1, 2);
      frame << std::cos(direction), std::sin(direction);
      const CornerWeights c1 = DirectionalWeights(*mesh, frame);
      const CornerWeights c2 = CotanWeights(*mesh) - c1;
      const double scale = CotanWeights(*mesh).cwiseAbs().maxCoeff();
      for (int i = 0; i < 3; ++i) // whichever corner is called i
      {
        const int j = (i + 1) % 3;
        const int k = (i + 2) % 3;
        const Plane gradient = HatGradient(shape, j);
        const double theta = direction - std::atan2(gradient[1], gradient[0]);
        const double I = angle[i], J = angle[j], K = angle[k];
        using std::cos;
        using std::sin;
        ExpectClose(c1(0, k), cos(theta) * cos(theta - K) / (2.0 * sin(K)), scale);
        ExpectClose(c1(0, j), -cos(theta + I) * cos(theta - K) / (2.0 * sin(J)), scale);
        ExpectClose(c1(0, i), cos(theta) * cos(theta + I) / (2.0 * sin(I)), scale);
        ExpectClose(c2(0, k), sin(theta) * sin(theta - K) / (2.0 * sin(K)), scale);
        ExpectClose(c2(0, j), -sin(theta + I) * sin(theta - K) / (2.0 * sin(J)), scale);
        ExpectClose(c2(0, i), sin(theta) * sin(theta + I) / (2.0 * sin(I)), scale);
      }
    }
  }
}

TEST(CotanWeights, DirectionsAtRightAnglesAddUpToIsotropic)
{
  const auto mesh = MakeMesh(Icosphere(2));
  TangentVectors e1(mesh->NumberOfTriangles(), 2);
  for (Index t = 0; t < mesh->NumberOfTriangles(); ++t)
  {
    e1.row(t) << std::cos(t), std::sin(t);
  }
  TangentVectors e2(e1.rows(), 2);
  e2 << -e1.col(1), e1.col(0);
  const CornerWeights sum = DirectionalWeights(*mesh, e1) + DirectionalWeights(*mesh, e2);
  EXPECT_LT((sum - CotanWeights(*mesh)).cwiseAbs().maxCoeff(), 1e-14);
}

TEST(CotanWeights, DiffusionAcrossAHeightOfANeedleKeepsItsDigits)
{
  for (const double height : { 1e-4, 1e-6, 1e-8 })
  {
    const Surface needle = OneTriangle({ 0, 0 }, { 1, 0 }, { 0.4, height });
    const auto mesh = MakeMesh(needle);
    const TriangleMesh::Shape s = mesh->Shapes()[0];
    TangentVectors e1(1, 2);
    e1 << 0.0, 1.0; // along the height: only the differences along corners 0 and 1 diffuse
    const CornerWeights c2 = AnisotropicWeights(*mesh, CotanWeights(*mesh), e1, 0.0, 1.0);
    const double expected = s.Area() / (s.Length * s.Length);
    EXPECT_NEAR(c2(0, 2) / expected, 1.0, 1e-12) << height;
    EXPECT_LT(c2.leftCols(2).cwiseAbs().maxCoeff(), 1e-12 * expected) << height;
  }
}

TEST(CotanWeights, SignOfTheDirectionDoesNotMatter)
{
  const auto mesh = MakeMesh(Icosphere(1));
  const TangentVectors e1 = TangentVectors::Constant(mesh->NumberOfTriangles(), 2, std::sqrt(0.5));
  EXPECT_EQ(DirectionalWeights(*mesh, e1), DirectionalWeights(*mesh, -e1));
}

TEST(CotanWeights, EqualDiffusivitiesAreIsotropicForAnyDirection)
{
  const auto mesh = MakeMesh(Icosphere(2));
  TangentVectors e1 = TangentVectors::Zero(mesh->NumberOfTriangles(), 2);
  e1.col(1).setOnes();
  const CornerWeights c = CotanWeights(*mesh);
  const CornerWeights a = AnisotropicWeights(*mesh, c, e1, 2.5, 2.5);
  EXPECT_LT((a - 2.5 * c).cwiseAbs().maxCoeff(), 1e-14);
}

TEST(CotanWeights, WithoutADirectionTheGeometricMeanActs)
{
  const auto mesh = MakeMesh(Icosphere(1));
  const TangentVectors none = TangentVectors::Zero(mesh->NumberOfTriangles(), 2);
  const CornerWeights c = CotanWeights(*mesh);
  EXPECT_EQ(AnisotropicWeights(*mesh, c, none, 4.0, 9.0), CornerWeights(6.0 * c));
  EXPECT_EQ(AnisotropicWeights(*mesh, c, none, 4.0, 0.0), CornerWeights(0.0 * c));
}

TEST(CotanWeights, DiffusionAlongADirectionDoesNotSeeGradientsAcross)
{
  // u = y with e1 = x: the flux c1 u vanishes at every vertex.
  const Surface s = Jittered(Strip(6, 6), 0.04, 0, 1, 0, 1);
  const auto assembler = MakeAssembler(s);
  const TriangleMesh& mesh = assembler->Mesh();
  TangentVectors e1(mesh.NumberOfTriangles(), 2);
  for (Index t = 0; t < mesh.NumberOfTriangles(); ++t)
  {
    const Eigen::RowVector3d edge = s.Vertices.row(s.Faces(mesh.InputTriangle()[t], 1)) -
      s.Vertices.row(s.Faces(mesh.InputTriangle()[t], 0));
    e1.row(t) << edge[0] / edge.norm(), -edge[1] / edge.norm(); // the x axis, seen from the edge
  }
  SparseMatrix k = ZeroMatrix(assembler->Pattern());
  assembler->Fill(k, Vector::Zero(mesh.NumberOfVertices()), 1.0, DirectionalWeights(mesh, e1));
  const Values y = Sample(mesh, s, [](const Eigen::RowVector3d& p) { return p[1]; });
  EXPECT_LT((k * y).cwiseAbs().maxCoeff(), 1e-14);
  const Values x = Sample(mesh, s, [](const Eigen::RowVector3d& p) { return p[0]; });
  EXPECT_GT((k * x).cwiseAbs().maxCoeff(), 0.1);
}
