// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Operators/CotanWeights.h"
#include "Core/Surface/IntrinsicDelaunay.h"
#include "Core/Surface/MedialMesh.h"
#include "Meshes.h"

#include <gtest/gtest.h>

using namespace SurfaceDiffusion;
using namespace SurfaceDiffusion::Testing;

TEST(MedialMesh, HasAVertexForEveryEdge)
{
  for (const Surface& s : { Icosphere(2), Disk(4), Moebius(20, 4), ThreeFins(3), Tetrahedron() })
  {
    const auto mesh = MakeMesh(s);
    const MedialMesh medial(*mesh);
    EXPECT_EQ(medial.Edges()->NumberOfVertices(), mesh->NumberOfEdges());
    EXPECT_EQ(medial.Edges()->NumberOfTriangles(), mesh->NumberOfTriangles());
    for (Index t = 0; t < mesh->NumberOfTriangles(); ++t)
    {
      for (int a = 0; a < 3; ++a)
      {
        const auto ends = medial.Ends()[medial.Edges()->TriangleVertices()(t, a)];
        const auto vertices = mesh->TriangleVertices().row(t);
        EXPECT_EQ(ends[0] + ends[1], vertices[(a + 1) % 3] + vertices[(a + 2) % 3]);
        EXPECT_TRUE((vertices.array() == ends[0]).any() && (vertices.array() == ends[1]).any());
      }
    }
  }
}

TEST(MedialMesh, SplitsEdgesOfThreeTriangles)
{
  const auto mesh = MakeMesh(ThreeFins(3));
  const MedialMesh medial(*mesh, true);
  EXPECT_EQ(medial.Edges()->NumberOfVertices(), mesh->NumberOfEdges() + 2 * 3);
  EXPECT_EQ(medial.Edges()->NumberOfComponents(), 3);
  EXPECT_GT(medial.Edges()->ControlAreas().minCoeff(), 0.0);
  const auto closed = MakeMesh(Icosphere(2));
  EXPECT_EQ(MedialMesh(*closed, true).Edges()->TriangleVertices(),
    MedialMesh(*closed).Edges()->TriangleVertices());
}

TEST(MedialMesh, HasAQuarterOfTheArea)
{
  const auto mesh = MakeMesh(Icosphere(2));
  const MedialMesh medial(*mesh);
  EXPECT_NEAR(medial.Edges()->ControlAreas().sum(), 0.25 * mesh->ControlAreas().sum(), 1e-13);
}

TEST(MedialMesh, GradientsAreThoseOfTheCrouzeixRaviartFunctions)
{
  // Edge means of a linear function have the function's own gradient on each triangle.
  const auto mesh = MakeMesh(Icosphere(1));
  const MedialMesh medial(*mesh);
  const Values u = Noise(*mesh);
  Values w(mesh->NumberOfEdges(), 1);
  for (Index e = 0; e < w.rows(); ++e)
  {
    w(e, 0) = 0.5 * (u(medial.Ends()[e][0], 0) + u(medial.Ends()[e][1], 0));
  }
  const auto gradientOn = [](const TriangleMesh& m, const Values& values, Index t)
  {
    const auto v = m.TriangleVertices().row(t);
    return Gradient(m.Shapes()[t], values(v[0], 0), values(v[1], 0), values(v[2], 0));
  };
  for (Index t = 0; t < mesh->NumberOfTriangles(); ++t)
  {
    // The axes of a medial triangle are turned by 180 degrees.
    EXPECT_LT((gradientOn(*medial.Edges(), w, t) + gradientOn(*mesh, u, t)).norm(), 1e-12);
  }
}

TEST(MedialMesh, TrianglesThatTouchAtAPointOnlyAreApart)
{
  const Surface bowTie =
    MakeSurface({ { 0, 0, 0 }, { 1, 0, 0 }, { 1, 1, 0 }, { -1, 0, 0 }, { -1, 1, 0 } },
      { { 0, 1, 2 }, { 0, 4, 3 } });
  const auto mesh = MakeMesh(bowTie);
  const MedialMesh medial(*mesh);
  EXPECT_EQ(mesh->NumberOfComponents(), 1);
  ASSERT_EQ(medial.Edges()->NumberOfComponents(), 2);
  // Each component's vertices lie together.
  for (Index t = 0; t < 2; ++t)
  {
    const auto corners = medial.Edges()->TriangleVertices().row(t).array();
    const Index begin = corners.minCoeff() < 3 ? 0 : 3;
    EXPECT_TRUE((corners >= begin).all() && (corners < begin + 3).all());
  }
}

TEST(MedialMesh, ExistsOnIntrinsicTriangulations)
{
  // A closed fan of slivers: flips give triangles that have a vertex twice or share two edges.
  for (const Surface& s : { Tetrahedron(), Cylinder(4, 2, 0.05, 2.0), Strip(12, 1, 1.0, 0.01) })
  {
    const auto mesh = IntrinsicDelaunay(MakeMesh(s)).Mesh();
    const MedialMesh medial(*mesh);
    EXPECT_NEAR(medial.Edges()->ControlAreas().sum(), 0.25 * mesh->ControlAreas().sum(), 1e-13);
    EXPECT_GT(medial.Edges()->ControlAreas().minCoeff(), 0.0);
  }
}
