// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Geometry/Derivatives.h"
#include "Meshes.h"
#include "Run/Solve.h"
#include "ThreadedFor.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <functional>
#include <limits>
#include <string>
#include <vector>

using namespace SurfaceDiffusion;
using namespace SurfaceDiffusion::Testing;
using Drawn = SurfaceDiffusion::Testing::Surface;

namespace
{

using Quantity = DerivativeQuantity;

Values Compute(const Drawn& s, const Values& data, Quantity quantity, double fwhm = 0.0,
  bool onCells = false, bool dataOnCells = false)
{
  DerivativesSettings settings;
  settings.Quantity = quantity;
  settings.SmoothingFWHM = fwhm;
  settings.ResultOnCells = onCells;
  Fields fields;
  fields.Data = { data, dataOnCells };
  return Derivative(s.Vertices, s.Faces, fields, settings).Result;
}

/// A row of `columns` values per vertex.
Values Sample(const Drawn& s, Eigen::Index columns,
  const std::function<Eigen::RowVectorXd(const Eigen::RowVector3d&)>& of)
{
  Values values(s.NumberOfVertices(), columns);
  for (Index i = 0; i < s.NumberOfVertices(); ++i)
  {
    values.row(i) = of(s.Vertices.row(i));
  }
  return values;
}

/// Of the first triangle.
Eigen::RowVector3d NormalOf(const Drawn& s)
{
  return (s.Vertices.row(s.Faces(0, 1)) - s.Vertices.row(s.Faces(0, 0)))
    .cross(s.Vertices.row(s.Faces(0, 2)) - s.Vertices.row(s.Faces(0, 0)))
    .normalized();
}

double RootMeanSquareOf(const Values& values)
{
  return std::sqrt(values.squaredNorm() / static_cast<double>(values.rows()));
}

/// A surface with the exact values of u, grad u, and of a field v = grad u + n x grad w.
struct Case
{
  Drawn S;
  Values U{}, Gradient{}, V{}, Divergence{}, Curl{};
};

Case OnSphere(int level)
{
  // u = z, w = x on the unit sphere, with Laplacians -2 u and -2 w.
  Case c{ Icosphere(level) };
  const auto tangential = [](const Eigen::RowVector3d& d, const Eigen::RowVector3d& n)
  { return Eigen::RowVector3d(d - d.dot(n) * n); };
  const Eigen::RowVector3d x(1.0, 0.0, 0.0);
  const Eigen::RowVector3d z(0.0, 0.0, 1.0);
  c.U = Sample(c.S, 1, [](const auto& p) { return Eigen::RowVectorXd::Constant(1, p[2]); });
  c.Gradient = Sample(c.S, 3, [&](const auto& p) { return tangential(z, p); });
  c.V = Sample(c.S, 3,
    [&](const auto& p)
    { return Eigen::RowVector3d(tangential(z, p) + p.cross(tangential(x, p))); });
  c.Divergence =
    Sample(c.S, 1, [](const auto& p) { return Eigen::RowVectorXd::Constant(1, -2.0 * p[2]); });
  c.Curl =
    Sample(c.S, 1, [](const auto& p) { return Eigen::RowVectorXd::Constant(1, -2.0 * p[0]); });
  return c;
}

/// A torus whose cells are all cut along the same diagonal, so that its vertices look alike.
Drawn RegularTorus(Index around, Index across)
{
  Drawn s = Torus(around, across);
  Index t = 0;
  for (Index j = 0; j < across; ++j)
  {
    for (Index i = 0; i < around; ++i)
    {
      const Index a = j * around + i;
      const Index b = j * around + (i + 1) % around;
      const Index c = (j + 1) % across * around + i;
      const Index d = (j + 1) % across * around + (i + 1) % around;
      s.Faces.row(t++) << a, b, d;
      s.Faces.row(t++) << a, d, c;
    }
  }
  return s;
}

Case OnTorus(Index across)
{
  // u = sin(v) of the angle v around the tube of radius 1, and w = cos(v); r = 2 + cos(v) is the
  // distance to the axis, and the Laplacian of f(v) is f'' - f' sin(v)/r.
  Case c{ RegularTorus(2 * across, across) };
  const auto at = [](const Eigen::RowVector3d& p)
  {
    struct
    {
      double V, R;
      Eigen::RowVector3d Along, Around; ///< unit vectors of v and of the angle about the axis
    } place;
    place.R = std::hypot(p[0], p[1]);
    place.V = std::atan2(p[2], place.R - 2.0);
    const Eigen::RowVector3d out(p[0] / place.R, p[1] / place.R, 0.0);
    place.Along = -std::sin(place.V) * out + std::cos(place.V) * Eigen::RowVector3d(0, 0, 1);
    place.Around << -out[1], out[0], 0.0;
    return place;
  };
  const auto scalar = [](double x) { return Eigen::RowVectorXd::Constant(1, x); };
  c.U = Sample(c.S, 1, [&](const auto& p) { return scalar(std::sin(at(p).V)); });
  c.Gradient = Sample(
    c.S, 3, [&](const auto& p) { return Eigen::RowVector3d(std::cos(at(p).V) * at(p).Along); });
  // grad w = -sin(v) Along, and n x Along = -Around with n = Along x Around inward.
  c.V = Sample(c.S, 3,
    [&](const auto& p) {
      return Eigen::RowVector3d(std::cos(at(p).V) * at(p).Along + std::sin(at(p).V) * at(p).Around);
    });
  c.Divergence = Sample(c.S, 1,
    [&](const auto& p)
    { return scalar(-std::sin(at(p).V) - std::cos(at(p).V) * std::sin(at(p).V) / at(p).R); });
  // The divergence of n x grad w is 0, and the curl of sin(v) Around is, up to the orientation,
  // -(1/r) d(r sin(v))/dv.
  c.Curl = Sample(c.S, 1,
    [&](const auto& p)
    {
      const double v = at(p).V;
      return scalar(-std::cos(v) + std::sin(v) * std::sin(v) / at(p).R);
    });
  return c;
}

void ExpectOrders(const char* name, const Case& coarse, const Case& fine, double ofLaplacian)
{
  struct Errors
  {
    double Gradient, Divergence, Curl, Laplacian;
  };
  const auto errorsOf = [](const Case& c)
  {
    Values curl = Compute(c.S, c.V, Quantity::Curl);
    if (curl.col(0).dot(c.Curl.col(0)) < 0.0) // the orientation of the mesh
    {
      curl = -curl;
    }
    return Errors{ RootMeanSquareOf(Compute(c.S, c.U, Quantity::Gradient) - c.Gradient),
      RootMeanSquareOf(Compute(c.S, c.V, Quantity::Divergence) - c.Divergence),
      RootMeanSquareOf(curl - c.Curl),
      RootMeanSquareOf(Compute(c.S, c.U, Quantity::Laplacian) - c.Divergence) };
  };
  const Errors a = errorsOf(coarse);
  const Errors b = errorsOf(fine);
  const auto order = [](double x, double y) { return ObservedOrder(x, y); };
  std::printf("%s: errors %.2g %.2g %.2g %.2g, orders %.2f %.2f %.2f %.2f\n", name, b.Gradient,
    b.Divergence, b.Curl, b.Laplacian, order(a.Gradient, b.Gradient),
    order(a.Divergence, b.Divergence), order(a.Curl, b.Curl), order(a.Laplacian, b.Laplacian));
  EXPECT_GT(order(a.Gradient, b.Gradient), 1.4);
  EXPECT_GT(order(a.Divergence, b.Divergence), 1.4);
  EXPECT_GT(order(a.Curl, b.Curl), 1.4);
  EXPECT_GT(order(a.Laplacian, b.Laplacian), ofLaplacian);
}

/// A flat piece with uneven triangles and a skew position in space.
Drawn UnevenPlate()
{
  return Rotated(Jittered(Plate(12, 1.0), 0.06, -0.99, 0.99, -0.99, 0.99));
}

/// Twice the area of the triangles at each vertex over six: A_i.
Vector ControlAreasOf(const Drawn& s)
{
  const auto mesh = MakeMesh(s);
  Vector areas = Vector::Zero(s.NumberOfVertices());
  for (Index i = 0; i < mesh->NumberOfVertices(); ++i)
  {
    areas[mesh->InputVertex()[i]] =
      mesh->ControlAreas()[i] * mesh->LengthUnit() * mesh->LengthUnit();
  }
  return areas;
}

} // namespace

TEST(Derivatives, HaveTheirOrders)
{
  ExpectOrders("sphere", OnSphere(4), OnSphere(5), 0.9);
  ExpectOrders("torus", OnTorus(32), OnTorus(64), 1.7);
}

TEST(Derivatives, OfConstantsAndOfLinearFunctionsOnPlanesAreExact)
{
  const Drawn s = UnevenPlate();
  const Eigen::RowVector3d normal = NormalOf(s);
  const Eigen::RowVector3d slope(0.3, -1.2, 0.7);
  const Eigen::RowVector3d tangential = slope - slope.dot(normal) * normal;
  const Values u = Sample(
    s, 1, [&](const auto& p) { return Eigen::RowVectorXd::Constant(1, 5.0 + p.dot(slope)); });
  const Eigen::Matrix3d a =
    (Eigen::Matrix3d() << 1.0, 2.0, 0.5, -0.3, 0.8, 0.1, 0.4, 1.5, -1.1).finished();
  const Values v =
    Sample(s, 3, [&](const auto& p) { return Eigen::RowVector3d(p * a.transpose()); });
  // The divergence and the curl of the tangential part, v = a x.
  const Eigen::Matrix3d plane = Eigen::Matrix3d::Identity() - normal.transpose() * normal;
  const double divergence = (plane * a).trace();
  const Eigen::RowVector3d whole(a(2, 1) - a(1, 2), a(0, 2) - a(2, 0), a(1, 0) - a(0, 1));
  for (const double fwhm : { 0.0, 0.7 })
  {
    for (const bool onCells : { false, true })
    {
      const Values gradient = Compute(s, u, Quantity::Gradient, fwhm, onCells);
      EXPECT_LT((gradient.rowwise() - tangential).cwiseAbs().maxCoeff(), fwhm > 0 ? 1e-9 : 1e-12);
      const double tolerance = fwhm > 0.0 ? 1e-7 : 1e-11;
      EXPECT_LT(Compute(s, u, Quantity::Laplacian, fwhm, onCells).cwiseAbs().maxCoeff(), tolerance);
      const Values d = Compute(s, v, Quantity::Divergence, fwhm, onCells);
      EXPECT_LT((d.array() - divergence).abs().maxCoeff(), tolerance);
      const Values c = Compute(s, v, Quantity::Curl, fwhm, onCells);
      EXPECT_LT((c.array() - whole.dot(normal)).abs().maxCoeff(), tolerance);
    }
  }
  const Values constant = Values::Constant(s.NumberOfVertices(), 1, 1e3);
  EXPECT_LT(Compute(s, constant, Quantity::Gradient).cwiseAbs().maxCoeff(), 1e-12);
  EXPECT_LT(Compute(s, constant, Quantity::Laplacian).cwiseAbs().maxCoeff(), 1e-12);
  const Values sphere = Compute(Icosphere(3), Values::Constant(642, 2, -7.0), Quantity::Gradient);
  EXPECT_EQ(sphere.cols(), 6);
  EXPECT_LT(sphere.cwiseAbs().maxCoeff(), 1e-12);
}

TEST(Derivatives, OfLinearFunctionsOnCellsAreExactOnPlanes)
{
  const Drawn s = UnevenPlate();
  const Eigen::RowVector3d normal = NormalOf(s);
  const Eigen::RowVector3d slope(0.3, -1.2, 0.7);
  const Eigen::RowVector3d tangential = slope - slope.dot(normal) * normal;
  Values u(s.Faces.rows(), 1);
  for (Eigen::Index t = 0; t < s.Faces.rows(); ++t)
  {
    const Eigen::RowVector3d sum =
      s.Vertices.row(s.Faces(t, 0)) + s.Vertices.row(s.Faces(t, 1)) + s.Vertices.row(s.Faces(t, 2));
    u(t, 0) = 5.0 + sum.dot(slope) / 3.0;
  }
  const double without = std::numeric_limits<double>::quiet_NaN();
  for (const bool isMissing : { false, true })
  {
    u(17, 0) = isMissing ? without : u(17, 0);
    for (const bool onCells : { false, true })
    {
      const Values gradient = Compute(s, u, Quantity::Gradient, 0.0, onCells, true);
      Index missing = 0;
      for (Eigen::Index i = 0; i < gradient.rows(); ++i)
      {
        const bool isNaN = gradient.row(i).hasNaN();
        missing += isNaN;
        EXPECT_TRUE(isNaN || (gradient.row(i) - tangential).norm() < 1e-11) << i;
      }
      EXPECT_EQ(missing, isMissing && onCells ? 1 : 0);
    }
  }
}

TEST(Derivatives, OfDataOnCellsAreAsAccurateAsThoseOfPoints)
{
  const auto of = [](const Eigen::RowVector3d& p)
  { return Eigen::RowVectorXd::Constant(1, std::sin(2.0 * p[0] + 1.0) * std::cos(1.5 * p[1])); };
  for (const double amount : { 0.0, 0.3 })
  {
    const Drawn s = Jittered(Plate(40, 1.0), amount * 0.05, -0.99, 0.99, -0.99, 0.99);
    Drawn centroids = s;
    centroids.Vertices.resize(s.Faces.rows(), 3);
    for (Eigen::Index t = 0; t < s.Faces.rows(); ++t)
    {
      centroids.Vertices.row(t) = (s.Vertices.row(s.Faces(t, 0)) + s.Vertices.row(s.Faces(t, 1)) +
                                    s.Vertices.row(s.Faces(t, 2))) /
        3.0;
    }
    const Values ofPoints = Compute(s, Sample(s, 1, of), Quantity::Gradient);
    const Values ofCells =
      Compute(s, Sample(centroids, 1, of), Quantity::Gradient, 0.0, false, true);
    // Means over the control cells give 0.15 and 0.24.
    EXPECT_LT(RootMeanSquareOf(ofCells - ofPoints), 0.03) << amount;
  }
}

TEST(Derivatives, ObeyTheTheoremsOfGaussAndStokes)
{
  const Drawn sphere = Icosphere(3);
  const auto field = [](const auto& p)
  { return Eigen::RowVector3d(p[1] * p[2], std::sin(3.0 * p[0]), 1.0 + p[2] * p[0]); };
  const Values v = Sample(sphere, 3, field);
  for (const Quantity quantity : { Quantity::Divergence, Quantity::Curl })
  {
    const Values found = Compute(sphere, v, quantity);
    EXPECT_GT(found.cwiseAbs().maxCoeff(), 0.5);
    EXPECT_NEAR(ControlAreasOf(sphere).dot(found.col(0)), 0.0, 1e-12);
  }
  // The flux across the boundary of a square that is not flat inside: over its four straight sides,
  // in planes z = 0, of a field that is linear there.
  Drawn plate = Jittered(Plate(12, 1.0), 0.06, -0.99, 0.99, -0.99, 0.99);
  const Values linear = Sample(plate, 3,
    [](const auto& p) { return Eigen::RowVector3d(2.0 * p[0] + p[1], p[1] - 4.0 * p[0], 0.0); });
  const double area = ControlAreasOf(plate).sum();
  const Values divergence = Compute(plate, linear, Quantity::Divergence);
  const Values curl = Compute(plate, linear, Quantity::Curl);
  EXPECT_NEAR(ControlAreasOf(plate).dot(divergence.col(0)), 3.0 * area, 1e-12);
  EXPECT_NEAR(std::abs(ControlAreasOf(plate).dot(curl.col(0))), 5.0 * area, 1e-12);
}

TEST(Derivatives, TheCurlOfAGradientIsZero)
{
  for (const Drawn& s : { Icosphere(3), UnevenPlate(), Torus(30, 16) })
  {
    const Values u = Sample(s, 1,
      [](const auto& p)
      { return Eigen::RowVectorXd::Constant(1, std::sin(2.0 * p[0]) * p[1] + p[2]); });
    const Values gradient = Compute(s, u, Quantity::Gradient, 0.0, true);
    EXPECT_LT(Compute(s, gradient, Quantity::Curl, 0.0, false, true).cwiseAbs().maxCoeff(), 1e-11);
    // The divergence is the Laplacian inside.
    const Values laplacian = Compute(s, u, Quantity::Laplacian);
    Values difference = Compute(s, gradient, Quantity::Divergence, 0.0, false, true) - laplacian;
    const auto mesh = MakeMesh(s);
    for (const Index i : mesh->BoundaryVertices())
    {
      difference.row(mesh->InputVertex()[i]).setZero();
    }
    EXPECT_LT(difference.cwiseAbs().maxCoeff(), 1e-11 * laplacian.cwiseAbs().maxCoeff());
  }
}

TEST(Derivatives, TheLaplacianIsRightAtBoundaries)
{
  const auto square = [](const Eigen::RowVector3d& p)
  { return Eigen::RowVectorXd::Constant(1, 3.0 + p[0] + p.squaredNorm()); };
  for (const Drawn& s : { Plate(4, 1.0), UnevenPlate(), Scaled(Rotated(Disk(6)), 1e3) })
  {
    const Values found = Compute(s, Sample(s, 1, square), Quantity::Laplacian);
    const auto mesh = MakeMesh(s);
    for (const Index i : mesh->BoundaryVertices())
    {
      EXPECT_NEAR(found(mesh->InputVertex()[i], 0), 4.0, 1e-9);
    }
  }
  // Of x on half a sphere: -2 x, also where the outermost triangles are on one side.
  double last = 1.0;
  for (const int level : { 3, 4, 5 })
  {
    Drawn s = Icosphere(level);
    std::vector<std::array<Index, 3>> faces;
    for (Index t = 0; t < s.NumberOfTriangles(); ++t)
    {
      if (s.Vertices(s.Faces(t, 0), 2) + s.Vertices(s.Faces(t, 1), 2) +
          s.Vertices(s.Faces(t, 2), 2) >
        0.0)
      {
        faces.push_back({ s.Faces(t, 0), s.Faces(t, 1), s.Faces(t, 2) });
      }
    }
    s.Faces.resize(static_cast<Eigen::Index>(faces.size()), 3);
    for (std::size_t t = 0; t < faces.size(); ++t)
    {
      s.Faces.row(static_cast<Eigen::Index>(t)) << faces[t][0], faces[t][1], faces[t][2];
    }
    const Values u = s.Vertices.col(0);
    const Values found = Compute(s, u, Quantity::Laplacian);
    const auto mesh = MakeMesh(s);
    double worst = 0.0;
    for (const Index i : mesh->BoundaryVertices())
    {
      const Index p = mesh->InputVertex()[i];
      worst = std::max(worst, std::abs(found(p, 0) + 2.0 * u(p, 0)));
    }
    std::printf("Laplacian at the rim of half a sphere: error %.3g\n", worst);
    EXPECT_LT(worst, 0.7 * last);
    last = worst;
  }
}

TEST(Derivatives, NoLaplacianIsSaidWhereNoneIsDetermined)
{
  const Drawn strip = Strip(8, 1);
  DerivativesSettings settings;
  settings.Quantity = Quantity::Laplacian;
  const Values u = strip.Vertices.col(0);
  const Solution found = Derivative(strip.Vertices, strip.Faces, u, settings);
  EXPECT_TRUE(found.Result.array().isNaN().all());
  ASSERT_EQ(found.Warnings.size(), 1U);
  EXPECT_NE(found.Warnings[0].find("no Laplacian"), std::string::npos) << found.Warnings[0];
}

TEST(Derivatives, OfVectorsWithANormalPartConvergeOnIrregularMeshes)
{
  double last = 1.0;
  for (const int level : { 4, 5, 6 })
  {
    Drawn s = Icosphere(level);
    const double h = MeanEdge(*MakeMesh(s));
    for (Index i = 0; i < s.NumberOfVertices(); ++i)
    {
      for (int c = 0; c < 3; ++c)
      {
        s.Vertices(i, c) += 0.2 * h * (2.0 * UniformRandom(9, c, i) - 1.0);
      }
      s.Vertices.row(i).normalize();
    }
    const Values up = Sample(s, 3, [](const auto&) { return Eigen::RowVector3d(0.0, 0.0, 1.0); });
    const Values z = s.Vertices.col(2);
    const double error = RootMeanSquareOf(Compute(s, up, Quantity::Divergence) + 2.0 * z);
    const double ofCurl = RootMeanSquareOf(Compute(s, up, Quantity::Curl));
    std::printf(
      "e_z on an irregular sphere: errors of divergence and curl %.3g %.3g\n", error, ofCurl);
    EXPECT_LT(error, 0.65 * last);
    EXPECT_LT(ofCurl, error);
    last = error;
  }
  EXPECT_LT(last, 0.03);
}

TEST(Derivatives, OfASurfaceWithOneSideNeedNoSeam)
{
  const Drawn s = Moebius(60, 6);
  const std::vector<Index> numbers = Permutation(s.NumberOfVertices(), 3);
  const Drawn other = Scaled(Renumbered(s, numbers), 1e-3);
  const auto function = [](const Eigen::RowVector3d& p)
  { return Eigen::RowVectorXd::Constant(1, std::sin(p[0]) * p[2] + 2.0 * p[1]); };
  const auto field = [](const Eigen::RowVector3d& p)
  { return Eigen::RowVector3d(p[1] * p[2], std::sin(3.0 * p[0]), 1.0 + p[2] * p[0]); };
  const Values u = Sample(s, 1, function);
  const Values v = Sample(s, 3, field);
  const auto renumbered = [&](const Values& of)
  {
    Values result = of;
    for (Index i = 0; i < s.NumberOfVertices(); ++i)
    {
      result.row(numbers[i]) = of.row(i);
    }
    return result;
  };
  for (const Quantity quantity : { Quantity::Gradient, Quantity::ConductionVelocity,
         Quantity::Laplacian, Quantity::Divergence, Quantity::Curl })
  {
    const bool takesVectors = quantity == Quantity::Divergence || quantity == Quantity::Curl;
    const double unit = quantity == Quantity::ConductionVelocity ? 1e3
      : quantity == Quantity::Laplacian                          ? 1e-6
                                                                 : 1e-3;
    for (const double fwhm : { 0.0, 0.3 })
    {
      const Values& data = takesVectors ? v : u;
      const Values found = Compute(s, data, quantity, fwhm);
      const Values again = unit * Compute(other, renumbered(data), quantity, 1e-3 * fwhm);
      EXPECT_LT(
        (again - renumbered(found)).cwiseAbs().maxCoeff(), 1e-8 * found.cwiseAbs().maxCoeff())
        << static_cast<int>(quantity) << ' ' << fwhm;
    }
  }
  // At each vertex the gradient is near that of the function in space, projected.
  const Values gradient = Compute(s, Values(s.Vertices.col(1)), Quantity::Gradient);
  const Values onTriangles = Compute(s, Values(s.Vertices.col(1)), Quantity::Gradient, 0.0, true);
  for (Index t = 0; t < s.NumberOfTriangles(); ++t)
  {
    for (int a = 0; a < 3; ++a)
    {
      EXPECT_LT((gradient.row(s.Faces(t, a)) - onTriangles.row(t)).norm(), 0.2);
    }
  }
}

TEST(Derivatives, FindTheSpeedOfANoisyPlanarWave)
{
  // 60 mm x 60 mm with edges of about 1 mm; 0.6 mm/ms = 0.6 m/s.
  const Drawn s = Rotated(Scaled(Plate(60, 1.0), 30.0));
  const Eigen::RowVector3d along =
    (s.Vertices.row(s.Faces(0, 1)) - s.Vertices.row(s.Faces(0, 0))).normalized();
  Values times = Sample(s, 1,
    [&](const auto& p) { return Eigen::RowVectorXd::Constant(1, 20.0 + p.dot(along) / 0.6); });
  const Values exact = Compute(s, times, Quantity::ConductionVelocity);
  EXPECT_LT((exact.rowwise() - 0.6 * along).cwiseAbs().maxCoeff(), 1e-10);
  for (Index i = 0; i < times.rows(); ++i)
  {
    times(i, 0) += 2.0 * std::sqrt(-2.0 * std::log(1.0 - UniformRandom(1, 0, i))) *
      std::cos(2.0 * Pi * UniformRandom(1, 1, i));
  }
  DerivativesSettings settings;
  settings.Quantity = Quantity::ConductionVelocity;
  settings.SmoothingFWHM = 14.0;
  const Solution found = Derivative(s.Vertices, s.Faces, times, settings);
  const Values& speed = found.Arrays.at("Speed");
  const double error = RootMeanSquareOf(speed.array() - 0.6) / 0.6;
  std::printf(
    "planar wave: mean speed %.4f, root mean square error %.2f %%\n", speed.mean(), 100.0 * error);
  EXPECT_NEAR(speed.mean(), 0.6, 0.02 * 0.6);
  EXPECT_LT(error, 0.02);
  EXPECT_LT((found.Result.rowwise().norm() - speed).cwiseAbs().maxCoeff(), 1e-12);
}

TEST(Derivatives, TheBandOfTheSpeedOfAPlanarWaveHoldsIt)
{
  const Drawn s = Plate(10, 1.0);
  const double slowness = 1.0 / 0.6;
  Fields fields;
  // Columns of slopes that are wrong by 1.6 standard errors, by 1.7, and by more than the slope itself.
  fields.Data.Values =
    s.Vertices.col(0) * Eigen::RowVector3d(slowness + 0.16, slowness + 0.17, 0.1);
  DerivativesSettings settings;
  settings.Quantity = DerivativeQuantity::ConductionVelocity;
  const Solution before = Derivative(s.Vertices, s.Faces, fields, settings);
  fields.SlopeErrors = Values::Constant(s.NumberOfVertices(), 3, 0.1);
  fields.SlopeErrors(7, 0) = std::numeric_limits<double>::quiet_NaN();
  const Solution found = Derivative(s.Vertices, s.Faces, fields, settings);
  // The band comes on top of what there is without it.
  EXPECT_EQ(found.Result, before.Result);
  EXPECT_EQ(found.Arrays.size(), before.Arrays.size() + 2);
  for (const auto& [name, values] : before.Arrays)
  {
    EXPECT_EQ(found.Arrays.at(name), values) << name;
  }
  EXPECT_EQ(before.Arrays.count("SpeedLower") + before.Arrays.count("SpeedUpper"), 0u);
  const Values& lower = found.Arrays.at("SpeedLower");
  const Values& upper = found.Arrays.at("SpeedUpper");
  for (Index i = 0; i < s.NumberOfVertices(); ++i)
  {
    if (i == 7)
    {
      EXPECT_TRUE(std::isnan(lower(i, 0)) && std::isnan(upper(i, 0)));
      continue;
    }
    EXPECT_TRUE(lower(i, 0) < 0.6 && 0.6 < upper(i, 0)) << lower(i, 0) << ' ' << upper(i, 0);
    EXPECT_LT(upper(i, 1), 0.6);
    EXPECT_NEAR(1.0 / lower(i, 1) - 1.0 / upper(i, 1), 0.329, 1e-4);
    EXPECT_NEAR(lower(i, 2), 1.0 / 0.2645, 1e-3);
    EXPECT_EQ(upper(i, 2), std::numeric_limits<double>::infinity());
  }
  const auto expect = [&](const std::string& text)
  {
    try
    {
      Derivative(s.Vertices, s.Faces, fields, settings);
      ADD_FAILURE() << "no error; expected: " << text;
    }
    catch (const std::runtime_error& error)
    {
      EXPECT_NE(std::string(error.what()).find(text), std::string::npos) << error.what();
    }
  };
  settings.SmoothingFWHM = 0.5;
  expect("SmoothingFWHM is 0.5; allowed: 0 together with SlopeErrors");
  settings.SmoothingFWHM = 0.0;
  settings.ResultOnCells = true;
  expect("allowed: 0 together with SlopeErrors");
  settings.ResultOnCells = false;
  fields.SlopeErrors(4, 1) = -0.1;
  expect("SlopeErrors is negative at point 4; allowed: 0 or more");
  fields.SlopeErrors.conservativeResize(Eigen::NoChange, 2);
  expect("SlopeErrors has 2 components; allowed: 3, as many as Data");
}

TEST(Derivatives, LeaveOutMissingDataAndMaskedParts)
{
  const Drawn s = Plate(10, 1.0);
  Values u =
    Sample(s, 1, [](const auto& p) { return Eigen::RowVectorXd::Constant(1, 2.0 * p[0] - p[1]); });
  const Index hole = 60;
  u(hole, 0) = std::numeric_limits<double>::quiet_NaN();
  const Values found = Compute(s, u, Quantity::Gradient);
  for (Index i = 0; i < s.NumberOfVertices(); ++i)
  {
    if (i == hole)
    {
      EXPECT_TRUE(std::isnan(found(i, 0)));
      continue;
    }
    EXPECT_LT((found.row(i) - Eigen::RowVector3d(2.0, -1.0, 0.0)).norm(), 1e-12) << i;
  }
  // A mask separates, and wrong values behind it do not matter.
  Fields fields;
  fields.Data.Values = u;
  fields.Data.Values(hole, 0) = 1e6;
  fields.Mask.Values.assign(static_cast<std::size_t>(s.NumberOfVertices()), 0);
  fields.Mask.Values[hole] = 1;
  const Values masked = Derivative(s.Vertices, s.Faces, fields).Result;
  EXPECT_EQ(masked.row(hole).norm(), 0.0);
  EXPECT_LT((masked.row(hole + 1) - Eigen::RowVector3d(2.0, -1.0, 0.0)).norm(), 1e-12);
}

TEST(Derivatives, DoNotDependOnThreadsOrOrientation)
{
  const Drawn s = Icosphere(5);
  const Values u =
    Sample(s, 2, [](const auto& p) { return Eigen::RowVector2d(p[0] * p[1], std::exp(p[2])); });
  DerivativesSettings settings;
  settings.SmoothingFWHM = 0.2;
  const Values one = Derivative(s.Vertices, s.Faces, u, settings).Result;
  const ThreadedFor threads(4);
  EXPECT_EQ(one, Derivative(s.Vertices, s.Faces, u, settings, threads).Result);
  Drawn mixed = s;
  for (Index t = 0; t < mixed.NumberOfTriangles(); t += 3)
  {
    std::swap(mixed.Faces(t, 0), mixed.Faces(t, 1));
  }
  const Solution found = Derivative(mixed.Vertices, mixed.Faces, u, settings);
  EXPECT_LT((found.Result - one).cwiseAbs().maxCoeff(), 1e-9);
  EXPECT_EQ(found.Warnings.size(), 1U);
}
