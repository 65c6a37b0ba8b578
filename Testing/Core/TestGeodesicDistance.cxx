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
                   : MakeFrontShapes(*mesh, ofMesh, TangentVectors(0, 2), 1.0, 1.0));
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

/// The mean error of great circles from a vertex, over the radius.
double ErrorOnSphere(int subdivisions, Index source = 5)
{
  constexpr double radius = 2.0;
  const Surface s = Icosphere(subdivisions, radius);
  const Found found = Find(s, { { source } });
  double sum = 0.0;
  for (Index i = 0; i < s.NumberOfVertices(); ++i)
  {
    const double cosine = s.Vertices.row(i).dot(s.Vertices.row(source)) / (radius * radius);
    sum += std::abs(found.Times[i] / radius - std::acos(std::max(-1.0, std::min(1.0, cosine))));
  }
  return sum / s.NumberOfVertices();
}

} // namespace

TEST(GeodesicDistance, OnASphereIsThatOfGreatCircles)
{
  const double coarse = ErrorOnSphere(3);
  const double fine = ErrorOnSphere(5);
  EXPECT_GT(coarse / fine, 3.5) << coarse << ", " << fine;
  EXPECT_LT(fine, 0.005 * Pi) << "of the largest distance";
}

// Straight lines from one point cross the edges of flat triangles: no error but round-off. Some
// ways of obtuse triangles go along an edge.
TEST(GeodesicDistance, InAPlaneIsExact)
{
  const Surface plate = Rotated(Plate(20, 3.0));
  for (const bool delaunay : { false, true })
  {
    const Found found = Find(plate, { { 137 } }, {}, Never, delaunay);
    for (Index i = 0; i < plate.NumberOfVertices(); ++i)
    {
      EXPECT_NEAR(found.Times[i], (plate.Vertices.row(i) - plate.Vertices.row(137)).norm(), 1e-12);
    }
  }
  const Surface irregular = Jittered(Plate(20, 3.0), 0.1, -2.99, 2.99, -2.99, 2.99);
  const Found found = Find(irregular, { { 137 } }, {}, Never, true);
  for (Index i = 0; i < irregular.NumberOfVertices(); ++i)
  {
    const double exact = (irregular.Vertices.row(i) - irregular.Vertices.row(137)).norm();
    EXPECT_NEAR(found.Times[i], exact, 1e-3 * exact);
  }
}

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

// The front of a whole side is plane.
TEST(GeodesicDistance, FromALineIsExactInAPlane)
{
  const Surface strip = Strip(30, 12, 5.0, 2.0);
  std::vector<Start> side;
  for (Index j = 0; j <= 12; ++j)
  {
    side.push_back({ 31 * j });
  }
  const Found found = Find(strip, side);
  for (Index i = 0; i < strip.NumberOfVertices(); ++i)
  {
    EXPECT_NEAR(found.Times[i], strip.Vertices(i, 0), 1e-12);
  }
}

// A plane front across two speeds: times add up. A point source: Fermat's principle.
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
  std::vector<Start> side;
  for (Index j = 0; j <= rows; ++j)
  {
    side.push_back({ (columns + 1) * j });
  }
  const Found plane = Find(strip, side, slowness);
  for (Index i = 0; i < strip.NumberOfVertices(); ++i)
  {
    const double x = strip.Vertices(i, 0);
    EXPECT_NEAR(plane.Times[i], x < 1.0 ? x : 1.0 + 3.0 * (x - 1.0), 1e-12);
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
  const GeodesicDistance fronts(mesh, MakeFrontShapes(*mesh, {}, ofMesh, 8.0, 0.5));
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

TEST(GeodesicDistance, StartTimesAreAdded)
{
  const Surface s = Torus(30, 16);
  const Found plain = Find(s, { { 11 } });
  const Found later = Find(s, { { 11, 2.5 } });
  for (Index i = 0; i < s.NumberOfVertices(); ++i)
  {
    EXPECT_NEAR(later.Times[i], plain.Times[i] + 2.5, 1e-12);
  }
}

TEST(GeodesicDistance, GoesAroundBarriersAndNotBeyondTheCutoff)
{
  const Index cells = 40;
  const Surface plate = Plate(cells, 1.0);
  std::vector<double> slowness(static_cast<std::size_t>(plate.NumberOfTriangles()), 1.0);
  for (Index t = 0; t < plate.NumberOfTriangles(); ++t)
  {
    const Eigen::RowVector3d middle =
      (plate.Vertices.row(plate.Faces(t, 0)) + plate.Vertices.row(plate.Faces(t, 1)) +
        plate.Vertices.row(plate.Faces(t, 2))) /
      3.0;
    if (std::abs(middle[0]) < 0.05 && middle[1] < 0.5)
    {
      slowness[static_cast<std::size_t>(t)] = Never;
    }
  }
  const auto at = [&](double x, double y)
  {
    return static_cast<Index>(
      std::lround((y + 1.0) * 0.5 * cells) * (cells + 1) + std::lround((x + 1.0) * 0.5 * cells));
  };
  const Found around = Find(plate, { { at(-0.5, 0.0) } }, slowness);
  const double corner = std::hypot(0.45, 0.5);
  EXPECT_NEAR(around.Times[at(0.5, 0.0)], 2.0 * corner + 0.1, 0.01);
  EXPECT_NEAR(around.Times[at(-0.5, 0.7)], 0.7, 1e-12);
  EXPECT_EQ(around.Times[at(0.0, -0.5)], Never);

  const Found near = Find(plate, { { at(0.0, 0.0) } }, {}, 0.5);
  const Found far = Find(plate, { { at(0.0, 0.0) } });
  for (Index i = 0; i < plate.NumberOfVertices(); ++i)
  {
    EXPECT_EQ(near.Times[i], far.Times[i] <= 0.5 ? far.Times[i] : Never);
  }
}

TEST(GeodesicDistance, IsInfiniteOnPartsWithoutASource)
{
  const Surface s = Joined(Icosphere(1), Moved(Icosphere(1), { 5.0, 0.0, 0.0 }));
  const Found found = Find(s, { { 0 } });
  for (Index i = 0; i < 42; ++i)
  {
    EXPECT_LT(found.Times[i], 4.0);
    EXPECT_EQ(found.Times[42 + i], Never);
    EXPECT_EQ(found.Labels[42 + i], -1);
  }
  for (const double time : Find(s, {}).Times)
  {
    EXPECT_EQ(time, Never);
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
