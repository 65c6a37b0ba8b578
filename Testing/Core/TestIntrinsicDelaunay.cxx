// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Heat.h"
#include "Meshes.h"

#include "Core/Operators/CotanWeights.h"
#include "Core/Operators/DirichletEnergy.h"
#include "Core/Surface/IntrinsicDelaunay.h"
#include "Core/Surface/MedialMesh.h"
#include "Core/Surface/TangentVectors.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdio>
#include <vector>

using namespace SurfaceDiffusion;
using namespace SurfaceDiffusion::Testing;

namespace
{

/// Flattened along x, so that most angles are far from those of a Delaunay triangulation.
Surface Pressed(Surface s, double factor)
{
  s.Vertices.col(0) *= factor;
  return s;
}

/// Sheared within the plane, so that angles opposite the boundary are obtuse too.
Surface Slanted(Surface s, double slope)
{
  s.Vertices.col(0) += slope * s.Vertices.col(1);
  return s;
}

/// The square [-1, 1]^2 with obtuse angles inside and none opposite its boundary.
Surface BadInside()
{
  Surface s = Plate(12, 1.0);
  for (auto&& v : s.Vertices.rowwise())
  {
    v[0] += 0.9 * v[1] * std::pow(1.0 - v[0] * v[0], 2) * std::pow(1.0 - v[1] * v[1], 2);
  }
  return s;
}

std::vector<std::pair<const char*, Surface>> BadSurfaces()
{
  return { { "pressed sphere", Pressed(Icosphere(3), 0.05) },
    { "slanted plate", Slanted(Plate(12, 1.0), 6.0) },
    { "Moebius band", Pressed(Moebius(24, 4), 0.1) },
    { "flat tetrahedron", Slanted(Tetrahedron(), 5.0) },
    { "pressed torus", Pressed(Torus(24, 12), 0.05) },
    { "twisted fins", Slanted(ThreeFins(6), 4.0) },
    { "one triangle",
      MakeSurface({ { 0, 0, 0 }, { 1, 0, 0 }, { 0.5, 0.01, 0 } }, { { 0, 1, 2 } }) } };
}

SparseMatrix Stiffness(const Assembler& assembler)
{
  SparseMatrix k = ZeroMatrix(assembler.Pattern());
  assembler.Fill(
    k, Vector::Zero(assembler.Mesh().NumberOfVertices()), 1.0, CotanWeights(assembler.Mesh()));
  return k;
}

} // namespace

TEST(IntrinsicDelaunay, MakesNoWeightNegative)
{
  for (const auto& [name, surface] : BadSurfaces())
  {
    const auto mesh = MakeMesh(surface);
    const Assembler flipped(IntrinsicDelaunay(mesh).Mesh());
    const SparseMatrix before = Stiffness(Assembler(mesh));
    const SparseMatrix after = Stiffness(flipped);
    double worstBefore = 0.0;
    double worstAfter = 0.0;
    for (int j = 0; j < after.outerSize(); ++j)
    {
      for (SparseMatrix::InnerIterator it(before, j); it; ++it)
      {
        worstBefore = it.row() == j ? worstBefore : std::max(worstBefore, it.value());
      }
      for (SparseMatrix::InnerIterator it(after, j); it; ++it)
      {
        worstAfter = it.row() == j ? worstAfter : std::max(worstAfter, it.value());
      }
    }
    EXPECT_GT(worstBefore, 0.01) << name << ": the surface is no test";
    EXPECT_LT(worstAfter, 1e-8) << name;
  }
}

// Edges that go far around, as on a twisted tube: every flip of all of them straightens by one
// turn.
TEST(IntrinsicDelaunay, SpiralsAreUnwound)
{
  for (const double turns : { 3.0, 10.0, 30.0 })
  {
    const Index cells = 100;
    const auto mesh = MakeMesh(Slanted(Strip(cells, 1, cells, 1.0), turns));
    const IntrinsicDelaunay delaunay(mesh);
    EXPECT_EQ(delaunay.NumberOfEdgesLeft(), 0) << turns;
    const SparseMatrix stiffness = Stiffness(Assembler(delaunay.Mesh()));
    const double diagonal = stiffness.diagonal().maxCoeff();
    for (int j = 0; j < stiffness.outerSize(); ++j)
    {
      for (SparseMatrix::InnerIterator entry(stiffness, j); entry; ++entry)
      {
        EXPECT_TRUE(entry.row() == j || entry.value() <= 1e-8 * diagonal) << turns;
      }
    }
    const auto flips = static_cast<double>(delaunay.Flips().size());
    std::printf("%g turns: %g flips per cell\n", turns, flips / cells);
    EXPECT_GT(flips, (turns - 1.0) * cells);
  }
}

TEST(IntrinsicDelaunay, KeepsTheArea)
{
  for (const auto& [name, surface] : BadSurfaces())
  {
    const auto mesh = MakeMesh(surface);
    const auto flipped = IntrinsicDelaunay(mesh).Mesh();
    double area = 0.0;
    for (Index t = 0; t < flipped->NumberOfTriangles(); ++t)
    {
      area += flipped->Shapes()[t].Area();
    }
    EXPECT_NEAR(area / mesh->ControlAreas().sum(), 1.0, 1e-12) << name;
    // The integral over the drawn surface: a third of its triangles at each vertex.
    EXPECT_EQ(flipped->ControlAreas(), mesh->ControlAreas()) << name;
    EXPECT_EQ(flipped->InputVertex(), mesh->InputVertex()) << name;
  }
}

TEST(IntrinsicDelaunay, ASmallComponentKeepsItsShapeBesideALargeOneWithNeedles)
{
  Surface small = Pressed(Icosphere(2), 0.2);
  const Surface large = MakeSurface({ { 9, 0, 0 }, { 10, 0, 0 }, { 9.5, 1e-9, 0 }, { 9.5, 1, 0 } },
    { { 0, 1, 2 }, { 0, 2, 3 }, { 2, 1, 3 } });
  const SparseMatrix alone = Stiffness(Assembler(IntrinsicDelaunay(MakeMesh(small)).Mesh()));
  const auto joined = MakeMesh(Joined(Scaled(small, 1e-7), large));
  const auto flipped = IntrinsicDelaunay(joined).Mesh();
  const SparseMatrix both = Stiffness(Assembler(flipped));
  const Index n = static_cast<Index>(alone.rows());
  const Index first = joined->InputVertex()[0] < n ? 0 : 4;
  ASSERT_EQ(both.rows(), n + 4);
  // The weights are those of the shape alone. Vertices can be numbered in another order.
  std::vector<double> expected, found;
  for (Index i = 0; i < n; ++i)
  {
    expected.push_back(alone.coeff(i, i));
    found.push_back(both.coeff(first + i, first + i));
  }
  std::sort(expected.begin(), expected.end());
  std::sort(found.begin(), found.end());
  for (Index i = 0; i < n; ++i)
  {
    EXPECT_NEAR(found[i] / expected[i], 1.0, 1e-6);
  }
}

TEST(IntrinsicDelaunay, EveryEdgeIsOneVertexOfTheMedialMesh)
{
  for (const auto& [name, surface] : BadSurfaces())
  {
    const auto flipped = IntrinsicDelaunay(MakeMesh(surface)).Mesh();
    const MedialMesh medial(*flipped);
    const Triangles& edges = medial.Edges()->TriangleVertices();
    std::vector<std::vector<double>> lengths(medial.Ends().size());
    for (Index t = 0; t < flipped->NumberOfTriangles(); ++t)
    {
      for (int a = 0; a < 3; ++a)
      {
        lengths[edges(t, a)].push_back(flipped->Shapes()[t].EdgeLength(a));
      }
    }
    for (const std::vector<double>& uses : lengths)
    {
      ASSERT_EQ(uses.size(), 2u) << name; // the sheets are closed
      EXPECT_NEAR(uses[0] / uses[1], 1.0, 1e-6) << name;
    }
  }
}

TEST(IntrinsicDelaunay, BackwardEulerKeepsTheBoundsAtAnyStep)
{
  for (const auto& [name, surface] : BadSurfaces())
  {
    const auto flipped =
      std::make_shared<const Assembler>(IntrinsicDelaunay(MakeMesh(surface)).Mesh());
    // One vertex at 1, the others at 0: an overshoot anywhere leaves the bounds.
    Values spike = Values::Zero(flipped->Mesh().NumberOfVertices(), 1);
    spike(spike.rows() / 2, 0) = 1.0;
    for (const double dt : { 1e-6, 1e-3, 1.0, 1e3 })
    {
      const Values u =
        Diffuse(flipped, PointData::FromValues(spike), dt, 1, 0.0, Scheme::BackwardEuler);
      EXPECT_GE(u.minCoeff(), -1e-12) << name << ", time step " << dt;
      EXPECT_LE(u.maxCoeff() - 1.0, 1e-12) << name << ", time step " << dt;
    }
  }
}

TEST(IntrinsicDelaunay, WithoutItTheSamePlateOvershoots)
{
  const auto plain = MakeAssembler(Slanted(Plate(12, 1.0), 6.0));
  Values spike = Values::Zero(plain->Mesh().NumberOfVertices(), 1);
  spike(spike.rows() / 2, 0) = 1.0;
  const Values u =
    Diffuse(plain, PointData::FromValues(spike), 1e-3, 1, 0.0, Scheme::BackwardEuler);
  EXPECT_LT(u.minCoeff(), -1e-4);
}

TEST(IntrinsicDelaunay, EnergyOfALinearFunctionIsExactOnAPlane)
{
  // It is exact on any triangulation of a plane, on one sheet and on two, as long as no edge is
  // flipped over the boundary.
  const Surface plate = BadInside();
  const auto flipped = IntrinsicDelaunay(MakeMesh(plate)).Mesh();
  const Values u = Sample(*flipped, plate, [](const auto& x) { return 2.0 * x[0] - x[1]; });
  EXPECT_NEAR(DirichletEnergy(*flipped, CotanWeights(*flipped), u), 0.5 * 5.0 * 4.0, 1e-9);
}

TEST(IntrinsicDelaunay, EnergyOfALinearFunctionIsExactIfBoundaryEdgesAreKept)
{
  const Surface plate = Slanted(Plate(12, 1.0), 6.0);
  const auto energy = [&](BoundaryEdges boundary)
  {
    const auto flipped =
      IntrinsicDelaunay(MakeMesh(plate), SerialFor(), ProgressMonitor(), boundary).Mesh();
    const Values u = Sample(*flipped, plate, [](const auto& x) { return 2.0 * x[0] - x[1]; });
    return DirichletEnergy(*flipped, CotanWeights(*flipped), u);
  };
  EXPECT_NEAR(energy(BoundaryEdges::Keep), 0.5 * 5.0 * 4.0, 1e-9);
  EXPECT_GT(std::abs(energy(BoundaryEdges::Flip) - 10.0), 0.1);
}

TEST(IntrinsicDelaunay, TransportKeepsAConstantFieldOfAPlane)
{
  const Surface plate = BadInside();
  const auto mesh = MakeMesh(plate);
  const Eigen::RowVector3d direction(0.6, 0.8, 0.0);
  const TangentVectors lines = TangentVectorsFromTriangleVectors(
    *mesh, plate.Vertices, plate.Faces, direction.replicate(plate.Faces.rows(), 1));
  const IntrinsicDelaunay delaunay(mesh);
  const TriangleMesh& flipped = *delaunay.Mesh();
  const TangentVectors transported = delaunay.Transport(lines);
  ASSERT_EQ(transported.rows(), flipped.NumberOfTriangles());
  const CornerWeights c = AnisotropicWeights(flipped, CotanWeights(flipped), transported, 3.0, 0.5);
  const Values u = Sample(flipped, plate, [](const auto& x) { return 2.0 * x[0] - x[1]; });
  // grad u . e1 = 0.4, grad u . e2 = -2.2
  EXPECT_NEAR(DirichletEnergy(flipped, c, u), 0.5 * (3.0 * 0.16 + 0.5 * 4.84) * 4.0, 1e-9);
}

TEST(IntrinsicDelaunay, TransportAfterwardsEqualsCarryingAlong)
{
  // In a plane directions have coordinates, and a flip takes the area-weighted mean of d d^T of two
  // triangles without any rotation.
  const Surface plate = BadInside();
  const auto mesh = MakeMesh(plate);
  Points directions(plate.NumberOfTriangles(), 3);
  for (Index t = 0; t < plate.NumberOfTriangles(); ++t)
  {
    const double angle = 2.0 * plate.Vertices.row(plate.Faces(t, 0)).sum();
    directions.row(t) << std::cos(angle), std::sin(angle), 0.0;
  }
  const IntrinsicDelaunay delaunay(mesh);
  ASSERT_GT(delaunay.Flips().size(), 50u);

  IntrinsicTriangulation triangulation(*mesh);
  const auto corner = [&](Index t, int a) -> Eigen::RowVector2d
  { return plate.Vertices.row(mesh->InputVertex()[triangulation.Vertex(t, a)]).head<2>(); };
  const auto area = [&](Index t)
  {
    const Eigen::RowVector2d u = corner(t, 1) - corner(t, 0);
    const Eigen::RowVector2d v = corner(t, 2) - corner(t, 0);
    return 0.5 * std::abs(u[0] * v[1] - u[1] * v[0]);
  };
  std::vector<Eigen::Matrix2d> carried(triangulation.NumberOfSides() / 3);
  for (Index t = 0; t < static_cast<Index>(carried.size()); ++t)
  {
    const Index input = mesh->InputTriangle()[t % mesh->NumberOfTriangles()]; // front or back
    const Eigen::RowVector2d d = directions.row(input).head<2>();
    carried[t] = area(t) * d.transpose() * d;
  }
  for (const IntrinsicTriangulation::EdgeFlip& flip : delaunay.Flips())
  {
    IntrinsicTriangulation::EdgeFlip again;
    ASSERT_TRUE(triangulation.Flip(flip.Side, again));
    const Index left = flip.Side / 3;
    const Index right = flip.Twin / 3;
    const Eigen::Matrix2d sum = carried[left] + carried[right];
    const double share = area(left) / (area(left) + area(right));
    carried[left] = share * sum;
    carried[right] = (1.0 - share) * sum;
  }

  const TangentVectors transported = delaunay.Transport(
    TangentVectorsFromTriangleVectors(*mesh, plate.Vertices, plate.Faces, directions));
  ASSERT_EQ(static_cast<std::size_t>(transported.rows()), carried.size());
  for (Index t = 0; t < static_cast<Index>(carried.size()); ++t)
  {
    const Eigen::RowVector2d x = (corner(t, 1) - corner(t, 0)).normalized();
    const Eigen::RowVector2d e = corner(t, 2) - corner(t, 0);
    const Eigen::RowVector2d y = (e - e.dot(x) * x).normalized();
    const Eigen::RowVector2d after = transported(t, 0) * x + transported(t, 1) * y;
    const Eigen::RowVector2d along = MainAxis(carried[t](0, 0), carried[t](0, 1), carried[t](1, 1));
    EXPECT_NEAR(std::abs(after.dot(along)), 1.0, 1e-12) << t;
  }
}

TEST(IntrinsicDelaunay, TransportLeavesTrianglesWithoutDirectionAlone)
{
  const auto mesh = MakeMesh(Pressed(Icosphere(3), 0.05));
  const IntrinsicDelaunay delaunay(mesh);
  ASSERT_GT(delaunay.Flips().size(), 50u);
  EXPECT_TRUE(delaunay.Transport(TangentVectors::Zero(mesh->NumberOfTriangles(), 2)).isZero(0.0));
}

TEST(IntrinsicDelaunay, EdgesFromAVertexToItselfDoNotDrownOthers)
{
  // A needle, covered twice: one of its edges becomes one around vertex 1, from 0 to 0.
  const auto needle =
    MakeMesh(MakeSurface({ { 0, 0, 0 }, { 1.4e-8, 0, 0 }, { -1, 1, 0 } }, { { 0, 1, 2 } }));
  const Assembler flipped(IntrinsicDelaunay(needle).Mesh());
  const CornerWeights c = CotanWeights(flipped.Mesh());
  ASSERT_EQ(c.rows(), 2);
  ASSERT_GT(c.maxCoeff(), 1e5);
  Index large;
  c.rowwise().maxCoeff().maxCoeff(&large);
  Vector weights(2);
  weights[large] = 1e4;
  weights[1 - large] = 1e-8;
  SparseMatrix k = ZeroMatrix(flipped.Pattern());
  flipped.Fill(k, Vector::Zero(3), 1.0, c, weights.data());
  for (int i = 0; i < 3; ++i)
  {
    const double others = k.col(i).sum() - k.coeff(i, i);
    EXPECT_NEAR(k.coeff(i, i) / -others, 1.0, 1e-14) << i;
  }
  // Where the two ends of such an edge have opposite signs, it has an energy.
  const CornerWeights opposite = CornerWeights::Constant(2, 3, -1.0);
  flipped.Fill(k, Vector::Zero(3), 1.0, c, weights.data(), SerialFor(), &opposite);
  EXPECT_NEAR(k.coeffs().maxCoeff() / (4.0 * 1e4 * c.maxCoeff()), 1.0, 1e-3);
}

TEST(IntrinsicDelaunay, LeavesADelaunayMeshAlone)
{
  const auto mesh = MakeMesh(Icosphere(3));
  const IntrinsicDelaunay delaunay(mesh);
  EXPECT_TRUE(delaunay.Flips().empty());
  EXPECT_EQ(delaunay.Mesh()->NumberOfTriangles(), mesh->NumberOfTriangles());
  EXPECT_NEAR(
    (Stiffness(Assembler(delaunay.Mesh())) - Stiffness(Assembler(mesh))).norm(), 0.0, 1e-11);
}
