// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
//
// Nonlinear diffusion of data that vary in one direction, on irregular strips, compared with a fine
// solution in one dimension.

#include "Heat.h"
#include "TotalVariation.h"

#include "Core/Surface/TangentVectors.h"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

using namespace SurfaceDiffusion;
using namespace SurfaceDiffusion::Testing;

namespace
{

using Kind = EdgeFunctionKind;

constexpr double TimeStep = 0.01;
constexpr int Steps = 4;

double InitialValue(double x)
{
  return std::cos(Pi * x) + 0.25 * std::cos(2.0 * Pi * x);
}

/// The same scheme in time on [0, 1], by linear elements of equal lengths with a lumped mass
/// matrix.
std::vector<double> SolveOnLine(const EdgeFunction& g, double fidelity, int cells)
{
  const double h = 1.0 / cells;
  std::vector<double> f(cells + 1), u, diagonal(cells + 1), side(cells + 1), flux(cells);
  for (int i = 0; i <= cells; ++i)
  {
    f[i] = InitialValue(i * h);
  }
  u = f;
  for (int step = 0; step < Steps; ++step)
  {
    for (int i = 0; i < cells; ++i)
    {
      const double slope = (u[i + 1] - u[i]) / h;
      flux[i] = TimeStep * g(slope * slope) / h;
    }
    for (int i = 0; i <= cells; ++i)
    {
      const double mass = i == 0 || i == cells ? 0.5 * h : h;
      diagonal[i] = mass * (1.0 + TimeStep * fidelity) + (i > 0 ? flux[i - 1] : 0.0) +
        (i < cells ? flux[i] : 0.0);
      side[i] = mass * (u[i] + TimeStep * fidelity * f[i]);
    }
    for (int i = 1; i <= cells; ++i)
    {
      const double factor = flux[i - 1] / diagonal[i - 1];
      diagonal[i] -= factor * flux[i - 1];
      side[i] += factor * side[i - 1];
    }
    for (int i = cells; i >= 0; --i)
    {
      u[i] = (side[i] + (i < cells ? flux[i] * u[i + 1] : 0.0)) / diagonal[i];
    }
  }
  return u;
}

/// Root mean square difference from the line on a strip of `cells` x cells/4 irregular cells.
double ErrorOnStrip(
  const EdgeFunction& g, double fidelity, Index cells, const std::vector<double>& line)
{
  const double h = 1.0 / cells;
  const Surface s = Rotated(Jittered(Strip(cells, cells / 4, 1.0, 0.25), 0.2 * h, 0.5 * h,
                              1.0 - 0.5 * h, 0.5 * h, 0.25 - 0.5 * h),
    0.0);
  const auto assembler = MakeAssembler(s);
  const TriangleMesh& mesh = assembler->Mesh();
  const double unit = mesh.LengthUnit();
  const bool dimensionless = GetEdgeFunction(g.Kind).Dimensionless;
  NonlinearDiffusion::Settings settings;
  settings.TimeStep = TimeStep / (dimensionless ? unit * unit : unit);
  settings.Fidelity = fidelity * (dimensionless ? unit * unit : unit);
  settings.Along = { g.Kind, g.Beta * unit * unit, g.Threshold * unit };
  settings.Across = settings.Along;
  const PointData data = PointData::FromValues(
    Sample(mesh, s, [](const Eigen::RowVector3d& x) { return InitialValue(x[0]); }));
  const auto model = MakeLagged(assembler, data, settings);
  Advance(*model, Steps);
  const auto fine = static_cast<double>(line.size() - 1);
  const Values expected = Sample(mesh, s,
    [&](const Eigen::RowVector3d& x)
    {
      const double place = std::min(std::max(0.0, x[0]), 1.0) * fine;
      const auto i = std::min(line.size() - 2, static_cast<std::size_t>(place));
      const double share = place - static_cast<double>(i);
      return (1.0 - share) * line[i] + share * line[i + 1];
    });
  return RootMeanSquare(mesh, model->State() - expected);
}

} // namespace

TEST(Convergence, NonlinearDiffusionIsOfSecondOrderInTheEdgeLength)
{
  // Thresholds above the slopes of the data keep Perona-Malik and Weickert well posed.
  const EdgeFunction functions[] = { { Kind::TotalVariation, 0.5, 1.0 },
    { Kind::Charbonnier, 1.0, 1.0 }, { Kind::PeronaMalikRational, 1.0, 8.0 },
    { Kind::PeronaMalikExponential, 1.0, 10.0 }, { Kind::Weickert, 1.0, 6.0 },
    { Kind::Constant, 1.0, 1.0 } };
  for (const EdgeFunction& g : functions)
  {
    for (const double fidelity : { 0.0, 5.0 }) // (2), (4) and (17)
    {
      const std::vector<double> line = SolveOnLine(g, fidelity, 4096);
      const double coarse = ErrorOnStrip(g, fidelity, 16, line);
      const double fine = ErrorOnStrip(g, fidelity, 64, line);
      EXPECT_LT(fine, 2e-3) << GetEdgeFunction(g.Kind).Name;
      EXPECT_GT(ObservedOrder(coarse, fine, 4.0), 1.6)
        << GetEdgeFunction(g.Kind).Name << ' ' << coarse << ' ' << fine;
    }
  }
}

// Radial data on a disk do not vary along circles. With e1 along the circles only the function
// across them acts, in a direction that turns from triangle to triangle.
TEST(Convergence, DirectionsThatVarySeparateTheFunctions)
{
  const auto differ = [](Index rings, double turn)
  {
    const Surface s = Disk(rings);
    const auto assembler = MakeAssembler(s);
    const TriangleMesh& mesh = assembler->Mesh();
    const double unit = mesh.LengthUnit();
    Points directions(s.NumberOfTriangles(), 3);
    for (Index t = 0; t < s.NumberOfTriangles(); ++t)
    {
      const Eigen::RowVector3d x = (s.Vertices.row(s.Faces(t, 0)) + s.Vertices.row(s.Faces(t, 1)) +
                                     s.Vertices.row(s.Faces(t, 2))) /
        3.0;
      const double angle = std::atan2(x[1], x[0]) + turn;
      directions.row(t) << std::cos(angle), std::sin(angle), 0.0;
    }
    NonlinearDiffusion::Settings settings;
    settings.TimeStep = TimeStep / (unit * unit);
    settings.Across = { Kind::Charbonnier, 0.0, 1.0 * unit };
    settings.Along = settings.Across;
    const PointData data = PointData::FromValues(
      Sample(mesh, s, [](const Eigen::RowVector3d& x) { return InitialValue(x.norm()); }));
    const auto isotropic = MakeLagged(assembler, data, settings);
    settings.Along = { Kind::Constant, 0.0, 1.0 };
    settings.AlongDiffusivity = 4.0;
    NonlinearDiffusion directed(assembler,
      TangentVectorsFromTriangleVectors(mesh, s.Vertices, s.Faces, directions), data, settings,
      MakeCholeskySolver());
    Advance(*isotropic, Steps);
    Advance(directed, Steps);
    return RootMeanSquare(mesh, isotropic->State() - directed.State());
  };
  const double around = 0.5 * Pi;
  const double coarse = differ(12, around);
  const double fine = differ(48, around);
  EXPECT_LT(fine, 2e-3);
  EXPECT_GT(ObservedOrder(coarse, fine, 4.0), 1.6) << coarse << ' ' << fine;
  EXPECT_GT(differ(48, 0.0), 20.0 * fine); // along the radii
}
