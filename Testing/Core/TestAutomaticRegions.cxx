// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
//
// Automatic weights and means of regions and edges, with data that are unusual.

#include "Meshes.h"
#include "Regions.h"

#include "Run/Solve.h"

#include <gtest/gtest.h>

#include <cmath>

using namespace SurfaceDiffusion;
using namespace SurfaceDiffusion::Testing;

namespace
{

const Testing::Surface& Sphere()
{
  static const Testing::Surface sphere = Icosphere(4);
  return sphere;
}

/// A cap of values 1 in 0, with normal noise; deviation(x) is that of a point.
template <typename F>
Values NoisyCap(const F& deviation)
{
  const TriangleMesh mesh(Sphere().Vertices, Sphere().Faces);
  const Values noise = NormalNoise(mesh, 1.0);
  Values f(Sphere().Vertices.rows(), 1);
  for (Index v = 0; v < mesh.NumberOfVertices(); ++v)
  {
    const Index i = mesh.InputVertex()[static_cast<std::size_t>(v)];
    const Eigen::RowVector3d x = Sphere().Vertices.row(i);
    f(i, 0) = (x[2] > 0.3 ? 1.0 : 0.0) + deviation(x) * noise(v, 0);
  }
  return f;
}

/// The share of points whose label is not that of the cap.
double ShareOfWrong(const Solution& solution)
{
  const Values& labels = solution.Arrays.at("RegionId");
  double wrong = 0.0;
  for (Eigen::Index i = 0; i < labels.rows(); ++i)
  {
    wrong += (Sphere().Vertices(i, 2) > 0.3 ? 2.0 : 1.0) == labels(i, 0) ? 0.0 : 1.0;
  }
  return wrong / static_cast<double>(labels.rows());
}

} // namespace

TEST(AutomaticRegions, AreThoseOfTheOtherPointsWhereOneIsAnOutlier)
{
  Values f = NoisyCap([](const Eigen::RowVector3d&) { return 0.3; });
  const Solution without = Segment(Sphere().Vertices, Sphere().Faces, f);
  EXPECT_LT(ShareOfWrong(without), 0.01);
  EXPECT_TRUE(without.Warnings.empty());
  for (const double outlier : { 50.0, -1e6 })
  {
    f(100, 0) = outlier;
    const Solution solution = Segment(Sphere().Vertices, Sphere().Faces, f);
    EXPECT_LT(ShareOfWrong(solution), 0.01) << outlier;
    ASSERT_EQ(solution.Warnings.size(), 1u);
    EXPECT_NE(solution.Warnings[0].find("count as outliers"), std::string::npos);
  }
}

/// 1/s^2 of the noise has the unit of the data.
TEST(AutomaticRegions, DoNotDependOnTheUnitOfFidelityFactors)
{
  const auto deviation = [](const Eigen::RowVector3d& x) { return x[0] > 0.0 ? 0.4 : 0.2; };
  const Values f = NoisyCap(deviation);
  double effective = 0.0;
  for (const double unit : { 1.0, 1e-3, 1e3 })
  {
    SurfaceData data(Values(unit * f));
    for (Eigen::Index i = 0; i < f.rows(); ++i)
    {
      data.FidelityFactors.Values.push_back(
        std::pow(unit * deviation(Sphere().Vertices.row(i)), -2));
    }
    EXPECT_LT(ShareOfWrong(Segment(Sphere().Vertices, Sphere().Faces, data)), 0.01) << unit;
    const Values u = MumfordShahEdges(Sphere().Vertices, Sphere().Faces, data).Result / unit;
    double error = 0.0;
    for (Eigen::Index i = 0; i < u.rows(); ++i)
    {
      error += std::pow(u(i, 0) - (Sphere().Vertices(i, 2) > 0.3 ? 1.0 : 0.0), 2);
    }
    error = std::sqrt(error / static_cast<double>(u.rows()));
    EXPECT_LT(error, 0.2) << unit;
    effective = unit == 1.0 ? error : effective;
    EXPECT_NEAR(error, effective, 1e-6) << unit;
  }
}
