// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Geometry/Curvature.h"
#include "Core/Surface/IntrinsicDelaunay.h"
#include "Meshes.h"
#include "NoisySurfaces.h"
#include "ThreadedFor.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>

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
  result.Found = EstimateCurvature(mesh, positions, fwhm / unit, getenv("DEL") ? &delaunay : result.Operators.get(), parallel);
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

} // namespace

TEST(Curvature, HasOrderTwoOnATorus)
{
  const TorusErrors coarse = ErrorsOnTorus(Rotated(Torus(48, 24)), 0.0);
  const TorusErrors c = ErrorsOnTorus(Torus(60, 30));
  const TorusErrors f = ErrorsOnTorus(Torus(120, 60));
  (void)coarse;
  std::printf("torus %g %g %g\n", f.Mean, f.Gaussian, f.Principal);
  EXPECT_GT(ObservedOrder(c.Mean, f.Mean), 1.9);
  EXPECT_GT(ObservedOrder(c.Gaussian, f.Gaussian), 1.9);
  EXPECT_GT(ObservedOrder(c.Principal, f.Principal), 1.9);
  const TorusErrors uc = ErrorsOnTorus(UnevenTorus(60, 30, 0.3));
  const TorusErrors uf = ErrorsOnTorus(UnevenTorus(120, 60, 0.3));
  const TorusErrors uff = ErrorsOnTorus(UnevenTorus(240, 120, 0.3));
  std::printf("uneven %g %g %g\n", uc.Mean, uf.Mean, uff.Mean);
  for (double width : {2.0,4.0,8.0})
  {
  const double h = MeanEdge(*MakeMesh(Torus(120, 60)));
  const TorusErrors hc = ErrorsOnTorus(UnevenTorus(60, 30, 0.3), 2*width * h);
  const TorusErrors hf = ErrorsOnTorus(UnevenTorus(120, 60, 0.3), width * h);
  std::printf("heat %g: %g %g %g, %g %g %g\n", width, hc.Mean, hc.Gaussian, hc.Principal, hf.Mean, hf.Gaussian, hf.Principal);
  }
  for (int level : {4,5})
  {
    Surface s = Icosphere(level);
    const double h = MeanEdge(*MakeMesh(s));
    for (Index i = 0; i < s.NumberOfVertices(); ++i) for (int a=0;a<3;++a)
      s.Vertices(i,a) += 0.1*h*std::sqrt(-2*std::log(1-UniformRandom(5, a, i)))*std::cos(2*Pi*UniformRandom(6,a,i));
    for (double w : {0.0, 2.0, 4.0, 8.0, 12.0, 16.0})
    {
    const Result r = Estimate(s, w * h);
    double m = 0, g = 0;
    for (Index i = 0; i < s.NumberOfVertices(); ++i) { m+=r.Found.Mean[i]; g += r.Found.Gaussian[i]; }
    std::printf("noisy %d %g: bias %g %g rms %g %g\n", level, w, m/s.NumberOfVertices()-1, g/s.NumberOfVertices()-1, RootMeanSquareOf(r, [&](Index i){return r.Found.Mean[i]-1;}), RootMeanSquareOf(r, [&](Index i){return r.Found.Gaussian[i]-1;}));
    }
  }
}
