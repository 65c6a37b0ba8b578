// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
//
// Fronts on surfaces of few triangles, where straight lines are the exact distances.
#include "Core/Geodesics/EikonalDistance.h"
#include "Core/Surface/IntrinsicDelaunay.h"
#include "Meshes.h"
#include "SteinerGraph.h"

#include <gtest/gtest.h>

using namespace SurfaceDiffusion;
using namespace SurfaceDiffusion::Testing;

namespace
{

/// A surface with its fronts.
class Fronts
{
public:
  /// spread: the largest speed of a triangle over the smallest; ofDirections: the same in each.
  explicit Fronts(
    const Surface& s, bool withSpeeds = false, double spread = 1.0, double ofDirections = 1.0)
    : Mesh(MakeMesh(s))
    , Delaunay(
        IntrinsicDelaunay(this->Mesh, SerialFor(), ProgressMonitor(), BoundaryEdges::Keep).Mesh())
  {
    Points positions(this->Mesh->NumberOfVertices(), 3);
    for (Index i = 0; i < this->Mesh->NumberOfVertices(); ++i)
    {
      positions.row(i) = s.Vertices.row(this->Mesh->InputVertex()[i]) / this->Mesh->LengthUnit();
    }
    if (withSpeeds)
    {
      std::vector<double> slowness;
      TangentVectors directions(this->Mesh->NumberOfTriangles(), 2);
      unsigned int seed = static_cast<unsigned int>(s.NumberOfVertices());
      const auto random = [&]
      {
        seed = seed * 1664525U + 1013904223U;
        return static_cast<double>(seed >> 8U) / (1U << 24U);
      };
      for (Index t = 0; t < this->Mesh->NumberOfTriangles(); ++t)
      {
        slowness.push_back(std::pow(spread, -random()));
        const double angle = 2.0 * Pi * random();
        directions.row(t) << std::cos(angle), std::sin(angle);
      }
      this->Shapes = MakeFrontShapes(*this->Mesh, slowness,
        ofDirections == 1.0 ? TangentVectors(0, 2) : directions, { ofDirections }, { 1.0 });
    }
    this->Solver = std::make_unique<EikonalDistance>(
      this->Mesh, this->Delaunay, positions, this->Shapes, SerialFor(), ProgressMonitor());
  }

  /// Per point of the surface, from pieces on its triangles.
  std::vector<double> From(std::vector<SourcePiece> pieces) const
  {
    for (SourcePiece& piece : pieces)
    {
      const auto& rows = this->Mesh->InputTriangle();
      piece.Triangle =
        static_cast<Index>(std::find(rows.begin(), rows.end(), piece.Triangle) - rows.begin());
    }
    const auto found = this->Solver->Find(pieces, {}, ProgressMonitor());
    std::vector<double> times(found.Times.size());
    for (std::size_t i = 0; i < times.size(); ++i)
    {
      times[this->Mesh->InputVertex()[i]] = found.Times[i] * this->Mesh->LengthUnit();
    }
    return times;
  }

  std::vector<double> FromCorner(Index triangle, int corner) const
  {
    std::array<double, 3> place = { 0.0, 0.0, 0.0 };
    place[static_cast<std::size_t>(corner)] = 1.0;
    return this->From({ { triangle, place, place, 0, 0, 0 } });
  }

  std::shared_ptr<const TriangleMesh> Mesh, Delaunay;
  FrontShapes Shapes;
  std::unique_ptr<const EikonalDistance> Solver;
};

Surface Tetrahedron(const Points& corners)
{
  Surface s;
  s.Vertices = corners;
  s.Faces.resize(4, 3);
  s.Faces << 0, 2, 1, 0, 1, 3, 0, 3, 2, 1, 2, 3;
  return s;
}

/// Four points of a ball that is stretched.
Points RandomCorners(unsigned int seed)
{
  Points corners(4, 3);
  for (Eigen::Index k = 0; k < corners.size(); ++k)
  {
    seed = seed * 1664525U + 1013904223U;
    corners.data()[k] = static_cast<double>(seed >> 8U) / (1U << 24U);
  }
  corners.col(0) *= 3.0;
  return corners;
}

} // namespace

// The straight edges are the shortest ways in space.
TEST(EikonalDistance, OverTetrahedraIsThatOfTheirEdges)
{
  for (unsigned int seed = 1; seed <= 60; ++seed)
  {
    const double unit = seed % 3 == 0 ? 1e3 : (seed % 3 == 1 ? 1.0 : 1e-3);
    const Points corners = unit * RandomCorners(seed);
    for (const bool withSpeeds : { false, true })
    {
      const std::vector<double> found = Fronts(Tetrahedron(corners), withSpeeds).FromCorner(0, 0);
      double largest = 0.0;
      double sum = 0.0;
      for (Index i = 1; i < 4; ++i)
      {
        const double edge = (corners.row(i) - corners.row(0)).norm();
        const double error = found[static_cast<std::size_t>(i)] - edge;
        largest = std::max(largest, edge);
        sum += std::abs(error);
        EXPECT_GE(error, -0.01 * largest) << seed;
      }
      EXPECT_LT(sum / 3.0, 0.02 * largest) << seed;
    }
  }
}

// Fronts are refracted at edges, and go along them in the faster triangle.
TEST(EikonalDistance, OfSpeedsThatJumpIsNotEarlierThanTheShortestWay)
{
  std::vector<Surface> surfaces = { Icosphere(0), Icosphere(1) };
  surfaces[0].Vertices.col(0) *= 4.0;
  surfaces[1].Vertices.col(2) *= 0.3;
  for (unsigned int seed = 1; seed <= 10; ++seed)
  {
    surfaces.push_back(Tetrahedron(RandomCorners(seed)));
  }
  for (const double spread : { 2.0, 10.0, 100.0 })
  {
    for (const double ofDirections : { 1.0, 2.0 })
    {
      for (std::size_t k = 0; k < surfaces.size(); ++k)
      {
        const Surface& s = surfaces[k];
        SCOPED_TRACE(testing::Message() << k << ", " << spread << ", " << ofDirections);
        const Fronts fronts(s, true, spread, ofDirections);
        const std::vector<double> found = fronts.FromCorner(fronts.Mesh->InputTriangle()[0], 0);
        const auto expected = TimesOverGraph(*fronts.Mesh, fronts.Shapes,
          fronts.Mesh->TriangleVertices()(0, 0), s.NumberOfVertices() == 4 ? 150 : 40);
        const double unit = fronts.Mesh->LengthUnit();
        const double largest = unit * *std::max_element(expected.begin(), expected.end());
        for (std::size_t v = 0; v < expected.size(); ++v)
        {
          const auto i = static_cast<std::size_t>(fronts.Mesh->InputVertex()[v]);
          EXPECT_GE(found[i], unit * expected[v] - 0.01 * largest) << i;
          EXPECT_LE(found[i], unit * expected[v] + 0.03 * largest) << i;
        }
      }
    }
  }
}

// Ways turn at the corners of open surfaces, and go through no edge that has no triangle behind it.
TEST(EikonalDistance, OfFewOpenTrianglesIsThatOfStraightLines)
{
  struct Case
  {
    Surface Shape;
    Index Target; ///< from corner 0 of the first triangle
    double Exact;
  };
  const Case cases[] = {
    { MakeSurface({ { .04, .1, 0 }, { .01, .83, 0 }, { .99, .27, 0 }, { .47, .03, 0 } },
        { { 0, 3, 1 }, { 3, 2, 1 } }),
      2, std::hypot(.95, .17) },
    { MakeSurface(
        { { -4, 3, 0 }, { 0, 0, 0 }, { 4, 3, 0 }, { -4, 2, 0 }, { 0, -1.2, 0 }, { 4, 2, 0 } },
        { { 0, 3, 1 }, { 3, 4, 1 }, { 1, 4, 5 }, { 1, 5, 2 } }),
      2, 10.0 },
    { MakeSurface(
        { { 0, 0, 0 }, { -1, 1, 0 }, { 1, 1, 0 }, { 0, 3, 0 }, { -1.5, .5, 0 }, { 1.5, .5, 0 } },
        { { 0, 1, 4 }, { 0, 5, 2 }, { 1, 2, 3 } }),
      3, std::sqrt(2.0) + std::sqrt(5.0) },
  };
  for (const Case& one : cases)
  {
    for (const bool withSpeeds : { false, true })
    {
      const double found = Fronts(Rotated(one.Shape), withSpeeds)
                             .FromCorner(0, 0)[static_cast<std::size_t>(one.Target)];
      EXPECT_GE(found, one.Exact * 0.99);
      EXPECT_LE(found, one.Exact * 1.01);
    }
  }
}

// Points within a large triangle, and a line across it, are where they are after it was cut.
TEST(EikonalDistance, OfPiecesWithinLargeTrianglesIsExactInAPlane)
{
  const Surface square = Rotated(MakeSurface(
    { { 0, 0, 0 }, { 1, 0, 0 }, { 1, 1, 0 }, { 0, 1, 0 } }, { { 0, 1, 2 }, { 0, 2, 3 } }));
  const Fronts fronts(square);
  EXPECT_GT(fronts.Solver->NumberOfVertices(), 100);
  const std::array<double, 3> place = { 0.2, 0.31, 0.49 };
  const Eigen::RowVector3d x =
    0.2 * square.Vertices.row(0) + 0.31 * square.Vertices.row(1) + 0.49 * square.Vertices.row(2);
  const std::vector<double> fromPoint = fronts.From({ { 0, place, place, 0, 0, 0 } });
  for (std::size_t i = 0; i < 4; ++i)
  {
    const double exact = (square.Vertices.row(static_cast<Eigen::Index>(i)) - x).norm();
    EXPECT_NEAR(fromPoint[i], exact, 1e-3 * exact);
  }
  // From the middle of the side at the bottom to the corner at the top
  const std::vector<double> fromLine =
    fronts.From({ { 0, { 0.5, 0.5, 0.0 }, { 0.0, 0.0, 1.0 }, 0, 1, 0 } });
  const double side = 0.5 / std::hypot(0.5, 1.0);
  EXPECT_NEAR(fromLine[0], 0.5, 1e-3);
  EXPECT_NEAR(fromLine[1], side, 1e-3);
  EXPECT_NEAR(fromLine[2], 0.0, 1e-12);
  EXPECT_NEAR(fromLine[3], 2.0 * side, 1e-3);
}

TEST(EikonalDistance, OfAVertexOfANeedleStartsThere)
{
  // A square whose first triangle is a needle along a side
  const Surface square =
    MakeSurface({ { 0x1.3354e5cd91044p+1, 0x1.b434ace141e0bp-1, -0x1.845dfb84c94bbp-3 },
                  { 0x1.df52ce91b9c8bp+0, 0x1.5f24c24bb8ce0p-6, -0x1.d64df5f74bfd0p-7 },
                  { 0x1.5c37030f31fc0p+1, -0x1.f25b1be39237ep-2, 0x1.167ede4f45c25p-3 },
                  { 0x1.9fe28193e61bep+1, 0x1.601bf1ba35fcap-2, -0x1.41e8f7583b264p-5 },
                  { 0x1.1961ae216e6b1p+1, 0x1.112333117526ap-1, -0x1.f56a841ce71d2p-4 } },
      { { 0, 4, 1 }, { 0, 1, 2 }, { 0, 2, 3 } });
  const std::vector<double> found = Fronts(square).FromCorner(0, 0);
  EXPECT_EQ(found[0], 0.0);
  EXPECT_NEAR(found[1], 1.0, 1e-3);
  EXPECT_NEAR(found[3], 1.0, 1e-3);
}

// A small part beside a large one is refined by its own size.
TEST(EikonalDistance, OfPartsDoesNotDependOnOtherParts)
{
  const Surface small = Tetrahedron(0.001 * RandomCorners(7));
  const std::vector<double> alone = Fronts(small).FromCorner(0, 0);
  const std::vector<double> beside =
    Fronts(Joined(small, Moved(Icosphere(4), { 9.0, 0.0, 0.0 }))).FromCorner(0, 0);
  for (std::size_t i = 0; i < 4; ++i)
  {
    EXPECT_NEAR(beside[i], alone[i], 1e-12);
    EXPECT_GT(beside[i] + (i == 0 ? 1.0 : 0.0), 0.0);
  }
  EXPECT_EQ(beside.back(), Never);
}

TEST(EikonalDistance, OfFineSurfacesIsThatOfTheirOwnTriangles)
{
  const Fronts fronts(Icosphere(4));
  EXPECT_EQ(fronts.Solver->NumberOfVertices(), fronts.Mesh->NumberOfVertices());
  const auto expected = GeodesicDistance(fronts.Delaunay).Find({ { 5, 0.0, 0, 0, 0.0 } }, Never);
  GeodesicDistance::Memory memory(fronts.Solver->NumberOfVertices());
  const auto found = fronts.Solver->FindNear(5, Never, memory);
  ASSERT_EQ(found.size(), expected.Times.size());
  for (const auto& [vertex, time] : found)
  {
    EXPECT_EQ(time, expected.Times[static_cast<std::size_t>(vertex)]);
  }
}
