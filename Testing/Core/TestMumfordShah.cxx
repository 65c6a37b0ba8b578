// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Geometry/RidgeCurves.h"
#include "Core/Models/MumfordShah.h"
#include "Core/Operators/CotanWeights.h"
#include "Core/Surface/IntrinsicDelaunay.h"
#include "Heat.h"
#include "Meshes.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>
#include <vector>

using namespace SurfaceDiffusion;
using namespace SurfaceDiffusion::Testing;

namespace
{

using Settings = MumfordShah::Settings;

constexpr double Tight = 1e-12; // tolerance of exact half steps
constexpr double Loose = 0.1; // the default of the library

/// The defaults of the library: lengths 8 h and 2 h, and edges from a jump of `threshold` on.
Settings NaturalSettings(const TriangleMesh& mesh, double threshold)
{
  const double h = MeanEdge(mesh);
  const double length = 8.0 * h;
  Settings settings;
  settings.Fidelity = 1.0 / (length * length);
  settings.EdgeWidth = 2.0 * h;
  settings.EdgeCost = threshold * threshold / (4.0 * length) / (1.0 + 0.125);
  return settings;
}

std::shared_ptr<LinearSolver> Solver(double tolerance, const ParallelFor& parallel = SerialFor())
{
  std::shared_ptr<LinearSolver> solver = MakeConjugateGradientSolver(parallel);
  solver->SetLimits({ tolerance, 10000 });
  return solver;
}

std::unique_ptr<MumfordShah> MakeModel(std::shared_ptr<const Assembler> assembler, PointData data,
  const Settings& settings, double tolerance = Loose, const ParallelFor& parallel = SerialFor(),
  Flags cuts = Flags())
{
  CornerWeights coefficients = CotanWeights(assembler->Mesh());
  return std::make_unique<MumfordShah>(std::move(assembler), std::move(coefficients),
    std::move(data), settings, Solver(tolerance, parallel), Solver(tolerance, parallel), parallel,
    std::move(cuts));
}

/// Steps to the end, or so many. Within a stage no step raises the energy.
int TakeSteps(MumfordShah& model, int limit)
{
  int steps = 0;
  for (; !model.Finished() && steps < limit; ++steps)
  {
    const double energy = model.Energy();
    const double width = model.CurrentEdgeWidth();
    model.Advance(ProgressMonitor());
    if (model.CurrentEdgeWidth() == width)
    {
      EXPECT_LE(model.Energy() - energy, 1e-12 * energy) << "step " << steps;
    }
  }
  return steps;
}

int Finish(MumfordShah& model)
{
  const int steps = TakeSteps(model, 2000);
  EXPECT_TRUE(model.Finished());
  return steps;
}

/// v without clamping.
Vector EdgeIndicator(const MumfordShah& model)
{
  std::vector<double> checkpoint(model.CheckpointSize());
  model.Save(checkpoint.data());
  return Eigen::Map<Vector>(checkpoint.data() + model.State().size(), model.State().rows());
}

/// 1 where z > height on the unit sphere, and white noise.
Values Cap(const TriangleMesh& mesh, const Surface& s, double height, double noise = 0.0)
{
  return Sample(mesh, s, [&](const Eigen::RowVector3d& x) { return x[2] > height ? 1.0 : 0.0; }) +
    noise * Noise(mesh);
}

/// The mean difference of u between both sides of x = position, 2 to 4 h from it.
double Rise(const TriangleMesh& mesh, const Surface& s, const Values& u, double position)
{
  const double h = MeanEdge(mesh) * mesh.LengthUnit();
  double sums[2] = { 0.0, 0.0 };
  double counts[2] = { 0.0, 0.0 };
  for (Index i = 0; i < mesh.NumberOfVertices(); ++i)
  {
    const double x = (s.Vertices(mesh.InputVertex()[i], 0) - position) / h;
    if (std::abs(x) > 2.0 && std::abs(x) < 4.0)
    {
      sums[x > 0.0] += u(i, 0);
      counts[x > 0.0] += 1.0;
    }
  }
  return sums[1] / counts[1] - sums[0] / counts[0];
}

} // namespace

TEST(MumfordShah, ProfileOfAnEdgeIsExponentialAndCostsBetaPerLength)
{
  const double eps = 0.1;
  double coarseProfile = 0.0, coarseCost = 0.0;
  for (const Index cells : { 80, 160 })
  {
    const Surface s = Moved(Strip(cells, 4, 4.0, 16.0 / cells), { -2.0, 0.0, 0.0 });
    const auto assembler = MakeAssembler(s);
    const TriangleMesh& mesh = assembler->Mesh();
    const double unit = mesh.LengthUnit();
    const Values x = Sample(mesh, s, [](const Eigen::RowVector3d& p) { return p[0]; });
    Settings settings;
    settings.EdgeCost = 3.0;
    settings.EdgeWidth = eps / unit;
    settings.NumberOfStages = 1;
    const auto model = MakeModel(assembler, PointData::FromValues(0.0 * x), settings, Tight,
      SerialFor(), x.col(0).array().abs() < 1e-12);
    Finish(*model);
    double profile = 0.0;
    const Vector v = EdgeIndicator(*model);
    for (Index i = 0; i < mesh.NumberOfVertices(); ++i)
    {
      profile =
        std::max(profile, std::abs(v[i] - 1.0 + std::exp(-std::abs(x(i, 0)) / (2.0 * eps))));
    }
    const double cost =
      std::abs(model->EdgeEnergy() / (settings.EdgeCost * 16.0 / cells / unit) - 1.0);
    std::printf("eps = %g h: profile to %.2e, cost to %.2e\n", eps * cells / 4.0, profile, cost);
    if (cells == 160)
    {
      EXPECT_LT(profile, 2e-3);
      EXPECT_LT(cost, 2e-3);
      EXPECT_NEAR(ObservedOrder(coarseProfile, profile), 2.0, 0.1);
      EXPECT_NEAR(ObservedOrder(coarseCost, cost), 2.0, 0.1);
    }
    coarseProfile = profile;
    coarseCost = cost;
  }
}

TEST(MumfordShah, JumpsAreLostBelowTheThresholdAndKeptAbove)
{
  const double threshold = 0.2;
  for (const Index rows : { 12, 24 })
  {
    const double side = 1.0 / rows;
    const Surface s = Jittered(Strip(12 * rows, rows, 12.0, 1.0), 0.3 * side, 0.1, 11.9, 0.1, 0.9);
    const auto assembler = MakeAssembler(s);
    const TriangleMesh& mesh = assembler->Mesh();
    for (const double factor : { 0.9, 1.25 })
    {
      const double jump = factor * threshold;
      const Values f =
        Sample(mesh, s, [&](const Eigen::RowVector3d& x) { return x[0] < 6.01 ? 0.0 : jump; });
      const auto model =
        MakeModel(assembler, PointData::FromValues(f), NaturalSettings(mesh, threshold));
      const int steps = Finish(*model);
      const double rise = Rise(mesh, s, model->State(), 6.01) / jump;
      std::printf("%d rows, jump %.3g of the threshold: %.3f of it at the edge, %d steps\n", rows,
        factor, rise, steps);
      if (factor < 1.0)
      {
        EXPECT_LT(rise, 0.5);
        EXPECT_LT(model->Edges().maxCoeff(), 0.5);
      }
      else
      {
        EXPECT_GT(rise, 0.95);
        EXPECT_GT(model->Edges().maxCoeff(), 0.9);
      }
    }
  }
}

TEST(MumfordShah, CapHasTheEnergyAndTheLengthOfItsEdge)
{
  const double height = 0.5;
  const double exact = 2.0 * Pi * std::sqrt(1.0 - height * height);
  for (const int subdivisions : { 5, 6 })
  {
    const Surface s = Icosphere(subdivisions);
    const auto assembler = MakeAssembler(s);
    const TriangleMesh& mesh = assembler->Mesh();
    const double h = MeanEdge(mesh) * mesh.LengthUnit();
    const Settings settings = NaturalSettings(mesh, 0.2);
    for (const double noise : { 0.0, 0.08 }) // sigma 0.046
    {
      const auto model =
        MakeModel(assembler, PointData::FromValues(Cap(mesh, s, height, noise)), settings);
      Finish(*model);
      const double energy =
        model->EdgeEnergy() / (settings.EdgeCost * 1.125 * exact / mesh.LengthUnit());
      const Polylines lines = FindRidges(mesh, s.Vertices, model->Edges(), 8.0 * h);
      ASSERT_EQ(lines.NumberOfLines(), 1);
      EXPECT_EQ(lines.Points.row(0), lines.Points.bottomRows(1));
      const double offset = (lines.Points.col(2).array() - height).abs().maxCoeff() / h;
      const double height2 = (lines.Points.rowwise().norm().array() - 1.0).abs().maxCoeff() / h;
      std::printf("%d subdivisions, noise %g: energy %.4f, length %.4f of the exact ones, offset "
                  "%.2f h, off the surface %.1e h\n",
        subdivisions, noise, energy, lines.Length(0) / exact, offset, height2);
      EXPECT_NEAR(lines.Length(0) / exact, 1.0, 0.005);
      EXPECT_LT(offset, 0.5);
      EXPECT_LT(height2, 1e-4);
      if (noise == 0.0)
      {
        EXPECT_NEAR(energy, 1.0, 0.05);
        EXPECT_NEAR(model->State().minCoeff(), 0.0, 0.02);
        EXPECT_NEAR(model->State().maxCoeff(), 1.0, 0.02);
      }
    }
  }
}

TEST(MumfordShah, CrossingJumpsGiveOneCurvePerArm)
{
  const Surface s = Jittered(Strip(96, 96), 0.003, 0.02, 0.98, 0.02, 0.98);
  const auto assembler = MakeAssembler(s);
  const TriangleMesh& mesh = assembler->Mesh();
  const Values f = Sample(mesh, s,
    [](const Eigen::RowVector3d& x)
    { return (x[0] > 0.5 ? 1.0 : 0.0) + (x[1] > 0.5 && x[0] > 0.5 ? 1.0 : 0.0); });
  const auto model = MakeModel(assembler, PointData::FromValues(f), NaturalSettings(mesh, 0.4));
  Finish(*model);
  const double h = MeanEdge(mesh) * mesh.LengthUnit();
  const Polylines lines = FindRidges(mesh, s.Vertices, model->Edges(), 8.0 * h);
  ASSERT_EQ(lines.NumberOfLines(), 3); // a T
  for (Index l = 0; l < 3; ++l)
  {
    EXPECT_NEAR(lines.Length(l), 0.5, 3.0 * h);
  }
  EXPECT_EQ(FindRidges(mesh, s.Vertices, Vector::Zero(f.rows()), h).NumberOfLines(), 0);
  const Surface closed = Icosphere(3);
  const auto sphere = MakeMesh(closed);
  const Vector ones = Vector::Ones(sphere->NumberOfVertices());
  EXPECT_LT(FindRidges(*sphere, closed.Vertices, ones, 1.0).NumberOfLines(), 30); // a tree
}

TEST(MumfordShah, CostlyEdgesLeaveTheLinearSteadyState)
{
  for (const int subdivisions : { 3, 4 })
  {
    const Surface s = Icosphere(subdivisions);
    const auto assembler = MakeAssembler(s);
    const TriangleMesh& mesh = assembler->Mesh();
    PointData data = PointData::FromValues(Cap(mesh, s, 0.2, 0.3));
    data.Missing.segment(10, 40) = true;
    data.Fixed.segment(100, 30) = true;
    Settings settings = NaturalSettings(mesh, 1e8);
    settings.Leakage = 1e-14;
    const auto model = MakeModel(assembler, data, settings, Tight);
    Finish(*model);
    LinearDiffusion::Settings steady;
    steady.Fidelity = settings.Fidelity;
    steady.TimeScheme = Scheme::SteadyState;
    const auto linear = MakeHeat(assembler, data, steady);
    linear->Advance(ProgressMonitor());
    EXPECT_LT((model->State() - linear->State()).cwiseAbs().maxCoeff(), 1e-10);
    EXPECT_LT(model->Edges().maxCoeff(), 1e-12);
  }
}

TEST(MumfordShah, EdgesStayInBoundsOnIntrinsicDelaunayMeshes)
{
  const Surface s = Rotated(Jittered(Strip(40, 20, 2.0, 1.0), 0.02, 0.01, 1.99, 0.01, 0.99));
  const IntrinsicDelaunay delaunay(MakeMesh(s));
  const auto assembler = std::make_shared<Assembler>(delaunay.Mesh());
  const TriangleMesh& mesh = assembler->Mesh();
  const auto model =
    MakeModel(assembler, PointData::FromValues(Noise(mesh)), NaturalSettings(mesh, 0.3), Tight);
  for (int step = 0; step < 40 && !model->Finished(); ++step)
  {
    model->Advance(ProgressMonitor());
    const Vector v = EdgeIndicator(*model);
    EXPECT_GT(v.minCoeff(), 0.0);
    EXPECT_LE(v.maxCoeff() - 1.0, 1e-9);
  }
}

TEST(MumfordShah, EnergyFallsOnObtuseMeshesWithLooseSolves)
{
  const Surface s = Jittered(Strip(40, 20, 2.0, 1.0), 0.024, 0.01, 1.99, 0.01, 0.99);
  const auto assembler = MakeAssembler(s);
  const TriangleMesh& mesh = assembler->Mesh();
  EXPECT_LT(CotanWeights(mesh).minCoeff(), -1.0); // the mesh is bad
  Values f = 0.1 * Noise(mesh, 2);
  f.col(1) += Sample(mesh, s, [](const Eigen::RowVector3d& x) { return x[0] > 0.9 ? 1.0 : 0.0; });
  for (const double tolerance : { 0.5, Loose, 1e-6 })
  {
    const auto model =
      MakeModel(assembler, PointData::FromValues(f), NaturalSettings(mesh, 0.4), tolerance);
    EXPECT_GT(Finish(*model), 8);
    EXPECT_GT(model->Edges().maxCoeff(), 0.9);
  }
}

TEST(MumfordShah, RotatedColorsHaveTheSameEdges)
{
  const Surface s = Icosphere(4);
  const auto assembler = MakeAssembler(s);
  const TriangleMesh& mesh = assembler->Mesh();
  Values f = 0.1 * Noise(mesh, 3);
  f.col(0) += Cap(mesh, s, 0.3);
  f.col(1) -= Cap(mesh, s, -0.4);
  const Eigen::Matrix3d turn =
    Eigen::AngleAxisd(0.7, Eigen::Vector3d(1.0, -2.0, 0.5).normalized()).toRotationMatrix();
  const Settings settings = NaturalSettings(mesh, 0.3);
  const auto model = MakeModel(assembler, PointData::FromValues(f), settings, 1e-10);
  const auto turned = MakeModel(assembler, PointData::FromValues(f * turn), settings, 1e-10);
  EXPECT_EQ(Finish(*model), Finish(*turned));
  EXPECT_LT((turned->State() - model->State() * turn).cwiseAbs().maxCoeff(), 1e-8);
  EXPECT_LT((turned->Edges() - model->Edges()).cwiseAbs().maxCoeff(), 1e-8);
  EXPECT_GT(model->Edges().maxCoeff(), 0.9);
}

TEST(MumfordShah, HolesAreFilledThroughEdges)
{
  for (const Index cells : { 48, 96 })
  {
    const Surface s = Strip(cells, cells);
    const auto assembler = MakeAssembler(s);
    const TriangleMesh& mesh = assembler->Mesh();
    const Values truth =
      Sample(mesh, s, [](const Eigen::RowVector3d& x) { return x[0] > 0.505 ? 1.0 : 0.0; });
    PointData data = PointData::FromValues(truth);
    const double h = MeanEdge(mesh) * mesh.LengthUnit();
    for (Index i = 0; i < mesh.NumberOfVertices(); ++i)
    {
      const auto x = s.Vertices.row(mesh.InputVertex()[i]);
      data.Missing[i] = std::hypot(x[0] - 0.5, x[1] - 0.5) < 8.0 * h;
      if (data.Missing[i])
      {
        data.Start(i, 0) = 0.5;
        data.Given(i, 0) = 1e9; // must not be read
      }
    }
    const Settings settings = NaturalSettings(mesh, 0.2);
    const auto model = MakeModel(assembler, data, settings);
    Finish(*model);
    LinearDiffusion::Settings steady;
    steady.Fidelity = settings.Fidelity;
    steady.TimeScheme = Scheme::SteadyState;
    const auto linear = MakeHeat(assembler, data, steady);
    linear->Advance(ProgressMonitor());
    const double error = RootMeanSquare(mesh, model->State() - truth);
    const double ofLinear = RootMeanSquare(mesh, linear->State() - truth);
    std::printf("%d cells: error %.4f, linear %.4f\n", cells, error, ofLinear);
    EXPECT_LT(error, 0.4 * ofLinear);
    const Polylines lines = FindRidges(mesh, s.Vertices, model->Edges(), 8.0 * h);
    ASSERT_EQ(lines.NumberOfLines(), 1); // the edge goes through the hole
    EXPECT_NEAR(lines.Length(0), 1.0, 3.0 * h);
  }
}

TEST(MumfordShah, ConstantsStayToTheLastBit)
{
  const auto assembler = MakeAssembler(Icosphere(3));
  const TriangleMesh& mesh = assembler->Mesh();
  const Values f = Values::Constant(mesh.NumberOfVertices(), 1, 0.7);
  const auto model = MakeModel(assembler, PointData::FromValues(f), NaturalSettings(mesh, 0.2));
  EXPECT_EQ(Finish(*model), 3); // one step per stage
  EXPECT_EQ(model->State(), f);
  EXPECT_EQ(model->Edges(), Vector::Zero(f.rows()));
}
