// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
//
// Sources anywhere on a surface, speeds and barriers, in the user's terms.
#include "Meshes.h"
#include "Run/Solve.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>

using namespace SurfaceDiffusion;
using namespace SurfaceDiffusion::Testing;

namespace
{

using Shape = Testing::Surface;

std::shared_ptr<const SourceShapes> Shapes(
  const std::vector<Eigen::RowVector3d>& places, std::vector<std::array<Index, 2>> segments = {})
{
  auto shapes = std::make_shared<SourceShapes>();
  shapes->Places.resize(static_cast<Eigen::Index>(places.size()), 3);
  for (std::size_t i = 0; i < places.size(); ++i)
  {
    shapes->Places.row(static_cast<Eigen::Index>(i)) = places[i];
  }
  shapes->Segments = std::move(segments);
  return shapes;
}

Eigen::RowVector3d MiddleOf(const Shape& s, const Eigen::RowVector3i& corners)
{
  return (s.Vertices.row(corners[0]) + s.Vertices.row(corners[1]) + s.Vertices.row(corners[2])) /
    3.0;
}

Solution From(const Shape& s, const std::shared_ptr<const SourceShapes>& sources,
  DistanceMethod method = DistanceMethod::Eikonal, bool gradient = false)
{
  SurfaceData data;
  data.Sources = sources;
  DistanceSettings settings;
  settings.Method = method;
  settings.ComputeGradient = gradient;
  return Distance(s.Vertices, s.Faces, data, settings);
}

/// Distances from marked points.
Solution From(const Shape& s, const std::vector<std::pair<Index, double>>& marks,
  const SurfaceData& more = {}, DistanceMethod method = DistanceMethod::Eikonal)
{
  SurfaceData data = more;
  data.Data.Values = Values::Zero(s.Vertices.rows(), 1);
  for (const auto& [point, mark] : marks)
  {
    data.Data.Values(point, 0) = mark;
  }
  DistanceSettings settings;
  settings.Method = method;
  return Distance(s.Vertices, s.Faces, data, settings);
}

std::string ErrorOf(const Shape& s, const SurfaceData& data, const DistanceSettings& settings)
{
  try
  {
    Distance(s.Vertices, s.Faces, data, settings);
  }
  catch (const std::runtime_error& error)
  {
    return error.what();
  }
  return "";
}

/// Triangles so oblique that the intrinsic Delaunay triangulation has others.
Shape ObliquePlate(double slope = 1.7)
{
  Shape s = Plate(20, 3.0);
  s.Vertices.col(0) += slope * s.Vertices.col(1);
  return s;
}

} // namespace

// Ways in a plane are straight from points within triangles, too, also where the triangles that
// they lie in are not those that the front runs over.
TEST(DistanceRun, FromPointsWithinTrianglesIsExactInAPlane)
{
  const std::vector<Eigen::RowVector3d> places = { { 0.123, 0.271, 0.0 }, { -1.3, 0.3, 0.4 },
    { 2.0, 0.91, -1.0 }, { 0.3, 0.3, 0.0 }, { 0.15, 0.3, 0.0 } };
  const auto sources = Shapes(places);
  for (const double slope : { 0.0, 1.7 })
  {
    const Shape plate = ObliquePlate(slope);
    const Solution found = From(plate, sources);
    const Values& nearest = found.Arrays.at("NearestSource");
    double largest = 0.0;
    for (Index i = 0; i < plate.NumberOfVertices(); ++i)
    {
      double exact = Never;
      Index argmin = -1;
      for (std::size_t k = 0; k < places.size(); ++k)
      {
        const double distance = (plate.Vertices.row(i) - places[k]).head(2).norm();
        argmin = distance < exact - 1e-9 ? static_cast<Index>(k) : argmin;
        exact = std::min(exact, distance);
      }
      // Obtuse angles at a boundary, which cannot be flipped, have errors from vertices, too.
      const double along = plate.Vertices(i, 0) - slope * plate.Vertices(i, 1);
      largest = std::max(largest,
        std::abs(along) < 2.0 && std::abs(plate.Vertices(i, 1)) < 2.0
          ? std::abs(found.Result(i, 0) - exact)
          : 0.0);
      EXPECT_NEAR(
        (plate.Vertices.row(i) - places[static_cast<std::size_t>(nearest(i, 0))]).head(2).norm(),
        exact, 1e-9)
        << i << ' ' << argmin;
    }
    EXPECT_LT(largest, slope == 0.0 ? 1e-12 : 0.01);
    EXPECT_EQ(found.Numbers.at("NumberOfSources")(0, 0), 5.0);
    EXPECT_EQ(found.Numbers.at("NumberOfUnreachedPoints")(0, 0), 0.0);
  }
}

// A line across a plane has plane fronts on both sides, in any direction and with any points.
TEST(DistanceRun, FromALineIsExactInAPlane)
{
  for (const double slope : { 0.0, 1.7 })
  {
    const Shape plate = ObliquePlate(slope);
    const Eigen::RowVector3d a(-3.0 - 1.17 * slope, -1.17, 0.0);
    const Eigen::RowVector3d b(3.0 + 0.41 * slope, 0.41, 0.0);
    const Eigen::RowVector3d inside = 0.47 * a + 0.53 * b;
    const Solution found = From(plate, Shapes({ a, b, inside }, { { 0, 2 }, { 2, 1 } }));
    const Eigen::RowVector2d along = (b - a).head(2).normalized();
    double largest = 0.0;
    for (Index i = 0; i < plate.NumberOfVertices(); ++i)
    {
      const Eigen::RowVector2d x = (plate.Vertices.row(i) - a).head(2);
      const double exact = std::abs(x[0] * along[1] - x[1] * along[0]);
      // Beside an end of the line, round fronts meet plane ones.
      const double foot = x.dot(along) / (b - a).head(2).norm();
      const bool isBeside = foot < 0.3 || foot > 0.7;
      largest = std::max(largest, isBeside ? 0.0 : std::abs(found.Result(i, 0) - exact));
      EXPECT_EQ(found.Arrays.at("NearestSource")(i, 0), 0.0); // one line
    }
    EXPECT_LT(largest, 1e-6) << slope;
    EXPECT_EQ(found.Numbers.at("NumberOfSources")(0, 0), 2.0);
  }
}

TEST(DistanceRun, FromAShortLineIsThatOfTheSegment)
{
  const Eigen::RowVector3d a(-1.03, -0.41, 0.2);
  const Eigen::RowVector3d b(1.21, 0.77, 0.2);
  for (const DistanceMethod method : { DistanceMethod::Eikonal, DistanceMethod::Heat })
  {
    const bool isMarched = method == DistanceMethod::Eikonal;
    const Shape plate = ObliquePlate(isMarched ? 1.7 : 0.0);
    const Solution found = From(plate, Shapes({ a, b }, { { 0, 1 } }), method);
    double sum = 0.0;
    double farthest = 0.0;
    for (Index i = 0; i < plate.NumberOfVertices(); ++i)
    {
      const Eigen::RowVector2d x = (plate.Vertices.row(i) - a).head(2);
      const Eigen::RowVector2d ab = (b - a).head(2);
      const double share = std::clamp(x.dot(ab) / ab.squaredNorm(), 0.0, 1.0);
      const double exact = (x - share * ab).norm();
      sum += std::abs(found.Result(i, 0) - exact);
      farthest = std::max(farthest, exact);
    }
    const double mean = sum / plate.NumberOfVertices() / farthest;
    EXPECT_LT(mean, isMarched ? 0.002 : 0.05);
  }
}

// Great circles from a place within a triangle.
TEST(DistanceRun, FromAPlaceOnASphereIsThatOfGreatCircles)
{
  const Eigen::RowVector3d place = Eigen::RowVector3d(0.21, -0.53, 0.6).normalized();
  for (const DistanceMethod method : { DistanceMethod::Eikonal, DistanceMethod::Heat })
  {
    double errors[2];
    for (const int level : { 3, 5 })
    {
      const Shape s = Icosphere(level);
      const Solution found = From(s, Shapes({ 3.0 * place }), method, true);
      const Values& gradient = found.Arrays.at("DistanceGradient");
      double sum = 0.0;
      double ofGradients = 0.0;
      Index counted = 0;
      for (Index i = 0; i < s.NumberOfVertices(); ++i)
      {
        const double cosine = std::clamp(s.Vertices.row(i).dot(place), -1.0, 1.0);
        sum += std::abs(found.Result(i, 0) - std::acos(cosine));
        if (std::abs(cosine) < 0.9)
        {
          const Eigen::RowVector3d exact = (cosine * s.Vertices.row(i) - place).normalized();
          ofGradients += (gradient.row(i) - exact).norm();
          ++counted;
        }
      }
      errors[level == 3 ? 0 : 1] = sum / s.NumberOfVertices();
      EXPECT_LT(ofGradients / counted, level == 3 ? 0.1 : 0.03);
    }
    EXPECT_GT(errors[0] / errors[1], method == DistanceMethod::Eikonal ? 3.5 : 2.0);
    EXPECT_LT(errors[1], method == DistanceMethod::Eikonal ? 0.003 * Pi : 0.005 * Pi);
  }
}

// Two speeds: the time of a plane front adds up, and the gradient has the length 1/speed.
TEST(DistanceRun, OfTwoSpeedsAddsUpAcrossThem)
{
  const Shape strip = Strip(30, 12, 6.0, 2.0);
  SurfaceData data;
  data.Speeds.OnCells = true;
  std::vector<std::pair<Index, double>> side;
  for (Index j = 0; j <= 12; ++j)
  {
    side.emplace_back(31 * j, 1.0);
  }
  for (const auto& corners : strip.Faces.rowwise())
  {
    const double x = MiddleOf(strip, corners)[0];
    data.Speeds.Values.push_back(x < 2.0 ? 0.5 : 4.0);
  }
  const Solution found = From(strip, side, data);
  ASSERT_EQ(found.Arrays.count("ArrivalTime"), 1U);
  for (Index i = 0; i < strip.NumberOfVertices(); ++i)
  {
    const double x = strip.Vertices(i, 0);
    EXPECT_NEAR(found.Result(i, 0), x < 2.0 ? x / 0.5 : 4.0 + (x - 2.0) / 4.0, 1e-12);
  }
  SurfaceData marked = data;
  marked.Data.Values = Values::Zero(strip.Vertices.rows(), 1);
  for (const auto& [point, mark] : side)
  {
    marked.Data.Values(point, 0) = mark;
  }
  DistanceSettings settings;
  settings.Method = DistanceMethod::Eikonal;
  settings.ComputeGradient = true;
  const Values gradient =
    Distance(strip.Vertices, strip.Faces, marked, settings).Arrays.at("ArrivalTimeGradient");
  for (Index i = 0; i < strip.NumberOfVertices(); ++i)
  {
    const double x = strip.Vertices(i, 0);
    if (std::abs(x - 2.0) > 1e-9)
    {
      EXPECT_NEAR(gradient(i, 0), x < 2.0 ? 2.0 : 0.25, 1e-12);
    }
  }
  // Start times add up, too.
  data.StartTimes.assign(static_cast<std::size_t>(strip.NumberOfVertices()), -3.0);
  EXPECT_LT((From(strip, side, data).Result - found.Result).array().abs().maxCoeff() - 3.0, 1e-12);
  EXPECT_NEAR(From(strip, side, data).Result(0, 0), -3.0, 1e-12);
}

// Constant speeds along and across a direction: ellipses, also from a place within a triangle, and
// with sources on points of triangles that the map makes obtuse.
TEST(DistanceRun, OfTwoSpeedsByDirectionAreEllipsesInAPlane)
{
  const Shape plate = Jittered(Plate(20, 3.0), 0.1, -2.99, 2.99, -2.99, 2.99);
  const Eigen::RowVector3d place(0.123, 0.271, 0.0);
  const double angle = 0.6;
  const Eigen::RowVector3d e1(std::cos(angle), std::sin(angle), 0.0);
  const Eigen::RowVector3d e2(-e1[1], e1[0], 0.0);
  for (const bool onCells : { false, true })
  {
    for (const double along : { 1.0, 4.0 })
    {
      SurfaceData data;
      data.Sources = Shapes({ place });
      data.Directions.OnCells = onCells;
      data.Directions.Values =
        e1.replicate(onCells ? plate.Faces.rows() : plate.Vertices.rows(), 1);
      data.Directions.Values.row(3) *= -7.0; // of any length and sign
      DistanceSettings settings;
      settings.Method = DistanceMethod::Eikonal;
      settings.AlongSpeed = along;
      settings.AcrossSpeed = 0.5;
      const Solution found = Distance(plate.Vertices, plate.Faces, data, settings);
      ASSERT_EQ(found.Arrays.count("ArrivalTime"), 1U);
      for (Index i = 0; i < plate.NumberOfVertices(); ++i)
      {
        const Eigen::RowVector3d x = plate.Vertices.row(i) - place;
        const double exact = std::hypot(x.dot(e1) / along, x.dot(e2) / 0.5);
        EXPECT_NEAR(found.Result(i, 0), exact, 1e-12 * exact);
      }
    }
  }
}

// The plane as another one sees it: x -> S exp(x), with x as a complex number and S a stretching
// by 3. Distances there are straight; here they have speeds 1/3 and 1, times |exp(-x)|, along and
// across directions that turn.
TEST(DistanceRun, OfDirectionsThatTurnConvergesToThatOfTheMappedPlane)
{
  double errors[2];
  for (const Index cells : { 30, 60 })
  {
    const Shape plate = Jittered(Plate(cells, 0.6), 0.3 / cells, -0.599, 0.599, -0.599, 0.599);
    const auto image = [](const Eigen::RowVector3d& x) -> Eigen::RowVector2d
    { return std::exp(x[0]) * Eigen::RowVector2d(3.0 * std::cos(x[1]), std::sin(x[1])); };
    SurfaceData data;
    const Eigen::RowVector3d place(0.011, 0.017, 0.0);
    data.Sources = Shapes({ place });
    data.Directions.Values.resize(plate.Vertices.rows(), 3);
    for (Index i = 0; i < plate.NumberOfVertices(); ++i)
    {
      const Eigen::RowVector3d x = plate.Vertices.row(i);
      data.Directions.Values.row(i) << std::cos(x[1]), -std::sin(x[1]), 0.0;
      data.Speeds.Values.push_back(std::exp(-x[0]));
    }
    DistanceSettings settings;
    settings.Method = DistanceMethod::Eikonal;
    settings.AlongSpeed = 1.0 / 3.0;
    const Solution found = Distance(plate.Vertices, plate.Faces, data, settings);
    double& error = errors[cells == 30 ? 0 : 1];
    error = 0.0;
    Index counted = 0;
    for (Index i = 0; i < plate.NumberOfVertices(); ++i)
    {
      const Eigen::RowVector3d x = plate.Vertices.row(i);
      const double exact = (image(x) - image(place)).norm();
      // Straight ways stay within the image of the plate.
      if (exact < 0.5)
      {
        error += std::abs(found.Result(i, 0) - exact) / 0.5;
        ++counted;
      }
    }
    error /= counted;
    EXPECT_GT(counted, 50);
  }
  EXPECT_LT(errors[1], 0.005);
  EXPECT_GT(errors[0] / errors[1], 2.0);
}

// Without a direction, fronts have the geometric mean of both speeds; alike ones need none.
TEST(DistanceRun, WithoutADirectionHasTheMeanOfBothSpeeds)
{
  const Shape s = Icosphere(2);
  SurfaceData data;
  const Values distances = From(s, { { 7, 1.0 } }).Result;
  data.Data.Values = Values::Zero(s.Vertices.rows(), 1);
  data.Data.Values(7, 0) = 1.0;
  DistanceSettings settings;
  settings.Method = DistanceMethod::Eikonal;
  settings.AlongSpeed = settings.AcrossSpeed = 2.0;
  EXPECT_LT((Distance(s.Vertices, s.Faces, data, settings).Result * 2.0 - distances)
              .array()
              .abs()
              .maxCoeff(),
    1e-12);
  settings.AlongSpeed = 16.0;
  settings.AcrossSpeed = 0.25;
  EXPECT_NE(ErrorOf(s, data, settings).find("Directions is not set; allowed: equal values"),
    std::string::npos);
  data.Directions.Values =
    Points::Constant(s.Vertices.rows(), 3, std::numeric_limits<double>::quiet_NaN());
  EXPECT_LT((Distance(s.Vertices, s.Faces, data, settings).Result * 2.0 - distances)
              .array()
              .abs()
              .maxCoeff(),
    1e-12);
  settings.Method = DistanceMethod::Heat;
  EXPECT_EQ(ErrorOf(s, data, settings),
    "Method is 0; allowed: 1 Eikonal or 3 Automatic together with AlongSpeed 16 and AcrossSpeed "
    "0.25");
}

TEST(DistanceRun, SpeedsAlongAndAcrossPerCellOrPointAreTheNumbersWhereTheyAreConstant)
{
  const Shape s = Jittered(Plate(12, 1.0), 0.03, -0.99, 0.99, -0.99, 0.99);
  const auto rows = [&](bool onCells)
  { return static_cast<std::size_t>(onCells ? s.Faces.rows() : s.Vertices.rows()); };
  for (const auto& [along, across] : { std::pair(4.0, 0.5), std::pair(2.0, 2.0) })
  {
    for (const bool onCells : { false, true })
    {
      SurfaceData data;
      data.Sources = Shapes({ { 0.123, 0.271, 0.0 }, { -0.5, -0.4, 0.0 } });
      data.Speeds.Values.assign(rows(false), 0.25);
      data.Directions.Values = Points::Random(s.Vertices.rows(), 3);
      DistanceSettings settings;
      settings.AlongSpeed = along;
      settings.AcrossSpeed = across;
      const Values numbers = Distance(s.Vertices, s.Faces, data, settings).Result;
      settings.AlongSpeed = 1.0;
      settings.AcrossSpeed = 0.5 * across; // a product, and a speed that only one of them has
      data.AlongSpeeds = { std::vector<double>(rows(onCells), along), onCells };
      data.AcrossSpeeds = { std::vector<double>(rows(onCells), 2.0), onCells };
      const Solution arrays = Distance(s.Vertices, s.Faces, data, settings);
      EXPECT_EQ(arrays.Result, numbers) << along << onCells;
      EXPECT_EQ(arrays.Arrays.count("ArrivalTime"), 1U);
    }
  }
}

// Of two layers with fibres along x, straight lines of which meet where the time is least.
TEST(DistanceRun, OfFibresInTwoLayersIsRefracted)
{
  double errors[2];
  for (const Index cells : { 40, 80 })
  {
    const Shape s = Jittered(Strip(2 * cells, cells, 4.0, 2.0), 0.3 / cells, 0.01, 1.9, 0.01, 1.99);
    SurfaceData data;
    const Eigen::RowVector3d place(1.013, 0.971, 0.0);
    data.Sources = Shapes({ place });
    data.Directions.OnCells = data.AlongSpeeds.OnCells = data.AcrossSpeeds.OnCells = true;
    data.Directions.Values = Eigen::RowVector3d(1.0, 0.0, 0.0).replicate(s.Faces.rows(), 1);
    for (const auto& corners : s.Faces.rowwise())
    {
      const bool isFirst = MiddleOf(s, corners)[0] < 2.0;
      data.AlongSpeeds.Values.push_back(isFirst ? 0.6 : 1.2);
      data.AcrossSpeeds.Values.push_back(isFirst ? 0.3 : 0.8);
    }
    const Solution found = Distance(s.Vertices, s.Faces, data, {});
    double& error = errors[cells == 40 ? 0 : 1];
    error = 0.0;
    Index counted = 0;
    for (Index i = 0; i < s.NumberOfVertices(); ++i)
    {
      const Eigen::RowVector3d x = s.Vertices.row(i);
      if (x[0] < 2.0)
      {
        continue; // some are reached through the other layer first
      }
      double exact = Never;
      for (double y = 0.0; y <= 2.0; y += 1e-3)
      {
        exact = std::min(exact,
          std::hypot((2.0 - place[0]) / 0.6, (y - place[1]) / 0.3) +
            std::hypot((x[0] - 2.0) / 1.2, (x[1] - y) / 0.8));
      }
      error += std::abs(found.Result(i, 0) - exact) / exact;
      ++counted;
    }
    error /= counted;
    EXPECT_GT(counted, 1000);
  }
  EXPECT_LT(errors[0], 0.01);
  EXPECT_LT(errors[1], 0.005);
}

// A line of triangles where both factors are 0, around which ellipses go, and one where one is 0.
TEST(DistanceRun, FactorsOfZeroAreBarriersAndSlowInOneDirection)
{
  const Shape strip = Strip(40, 20, 4.0, 2.0);
  SurfaceData data;
  data.Directions.OnCells = data.AlongSpeeds.OnCells = data.AcrossSpeeds.OnCells = true;
  data.Directions.Values = Eigen::RowVector3d(1.0, 0.0, 0.0).replicate(strip.Faces.rows(), 1);
  std::vector<char> isLine;
  for (const auto& corners : strip.Faces.rowwise())
  {
    const Eigen::RowVector3d middle = MiddleOf(strip, corners);
    isLine.push_back(std::abs(middle[0] - 2.05) < 0.05 && middle[1] > 0.5);
    data.AlongSpeeds.Values.push_back(isLine.back() ? 0.0 : 2.0);
    data.AcrossSpeeds.Values.push_back(isLine.back() ? 0.0 : 1.0);
  }
  const auto time = [&] // from (1, 1.5) to (3, 1.5)
  {
    return From(strip, { { 41 * 15 + 10, 1.0 } }, data).Result(41 * 15 + 30, 0);
  };
  const double around = std::hypot(0.5, 1.0) + 0.05 + std::hypot(0.45, 1.0);
  EXPECT_NEAR(time(), around, 1e-12);
  for (std::size_t t = 0; t < isLine.size(); ++t)
  {
    data.AcrossSpeeds.Values[t] = 1.0; // fronts go up and down within it
  }
  EXPECT_NEAR(time(), around, 0.01 * around);
  for (std::size_t t = 0; t < isLine.size(); ++t)
  {
    data.AlongSpeeds.Values[t] = 2.0;
    data.AcrossSpeeds.Values[t] = isLine[t] ? 0.0 : 1.0; // fronts go along it
  }
  EXPECT_NEAR(time(), 1.0, 0.01);
  data.Directions.Values.setConstant(std::numeric_limits<double>::quiet_NaN());
  const double without = time(); // a barrier, too
  EXPECT_GT(without, 1.5);
  EXPECT_LT(without, 1.01 * (std::hypot(1.0, 1.0) + 0.1 + std::hypot(0.9, 1.0)) / std::sqrt(2.0));
}

// A barrier of speed 0, and the same one as a mask: ways go around its free end.
TEST(DistanceRun, GoesAroundBarriersOfSpeedZeroAndOfMasks)
{
  const Shape strip = Strip(40, 20, 4.0, 2.0);
  SurfaceData slow;
  slow.Speeds.OnCells = true;
  SurfaceData masked;
  masked.Mask.OnCells = true;
  for (const auto& corners : strip.Faces.rowwise())
  {
    const Eigen::RowVector3d middle = MiddleOf(strip, corners);
    const bool isBarrier = std::abs(middle[0] - 2.05) < 0.05 && middle[1] > 0.5;
    slow.Speeds.Values.push_back(isBarrier ? 0.0 : 1.0);
    masked.Mask.Values.push_back(isBarrier ? 1 : 0);
  }
  const Index source = 41 * 15 + 10; // (1, 1.5)
  const Index target = 41 * 15 + 30; // (3, 1.5)
  // by (2, 0.5) and (2.1, 0.5)
  const double around = std::hypot(1.0, 1.0) + 0.1 + std::hypot(0.9, 1.0);
  for (const SurfaceData& data : { slow, masked })
  {
    const Solution found = From(strip, { { source, 1.0 } }, data);
    EXPECT_NEAR(found.Result(target, 0), around, 0.01);
    EXPECT_GT(found.Result(target, 0), 2.5); // not the straight 2
  }
  // Closed across the strip, it is not passed.
  for (std::size_t t = 0; t < slow.Speeds.Values.size(); ++t)
  {
    const auto corners = strip.Faces.row(static_cast<Eigen::Index>(t));
    const double x = MiddleOf(strip, corners)[0];
    slow.Speeds.Values[t] = std::abs(x - 2.05) < 0.05 ? 0.0 : 1.0;
  }
  const Solution closed = From(strip, { { source, 7.0 } }, slow);
  EXPECT_EQ(closed.Result(target, 0), Never);
  EXPECT_EQ(closed.Arrays.at("NearestSource")(target, 0), 0.0);
  EXPECT_EQ(closed.Arrays.at("NearestSource")(source, 0), 7.0);
  EXPECT_EQ(closed.Numbers.at("NumberOfUnreachedPoints")(0, 0), 21.0 * 20.0);
}

TEST(DistanceRun, SourcesWithinBarriersDoNotCount)
{
  const Shape strip = Strip(40, 20, 4.0, 2.0);
  const Index source = 41 * 10 + 20, within = 41 * 10 + 10, beside = 41 * 10 + 11;
  SurfaceData data;
  data.Speeds.OnCells = true;
  for (const auto& corners : strip.Faces.rowwise())
  {
    data.Speeds.Values.push_back((corners.array() == within).any() ? 0.0 : 1.0);
  }
  const Solution found = From(strip, { { source, 1.0 }, { within, 2.0 }, { beside, 3.0 } }, data);
  EXPECT_EQ(found.Numbers.at("NumberOfSources")(0, 0), 2.0);
  EXPECT_EQ(found.Result(within, 0), Never);
  EXPECT_EQ(found.Result(beside, 0), 0.0);
  auto shapes = std::make_shared<SourceShapes>();
  shapes->OfPoints = { source, within, beside };
  shapes->Places = Points::Zero(3, 3);
  data.Sources = shapes;
  EXPECT_EQ(Distance(strip.Vertices, strip.Faces, data, {}).Result, found.Result);
}

// Points that are merged into one may have sources of several names.
TEST(DistanceRun, SourcesAtOneVertexAreNeighboursOfEachOfTheirNames)
{
  Shape strip = Strip(40, 20, 4.0, 2.0);
  strip.Vertices.col(0) += 0.33 * strip.Vertices.col(1); // ways between the sources are shorter
  const Index n = strip.NumberOfVertices(), row = 41 * 10;
  strip.Vertices.conservativeResize(n + 41, 3);
  strip.Vertices.bottomRows(41) = strip.Vertices.middleRows(row, 41).eval();
  for (Eigen::Index k = 0; k < 3 * 2 * 40 * 10; ++k)
  {
    Index& corner = strip.Faces.data()[k];
    corner = corner >= row ? n + corner - row : corner; // both are used
  }
  SurfaceData data;
  data.Data.Values = Values::Zero(n + 41, 1);
  data.Data.Values.bottomRows(41).setConstant(2.0);
  for (const double y : strip.Vertices.col(1))
  {
    data.Speeds.Values.push_back(y > 1.25 ? 4.0 : 1.0);
  }
  DistanceSettings settings;
  settings.MergeCoincidentPoints = true;
  const auto times = [&] { return Distance(strip.Vertices, strip.Faces, data, settings).Result; };
  const Values ofLine = times();
  for (Index i = row; i < row + 41; i += 2)
  {
    data.Data.Values(i, 0) = 1.0; // they come first
  }
  EXPECT_LT((times() - ofLine).cwiseAbs().maxCoeff(), 1e-13);
}

TEST(DistanceRun, LabelsOfRegionsAreTheirValues)
{
  const Shape s = Icosphere(3);
  for (const DistanceMethod method : { DistanceMethod::Eikonal, DistanceMethod::Heat })
  {
    const Solution found =
      From(s, { { 0, -2.0 }, { 7, 4.0 }, { 8, 4.0 }, { 30, 2.5 } }, {}, method);
    const DistanceMethod ofSources =
      method == DistanceMethod::Heat ? DistanceMethod::Automatic : method;
    const Solution alone[] = { From(s, { { 0, 1.0 } }, {}, ofSources),
      From(s, { { 7, 1.0 }, { 8, 1.0 } }, {}, ofSources), From(s, { { 30, 1.0 } }, {}, ofSources) };
    const double names[] = { -2.0, 4.0, 2.5 };
    for (Index i = 0; i < s.NumberOfVertices(); ++i)
    {
      int nearest = 0;
      for (const int k : { 1, 2 })
      {
        nearest = alone[k].Result(i, 0) < alone[nearest].Result(i, 0) ? k : nearest;
      }
      // Of sources that are equally near, round-off decides.
      const double name = found.Arrays.at("NearestSource")(i, 0);
      const auto k = std::find(names, names + 3, name) - names;
      ASSERT_LT(k, 3);
      EXPECT_NEAR(alone[k].Result(i, 0), alone[nearest].Result(i, 0), 1e-13) << i;
      if (method == DistanceMethod::Eikonal)
      {
        EXPECT_EQ(found.Result(i, 0), alone[nearest].Result(i, 0)) << i;
      }
    }
  }
}

TEST(DistanceRun, SourcesNearExcludedTrianglesDoNotMove)
{
  const Shape plate = Plate(20, 3.0);
  SurfaceData data;
  data.Mask.Values.assign(static_cast<std::size_t>(plate.NumberOfVertices()), 0);
  for (Index i = 0; i < plate.NumberOfVertices(); ++i)
  {
    data.Mask.Values[static_cast<std::size_t>(i)] = plate.Vertices(i, 0) > 0.0 ? 1 : 0;
  }
  data.Sources = Shapes({ { 1.0, 0.0, 0.0 }, { -1.0, 0.0, 0.0 }, { -1.0, 0.5, 9.0 } });
  DistanceSettings settings;
  settings.Method = DistanceMethod::Eikonal;
  settings.MaximumDistance = 5.0;
  const Solution found = Distance(plate.Vertices, plate.Faces, data, settings);
  EXPECT_EQ(found.Numbers.at("NumberOfSources")(0, 0), 1.0);
  EXPECT_EQ(found.Warnings.size(), 2U);
  for (Index i = 0; i < plate.NumberOfVertices(); ++i)
  {
    const double exact = (plate.Vertices.row(i) - data.Sources->Places.row(1)).norm();
    if (plate.Vertices(i, 0) > 0.0)
    {
      EXPECT_EQ(found.Result(i, 0), Never);
    }
    else
    {
      EXPECT_NEAR(found.Result(i, 0), exact, 1e-12);
    }
  }
  data.Sources = Shapes({ { 1.0, 0.0, 0.0 }, { 0.0, 0.0, 9.0 } });
  EXPECT_EQ(ErrorOf(plate, data, settings),
    "no source is on the surface: of the points and lines, 1 are farther than MaximumDistance and "
    "1 "
    "where Mask excludes the surface; allowed: one source on it");
}

TEST(DistanceRun, NamesWhatIsNotAllowed)
{
  const Shape s = Icosphere(2);
  DistanceSettings settings;
  const auto expect = [&](const SurfaceData& data, const std::string& text)
  {
    EXPECT_NE(ErrorOf(s, data, settings).find(text), std::string::npos)
      << ErrorOf(s, data, settings);
  };
  SurfaceData data;
  expect(data, "Data is not set; allowed: ");
  data.Data.Values = Values::Zero(s.NumberOfVertices(), 1);
  expect(data, "Data marks no point; allowed: one or more, with a number other than 0 and NaN");
  data.Data.Values(3, 0) = 1.0;
  data.Mask.Values.assign(static_cast<std::size_t>(s.NumberOfVertices()), 0);
  data.Mask.Values[3] = 1;
  expect(data, "all 1 nonzero points of Data are where Mask excludes the surface");
  data.Mask.Values.clear();
  data.Speeds.Values.assign(static_cast<std::size_t>(s.NumberOfVertices()), 1.0);
  settings.Method = DistanceMethod::Heat;
  expect(data, "Method is 0; allowed: 1 Eikonal or 3 Automatic together with Speeds");
  settings.Method = DistanceMethod::Eikonal;
  data.Speeds.Values[5] = -1.0;
  expect(data,
    "Speeds is -1 at point 5; allowed: finite numbers, 0 or more (if it stands for no value, set 0 "
    "in its place, which is a barrier, or mask it with Mask)");
  data.Speeds.Values.clear();
  data.StartTimes.assign(static_cast<std::size_t>(s.NumberOfVertices()), Never);
  expect(data, "StartTimes is inf at point 3; allowed: finite numbers");
  data.StartTimes.clear();
  data.Data.Values(4, 0) = Never;
  expect(data, "Data is infinite at point 4");
  settings.MaximumDistance = -1.0;
  expect(data, "MaximumDistance is -1; allowed: ");
}
