// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Geodesics/GeodesicDistance.h"
#include "Core/Geodesics/HeatDistance.h"
#include "Core/Surface/IntrinsicDelaunay.h"
#include "MeshFiles.h"
#include "Meshes.h"

#include <gtest/gtest.h>

using namespace SurfaceDiffusion;
using namespace SurfaceDiffusion::Testing;

namespace
{

constexpr double Step = HeatDistance::UsualStep;

/// Distances on the intrinsic Delaunay triangulation of a surface, per point, in its unit.
class Distances
{
public:
  explicit Distances(const Surface& s, double m = Step, const ParallelFor& parallel = SerialFor())
    : Mesh(IntrinsicDelaunay(MakeMesh(s), parallel, ProgressMonitor(), BoundaryEdges::Keep).Mesh())
    , Heat(std::make_shared<const Assembler>(this->Mesh), m, parallel)
    , Points(s.NumberOfVertices())
    , VertexOf(static_cast<std::size_t>(s.NumberOfVertices()), -1)
  {
    for (Index i = 0; i < this->Mesh->NumberOfVertices(); ++i)
    {
      this->VertexOf[static_cast<std::size_t>(this->Mesh->InputVertex()[i])] = i;
    }
  }

  /// One column per set of points.
  Values From(const std::vector<std::vector<Index>>& sets) const
  {
    std::vector<std::vector<HeatSource>> sources;
    for (const auto& set : sets)
    {
      sources.emplace_back();
      for (const Index point : set)
      {
        sources.back().push_back({ this->VertexOf[static_cast<std::size_t>(point)] });
      }
    }
    const Values found = this->Heat.Find(sources) * this->Mesh->LengthUnit();
    Values all = Values::Constant(this->Points, found.cols(), Never);
    for (Index i = 0; i < this->Mesh->NumberOfVertices(); ++i)
    {
      all.row(this->Mesh->InputVertex()[i]) = found.row(i);
    }
    return all;
  }
  Vector From(Index point) const { return this->From({ { point } }).col(0); }

  Vector ByFronts(Index point) const
  {
    const Index v = this->VertexOf[static_cast<std::size_t>(point)];
    const auto times = GeodesicDistance(this->Mesh).Find({ { v, 0.0, 0, 0, 0.0 } }, Never).Times;
    Vector all = Vector::Constant(this->Points, Never);
    for (Index i = 0; i < this->Mesh->NumberOfVertices(); ++i)
    {
      all[this->Mesh->InputVertex()[i]] =
        times[static_cast<std::size_t>(i)] * this->Mesh->LengthUnit();
    }
    return all;
  }

private:
  std::shared_ptr<const TriangleMesh> Mesh;
  HeatDistance Heat;
  Index Points;
  std::vector<Index> VertexOf;
};

Vector GreatCircles(const Surface& sphere, Index from)
{
  return (sphere.Vertices * sphere.Vertices.row(from).transpose())
    .array()
    .max(-1.0)
    .min(1.0)
    .acos()
    .matrix();
}

} // namespace

// The heat has no slope on the face opposite the source, and round-off no direction.
TEST(HeatDistance, OnATetrahedronIsEqualAtTheOtherCorners)
{
  const Surface tetrahedron =
    MakeSurface({ { 1, 1, 1 }, { 1, -1, -1 }, { -1, 1, -1 }, { -1, -1, 1 } },
      { { 0, 2, 1 }, { 0, 1, 3 }, { 0, 3, 2 }, { 1, 2, 3 } });
  const Vector found = Distances(tetrahedron).From(0);
  EXPECT_GT(found[1], 1.0);
  EXPECT_NEAR(found[2], found[1], 1e-9);
  EXPECT_NEAR(found[3], found[1], 1e-9);
}

// The heat of many sources has gradients between them, where the distance is 0.
TEST(HeatDistance, FromARegionIsThatFromItsRim)
{
  const Surface s = Icosphere(4);
  const Vector angles = GreatCircles(s, 5);
  std::vector<Index> cap;
  for (Index i = 0; i < s.NumberOfVertices(); ++i)
  {
    if (angles[i] < 0.5)
    {
      cap.push_back(i);
    }
  }
  Vector exact = Vector::Constant(s.NumberOfVertices(), Never);
  for (const Index i : cap)
  {
    exact = exact.cwiseMin(GreatCircles(s, i));
  }
  const Vector found = Distances(s).From({ cap }).col(0);
  EXPECT_LT((found - exact).cwiseAbs().mean(), 0.01 * Pi);
  for (const Index i : cap)
  {
    EXPECT_NEAR(found[i], 0.0, 0.02);
  }
}

// The front of a whole side is plane but at the ends of the side, whose vertices have less area for
// the same heat.
TEST(HeatDistance, FromALineIsPlane)
{
  const Surface strip = Strip(60, 12, 5.0, 1.0);
  std::vector<Index> side;
  for (Index j = 0; j <= 12; ++j)
  {
    side.push_back(61 * j);
  }
  const Vector found = Distances(strip).From({ side }).col(0);
  for (Index i = 0; i < strip.NumberOfVertices(); ++i)
  {
    EXPECT_NEAR(found[i], strip.Vertices(i, 0), 0.3 * 5.0 / 60.0);
  }
}

// Heat is below the smallest number at the far end of a strip: 2,000 edges.
TEST(HeatDistance, ReachesWhereHeatUnderflows)
{
  const Surface strip = Strip(4000, 2, 4000.0, 2.0);
  const Vector found = Distances(strip).From(4001);
  EXPECT_NEAR(found[2 * 4001 - 1], 4000.0, 10.0);
  EXPECT_NEAR(found[4001 + 1000], 1000.0, 10.0);
}

TEST(HeatDistance, IsInfiniteOnPartsWithoutASource)
{
  const Surface s = Joined(Icosphere(2), Moved(Icosphere(2), { 5.0, 0.0, 0.0 }));
  const Vector found = Distances(s).From(0);
  const Vector alone = Distances(Icosphere(2)).From(0);
  for (Index i = 0; i < 162; ++i)
  {
    EXPECT_LT(found[i], 4.0);
    EXPECT_NEAR(found[i], alone[i], 1e-12);
    EXPECT_EQ(found[162 + i], Never);
  }
  EXPECT_EQ(found[0], 0.0);
}

// Columns are those of single solves, in panels of any size, and on any number of threads.
TEST(HeatDistance, OfSeveralSetsIsThatOfEach)
{
  const Surface s = Torus(40, 20);
  const Distances distances(s);
  std::vector<std::vector<Index>> sets;
  for (Index k = 0; k < 11; ++k)
  {
    sets.push_back({ 70 * k, 70 * k + 3 });
  }
  const Values all = distances.From(sets);
  for (std::size_t k = 0; k < sets.size(); ++k)
  {
    EXPECT_LT((all.col(k) - distances.From({ sets[k] }).col(0)).cwiseAbs().maxCoeff(), 1e-12);
  }
}

TEST(HeatDistance, IsThatOfTheSurfaceScaledRotatedAndRenumbered)
{
  const Surface s = Torus(24, 12);
  const std::vector<Index> numbers = Permutation(s.NumberOfVertices(), 4);
  const Vector expected = Distances(s).From(17);
  const Surface other = Renumbered(Rotated(Scaled(s, 1e30), 2.0), numbers);
  const Vector found = Distances(other).From(numbers[17]);
  for (Index i = 0; i < s.NumberOfVertices(); ++i)
  {
    EXPECT_NEAR(found[numbers[i]] * 1e-30, expected[i], 1e-9);
  }
}

// Of ten scans the mean difference from fronts, whose error is smaller, is below 1 % of the largest
// distance.
TEST(HeatDistance, OnScansIsNearThatOfFronts)
{
  if (!HaveMeshFiles())
  {
    GTEST_SKIP() << "SURFACEDIFFUSION_MESH_DIR is not set";
  }
  double sum = 0.0;
  const std::vector<std::string> scans = { "bunny00", "camel", "cow", "armadillo", "blade", "bear",
    "elephant", "homer", "ChineseDragon-10kv", "man" };
  for (const std::string& name : scans)
  {
    const Surface s = ReadMeshFile(name);
    const Distances distances(s);
    const Index from = s.Faces(s.NumberOfTriangles() / 3, 0);
    const Vector fronts = distances.ByFronts(from);
    const Vector heat = distances.From(from);
    double difference = 0.0, largest = 0.0;
    Index count = 0;
    for (Index i = 0; i < fronts.size(); ++i)
    {
      if (fronts[i] < Never)
      {
        difference += std::abs(heat[i] - fronts[i]);
        largest = std::max(largest, fronts[i]);
        ++count;
      }
    }
    sum += difference / count / largest;
  }
  EXPECT_LT(sum / static_cast<double>(scans.size()), 0.01);
}
