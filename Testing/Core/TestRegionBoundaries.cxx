// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Geometry/RegionBoundaries.h"
#include "Meshes.h"

#include <gtest/gtest.h>

using namespace SurfaceDiffusion;
using namespace SurfaceDiffusion::Testing;

namespace
{

/// One column per function of the place.
template <typename... F>
Values Regions(const Surface& s, const F&... functions)
{
  Values u(s.NumberOfVertices(), static_cast<Eigen::Index>(sizeof...(functions)));
  for (Index i = 0; i < s.NumberOfVertices(); ++i)
  {
    const Eigen::RowVector3d x = s.Vertices.row(i);
    Eigen::Index k = 0;
    ((u(i, k++) = functions(x)), ...);
  }
  return u;
}

double TotalLength(const RegionBoundaries& found)
{
  double length = 0.0;
  for (const RegionBoundary& curve : found.Curves)
  {
    length += curve.Length;
  }
  return length;
}

} // namespace

TEST(RegionBoundaries, OfLinearFunctionsAreExact)
{
  const Surface s = Jittered(Plate(12, 1.0), 0.03, -0.99, 0.99, -0.99, 0.99);
  const Values u = Regions(
    s, [](const auto& x) { return x[0] + 0.3 * x[1] - 0.1; }, [](const auto&) { return 0.0; });
  const RegionBoundaries found = FindRegionBoundaries(s.Vertices, s.Faces, u);
  ASSERT_EQ(found.Curves.size(), 1u);
  const RegionBoundary& curve = found.Curves[0];
  EXPECT_EQ(curve.Regions, (std::array<Index, 2>{ 1, 2 }));
  EXPECT_NEAR(curve.Length, 2.0 * std::hypot(1.0, 0.3), 1e-12);
  for (const Index p : curve.Points)
  {
    EXPECT_NEAR(found.Points(p, 0) + 0.3 * found.Points(p, 1), 0.1, 1e-14);
  }
  EXPECT_NEAR(std::abs(found.Points(curve.Points.front(), 1)), 1.0, 1e-14);
  EXPECT_NEAR(std::abs(found.Points(curve.Points.back(), 1)), 1.0, 1e-14);
  const Vector areas = RegionAreas(s.Vertices, s.Faces, u, Vector());
  EXPECT_NEAR(areas[0], 2.0 * 0.9, 1e-12);
  EXPECT_NEAR(areas[1], 2.0 * 1.1, 1e-12);
}

TEST(RegionBoundaries, ThreeLinearFunctionsMeetAtTheirJunction)
{
  // The largest of three gradients at 120 degrees: three half-lines from one point.
  const Surface s = Jittered(Plate(9, 1.0), 0.04, -0.99, 0.99, -0.99, 0.99);
  const auto towards = [](double degrees)
  {
    const double angle = degrees * Pi / 180.0;
    return [angle](const Eigen::RowVector3d& x)
    { return std::cos(angle) * (x[0] - 0.123) + std::sin(angle) * (x[1] + 0.077); };
  };
  const Values u = Regions(s, towards(20.0), towards(140.0), towards(260.0));
  const RegionBoundaries found = FindRegionBoundaries(s.Vertices, s.Faces, u);
  ASSERT_EQ(found.Curves.size(), 3u);
  for (const RegionBoundary& curve : found.Curves)
  {
    const Eigen::RowVector3d junction(0.123, -0.077, 0.0);
    const double distance = std::min((found.Points.row(curve.Points.front()) - junction).norm(),
      (found.Points.row(curve.Points.back()) - junction).norm());
    EXPECT_LT(distance, 1e-13);
    const Eigen::RowVector3d whole =
      found.Points.row(curve.Points.back()) - found.Points.row(curve.Points.front());
    EXPECT_NEAR(curve.Length, whole.norm(), 1e-12); // straight
  }
  EXPECT_NEAR(RegionAreas(s.Vertices, s.Faces, u, Vector()).sum(), 4.0, 1e-12);
}

TEST(RegionBoundaries, OfASphereIsAClosedCurveOfOrderTwo)
{
  std::vector<double> errors;
  for (const int subdivisions : { 3, 4, 5 })
  {
    const Surface s = Rotated(Icosphere(subdivisions));
    const Values u = Regions(
      s, [](const auto& x) { return x[2]; }, [](const auto&) { return 0.5; });
    const RegionBoundaries found = FindRegionBoundaries(s.Vertices, s.Faces, u);
    ASSERT_EQ(found.Curves.size(), 1u);
    EXPECT_EQ(found.Curves[0].Points.front(), found.Curves[0].Points.back());
    errors.push_back(std::abs(TotalLength(found) - 2.0 * Pi * std::sqrt(0.75)));
  }
  EXPECT_GT(ObservedOrder(errors[0], errors[1]), 1.8);
  EXPECT_GT(ObservedOrder(errors[1], errors[2]), 1.8);
}

TEST(RegionBoundaries, EveryPointIsInTwoSegmentsOfItsPairOnAClosedSurface)
{
  // Random values: curves end only where three regions or more meet.
  const Surface s = Rotated(Torus(30, 15));
  Values u(s.NumberOfVertices(), 6);
  for (Index i = 0; i < s.NumberOfVertices(); ++i)
  {
    for (int k = 0; k < 6; ++k)
    {
      u(i, k) = std::floor(6.0 * UniformRandom(1, k, i)); // with many ties
    }
  }
  const RegionBoundaries found = FindRegionBoundaries(s.Vertices, s.Faces, u);
  std::vector<int> ends(static_cast<std::size_t>(found.Points.rows()), 0);
  for (const RegionBoundary& curve : found.Curves)
  {
    EXPECT_LT(curve.Regions[0], curve.Regions[1]);
    if (curve.Points.front() != curve.Points.back())
    {
      ++ends[curve.Points.front()];
      ++ends[curve.Points.back()];
    }
  }
  for (const int count : ends)
  {
    EXPECT_TRUE(count == 0 || count >= 3) << count;
  }
  EXPECT_TRUE(found.Points.allFinite());
  const Vector one = Vector::Ones(s.NumberOfVertices());
  const Vector areas = RegionAreas(s.Vertices, s.Faces, u, one);
  const auto mesh = MakeMesh(s);
  const double unit = mesh->LengthUnit() * mesh->LengthUnit();
  EXPECT_NEAR(areas.sum(), mesh->ControlAreas().sum() * unit, 1e-9 * areas.sum());
}

TEST(RegionBoundaries, AreasFollowTheWeights)
{
  const Surface s = Plate(8, 1.0);
  const Values u = Regions(
    s, [](const auto& x) { return x[0] - 0.1; }, [](const auto&) { return 0.0; });
  Vector weights(s.NumberOfVertices());
  for (Index i = 0; i < weights.size(); ++i)
  {
    weights[i] = 2.0 + s.Vertices(i, 0);
  }
  const Vector areas = RegionAreas(s.Vertices, s.Faces, u, weights);
  EXPECT_NEAR(areas[0], 2.0 * (2.0 * 0.9 + 0.5 * (1.0 - 0.01)), 1e-12); // int of 2 + x
  EXPECT_NEAR(areas.sum(), 8.0, 1e-12);
}

TEST(RegionBoundaries, ComponentsAreThoseOfConnectedLabels)
{
  const Surface s = Joined(Icosphere(2), Icosphere(2));
  std::vector<Index> labels(static_cast<std::size_t>(s.NumberOfVertices()), 1);
  for (Index i = 0; i < s.NumberOfVertices(); ++i)
  {
    labels[i] = std::abs(s.Vertices(i, 2)) > 0.6 ? 2 : 1;
  }
  EXPECT_EQ(CountRegionComponents(s.Faces, labels, 3), (std::vector<Index>{ 2, 4, 0 }));
}
