// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Geodesics/GeodesicDistance.h"
#include "Core/Surface/IntrinsicDelaunay.h"
#include "Core/Surface/TangentVectors.h"
#include "Meshes.h"

#include <gtest/gtest.h>

using namespace SurfaceDiffusion;
using namespace SurfaceDiffusion::Testing;

namespace
{

/// Times per point of the surface, in its unit, from sources at points with start times and labels.
struct Found
{
  std::vector<double> Times;
  std::vector<Index> Labels;
};

struct Start
{
  Index Point;
  double Time = 0.0;
  Index Label = 0;
};

Found Find(const Surface& s, const std::vector<Start>& starts,
  const std::vector<double>& slowness = {}, double cutoff = Never, bool delaunay = false,
  bool nearest = false)
{
  auto mesh = MakeMesh(s);
  const double unit = mesh->LengthUnit();
  std::vector<Index> vertexOf(static_cast<std::size_t>(s.NumberOfVertices()), -1);
  for (Index i = 0; i < mesh->NumberOfVertices(); ++i)
  {
    vertexOf[mesh->InputVertex()[i]] = i;
  }
  std::vector<FrontSource> sources;
  for (const Start& start : starts)
  {
    const double time = start.Time / unit;
    sources.push_back({ vertexOf[start.Point], time, start.Label, start.Point, time });
  }
  std::vector<double> ofMesh;
  for (Index t = 0; !slowness.empty() && t < mesh->NumberOfTriangles(); ++t)
  {
    ofMesh.push_back(slowness[mesh->InputTriangle()[t]]);
  }
  const auto inputVertex = mesh->InputVertex();
  if (delaunay)
  {
    mesh = IntrinsicDelaunay(mesh, SerialFor(), ProgressMonitor(), BoundaryEdges::Keep).Mesh();
  }
  const GeodesicDistance fronts(mesh,
    ofMesh.empty() ? FrontShapes()
                   : MakeFrontShapes(*mesh, ofMesh, TangentVectors(0, 2), { 1.0 }, { 1.0 }));
  const auto arrival = nearest ? fronts.FindNearest(sources) : fronts.Find(sources, cutoff / unit);
  Found found{ std::vector<double>(vertexOf.size(), Never),
    std::vector<Index>(vertexOf.size(), -1) };
  for (std::size_t i = 0; i < inputVertex.size(); ++i)
  {
    found.Times[inputVertex[i]] = arrival.Times[i] * unit;
    const Index source = arrival.Sources[i];
    found.Labels[inputVertex[i]] = source < 0 ? -1 : sources[source].Label;
  }
  return found;
}

} // namespace

// No way is shorter than a straight line, although angles at the boundary are obtuse.
TEST(GeodesicDistance, WaysInAPlaneDoNotLeaveIt)
{
  Surface slanted = Plate(12, 1.0);
  slanted.Vertices.col(0) += 2.0 * slanted.Vertices.col(1);
  const Surface triangles =
    MakeSurface({ { 0, 0, 0 }, { 1, 0, 0 }, { 0.2, 1, 0 }, { 0.4, 0.05, 0 } },
      { { 0, 1, 3 }, { 1, 2, 3 }, { 2, 0, 3 } });
  for (const Surface& s : { slanted, triangles })
  {
    for (Index source = 0; source < s.NumberOfVertices(); ++source)
    {
      const Found found = Find(s, { { source } }, {}, Never, true);
      for (Index i = 0; i < s.NumberOfVertices(); ++i)
      {
        EXPECT_GE(found.Times[i], (s.Vertices.row(i) - s.Vertices.row(source)).norm() - 1e-12);
      }
    }
  }
  const Found found = Find(triangles, { { 3 } }, {}, Never, true);
  for (Index i = 0; i < 3; ++i)
  {
    EXPECT_NEAR(
      found.Times[i], (triangles.Vertices.row(i) - triangles.Vertices.row(3)).norm(), 1e-14);
  }
}

// From one end of the short diagonal of a kite of two triangles, on which the heat method is wrong
// by a quarter.
TEST(GeodesicDistance, OnAKiteOfTwoTrianglesIsExact)
{
  const Surface kite = MakeSurface(
    { { 0, 0, 0 }, { 1, -3, 0 }, { 2, 0, 0 }, { 1, 3, 0 } }, { { 0, 1, 2 }, { 0, 2, 3 } });
  const Found fromCorner = Find(kite, { { 2 } });
  EXPECT_NEAR(fromCorner.Times[0], 2.0, 1e-14);
  EXPECT_NEAR(fromCorner.Times[1], std::sqrt(10.0), 1e-14);
  EXPECT_EQ(fromCorner.Times[2], 0.0);
  EXPECT_NEAR(fromCorner.Times[3], std::sqrt(10.0), 1e-14);
  EXPECT_NEAR(Find(kite, { { 1 } }).Times[3], 6.0, 1e-14);
}

// Fermat's principle
TEST(GeodesicDistance, OfTwoSpeedsIsRefracted)
{
  const Index columns = 60, rows = 60;
  const Surface strip = Strip(columns, rows, 2.0, 2.0);
  std::vector<double> slowness;
  for (Index t = 0; t < strip.NumberOfTriangles(); ++t)
  {
    const double x = (strip.Vertices(strip.Faces(t, 0), 0) + strip.Vertices(strip.Faces(t, 1), 0) +
                       strip.Vertices(strip.Faces(t, 2), 0)) /
      3.0;
    slowness.push_back(x < 1.0 ? 1.0 : 3.0);
  }
  const Found point = Find(strip, { { 0 } }, slowness);
  double largest = 0.0;
  for (Index i = 0; i < strip.NumberOfVertices(); ++i)
  {
    const double x = strip.Vertices(i, 0), y = strip.Vertices(i, 1);
    if (x < 1.0)
    {
      continue;
    }
    double best = Never;
    for (Index k = 0; k <= 20000; ++k) // where the way crosses x = 1
    {
      const double at = 1e-4 * k;
      best = std::min(best, std::hypot(1.0, at) + 3.0 * std::hypot(x - 1.0, y - at));
    }
    largest = std::max(largest, std::abs(point.Times[i] - best) / best);
  }
  EXPECT_LT(largest, 0.01);
}

// Speeds of 16:1 give edges lengths that differ much between their triangles. Fronts end nevertheless.
TEST(GeodesicDistance, OfVeryDifferentSpeedsByDirectionEnds)
{
  const Surface torus = Torus(60, 30, 2.0, 0.8);
  const auto mesh = MakeMesh(torus);
  Points directions(torus.Faces.rows(), 3);
  for (Eigen::Index f = 0; f < torus.Faces.rows(); ++f)
  {
    const Eigen::RowVector3d x = torus.Vertices.row(torus.Faces(f, 0));
    directions.row(f) = Eigen::RowVector3d(0.3, -0.2, 1.0).cross(x);
  }
  const TangentVectors ofMesh =
    TangentVectorsFromTriangleVectors(*mesh, torus.Vertices, torus.Faces, directions);
  const GeodesicDistance fronts(mesh, MakeFrontShapes(*mesh, {}, ofMesh, { 8.0 }, { 0.5 }));
  const auto arrival = fronts.Find({ { 5, 0.0, 0, 0, 0.0 } }, Never);
  for (const double time : arrival.Times)
  {
    EXPECT_TRUE(time >= 0.0 && time < Never);
  }
}

// Each label arrives as if it were alone, also beside the lines where labels meet.
TEST(GeodesicDistance, LabelsAreThoseOfTheNearestSource)
{
  for (const Surface& s :
    { Icosphere(4), Jittered(Plate(30, 1.0), 0.012, -0.99, 0.99, -0.99, 0.99) })
  {
    const std::vector<Index> points = { 3, 300, 777, 500, 222, 301 };
    std::vector<Start> starts;
    std::vector<Found> alone;
    for (const Index point : points)
    {
      starts.push_back(
        { point, 0.1 * static_cast<double>(starts.size() % 2), static_cast<Index>(starts.size()) });
      alone.push_back(Find(s, { starts.back() }));
    }
    const Found all = Find(s, starts, {}, Never, false, true);
    for (Index i = 0; i < s.NumberOfVertices(); ++i)
    {
      double nearest = Never;
      for (const Found& one : alone)
      {
        nearest = std::min(nearest, one.Times[i]);
      }
      EXPECT_EQ(all.Times[i], nearest);
      EXPECT_EQ(alone[all.Labels[i]].Times[i], nearest);
    }
  }
}

TEST(GeodesicDistance, IsNotBeyondTheCutoff)
{
  const Surface plate = Plate(40, 1.0);
  const Index middle = 20 * 41 + 20;
  const Found near = Find(plate, { { middle } }, {}, 0.5);
  const Found far = Find(plate, { { middle } });
  for (Index i = 0; i < plate.NumberOfVertices(); ++i)
  {
    EXPECT_EQ(near.Times[i], far.Times[i] <= 0.5 ? far.Times[i] : Never);
  }
}

TEST(GeodesicDistance, IsThatOfTheSurfaceRotatedAndRenumbered)
{
  const Surface s = Torus(24, 12);
  const std::vector<Index> numbers = Permutation(s.NumberOfVertices(), 4);
  const Found expected = Find(s, { { 17 } });
  const Found found = Find(Renumbered(Rotated(s, 2.0), numbers), { { numbers[17] } });
  for (Index i = 0; i < s.NumberOfVertices(); ++i)
  {
    EXPECT_NEAR(found.Times[numbers[i]], expected.Times[i], 1e-9);
  }
}
