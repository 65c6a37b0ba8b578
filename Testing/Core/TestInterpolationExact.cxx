// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
//
// Interpolation of exact values inside triangles.
#include "Interpolation.h"

#include <Eigen/QR>
#include <gtest/gtest.h>

#include <cmath>

using namespace SurfaceDiffusion;
using namespace SurfaceDiffusion::Testing;

namespace
{

/// At the shares b and c of the second and the third vertex of a triangle.
SurfacePoint PlaceIn(const TriangleMesh& mesh, Index triangle, double b, double c)
{
  SurfacePoint place;
  place.Coordinates = { 1.0 - b - c, b, c };
  for (int a = 0; a < 3; ++a)
  {
    place.Vertices[a] = mesh.TriangleVertices()(triangle, a);
  }
  return place;
}

void Add(ScatteredValues& data, const SurfacePoint& place, double value)
{
  const Eigen::Index row = data.Count();
  data.Places.push_back(place);
  data.Given.conservativeResize(row + 1, 1);
  data.Weights = Vector::Ones(row + 1);
  data.Given(row, 0) = value;
}

double At(const SurfacePoint& place, const Values& u)
{
  double value = 0.0;
  for (std::size_t a = 0; a < 3; ++a)
  {
    value += place.Coordinates[a] * u(place.Vertices[a], 0);
  }
  return value;
}

double LargestMisfit(const ScatteredValues& data, const Values& u)
{
  double largest = 0.0;
  for (Index i = 0; i < data.Count(); ++i)
  {
    largest = std::max(largest, std::abs(At(data.Places[i], u) - data.Given(i, 0)));
  }
  return largest;
}

} // namespace

TEST(InterpolationExact, HoldsValuesNearToEachOtherInATriangle)
{
  Surface s;
  s.Vertices.resize(3, 3);
  s.Vertices << 0, 0, 0, 1, 0, 0, 0, 1, 0;
  s.Faces.resize(1, 3);
  s.Faces << 0, 1, 2;
  const auto assembler = MakeAssembler(s);
  for (const double apart : { 0.02, 0.002 })
  {
    for (const RimCondition rim : { RimCondition::Natural, RimCondition::Free })
    {
      ScatteredValues data;
      Add(data, PlaceIn(assembler->Mesh(), 0, 0.3, 0.3), 0.0);
      Add(data, PlaceIn(assembler->Mesh(), 0, 0.3 + apart, 0.3), 1.0);
      Add(data, PlaceIn(assembler->Mesh(), 0, 0.1, 0.8), 2.0);
      Interpolation::Settings settings = InterpolationSettings(Choice::Exact);
      settings.Rim = rim;
      const double misfit = LargestMisfit(data, Interpolate(assembler, data, settings).U);
      std::printf("%g edges apart: misfit %.1e\n", apart, misfit);
      EXPECT_LT(misfit, 2e-7);
    }
  }
}

TEST(InterpolationExact, HoldsValuesNearToEachOtherOnEverySideOfAnEdge)
{
  for (const Surface& s : { Strip(9, 7), Icosphere(3), Moebius(20, 4) })
  {
    const auto assembler = MakeAssembler(s);
    const TriangleMesh& mesh = assembler->Mesh();
    for (const double apart : { 0.02, 0.002, 0.0003 })
    {
      ScatteredValues data;
      const auto vertices = mesh.TriangleVertices();
      Add(data, PlaceIn(mesh, 0, 0.4, apart / 2.0), 0.0);
      for (Index t = 1; t < mesh.NumberOfTriangles(); ++t) // the other side of the edge 0, 1
      {
        int shared = 0;
        std::array<double, 3> coordinates = { apart / 2.0, apart / 2.0, apart / 2.0 };
        for (int a = 0; a < 3; ++a)
        {
          const bool isFirst = vertices(t, a) == vertices(0, 0);
          const bool isSecond = vertices(t, a) == vertices(0, 1);
          shared += isFirst || isSecond;
          coordinates[a] = isFirst ? 0.6 - apart / 2.0 : isSecond ? 0.4 : coordinates[a];
        }
        if (shared == 2)
        {
          SurfacePoint place = PlaceIn(mesh, t, 0.0, 0.0);
          place.Coordinates = coordinates;
          Add(data, place, 1.0);
        }
      }
      const Index far = mesh.NumberOfTriangles() / 2; // and beside a vertex that has a value
      Add(data, SurfacePoint::AtVertex(vertices(far, 0)), 0.5);
      Add(data, PlaceIn(mesh, far, apart, 0.0), 0.7);
      Add(data, PlaceIn(mesh, far, 0.0, apart), 0.1);
      for (Index t = 5; t < mesh.NumberOfTriangles(); t += 17)
      {
        Add(data, PlaceIn(mesh, t, 0.2, 0.5), std::sin(t));
      }
      const Values u = Interpolate(assembler, data, InterpolationSettings(Choice::Exact)).U;
      const double misfit = LargestMisfit(data, u);
      std::printf(
        "%d vertices, %g edges apart: misfit %.1e\n", mesh.NumberOfVertices(), apart, misfit);
      EXPECT_LT(misfit, 2e-6);
    }
  }
}

TEST(InterpolationExact, TakesTheLeastMisfitWhereATriangleHasMoreValuesThanCorners)
{
  const auto assembler = MakeAssembler(Icosphere(2));
  const TriangleMesh& mesh = assembler->Mesh();
  ScatteredValues data;
  Eigen::MatrixXd coordinates(6, 3);
  Eigen::VectorXd values(6);
  for (Index i = 0; i < 6; ++i)
  {
    const double b = 0.1 + 0.13 * i;
    const SurfacePoint place = PlaceIn(mesh, 7, b, (1.0 - b) * (0.2 + 0.7 * (i % 2)));
    Add(data, place, i * i);
    coordinates.row(i) << place.Coordinates[0], place.Coordinates[1], place.Coordinates[2];
    values[i] = i * i;
  }
  Add(data, PlaceIn(mesh, 200, 0.3, 0.3), 4.0);
  const auto result = Interpolate(assembler, data, InterpolationSettings(Choice::Exact));
  const Eigen::VectorXd best = coordinates.colPivHouseholderQr().solve(values);
  for (int a = 0; a < 3; ++a)
  {
    EXPECT_NEAR(result.U(mesh.TriangleVertices()(7, a), 0), best[a], 1e-6);
  }
  EXPECT_NEAR(At(data.Places[6], result.U), 4.0, 1e-9);
}
