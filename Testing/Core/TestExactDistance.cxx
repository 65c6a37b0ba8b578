// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "ExactDistances.h"
#include "Hubs.h"
#include "Unfolding.h"

#include <gtest/gtest.h>

#include <cmath>

using namespace SurfaceDiffusion;
using namespace SurfaceDiffusion::Testing;

namespace
{

/// A point with coordinates from -1 to 1.
Eigen::RowVector3d RandomPoint(std::int64_t seed, Index i)
{
  return { 2.0 * UniformRandom(seed, 0, i) - 1.0, 2.0 * UniformRandom(seed, 1, i) - 1.0,
    2.0 * UniformRandom(seed, 2, i) - 1.0 };
}

/// A cylinder that is closed by two cones.
Surface Spindle(Index meridians, Index rings)
{
  Surface s{ Points(2 + meridians * rings, 3), Triangles(2 * meridians * rings, 3) };
  s.Vertices.topRows(2) << 0.0, 0.0, 2.0, 0.0, 0.0, -2.0;
  Index t = 0;
  for (Index k = 0; k < meridians; ++k)
  {
    const double angle = 2.0 * Pi * k / meridians;
    const Index last = meridians * (rings - 1);
    const Index i = 2 + k, j = 2 + (k + 1) % meridians;
    for (Index r = 0; r < rings; ++r)
    {
      s.Vertices.row(i + r * meridians) << std::cos(angle), std::sin(angle),
        1.0 - (2.0 * r + 1.0) / rings;
    }
    s.Faces.row(t++) << 0, i, j;
    s.Faces.row(t++) << 1, j + last, i + last;
    for (Index at = 0; at < last; at += meridians)
    {
      s.Faces.row(t++) << i + at, i + at + meridians, j + at + meridians;
      s.Faces.row(t++) << i + at, j + at + meridians, j + at;
    }
  }
  return s;
}

// What windows do at a hub depends on what lies behind its triangles: measured in seconds, 40,000 of a
// disk or a book take .02, 32,000 of a spindle with 4,000 meridians 4.
TEST(ExactDistance, TakesLongAtHubsOfClosedSurfacesAlone)
{
  const auto isShort = [](const Surface& s)
  { return ExactDistance::TakesAtMostASecond(*MakeMesh(s)); };
  EXPECT_TRUE(isShort(TrianglesAtAVertex(20000)));
  EXPECT_TRUE(isShort(TrianglesAtAVertex(40000)));
  EXPECT_TRUE(isShort(TrianglesAtAnEdge(40000)));
  EXPECT_FALSE(isShort(TrianglesAtAVertex(200000)));
  EXPECT_TRUE(isShort(Spindle(1000, 2)));
  EXPECT_TRUE(isShort(Spindle(100, 200)));
  EXPECT_FALSE(isShort(Spindle(4000, 4)));
  EXPECT_FALSE(isShort(Spindle(10000, 1)));
}

TEST(ExactDistance, VerticesOfATetrahedronAreAsFarAsItsEdgesAreLong)
{
  for (std::int64_t seed = 0; seed < 300; ++seed)
  {
    Surface s = Tetrahedron();
    for (Index i = 0; i < 4; ++i)
    {
      s.Vertices.row(i) = RandomPoint(seed, i);
    }
    const ExactOn on(s);
    for (Index i = 0; i < 4; ++i)
    {
      const auto found = on.From(i);
      for (Index j = 0; j < 4; ++j)
      {
        EXPECT_NEAR(found[j], (s.Vertices.row(i) - s.Vertices.row(j)).norm(), 1e-13)
          << "seed " << seed << ", from " << i << " to " << j;
      }
    }
  }
}

TEST(ExactDistance, NothingLiesBehindAnEdgeOfOneTriangle)
{
  const Surface s = MakeSurface(
    { { 0, 0, 0 }, { -1, 1, 0 }, { 1, 1, 0 }, { 0, 3, 0 }, { -1.5, .5, 0 }, { 1.5, .5, 0 } },
    { { 0, 1, 4 }, { 0, 5, 2 }, { 1, 2, 3 } });
  EXPECT_NEAR(ExactOn(s).From(0)[3], std::sqrt(2.0) + std::sqrt(5.0), 1e-13);
}

/// A plate whose inner vertices are moved at random, in a skew plane.
Surface RandomPlate(Index cells)
{
  Surface s = Plate(cells, 1.0);
  for (Index i = 0; i < s.NumberOfVertices(); ++i)
  {
    if (s.Vertices.row(i).cwiseAbs().maxCoeff() < 0.99)
    {
      s.Vertices.row(i).head(2) += 0.3 / cells * RandomPoint(7, i).head(2);
    }
  }
  return Rotated(s);
}

TEST(ExactDistance, DistancesInAConvexPieceOfAPlaneAreStraight)
{
  const Surface s = RandomPlate(12);
  const ExactOn on(s);
  for (Index k = 0; k < 12; ++k)
  {
    const Index triangle = 23 * k;
    const auto corner = [&](int a) { return s.Vertices.row(s.Faces(triangle, a)); };
    // Within a triangle, on an edge, beside a vertex; then lines within a triangle and along an edge
    const double tiny = std::pow(10.0, -static_cast<double>(k + 1));
    const std::array<double, 3> from[] = { { 0.2, 0.3, 0.5 }, { 0.25, 0.75, 0.0 },
      { 0.5 * tiny, 1.0 - tiny, 0.5 * tiny }, { tiny, 0.5, 0.5 - tiny } };
    const std::array<double, 3> to[] = { { 0.2, 0.3, 0.5 }, { 0.1, 0.1, 0.8 }, { 1.0, 0.0, 0.0 },
      { 0.4, 0.6, 0.0 } };
    for (const auto& a : from)
    {
      for (const auto& b : to)
      {
        const Eigen::RowVector3d first = a[0] * corner(0) + a[1] * corner(1) + a[2] * corner(2);
        const Eigen::RowVector3d last = b[0] * corner(0) + b[1] * corner(1) + b[2] * corner(2);
        const Eigen::RowVector3d along = last - first;
        const auto found = on.From({ on.At(triangle, a, b) });
        for (Index i = 0; i < s.NumberOfVertices(); ++i)
        {
          const Eigen::RowVector3d x = s.Vertices.row(i);
          const double square = along.squaredNorm();
          const double share =
            square > 0.0 ? std::clamp((x - first).dot(along) / square, 0.0, 1.0) : 0.0;
          ASSERT_NEAR(found[i], (x - first - share * along).norm(), 1e-11)
            << "triangle " << triangle << ", to " << i;
        }
      }
    }
  }
}

TEST(ExactDistance, WaysGoAroundAHoleByItsCorners)
{
  Surface s = Plate(12, 1.0); // without the square of half its size
  const double half = 0.5;
  std::vector<std::array<Index, 3>> kept;
  for (Index t = 0; t < s.NumberOfTriangles(); ++t)
  {
    const Eigen::RowVector3d middle =
      (s.Vertices.row(s.Faces(t, 0)) + s.Vertices.row(s.Faces(t, 1)) +
        s.Vertices.row(s.Faces(t, 2))) /
      3.0;
    if (middle.cwiseAbs().maxCoeff() > half)
    {
      kept.push_back({ s.Faces(t, 0), s.Faces(t, 1), s.Faces(t, 2) });
    }
  }
  s.Faces.resize(static_cast<Index>(kept.size()), 3);
  for (std::size_t t = 0; t < kept.size(); ++t)
  {
    s.Faces.row(static_cast<Index>(t)) << kept[t][0], kept[t][1], kept[t][2];
  }
  using Place = Eigen::RowVector2d;
  const auto sees = [&](const Place& a, const Place& b)
  {
    // The part of the line from a to b within the open square is empty.
    double from = 0.0, to = 1.0;
    for (int k = 0; k < 2; ++k)
    {
      const double way = b[k] - a[k];
      if (std::abs(way) < 1e-9)
      {
        from = std::abs(a[k]) >= half - 1e-9 ? 1.0 : from;
        continue;
      }
      const double in = (-half - a[k]) / way, out = (half - a[k]) / way;
      from = std::max(from, std::min(in, out));
      to = std::min(to, std::max(in, out));
    }
    return to - from < 1e-9;
  };
  const Place corners[] = { { half, half }, { -half, half }, { -half, -half }, { half, -half } };
  const auto distance = [&](const Place& a, const Place& b)
  {
    double least = sees(a, b) ? (a - b).norm() : Never;
    for (int first = 0; first < 4; ++first)
    {
      for (int turns = 0; turns < 3; ++turns)
      {
        for (const int side : { 1, 3 })
        {
          const int last = (first + side * turns) % 4;
          if (sees(a, corners[first]) && sees(corners[last], b))
          {
            least = std::min(
              least, (a - corners[first]).norm() + 2.0 * half * turns + (corners[last] - b).norm());
          }
        }
      }
    }
    return least;
  };
  const ExactOn on(s);
  for (Index i = 0; i < s.NumberOfVertices(); i += 5)
  {
    if (s.Vertices.row(i).cwiseAbs().maxCoeff() < half - 1e-9)
    {
      continue;
    }
    const auto found = on.From(i);
    for (Index j = 0; j < s.NumberOfVertices(); ++j)
    {
      const bool inHole = s.Vertices.row(j).cwiseAbs().maxCoeff() < half - 1e-9;
      const double right =
        inHole ? Never : distance(s.Vertices.row(i).head(2), s.Vertices.row(j).head(2));
      ASSERT_TRUE(found[j] == right || std::abs(found[j] - right) < 1e-12)
        << i << " to " << j << ": " << found[j] << ", not " << right;
    }
  }
}

/// Sectors around an apex, cut at radii 1 to `rings`. Vertex 1 + sector * rings + r is at radius r + 1.
/// height: of every second ray over the plane, by which the angles at the apex are 2 pi and more; below
/// 0: a cone, on which they are less.
Surface Sectors(Index sectors, Index rings, double height, double& angle)
{
  std::vector<Eigen::RowVector3d> points{ { 0, 0, 0 } };
  std::vector<std::array<Index, 3>> faces;
  for (Index k = 0; k < sectors; ++k)
  {
    const double turn = 2.0 * Pi * k / sectors;
    const double z = height < 0.0 || k % 2 == 0 ? height : -height;
    const Eigen::RowVector3d ray =
      Eigen::RowVector3d(std::cos(turn), std::sin(turn), z).normalized();
    const Index here = 1 + k * rings, next = 1 + (k + 1) % sectors * rings;
    faces.push_back({ 0, here, next });
    for (Index r = 0; r < rings; ++r)
    {
      points.emplace_back((r + 1.0) * ray);
      if (r > 0)
      {
        faces.push_back({ here + r - 1, here + r, next + r });
        faces.push_back({ here + r - 1, next + r, next + r - 1 });
      }
    }
  }
  angle = std::acos(points[1].dot(points[static_cast<std::size_t>(1 + rings)]));
  return MakeSurface(points, faces);
}

TEST(ExactDistance, DistancesAroundAnApexAreThoseOfItsSectorsInThePlane)
{
  for (const double height : { -2.0, -0.3, 0.0, 0.2, 1.0 })
  {
    constexpr Index sectors = 10, rings = 4;
    double angle = 0.0;
    const ExactOn on(Sectors(sectors, rings, height, angle));
    for (Index r = 0; r < rings; ++r)
    {
      const auto found = on.From(1 + r);
      EXPECT_NEAR(found[0], r + 1.0, 1e-13);
      for (Index k = 0; k < sectors; ++k)
      {
        for (Index q = 0; q < rings; ++q)
        {
          // Chords over the rim are ways only where they stay within it
          const double between = angle * std::min(k, sectors - k);
          const double a = r + 1.0, b = q + 1.0;
          const double right =
            between < Pi ? std::sqrt(a * a + b * b - 2.0 * a * b * std::cos(between)) : a + b;
          ASSERT_NEAR(found[1 + k * rings + q], right, 1e-12)
            << "height " << height << ", radii " << a << " and " << b << ", sector " << k;
        }
      }
    }
  }
}

TEST(ExactDistance, DistancesOnConvexPolyhedraAreTheShortestUnfoldedLines)
{
  for (const double stretch : { 1.0, 0.2, 4.0, 15.0 })
  {
    Surface s = Icosphere(0);
    s.Vertices.col(0) *= stretch;
    s.Vertices.col(1) *= std::sqrt(stretch);
    const ExactOn on(s);
    Unfolding unfolding(s);
    for (Index i = 0; i < s.NumberOfVertices(); ++i)
    {
      const auto found = on.From(i);
      const auto right = unfolding.From(i);
      for (Index j = 0; j < s.NumberOfVertices(); ++j)
      {
        ASSERT_NEAR(found[j], right[static_cast<std::size_t>(j)], 1e-12 * (1.0 + stretch))
          << "stretch " << stretch << ", from " << i << " to " << j;
      }
    }
  }
}

/// A strip whose ends are glued together after half a turn.
Surface MoebiusStrip(Index around, Index across)
{
  std::vector<Eigen::RowVector3d> points;
  std::vector<std::array<Index, 3>> faces;
  for (Index i = 0; i < around; ++i)
  {
    const double turn = 2.0 * Pi * i / around;
    for (Index j = 0; j <= across; ++j)
    {
      const double side = static_cast<double>(j) / across - 0.5;
      const double radius = 1.0 + side * std::cos(0.5 * turn);
      points.emplace_back(
        radius * std::cos(turn), radius * std::sin(turn), side * std::sin(0.5 * turn));
      if (j < across)
      {
        const auto at = [&](Index row, Index column)
        { return row < around ? row * (across + 1) + column : across - column; };
        faces.push_back({ at(i, j), at(i + 1, j), at(i + 1, j + 1) });
        faces.push_back({ at(i, j + 1), at(i, j), at(i + 1, j + 1) });
      }
    }
  }
  return MakeSurface(points, faces);
}

TEST(ExactDistance, DistancesAreAMetricAndTheSameOnAFinerMeshOfTheSurface)
{
  Surface rough = Icosphere(2);
  for (Index i = 0; i < rough.NumberOfVertices(); ++i)
  {
    rough.Vertices.row(i) *= 1.0 + 0.4 * UniformRandom(3, 0, i);
  }
  for (const Surface& s : { rough, MoebiusStrip(9, 2), Torus(8, 6), Joined(RandomPlate(4), rough) })
  {
    const ExactOn on(s), finer(Subdivided(s, 1));
    const Index n = s.NumberOfVertices();
    std::vector<ExactOn::Found> from;
    for (Index i = 0; i < n; ++i)
    {
      from.push_back(on.From(i));
    }
    for (Index i = 0; i < n; i += 5)
    {
      const auto fine = finer.From(i);
      for (Index j = 0; j < n; ++j)
      {
        const double here = from[static_cast<std::size_t>(i)][j];
        const double back = from[static_cast<std::size_t>(j)][i];
        ASSERT_TRUE(here == back || std::abs(here - back) < 1e-12) << i << " and " << j;
        ASSERT_TRUE(here == fine[j] || std::abs(here - fine[j]) < 1e-12) << i << " and " << j;
        for (Index k = 0; k < n; k += 3)
        {
          const double over =
            from[static_cast<std::size_t>(i)][k] + from[static_cast<std::size_t>(k)][j];
          if (std::isfinite(over))
          {
            ASSERT_LE(here - over, 1e-12);
          }
        }
      }
    }
  }
}

TEST(ExactDistance, TheNumberingAndTheSidesOfTrianglesDoNotMatter)
{
  Surface s = Torus(12, 10);
  s.Vertices.col(2) *= 3.0;
  Surface turned = s;
  for (Index t = 0; t < s.NumberOfTriangles(); t += 3)
  {
    std::swap(turned.Faces(t, 0), turned.Faces(t, 2));
  }
  const std::vector<Index> numbers = Permutation(s.NumberOfVertices(), 5);
  const auto found = ExactOn(s).From(7), other = ExactOn(turned).From(7);
  const auto renumbered = ExactOn(Renumbered(s, numbers)).From(numbers[7]);
  for (Index i = 0; i < s.NumberOfVertices(); ++i)
  {
    EXPECT_NEAR(found[i], other[i], 1e-13);
    EXPECT_NEAR(found[i], renumbered[numbers[static_cast<std::size_t>(i)]], 1e-13);
  }
}

TEST(ExactDistance, WaysGoOverAnEdgeOfManyTrianglesIntoEachOther)
{
  constexpr Index pages = 20000;
  std::vector<Eigen::RowVector3d> points{ { 0, 0, 0 }, { 0, 0, 1 } };
  std::vector<std::array<Index, 3>> faces;
  for (Index k = 0; k < pages; ++k)
  {
    const double turn = 2.0 * Pi * k / pages;
    points.emplace_back(std::cos(turn), std::sin(turn), 0.25);
    faces.push_back({ 0, 1, k + 2 });
  }
  const ExactOn on(MakeSurface(points, faces));
  const auto found = on.From(2);
  const auto within = on.From({ on.At(7, { 0.5, 0.0, 0.5 }, { 0.5, 0.0, 0.5 }) });
  for (Index k = 1; k < pages; ++k)
  {
    EXPECT_NEAR(found[k + 2], 2.0, 1e-12); // over the spine, unfolded
    if (k != 7)
    {
      EXPECT_NEAR(within[k + 2], std::hypot(1.5, 0.125), 1e-12);
    }
  }
}

TEST(ExactDistance, DistancesAroundAVertexOfManyTrianglesAreChords)
{
  constexpr Index slices = 20000;
  double angle = 0.0;
  const Surface s = Sectors(slices, 1, 0.0, angle);
  const auto found = ExactOn(s).From(1);
  for (Index i = 0; i < s.NumberOfVertices(); ++i)
  {
    ASSERT_NEAR(found[i], (s.Vertices.row(i) - s.Vertices.row(1)).norm(), 1e-10);
  }
}

TEST(ExactDistance, WaysGoThroughAVertexThatJoinsTwoParts)
{
  // Two squares at a corner, and a third one apart
  const Surface s = MakeSurface({ { 0, 0, 0 }, { 1, 0, 0 }, { 1, 1, 0 }, { 0, 1, 0 }, { 2, 1, 0 },
                                  { 2, 2, 0 }, { 1, 2, 0 }, { 5, 0, 0 }, { 6, 0, 0 }, { 5, 1, 0 } },
    { { 0, 1, 2 }, { 0, 2, 3 }, { 2, 4, 5 }, { 2, 5, 6 }, { 7, 8, 9 } });
  const auto found = ExactOn(s).From(1);
  EXPECT_NEAR(found[4], 2.0, 1e-13);
  EXPECT_NEAR(found[5], 1.0 + std::sqrt(2.0), 1e-13);
  EXPECT_EQ(found[7], Never);
  EXPECT_EQ(found.Sources[7], -1);
}

TEST(ExactDistance, TheNearestOfSeveralSourcesIsNamed)
{
  const Surface s = RandomPlate(10);
  const ExactOn on(s);
  const std::vector<SourcePiece> pieces{ on.At(5), on.At(30, { 0.2, 0.2, 0.6 }, { 0.2, 0.2, 0.6 }),
    on.At(111), on.At(160, { 0.1, 0.2, 0.7 }, { 0.5, 0.5, 0.0 }) };
  const auto all = on.From(pieces);
  std::vector<ExactOn::Found> alone;
  for (const SourcePiece& piece : pieces)
  {
    alone.push_back(on.From({ piece }));
  }
  constexpr double cutoff = 0.4;
  const auto cut = on.From(pieces, cutoff);
  for (Index i = 0; i < s.NumberOfVertices(); ++i)
  {
    double least = Never;
    for (const auto& one : alone)
    {
      least = std::min(least, one[i]);
    }
    EXPECT_NEAR(all[i], least, 1e-13);
    const auto source = static_cast<std::size_t>(all.Sources[static_cast<std::size_t>(i)]);
    EXPECT_NEAR(alone[source][i], least, 1e-13);
    EXPECT_EQ(cut[i], least <= cutoff ? all[i] : Never);
  }
}

TEST(ExactDistance, DistancesNearOneSourceAfterAnotherAreThoseOfEach)
{
  const Surface s = Icosphere(4);
  const ExactOn on(s);
  const auto mesh = std::make_shared<const TriangleMesh>(s.Vertices, s.Faces);
  const ExactDistance exact(mesh);
  const double cutoff = 0.3 / mesh->LengthUnit();
  ExactDistance::Memories memories;
  for (const Index source : { 5, 100, 6, 5 })
  {
    const auto near = exact.FindNear(on.At(source), cutoff, memories);
    const std::vector<double> all = exact.Find({ on.At(source) }, cutoff).Times;
    std::size_t reached = 0;
    for (Index i = 0; i < mesh->NumberOfVertices(); ++i)
    {
      const double time = all[static_cast<std::size_t>(i)];
      if (time < Never)
      {
        ASSERT_LT(reached, near.size());
        EXPECT_EQ(near[reached], std::make_pair(i, time));
        ++reached;
      }
    }
    EXPECT_EQ(reached, near.size());
  }
  EXPECT_EQ(memories.Free.size(), 1u);
  const ProgressMonitor::Callback stop = [](double) { return false; };
  EXPECT_THROW(exact.FindNear(on.At(5), Never, memories, ProgressMonitor(stop)), Aborted);
}

TEST(ExactDistance, WorkEndsOnNeedlesAndAtARequest)
{
  // A tube of width 1e-6 and length 1, with triangles of all directions and edges of three
  std::vector<Eigen::RowVector3d> points;
  for (Index i = 0; i < 12; ++i)
  {
    points.emplace_back(1e-6 * RandomPoint(2, i));
    points.back()[2] *= 1e6;
  }
  std::vector<std::array<Index, 3>> faces;
  for (Index i = 0; i < 12; ++i)
  {
    faces.push_back({ i, (i + 1) % 12, (i + 5) % 12 });
    faces.push_back({ i, (i + 4) % 12, (i + 9) % 12 });
  }
  const ExactOn on(MakeSurface(points, faces));
  for (Index i = 0; i < 12; ++i)
  {
    const auto found = on.From(i);
    for (Index j = 0; j < 12; ++j)
    {
      EXPECT_GE(found[j],
        (points[static_cast<std::size_t>(i)] - points[static_cast<std::size_t>(j)]).norm() - 1e-12);
      EXPECT_NEAR(found[j], on.From(j)[i], 1e-11);
    }
  }
  const ExactOn sphere(Icosphere(5));
  Index calls = 0;
  const ProgressMonitor::Callback stop = [&](double) { return ++calls < 3; };
  EXPECT_THROW(sphere.From({ sphere.At(0) }, Never, ProgressMonitor(stop)), Aborted);
  EXPECT_EQ(calls, 3);
}

} // namespace
