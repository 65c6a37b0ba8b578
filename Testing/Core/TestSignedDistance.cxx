// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Meshes.h"
#include "Run/Solve.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <string>
#include <vector>

using namespace SurfaceDiffusion;
using namespace SurfaceDiffusion::Testing;

namespace
{

using Shape = Testing::Surface;

Solution ToRegion(const Shape& s, const std::function<bool(const Eigen::RowVector3d&)>& isInside,
  DistanceMethod method = DistanceMethod::Automatic)
{
  SurfaceData data;
  data.Data.Values = Values::Zero(s.Vertices.rows(), 1);
  for (Index i = 0; i < s.NumberOfVertices(); ++i)
  {
    data.Data.Values(i, 0) = isInside(s.Vertices.row(i)) ? 3.0 : 0.0;
  }
  DistanceSettings settings;
  settings.Method = method;
  settings.Signed = true;
  return Distance(s.Vertices, s.Faces, data, settings);
}

/// To the closed line through these places.
Solution ToCurve(
  const Shape& s, const std::vector<Eigen::RowVector3d>& places, bool isClosed = true)
{
  auto shapes = std::make_shared<SourceShapes>();
  const auto count = static_cast<Index>(places.size());
  shapes->Places.resize(count, 3);
  for (Index k = 0; k < count; ++k)
  {
    shapes->Places.row(k) = places[static_cast<std::size_t>(k)];
    if (isClosed || k + 1 < count)
    {
      shapes->Segments.push_back({ k, (k + 1) % count });
    }
  }
  SurfaceData data;
  data.Sources = shapes;
  DistanceSettings settings;
  settings.Signed = true;
  return Distance(s.Vertices, s.Faces, data, settings);
}

/// The mean and the largest error, as parts of the largest distance.
std::pair<double, double> ErrorOf(const Solution& found, const Shape& s,
  const std::function<double(const Eigen::RowVector3d&)>& right)
{
  double sum = 0.0, most = 0.0, largest = 0.0;
  for (Index i = 0; i < s.NumberOfVertices(); ++i)
  {
    const double exact = right(s.Vertices.row(i));
    const double error = std::abs(found.Result(i, 0) - exact);
    sum += error;
    most = std::max(most, error);
    largest = std::max(largest, std::abs(exact));
  }
  return { sum / (s.NumberOfVertices() * largest), most / largest };
}

std::vector<Eigen::RowVector3d> Circle(double latitude, Index count)
{
  std::vector<Eigen::RowVector3d> places;
  for (Index k = 0; k < count; ++k)
  {
    const double turn = 2.0 * Pi * k / count;
    places.emplace_back(
      std::cos(latitude) * std::cos(turn), std::cos(latitude) * std::sin(turn), std::sin(latitude));
  }
  return places;
}

void ExpectError(const std::function<Solution()>& solve, const char* part)
{
  try
  {
    solve();
    FAIL() << part;
  }
  catch (const std::runtime_error& error)
  {
    EXPECT_NE(std::string(error.what()).find(part), std::string::npos) << error.what();
    EXPECT_NE(std::string(error.what()).find("allowed"), std::string::npos) << error.what();
  }
}

// The boundary is half way between the points of the region and the others, but near the rim, where these
// have fewer neighbours.
TEST(SignedDistance, ToAHalfPlaneIsStraight)
{
  const Shape plate = Plate(10, 1.0); // edges of 0.2
  for (const DistanceMethod method : { DistanceMethod::Exact, DistanceMethod::Eikonal })
  {
    const Solution found = ToRegion(
      plate, [](const Eigen::RowVector3d& x) { return x[0] < 0.1; }, method);
    const auto [mean, most] =
      ErrorOf(found, plate, [](const Eigen::RowVector3d& x) { return x[0] - 0.1; });
    EXPECT_LE(mean, 1e-2);
    EXPECT_LE(most, 2e-2);
    EXPECT_EQ(found.Arrays.at("NearestSource")(0, 0), 3.0);
  }
}

TEST(SignedDistance, ToACapOfASphereIsThatOfItsLatitude)
{
  const Shape ball = Icosphere(4);
  const double latitude = 0.4;
  const auto right = [&](const Eigen::RowVector3d& x)
  { return latitude - std::asin(std::clamp(x[2], -1.0, 1.0)); };
  for (const DistanceMethod method :
    { DistanceMethod::Exact, DistanceMethod::Eikonal, DistanceMethod::Heat })
  {
    const Solution found = ToRegion(
      ball, [&](const Eigen::RowVector3d& x) { return right(x) < 0.0; }, method);
    const auto [mean, most] = ErrorOf(found, ball, right);
    EXPECT_LE(mean, 7e-3) << static_cast<int>(method);
    EXPECT_LE(most, 3e-2) << static_cast<int>(method);
  }
}

TEST(SignedDistance, ToACircleIsBelowZeroOnTheSmallerSide)
{
  const Shape ball = Icosphere(4);
  for (const double latitude : { 0.7, -0.2 })
  {
    const Solution found = ToCurve(ball, Circle(latitude, 100));
    const auto [mean, most] = ErrorOf(found, ball,
      [&](const Eigen::RowVector3d& x)
      {
        const double north = latitude - std::asin(std::clamp(x[2], -1.0, 1.0));
        return latitude > 0.0 ? north : -north;
      });
    EXPECT_LE(mean, 2e-3);
    EXPECT_LE(most, 5e-3);
    EXPECT_EQ(found.Numbers.at("NumberOfSources")(0, 0), 100.0);
  }
}

// Where a curve goes through points and along edges, these have 0, and its sides are no less certain.
TEST(SignedDistance, ToACurveAlongEdgesIsExact)
{
  const Shape plate = Plate(10, 1.0);
  const Solution found =
    ToCurve(plate, { { -0.4, -0.4, 0 }, { 0.4, -0.4, 0 }, { 0.4, 0.4, 0 }, { -0.4, 0.4, 0 } });
  const auto right = [](const Eigen::RowVector3d& x)
  {
    const double dx = std::abs(x[0]) - 0.4, dy = std::abs(x[1]) - 0.4;
    return dx > 0.0 && dy > 0.0 ? std::hypot(dx, dy) : std::max(dx, dy);
  };
  EXPECT_LE(ErrorOf(found, plate, right).second, 1e-12);
}

TEST(SignedDistance, NeedsTwoSides)
{
  const Shape torus = Torus(40, 20, 2.0, 0.7);
  ExpectError(
    [&] {
      return ToCurve(torus, { { 2.7, 0, 0 }, { 2, 0, 0.7 }, { 1.3, 0, 0 }, { 2, 0, -0.7 } });
    },
    "do not divide the surface");
  ExpectError(
    [&] {
      return ToCurve(torus, { { 2.7, 0, 0 }, { 2, 0, 0.7 }, { 2, 1, 0.7 } }, false);
    },
    "is on no closed line");
  ExpectError([&] { return ToRegion(torus, [](const Eigen::RowVector3d&) { return true; }); },
    "has no boundary");
  const Shape ball = Icosphere(3);
  SurfaceData data;
  data.Data.Values = Values::Ones(ball.Vertices.rows(), 1);
  data.Data.Values(0, 0) = 0.0;
  DistanceSettings settings;
  settings.Signed = true;
  settings.AlongSpeed = settings.AcrossSpeed = 2.0;
  ExpectError([&] { return Distance(ball.Vertices, ball.Faces, data, settings); }, "Signed");
}

} // namespace
