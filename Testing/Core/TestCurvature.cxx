// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Geometry/Curvature.h"
#include "Core/Surface/IntrinsicDelaunay.h"
#include "Meshes.h"
#include "ThreadedFor.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <functional>
#include <vector>

using namespace SurfaceDiffusion;
using namespace SurfaceDiffusion::Testing;

namespace
{

/// The curvatures of a surface in coordinate units, per vertex of its mesh.
struct Result
{
  std::shared_ptr<const Assembler> Operators;
  Curvatures Found;

  const TriangleMesh& Mesh() const { return this->Operators->Mesh(); }
  Index InputVertex(Index i) const { return this->Mesh().InputVertex()[i]; }
};

Result Estimate(const Surface& s, double fwhm = 0.0, const ParallelFor& parallel = SerialFor())
{
  Result result;
  result.Operators = MakeAssembler(s);
  const TriangleMesh& mesh = result.Mesh();
  const double unit = mesh.LengthUnit();
  const Assembler delaunay(IntrinsicDelaunay(result.Operators->SharedMesh()).Mesh());
  Points positions(mesh.NumberOfVertices(), 3);
  for (Index i = 0; i < mesh.NumberOfVertices(); ++i)
  {
    positions.row(i) = s.Vertices.row(mesh.InputVertex()[i]) / unit;
  }
  result.Found = EstimateCurvature(mesh, positions, fwhm / unit, &delaunay, parallel);
  result.Found.Mean /= unit;
  result.Found.Gaussian /= unit * unit;
  result.Found.Principal /= unit;
  return result;
}

/// Root mean square of a value per vertex.
double RootMeanSquareOf(const Result& result, const std::function<double(Index)>& of)
{
  Values values(result.Mesh().NumberOfVertices(), 1);
  for (Index i = 0; i < values.rows(); ++i)
  {
    values(i, 0) = of(i);
  }
  return RootMeanSquare(result.Mesh(), values);
}

constexpr double Major = 2.0;
constexpr double Minor = 1.0;

/// The principal curvature of a torus of circles about the z axis at a point.
double SmallerOnTorus(const Eigen::RowVector3d& p)
{
  const double r = std::hypot(p[0], p[1]);
  return (r - Major) / Minor / r;
}

struct TorusErrors
{
  double Mean, Gaussian, Principal;
};

TorusErrors ErrorsOnTorus(const Surface& s, double fwhm = 0.0)
{
  const Result result = Estimate(s, fwhm);
  const auto smaller = [&](Index i)
  { return SmallerOnTorus(s.Vertices.row(result.InputVertex(i))); };
  return { RootMeanSquareOf(result,
             [&](Index i) { return result.Found.Mean[i] - 0.5 * (1.0 / Minor + smaller(i)); }),
    RootMeanSquareOf(
      result, [&](Index i) { return result.Found.Gaussian[i] - smaller(i) / Minor; }),
    RootMeanSquareOf(result,
      [&](Index i)
      {
        return std::hypot(
          result.Found.Principal(i, 0) - 1.0 / Minor, result.Found.Principal(i, 1) - smaller(i));
      }) };
}

/// A torus whose vertices are moved along it at random, by up to `amount` of an edge.
Surface UnevenTorus(Index around, Index across, double amount)
{
  Surface s = Torus(around, across, Major, Minor);
  for (Index i = 0; i < s.NumberOfVertices(); ++i)
  {
    const Eigen::RowVector3d p = s.Vertices.row(i);
    const auto move = [&](int c) { return amount * (2.0 * UniformRandom(3, c, i) - 1.0); };
    const double u = std::atan2(p[1], p[0]) + move(0) * 2.0 * Pi / around;
    const double v = std::atan2(p[2], std::hypot(p[0], p[1]) - Major) + move(1) * 2.0 * Pi / across;
    const double r = Major + Minor * std::cos(v);
    s.Vertices.row(i) << r * std::cos(u), r * std::sin(u), Minor * std::sin(v);
  }
  return s;
}

double Normal(std::int64_t seed, int c, Index i)
{
  return std::sqrt(-2.0 * std::log(1.0 - UniformRandom(seed, c, i))) *
    std::cos(2.0 * Pi * UniformRandom(seed + 1, c, i));
}

/// The upper part of a sphere, cut at the edges of triangles.
Surface Cap(int level, double radius)
{
  Surface s = Icosphere(level, radius);
  std::vector<std::array<Index, 3>> faces;
  for (Index t = 0; t < s.NumberOfTriangles(); ++t)
  {
    const auto z = [&](int a) { return s.Vertices(s.Faces(t, a), 2); };
    if (std::min({ z(0), z(1), z(2) }) > 0.2 * radius)
    {
      faces.push_back({ s.Faces(t, 0), s.Faces(t, 1), s.Faces(t, 2) });
    }
  }
  s.Faces.resize(static_cast<Eigen::Index>(faces.size()), 3);
  for (std::size_t t = 0; t < faces.size(); ++t)
  {
    s.Faces.row(static_cast<Eigen::Index>(t)) << faces[t][0], faces[t][1], faces[t][2];
  }
  return s;
}

/// The hull of a few points on the unit sphere, at random: the triangles with all others on one side.
Surface Hull(Index points, std::int64_t seed)
{
  Surface s{ Points(points, 3), Triangles() };
  for (Index i = 0; i < points; ++i)
  {
    for (int c = 0; c < 3; ++c)
    {
      s.Vertices(i, c) = Normal(seed, c, i);
    }
    s.Vertices.row(i).normalize();
  }
  std::vector<Eigen::RowVector3d> vertices;
  std::vector<std::array<Index, 3>> faces;
  for (Index i = 0; i < points; ++i)
  {
    vertices.emplace_back(s.Vertices.row(i));
    for (Index j = 0; j < points; ++j)
    {
      for (Index k = 0; k < points; ++k)
      {
        const Eigen::RowVector3d a = s.Vertices.row(i);
        const Eigen::RowVector3d normal = (s.Vertices.row(j) - a).cross(s.Vertices.row(k) - a);
        if (i < j && i < k && j != k &&
          ((s.Vertices.rowwise() - a) * normal.transpose()).maxCoeff() < 1e-12)
        {
          faces.push_back({ i, j, k });
        }
      }
    }
  }
  return MakeSurface(vertices, faces);
}

/// An L with arms of these lengths and widths, and a height.
Surface LPrism(double a, double b, double widthOfA, double widthOfB, double height)
{
  const double outline[6][2] = { { 0.0, 0.0 }, { a, 0.0 }, { a, widthOfA }, { widthOfB, widthOfA },
    { widthOfB, b }, { 0.0, b } };
  std::vector<Eigen::RowVector3d> vertices;
  std::vector<std::array<Index, 3>> faces;
  for (const double z : { 0.0, height })
  {
    for (const auto& p : outline)
    {
      vertices.emplace_back(p[0], p[1], z);
    }
  }
  for (Index i = 1; i < 5; ++i)
  {
    faces.push_back({ 0, i + 1, i });
    faces.push_back({ 6, i + 6, i + 7 });
  }
  for (Index i = 0; i < 6; ++i)
  {
    const Index j = (i + 1) % 6;
    faces.push_back({ i, j, j + 6 });
    faces.push_back({ i, j + 6, i + 6 });
  }
  return MakeSurface(vertices, faces);
}

/// Per vertex of the input.
Values MeanOf(const Surface& s, double fwhm = 0.0)
{
  const Result found = Estimate(s, fwhm);
  return ToInput(found.Mesh(), found.Found.Mean, s.NumberOfVertices());
}

/// With the coordinates that files and VTK have.
Surface InSinglePrecision(Surface s)
{
  s.Vertices = s.Vertices.cast<float>().cast<double>().eval();
  return s;
}

} // namespace

TEST(Curvature, OfPiecesThatDetermineNoPolynomialDoesNotDependOnTheAxes)
{
  std::vector<Surface> pieces = { Icosphere(0),
    MakeSurface({ { 2, 2, 0 }, { 3, 3, 2 }, { 1, 1, 2 }, { 0, 2, 2 } },
      { { 2, 1, 3 }, { 0, 3, 1 }, { 0, 2, 3 }, { 0, 1, 2 } }),
    MakeSurface({ { 0, 0, 0 }, { 1, 0, 0.3 }, { 0, 1, 0.2 }, { -1, 0.2, 0.4 } },
      { { 0, 1, 2 }, { 0, 2, 3 } }),
    LPrism(3.0, 2.0, 0.5, 1.0, 0.7) };
  for (Index seed = 0; seed < 10; ++seed)
  {
    pieces.push_back(Hull(5 + seed % 3, 10 * seed));
  }
  for (const Surface& s : pieces)
  {
    const Values expected = MeanOf(s);
    for (const double angle : { 0.5, 1.0, 2.0 })
    {
      const Surface turned = Scaled(Rotated(s, angle), 1e3);
      EXPECT_LT((1e3 * MeanOf(turned) - expected).cwiseAbs().maxCoeff(),
        1e-9 * (1.0 + expected.cwiseAbs().maxCoeff()));
    }
  }
}

TEST(Curvature, OfConvexSolidsIsPositive)
{
  std::vector<Surface> solids = { Icosphere(0), Hull(4, 1) };
  for (Index seed = 0; seed < 20; ++seed)
  {
    for (const Index points : { 6, 10, 20 })
    {
      solids.push_back(Hull(points, 7 * seed + points));
    }
  }
  for (const Surface& s : solids)
  {
    EXPECT_GT(MeanOf(s).minCoeff(), 0.0) << s.NumberOfVertices();
  }
  for (Index seed = 0; seed < 100; ++seed)
  {
    const auto random = [&](int c) { return UniformRandom(5, c, seed); };
    const double a = 1.0 + 4.0 * random(0);
    const double b = 1.0 + 4.0 * random(1);
    const Values mean = MeanOf(LPrism(
      a, b, b * (0.1 + 0.8 * random(2)), a * (0.1 + 0.8 * random(3)), 0.05 + 5.0 * random(4)));
    for (Index i = 0; i < 12; ++i)
    {
      EXPECT_TRUE(i % 6 == 3 || mean(i, 0) > 1e-3) << seed << ' ' << i << ' ' << mean(i, 0);
    }
  }
}

TEST(Curvature, OfASurfaceWithOneSideNeedsNoSeam)
{
  const Surface s = Moebius(60, 6);
  const std::vector<Index> numbers = Permutation(s.NumberOfVertices(), 3);
  const Surface other = Scaled(Rotated(Renumbered(s, numbers)), 1e-3);
  // The same strip in two halves, which have two sides each.
  const auto halfOf = [&](bool isFirst)
  {
    Surface half = s;
    std::vector<std::array<Index, 3>> faces;
    for (Index t = 0; t < s.NumberOfTriangles(); ++t)
    {
      const double y =
        s.Vertices(s.Faces(t, 0), 1) + s.Vertices(s.Faces(t, 1), 1) + s.Vertices(s.Faces(t, 2), 1);
      if ((y > 0.0) == isFirst)
      {
        faces.push_back({ s.Faces(t, 0), s.Faces(t, 1), s.Faces(t, 2) });
      }
    }
    half.Faces.resize(static_cast<Eigen::Index>(faces.size()), 3);
    for (std::size_t t = 0; t < faces.size(); ++t)
    {
      half.Faces.row(static_cast<Eigen::Index>(t)) << faces[t][0], faces[t][1], faces[t][2];
    }
    return half;
  };
  for (const double fwhm : { 0.0, 0.3 })
  {
    const Values found = MeanOf(s, fwhm);
    const Values again = MeanOf(other, 1e-3 * fwhm) * 1e-3;
    const Values first = MeanOf(halfOf(true), fwhm);
    const Values second = MeanOf(halfOf(false), fwhm);
    EXPECT_GT(found.maxCoeff(), 0.05);
    for (Index i = 0; i < s.NumberOfVertices(); ++i)
    {
      ASSERT_NEAR(again(numbers[i], 0), found(i, 0), 1e-7) << fwhm;
      const double y = s.Vertices(i, 1);
      if (std::abs(y) > 0.8)
      {
        const double ofHalf = std::abs((y > 0.0 ? first : second)(i, 0));
        if (fwhm > 0.0)
        {
          ASSERT_NEAR(found(i, 0), ofHalf, 0.01) << i;
        }
        else
        {
          ASSERT_NEAR(found(i, 0), ofHalf, 1e-9) << i;
        }
      }
    }
  }
}

TEST(Curvature, OfPlanesInSinglePrecisionIsZero)
{
  const Surface plane = Jittered(Plate(20, 1.0), 0.03, -0.99, 0.99, -0.99, 0.99);
  const Surface coarse = Jittered(Plate(3, 1.0), 0.2, -0.99, 0.99, -0.99, 0.99);
  for (const Surface& flat : { plane, coarse, Moved(plane, { 30.0, 0.0, 0.0 }) })
  {
    for (const double angle : { 0.3, 1.0, 2.2 })
    {
      const Surface s = InSinglePrecision(Scaled(Rotated(flat, angle), 37.0));
      for (const double fwhm : { 0.0, 15.0 })
      {
        const Result found = Estimate(s, fwhm);
        for (Index i = 0; i < found.Mesh().NumberOfVertices(); ++i)
        {
          ASSERT_EQ(found.Found.Curvedness(i), 0.0) << fwhm << ' ' << angle;
          ASSERT_EQ(found.Found.ShapeIndex(i), 0.0);
        }
      }
    }
  }
  // What is no rounding stays.
  const Surface sphere = InSinglePrecision(Icosphere(6));
  EXPECT_NEAR(MeanOf(sphere).minCoeff(), 1.0, 0.01);
}

/// Of half planes that meet in an edge, and of solids without other edges than sharp ones. Where no
/// neighbours with normals at 60 degrees or more count, the sharpest ones are flat.
TEST(Curvature, SharpEdgesAndCornersAreNotFlat)
{
  double last = 0.0;
  for (const double degrees : { 110.0, 90.0, 70.0, 50.0, 30.0 })
  {
    const double half = 0.5 * degrees * Pi / 180.0;
    Surface wedge = Plate(16, 1.0);
    for (auto&& v : wedge.Vertices.rowwise())
    {
      const double x = v[0];
      v[0] = -std::abs(x) * std::cos(half);
      v[2] = x * std::sin(half);
    }
    const Result result = Estimate(wedge);
    double least = std::numeric_limits<double>::infinity();
    for (Index i = 0; i < result.Mesh().NumberOfVertices(); ++i)
    {
      const auto p = wedge.Vertices.row(result.InputVertex(i));
      if (p[0] == 0.0 && std::abs(p[1]) < 0.9)
      {
        least = std::min(least, std::abs(result.Found.Mean[i]));
      }
    }
    EXPECT_GT(least, 1.2 * last) << degrees;
    last = least;
  }
  for (const Surface& solid : { Tetrahedron(), Icosphere(0) })
  {
    const Result result = Estimate(solid);
    EXPECT_GT(result.Found.Mean.cwiseAbs().minCoeff(), 0.5);
    EXPECT_LT(result.Found.Mean.cwiseAbs().maxCoeff(), 4.0);
  }
}

TEST(Curvature, HasOrderTwoOnATorus)
{
  const TorusErrors coarse = ErrorsOnTorus(Torus(60, 30));
  const TorusErrors fine = ErrorsOnTorus(Torus(120, 60));
  std::printf("torus: errors %.2g %.2g %.2g, orders %.2f %.2f %.2f\n", fine.Mean, fine.Gaussian,
    fine.Principal, ObservedOrder(coarse.Mean, fine.Mean),
    ObservedOrder(coarse.Gaussian, fine.Gaussian), ObservedOrder(coarse.Principal, fine.Principal));
  EXPECT_GT(ObservedOrder(coarse.Mean, fine.Mean), 1.9);
  EXPECT_GT(ObservedOrder(coarse.Gaussian, fine.Gaussian), 1.9);
  EXPECT_GT(ObservedOrder(coarse.Principal, fine.Principal), 1.9);
}

TEST(Curvature, ConvergesOnUnevenMeshesAtEveryScale)
{
  const double h = MeanEdge(*MakeMesh(Torus(120, 60)));
  for (const double width : { 0.0, 2.0, 4.0 }) // in edges
  {
    const TorusErrors coarse = ErrorsOnTorus(UnevenTorus(60, 30, 0.3), 2.0 * width * h);
    const TorusErrors fine = ErrorsOnTorus(UnevenTorus(120, 60, 0.3), width * h);
    std::printf("uneven torus, FWHM %g h: error of H %.2g, order %.2f\n", width, fine.Mean,
      ObservedOrder(coarse.Mean, fine.Mean));
    EXPECT_GT(ObservedOrder(coarse.Mean, fine.Mean), 1.0);
    EXPECT_LT(fine.Mean, 0.012);
  }
}

TEST(Curvature, OfANoisySphereIsRightAtItsScale)
{
  for (const int level : { 4, 5 })
  {
    Surface s = Icosphere(level);
    const double h = MeanEdge(*MakeMesh(s));
    for (Index i = 0; i < s.NumberOfVertices(); ++i)
    {
      for (int c = 0; c < 3; ++c)
      {
        s.Vertices(i, c) += 0.1 * h * Normal(5, c, i);
      }
    }
    const auto errorOf = [](const Result& found)
    { return RootMeanSquareOf(found, [&](Index i) { return found.Found.Mean[i] - 1.0; }); };
    const Result own = Estimate(s);
    const Result smooth = Estimate(s, 8.0 * h);
    const double ofGaussian =
      RootMeanSquareOf(smooth, [&](Index i) { return smooth.Found.Gaussian[i] - 1.0; });
    std::printf("noisy sphere of %d vertices: error of H %.2g, with FWHM 8 h %.4f, of K %.4f\n",
      s.NumberOfVertices(), errorOf(own), errorOf(smooth), ofGaussian);
    EXPECT_GT(errorOf(own), 0.3); // the noise
    EXPECT_LT(errorOf(smooth), 0.03);
    EXPECT_LT(ofGaussian, 0.03);
  }
}

TEST(Curvature, IsOneSidedAtBoundaries)
{
  const double radius = 3.0;
  const Surface s = Cap(4, radius);
  for (const double fwhm : { 0.0, 0.5, 1.5 })
  {
    const Result found = Estimate(s, fwhm);
    for (Index i = 0; i < found.Mesh().NumberOfVertices(); ++i)
    {
      ASSERT_NEAR(found.Found.Mean[i] * radius, 1.0, 0.02) << fwhm;
      ASSERT_NEAR(found.Found.Gaussian[i] * radius * radius, 1.0, 0.04) << fwhm;
    }
  }
}

TEST(Curvature, HasTheSignOfTheOrientation)
{
  const Surface s = Rotated(Cylinder(100, 40, 2.0, 5.0));
  for (const double fwhm : { 0.0, 0.6 })
  {
    const Result found = Estimate(s, fwhm);
    const Result flipped = Estimate(Flipped(s), fwhm);
    Surface mixed = s;
    for (Index t = 0; t < mixed.NumberOfTriangles(); t += 4)
    {
      std::swap(mixed.Faces(t, 1), mixed.Faces(t, 2));
    }
    const Result same = Estimate(mixed, fwhm);
    EXPECT_EQ(same.Found.TurnedTriangles, (mixed.NumberOfTriangles() + 3) / 4);
    EXPECT_EQ(found.Found.TurnedTriangles, 0);
    const double sign = found.Found.Mean[0] > 0.0 ? 1.0 : -1.0;
    for (Index i = 0; i < found.Mesh().NumberOfVertices(); ++i)
    {
      ASSERT_NEAR(found.Found.Mean[i], sign * 0.25, 0.003);
      ASSERT_NEAR(found.Found.Gaussian[i], 0.0, 0.002);
      ASSERT_NEAR(found.Found.ShapeIndex(i), sign * 0.5, 0.02);
      ASSERT_NEAR(found.Found.Curvedness(i), 0.5 / std::sqrt(2.0), 0.006);
      ASSERT_NEAR(flipped.Found.Mean[i], -found.Found.Mean[i], 1e-9);
      ASSERT_NEAR(same.Found.Mean[i], found.Found.Mean[i], 1e-9);
    }
  }
}

TEST(Curvature, DoesNotDependOnThreadsNumberingOrUnit)
{
  const Surface s = UnevenTorus(60, 30, 0.3);
  const std::vector<Index> numbers = Permutation(s.NumberOfVertices(), 3);
  const Surface renumbered = Renumbered(s, numbers);
  for (const double fwhm : { 0.0, 0.6 })
  {
    const Result one = Estimate(s, fwhm);
    const ThreadedFor threads(4);
    const Result several = Estimate(s, fwhm, threads);
    EXPECT_EQ(one.Found.Mean, several.Found.Mean);
    EXPECT_EQ(one.Found.Gaussian, several.Found.Gaussian);
    const Result large = Estimate(Moved(Scaled(s, 1e5), { 3e6, 0.0, -1e6 }), 1e5 * fwhm);
    const auto byInput = [](const Result& found, const Surface& of)
    { return ToInput(found.Mesh(), found.Found.Mean, of.NumberOfVertices()); };
    const Values expected = byInput(one, s);
    EXPECT_LT((1e5 * byInput(large, s) - expected).cwiseAbs().maxCoeff(), 1e-6);
    const Values other = byInput(Estimate(renumbered, fwhm), renumbered);
    for (Index i = 0; i < s.NumberOfVertices(); ++i)
    {
      ASSERT_NEAR(other(numbers[i], 0), expected(i, 0), 1e-6);
    }
  }
}
