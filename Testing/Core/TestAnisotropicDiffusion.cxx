// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Surface/TangentVectors.h"
#include "Heat.h"
#include "Meshes.h"

#include <gtest/gtest.h>

#include <cstdio>

using namespace SurfaceDiffusion;
using namespace SurfaceDiffusion::Testing;

namespace
{

/// (4) with constant g1 along `direction` of each triangle and g2 across.
Values DiffuseAlong(const Surface& s, const Points& directions, double g1, double g2,
  const Values& start, double time, int steps)
{
  const auto assembler = MakeAssembler(s);
  const TriangleMesh& mesh = assembler->Mesh();
  const TangentVectors frames =
    TangentVectorsFromTriangleVectors(mesh, s.Vertices, s.Faces, directions);
  const CornerWeights c = AnisotropicWeights(mesh, CotanWeights(mesh), frames, g1, g2);
  LinearDiffusion heat(assembler, c, PointData::FromValues(start), HeatSettings(mesh, time / steps),
    MakeCholeskySolver());
  Advance(heat, steps);
  return heat.State();
}

} // namespace

// Modes of a closed-off cylinder, e1 axial: exp(-(a k^2 + b n^2 / R^2) t) with (13), (14).
TEST(AnisotropicDiffusion, ModesOfACylinderDecayAtTheirOwnRates)
{
  const double radius = 0.7;
  const double length = 2.0;
  const double a = 2.0;
  const double b = 0.3;
  for (const auto& mode : { std::array<int, 2>{ 1, 0 }, { 0, 2 }, { 2, 1 } })
  {
    const double k = mode[0] * Pi / length;
    const int n = mode[1];
    const double rate = a * k * k + b * n * n / (radius * radius);
    double coarser = 0.0;
    for (const Index along : { 16, 32, 64 })
    {
      const Surface upright = Cylinder(2 * along, along, radius, length);
      const Surface s = Rotated(upright);
      const auto mesh = MakeMesh(s);
      const Points axis = Rotated({ Eigen::RowVector3d(0, 0, -1), Triangles() })
                            .Vertices.replicate(s.NumberOfTriangles(), 1);
      const Values start = Sample(*mesh, upright,
        [&](const Eigen::RowVector3d& p)
        { return std::cos(k * p[2]) * std::cos(n * std::atan2(p[1], p[0])); });
      const double time = 0.4 / rate;
      const Values exact = std::exp(-rate * time) * start;
      const Values u = DiffuseAlong(s, axis, a, b, start, time, 40);
      const double error = RootMeanSquare(*mesh, u - exact) / RootMeanSquare(*mesh, exact);
      if (coarser > 0.0)
      {
        const double order = ObservedOrder(coarser, error);
        std::printf(
          "k %d, n %d, %d rows: error %.2e, order in h %.3f\n", mode[0], n, along, error, order);
        EXPECT_NEAR(order, 2.0, 0.1);
      }
      coarser = error;
    }
  }
}

// On a plane the solution from a Gaussian is a Gaussian with 2 g t more variance along each axis.
TEST(AnisotropicDiffusion, GaussianSpreadsByTwiceGTimesTheTimeAlongEachAxis)
{
  const Surface s = Plate(100, 6.0);
  const auto mesh = MakeMesh(s);
  const Eigen::RowVector3d e1 = Eigen::RowVector3d(2.0, 1.0, 0.0).normalized();
  const Eigen::RowVector3d e2(-e1[1], e1[0], 0.0);
  const Values start =
    Sample(*mesh, s, [](const Eigen::RowVector3d& p) { return std::exp(-p.squaredNorm() / 0.5); });
  const double g1 = 1.0;
  const double g2 = 0.2;
  const double time = 0.5;
  const Values u = DiffuseAlong(s, e1.replicate(s.NumberOfTriangles(), 1), g1, g2, start, time, 10);
  const auto moment = [&](const Values& v, const Eigen::RowVector3d& x, const Eigen::RowVector3d& y)
  {
    double sum = 0.0;
    double total = 0.0;
    for (Index i = 0; i < mesh->NumberOfVertices(); ++i)
    {
      const Eigen::RowVector3d p = s.Vertices.row(mesh->InputVertex()[i]);
      sum += mesh->ControlAreas()[i] * v(i, 0) * p.dot(x) * p.dot(y);
      total += mesh->ControlAreas()[i] * v(i, 0);
    }
    return sum / total;
  };
  EXPECT_NEAR(moment(u, e1, e1) - moment(start, e1, e1), 2.0 * g1 * time, 1e-4);
  EXPECT_NEAR(moment(u, e2, e2) - moment(start, e2, e2), 2.0 * g2 * time, 1e-4);
  EXPECT_NEAR(moment(u, e1, e2), moment(start, e1, e2), 1e-4);
}

TEST(AnisotropicDiffusion, StrongAnisotropyStillConverges)
{
  // g1/g2 = 100 along the diagonal of a square, data that vary across it only slowly.
  double coarser = 0.0;
  for (const Index cells : { 32, 64 })
  {
    const Surface s = Plate(cells, 6.0);
    const auto mesh = MakeMesh(s);
    const Eigen::RowVector3d e1 = Eigen::RowVector3d(1.0, 1.0, 0.0).normalized();
    const Eigen::RowVector3d e2(-e1[1], e1[0], 0.0);
    const double time = 1.0;
    const auto gaussian = [&](double t)
    {
      const double v1 = 1.0 + 2.0 * t;
      const double v2 = 1.0 + 0.02 * t;
      return Sample(*mesh, s,
        [&](const Eigen::RowVector3d& p)
        {
          return std::exp(-0.5 * (std::pow(p.dot(e1), 2) / v1 + std::pow(p.dot(e2), 2) / v2)) /
            std::sqrt(v1 * v2);
        });
    };
    const Values u =
      DiffuseAlong(s, e1.replicate(s.NumberOfTriangles(), 1), 1.0, 0.01, gaussian(0.0), time, 20);
    const Values exact = gaussian(time);
    const double error = RootMeanSquare(*mesh, u - exact) / RootMeanSquare(*mesh, exact);
    if (coarser > 0.0)
    {
      const double order = ObservedOrder(coarser, error);
      std::printf("%d cells: error %.2e, order in h %.3f\n", cells, error, order);
      EXPECT_NEAR(order, 2.0, 0.15);
    }
    coarser = error;
  }
}
