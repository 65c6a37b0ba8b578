// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Geometry/NormalVariation.h"
#include "Core/Geometry/QuadricDistances.h"
#include "Meshes.h"
#include "NoisySurfaces.h"

#include <gtest/gtest.h>

#include <cmath>

using namespace SurfaceDiffusion;
using namespace SurfaceDiffusion::Testing;

namespace
{

/// Of unit normals in single precision, over many iterations.
constexpr double Rounding = 1e-6;

/// A surface ready for NormalVariation, in units of its mean edge length h.
struct Faces
{
  explicit Faces(const Surface& s)
    : Mesh(s.Vertices, s.Faces)
    , Graph(Mesh)
    , Places(GatherVertices(Mesh, s.Vertices) / Mesh.LengthUnit())
  {
    this->Geometry.Measure(this->Mesh, this->Places, SerialFor());
  }

  NormalVariation Variation(const ParallelFor& parallel = SerialFor()) const
  {
    NormalVariation variation(this->Graph, this->Mesh.MeanEdgeLength(), parallel);
    variation.SetPlaces(this->Places, this->Geometry);
    return variation;
  }

  /// Row f is value(t) of the triangle t of the surface that is triangle f of the mesh.
  template <typename Value>
  Points Data(const Value& value) const
  {
    Points data(this->Mesh.NumberOfTriangles(), 3);
    for (Index f = 0; f < this->Mesh.NumberOfTriangles(); ++f)
    {
      data.row(f) = value(this->Mesh.InputTriangle()[f]);
    }
    return data;
  }

  TriangleMesh Mesh;
  FaceGraph Graph;
  Points Places;
  FaceGeometry Geometry;
};

NormalVariationSettings Settings(double first, double second, int iterations)
{
  NormalVariationSettings settings;
  settings.First = first;
  settings.Second = second;
  settings.Iterations = iterations;
  return settings;
}

/// A strip in the plane z = 0, and the same bent by an angle at each column of vertices.
struct BentStrip
{
  BentStrip(Index columns, Index rows, double angle)
    : Flat(Strip(columns, rows, 0.1 * columns, 0.1 * rows))
    , Bent(Flat)
  {
    for (Index i = 0; i < this->Flat.NumberOfVertices(); ++i)
    {
      double x = 0.0, z = 0.0;
      const long column = std::lround(this->Flat.Vertices(i, 0) / 0.1);
      for (long k = 0; k < column; ++k)
      {
        x += 0.1 * std::cos(angle * k);
        z += 0.1 * std::sin(angle * k);
      }
      this->Bent.Vertices.row(i) << x, this->Flat.Vertices(i, 1), z;
    }
  }

  Surface Flat, Bent;
};

Eigen::RowVector3d Centroid(const Surface& s, Index t)
{
  return (s.Vertices.row(s.Faces(t, 0)) + s.Vertices.row(s.Faces(t, 1)) +
           s.Vertices.row(s.Faces(t, 2))) /
    3.0;
}

double LargestDifference(const Points& a, const Points& b)
{
  return (a - b).rowwise().norm().maxCoeff();
}

} // namespace

TEST(NormalVariation, ConstantNormalsStay)
{
  const Faces faces(NoisyAlongNormals(Icosphere(3), 0.3));
  const Points data = faces.Data([](Index) { return Eigen::RowVector3d(0.6, 0.0, -0.8); });
  NormalVariation variation = faces.Variation();
  EXPECT_LT(LargestDifference(variation.Minimize(data, Settings(0.3, 0.5, 20)), data), Rounding);
  EXPECT_LT(variation.MeasureEnergy(data).Value, Rounding);
}

/// On surfaces that can be unrolled, such as cylinders, also with steep turns.
TEST(NormalVariation, LinearNormalsOfBentStripsStay)
{
  for (const double angle : { 0.0, 0.1, 0.7 })
  {
    const BentStrip strip(8, 5, angle);
    const Faces faces(strip.Bent);
    const Points data = faces.Data(
      [&](Index t)
      {
        const Eigen::RowVector3d c = Centroid(strip.Flat, t);
        return Eigen::RowVector3d(1.0 + c[0], 0.5 * c[0] - 2.0 * c[1], -0.3);
      });
    NormalVariation variation = faces.Variation();
    EXPECT_LT(LargestDifference(variation.Minimize(data, Settings(0.3, 0.5, 3000)), data), 1e-6);
    const NormalVariation::Energy energy = variation.MeasureEnergy(data);
    EXPECT_LT(energy.Value, 1e-2);
    EXPECT_LT(energy.Gap, 1e-4);
  }
}

/// Around a cylinder, slopes that are the same everywhere are 0. There the total variation of a bar
/// takes a1 times the length of its boundary from its area.
TEST(NormalVariation, OfManyTimesTheSecondOrderIsTheTotalVariation)
{
  const Index around = 24;
  const Index along = 4;
  const Surface cylinder = Cylinder(around, along, 1.0, 0.5);
  const Faces faces(cylinder);
  const auto isBar = [&](Index t)
  {
    const Eigen::RowVector3d c = Centroid(cylinder, t);
    return std::abs(std::atan2(c[1], c[0])) < 2.0 * Pi * 4.0 / around;
  };
  const Points data = faces.Data(
    [&](Index t) { return Eigen::RowVector3d(isBar(t) ? 1.0 : 0.0, 2.0, isBar(t) ? -1.0 : 0.0); });
  const double h = faces.Mesh.MeanEdgeLength() * faces.Mesh.LengthUnit();
  const double first = 0.2;
  const double force = first * 2.0 * 0.5 / h; // per component, as a vector of the length 1
  const double triangles = 2.0 * along;
  const double bar = 8.0 * triangles;
  NormalVariation variation = faces.Variation();
  const Points found = variation.Minimize(data, Settings(first, 1e4, 20000));
  for (Index f = 0; f < faces.Mesh.NumberOfTriangles(); ++f)
  {
    const double loss = force / std::sqrt(2.0);
    const double expected =
      isBar(faces.Mesh.InputTriangle()[f]) ? 1.0 - loss / bar : loss / (around * triangles - bar);
    EXPECT_NEAR(found(f, 0), expected, 1e-4);
    EXPECT_NEAR(found(f, 1), 2.0, Rounding);
    EXPECT_NEAR(found(f, 2), -expected, 1e-4);
  }
}

TEST(NormalVariation, GapIsNotNegativeAndVanishes)
{
  const Surface block = NoisyAlongNormals(LBlock(6), 0.3);
  const Faces faces(block);
  const Points data = faces.Geometry.Normals;
  double last = 0.0;
  for (const int iterations : { 0, 1, 10, 100, 1000, 10000 })
  {
    NormalVariation variation = faces.Variation();
    variation.SetWeights(data, 0.3);
    variation.Minimize(data, Settings(0.1, 0.13, iterations));
    const NormalVariation::Energy energy = variation.MeasureEnergy(data);
    EXPECT_GE(energy.Gap, -Rounding * energy.Value) << iterations;
    last = energy.Gap / energy.Value;
  }
  EXPECT_LT(last, 1e-3);
}

/// With the weights of their normals, two planes keep their dihedral angle: the loss of contrast is
/// that of a penalty that saturates.
TEST(NormalVariation, PlanesAtAnyAngleKeepTheirNormals)
{
  for (const double degrees : { 40.0, 60.0, 90.0, 150.0, 179.0 })
  {
    BentStrip strip(20, 6, 0.0);
    for (Index i = 0; i < strip.Flat.NumberOfVertices(); ++i)
    {
      auto p = strip.Bent.Vertices.row(i);
      const double beyond = std::max(0.0, p[0] - 1.0);
      p[0] += beyond * (std::cos(degrees * Pi / 180.0) - 1.0);
      p[2] = beyond * std::sin(degrees * Pi / 180.0);
    }
    const Faces faces(strip.Bent);
    const Points data = faces.Geometry.Normals;
    NormalVariation variation = faces.Variation();
    variation.SetWeights(data, 0.3);
    Points found = variation.Minimize(data, Settings(0.1, 0.13, 200));
    found.rowwise().normalize();
    EXPECT_LT(LargestDifference(found, data), 0.003) << degrees;
  }
}

TEST(NormalVariation, EdgesOfSeveralTrianglesJoinNoNormals)
{
  const Faces faces(ThreeFins(4));
  const Points data = faces.Geometry.Normals;
  NormalVariation variation = faces.Variation();
  EXPECT_LT(LargestDifference(variation.Minimize(data, Settings(0.3, 0.5, 20)), data), Rounding);
}

TEST(NormalVariation, AbortEndsTheWork)
{
  const Faces faces(LBlock(6));
  int reports = 0;
  const ProgressMonitor::Callback stop = [&](double) { return ++reports < 5; };
  EXPECT_THROW(faces.Variation().Minimize(
                 faces.Geometry.Normals, Settings(0.1, 0.1, 20), ProgressMonitor(stop)),
    Aborted);
  EXPECT_EQ(reports, 5);
}
