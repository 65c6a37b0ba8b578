// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Models/BeltramiFlow.h"
#include "Core/Operators/MeanCorrection.h"
#include "Core/Surface/IntrinsicDelaunay.h"
#include "Core/Surface/TangentVectors.h"
#include "EveryMeshFile.h"
#include "Heat.h"
#include "TotalVariation.h"

#include <Eigen/Eigenvalues>
#include <Eigen/LU>
#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>
#include <vector>

using namespace SurfaceDiffusion;
using namespace SurfaceDiffusion::Testing;

namespace
{

using Settings = BeltramiFlow::Settings;
using Metric = BeltramiFlow::Metric;

constexpr Metric BothMetrics[] = { Metric::Induced, Metric::Fixed };

/// Settings whose time step, weight and scale are in coordinate units.
Settings MakeSettings(const TriangleMesh& mesh, double timeStep, double scale,
  Metric metric = Metric::Induced, double fidelity = 0.0)
{
  const double unit = mesh.LengthUnit();
  Settings settings;
  settings.TimeStep = timeStep / (unit * unit);
  settings.Fidelity = fidelity * unit * unit;
  settings.ColorScale = scale / unit;
  settings.MassMetric = metric;
  return settings;
}

/// The defaults of the library for values in a range of 1: b = 10 h, time steps in h^2.
Settings NaturalSettings(
  const TriangleMesh& mesh, double timeStep, Metric metric = Metric::Induced, double fidelity = 0.0)
{
  const double h = MeanEdge(mesh);
  Settings settings;
  settings.TimeStep = timeStep * h * h;
  settings.Fidelity = fidelity / (h * h);
  settings.ColorScale = 10.0 * h;
  settings.MassMetric = metric;
  return settings;
}

std::unique_ptr<BeltramiFlow> MakeFlow(std::shared_ptr<const Assembler> assembler, PointData data,
  const Settings& settings, std::shared_ptr<LinearSolver> solver = MakeCholeskySolver(),
  const ParallelFor& parallel = SerialFor(), TangentVectors frames = TangentVectors())
{
  return std::make_unique<BeltramiFlow>(std::move(assembler), std::move(frames), std::move(data),
    settings, std::move(solver), parallel);
}

/// K and m M of the flow at u, from 3 x 3 matrices of the gradients in space.
struct DenseSystem
{
  Eigen::MatrixXd Stiffness;
  Eigen::VectorXd Mass;
};

DenseSystem MakeDense(const TriangleMesh& mesh, const Surface& s, const Values& u,
  const Settings& settings, const Eigen::RowVector3d& direction)
{
  const Index n = mesh.NumberOfVertices();
  DenseSystem system{ Eigen::MatrixXd::Zero(n, n), Eigen::VectorXd::Zero(n) };
  for (Index t = 0; t < mesh.NumberOfTriangles(); ++t)
  {
    const auto vertex = mesh.TriangleVertices().row(t);
    Eigen::Vector3d x[3], gradient[3];
    for (int a = 0; a < 3; ++a)
    {
      x[a] = s.Vertices.row(mesh.InputVertex()[vertex[a]]).transpose() / mesh.LengthUnit();
    }
    const Eigen::Vector3d twiceArea = (x[1] - x[0]).cross(x[2] - x[0]);
    const Eigen::Vector3d normal = twiceArea.normalized();
    const Eigen::Matrix3d tangential = Eigen::Matrix3d::Identity() - normal * normal.transpose();
    const Eigen::Vector3d e1 = (tangential * direction.transpose()).normalized();
    const Eigen::Vector3d e2 = normal.cross(e1);
    const Eigen::Matrix3d stretch = std::sqrt(settings.AlongDiffusivity) * e1 * e1.transpose() +
      std::sqrt(settings.AcrossDiffusivity) * e2 * e2.transpose();
    for (int a = 0; a < 3; ++a)
    {
      gradient[a] =
        stretch * twiceArea.cross(x[(a + 2) % 3] - x[(a + 1) % 3]) / twiceArea.squaredNorm();
    }
    Eigen::Matrix3d g = tangential;
    for (Eigen::Index c = 0; c < u.cols(); ++c)
    {
      const Eigen::Vector3d v = u(vertex[0], c) * gradient[0] + u(vertex[1], c) * gradient[1] +
        u(vertex[2], c) * gradient[2];
      g += settings.ColorScale * settings.ColorScale * v * v.transpose();
    }
    const Eigen::Matrix3d whole = g + normal * normal.transpose();
    const double ratio = std::sqrt(whole.determinant());
    const Eigen::Matrix3d d = ratio * whole.inverse();
    for (int a = 0; a < 3; ++a)
    {
      system.Mass[vertex[a]] +=
        twiceArea.norm() / 6.0 * (settings.MassMetric == Metric::Induced ? ratio : 1.0);
      for (int b = 0; b < 3; ++b)
      {
        system.Stiffness(vertex[a], vertex[b]) +=
          0.5 * twiceArea.norm() * gradient[a].dot(d * gradient[b]);
      }
    }
  }
  return system;
}

/// Steps until the state moves by less than `tolerance`; returns the number of steps.
int RunToRest(Model& model, double tolerance, int limit = 1000)
{
  int steps = 0;
  for (double change = 1.0; change > tolerance && steps < limit; ++steps)
  {
    const Values before = model.State();
    model.Advance(ProgressMonitor());
    change = (model.State() - before).cwiseAbs().maxCoeff();
  }
  EXPECT_LT(steps, limit);
  return steps;
}

/// The ring 1.2 < r < 2.4 in the plane.
Surface Ring(Index around, Index along)
{
  Surface s = Cylinder(around, along, 1.0, 1.2);
  for (Index i = 0; i < s.NumberOfVertices(); ++i)
  {
    auto v = s.Vertices.row(i);
    v.head<2>() *= 1.2 + v[2];
    v[2] = 0.0;
  }
  return s;
}

/// The largest error of the steady state over the boundary values of an exact minimal surface.
template <typename Height>
double MinimalSurfaceError(const Surface& s, Metric metric, const Height& height)
{
  const auto assembler = MakeAssembler(s);
  const TriangleMesh& mesh = assembler->Mesh();
  const Values exact = Sample(mesh, s, height);
  PointData data = PointData::FromValues(exact);
  for (Index i = 0; i < mesh.NumberOfVertices(); ++i)
  {
    data.Start(i, 0) = 0.0;
  }
  for (const Index i : mesh.BoundaryVertices())
  {
    data.Fixed[i] = true;
    data.Start(i, 0) = exact(i, 0);
  }
  const auto flow = MakeFlow(assembler, data, MakeSettings(mesh, 1e4, 1.0, metric));
  const int steps = RunToRest(*flow, 1e-13);
  const double error = (flow->State() - exact).cwiseAbs().maxCoeff();
  std::printf("%d vertices, %d steps: %.3e\n", mesh.NumberOfVertices(), steps, error);
  return error;
}

} // namespace

TEST(BeltramiFlow, StepSolvesItsEquation)
{
  const Surface s = Icosphere(2);
  const auto assembler = MakeAssembler(s);
  const TriangleMesh& mesh = assembler->Mesh();
  PointData data = PointData::FromValues(Noise(mesh, 3));
  data.Missing.head(9) = true;
  data.Start.topRows(9).setConstant(0.25);
  data.Given.topRows(9).setConstant(1e6); // never read
  for (const Metric metric : BothMetrics)
  {
    for (const double along : { 1.0, 0.3 })
    {
      Settings settings = MakeSettings(mesh, 0.05, 0.7, metric, 2.0);
      settings.AlongDiffusivity = along;
      const auto flow = MakeFlow(assembler, data, settings, MakeCholeskySolver(), SerialFor(),
        along == 1.0 ? TangentVectors() : SkewFrames(mesh, s));
      flow->Advance(ProgressMonitor());
      const DenseSystem dense = MakeDense(mesh, s, data.Start, settings, { 1.0, 2.0, 3.0 });
      Eigen::MatrixXd a = settings.TimeStep * dense.Stiffness;
      Eigen::MatrixXd b = dense.Mass.asDiagonal() * data.Start;
      for (Index i = 0; i < mesh.NumberOfVertices(); ++i)
      {
        const double pull =
          data.Missing[i] ? 0.0 : settings.TimeStep * settings.Fidelity * mesh.ControlAreas()[i];
        a(i, i) += dense.Mass[i] + pull;
        b.row(i) += pull * data.Given.row(i);
      }
      const Eigen::MatrixXd expected = a.partialPivLu().solve(b);
      EXPECT_LT((flow->State() - expected).cwiseAbs().maxCoeff(), 1e-12) << along;
      EXPECT_GT((flow->State() - data.Start).cwiseAbs().maxCoeff(), 0.1);
    }
  }
}

TEST(BeltramiFlow, OneChannelHasTheEnergyAndTheSteadyStateOfCharbonnier)
{
  const Surface s = Icosphere(3);
  const auto assembler = MakeAssembler(s);
  const TriangleMesh& mesh = assembler->Mesh();
  const PointData data = PointData::FromValues(Cap(mesh, s, 1.0) + 0.2 * Noise(mesh));
  const Settings settings = NaturalSettings(mesh, 1e3, Metric::Fixed, 0.02);
  NonlinearDiffusion::Settings lagged;
  lagged.TimeStep = settings.TimeStep;
  lagged.Fidelity = settings.Fidelity;
  lagged.Along = lagged.Across = { EdgeFunctionKind::Charbonnier, 1e-6, 1.0 / settings.ColorScale };
  const auto charbonnier = MakeLagged(assembler, data, lagged);
  EXPECT_NEAR(MakeFlow(assembler, data, settings)->Energy(), charbonnier->Energy(),
    1e-13 * charbonnier->Energy());
  RunToRest(*charbonnier, 1e-13);
  PointData rest = data;
  rest.Start = charbonnier->State();
  for (const Metric metric : BothMetrics)
  {
    Settings options = settings;
    options.MassMetric = metric;
    const auto fromRest = MakeFlow(assembler, rest, options);
    EXPECT_NEAR(fromRest->Energy(), charbonnier->Energy(), 1e-13 * charbonnier->Energy());
    Advance(*fromRest, 3);
    EXPECT_LT((fromRest->State() - rest.Start).cwiseAbs().maxCoeff(), 1e-11); // the same flux
    const auto flow = MakeFlow(assembler, data, options);
    RunToRest(*flow, 1e-13);
    EXPECT_LT((flow->State() - rest.Start).cwiseAbs().maxCoeff(), 1e-11);
    EXPECT_GT((flow->State() - data.Start).cwiseAbs().maxCoeff(), 0.1);
  }
}

TEST(BeltramiFlow, SmallScaleIsLinearDiffusion)
{
  const Surface s = Icosphere(3);
  const auto assembler = MakeAssembler(s);
  const TriangleMesh& mesh = assembler->Mesh();
  const PointData data = PointData::FromValues(Noise(mesh, 2));
  const Values linear =
    Diffuse(assembler, data, 0.05, 5, 0.0, LinearDiffusion::Scheme::BackwardEuler);
  for (const Metric metric : BothMetrics)
  {
    double errors[2];
    for (const int i : { 0, 1 })
    {
      const auto flow =
        MakeFlow(assembler, data, MakeSettings(mesh, 0.01, i == 0 ? 1e-2 : 1e-3, metric));
      Advance(*flow, 5);
      errors[i] = (flow->State() - linear).cwiseAbs().maxCoeff();
    }
    EXPECT_LT(errors[1], 1e-4);
    EXPECT_NEAR(errors[0] / errors[1], 100.0, 10.0); // of second order in b
  }
}

TEST(BeltramiFlow, SteadyStateOverAFixedBoundaryIsScherksSurface)
{
  const auto scherk = [](const Eigen::RowVector3d& x)
  { return std::log(std::cos(x[0]) / std::cos(x[1])); };
  for (const Metric metric : BothMetrics)
  {
    const double coarse =
      MinimalSurfaceError(Jittered(Plate(20, 1.0), 0.02, -0.99, 0.99, -0.99, 0.99), metric, scherk);
    const double fine =
      MinimalSurfaceError(Jittered(Plate(40, 1.0), 0.01, -0.99, 0.99, -0.99, 0.99), metric, scherk);
    EXPECT_LT(fine, 1e-3);
    EXPECT_GT(ObservedOrder(coarse, fine), 1.8);
  }
}

TEST(BeltramiFlow, SteadyStateBetweenTwoCirclesIsACatenoid)
{
  const auto catenoid = [](const Eigen::RowVector3d& x) { return std::acosh(x.norm()); };
  for (const Metric metric : BothMetrics)
  {
    const double coarse = MinimalSurfaceError(Ring(60, 12), metric, catenoid);
    const double fine = MinimalSurfaceError(Ring(120, 24), metric, catenoid);
    EXPECT_LT(fine, 1e-3);
    EXPECT_GT(ObservedOrder(coarse, fine), 1.9);
  }
}

/// In one dimension, u_t = u_xx/(1 + b^2 u_x^2)^2 in the induced metric. A profile that moves at
/// the constant speed c satisfies the ordinary differential equation p' = c (1 + b^2 p^2)^2 of its
/// slope p, so that with b = 1
///   c x = (p/(1 + p^2) + atan p)/2,  u = p^2/(2 c (1 + p^2)) + c t.
TEST(BeltramiFlow, ProfileOfTheOrdinaryDifferentialEquationMovesAtItsSpeed)
{
  const double speed = 0.5, time = 0.005;
  const auto slope = [&](double x)
  {
    double low = -2.0, high = 2.0;
    for (int i = 0; i < 60; ++i)
    {
      const double p = 0.5 * (low + high);
      (0.5 * (p / (1.0 + p * p) + std::atan(p)) < speed * x ? low : high) = p;
    }
    return low;
  };
  double errors[2];
  for (const int level : { 0, 1 })
  {
    const Index cells = 120 << level;
    const Surface s = Moved(Strip(cells, 2, 2.0, 4.0 / cells), { -1.0, 0.0, 0.0 });
    const auto assembler = MakeAssembler(s);
    const TriangleMesh& mesh = assembler->Mesh();
    const Values start = Sample(mesh, s,
      [&](const Eigen::RowVector3d& x)
      {
        const double p = slope(x[0]);
        return p * p / (2.0 * speed * (1.0 + p * p));
      });
    const int steps = 4 << (2 * level);
    const auto flow =
      MakeFlow(assembler, PointData::FromValues(start), MakeSettings(mesh, time / steps, 1.0));
    Advance(*flow, steps);
    errors[level] = 0.0;
    for (Index i = 0; i < mesh.NumberOfVertices(); ++i)
    {
      if (std::abs(s.Vertices(mesh.InputVertex()[i], 0)) < 0.4) // far from the ends
      {
        const double moved = flow->State()(i, 0) - start(i, 0);
        errors[level] = std::max(errors[level], std::abs(moved / (speed * time) - 1.0));
      }
    }
  }
  std::printf("speed to %.2e, %.2e\n", errors[0], errors[1]);
  EXPECT_LT(errors[1], 1e-3);
  EXPECT_GT(ObservedOrder(errors[0], errors[1]), 1.8);
}

TEST(BeltramiFlow, RotatedColorsGiveTheRotatedResult)
{
  const Surface s = Icosphere(4);
  const auto assembler = MakeAssembler(s);
  const TriangleMesh& mesh = assembler->Mesh();
  const Values f = Noise(mesh, 3);
  const Eigen::Matrix3d turn =
    Eigen::AngleAxisd(0.7, Eigen::Vector3d(1.0, -2.0, 0.5).normalized()).toRotationMatrix();
  for (const Metric metric : BothMetrics)
  {
    const Settings settings = NaturalSettings(mesh, 2.0, metric, 0.1);
    const auto flow = MakeFlow(assembler, PointData::FromValues(f), settings);
    const auto turned = MakeFlow(assembler, PointData::FromValues(f * turn), settings);
    Advance(*flow, 5);
    Advance(*turned, 5);
    EXPECT_LT((turned->State() - flow->State() * turn).cwiseAbs().maxCoeff(), 1e-12);
    EXPECT_NEAR(turned->Energy(), flow->Energy(), 1e-12 * flow->Energy());
    EXPECT_GT((flow->State() - f).cwiseAbs().maxCoeff(), 0.1);
  }
}

TEST(BeltramiFlow, AreaNeverRisesOnScannedMeshes)
{
  ForEachMeshFile(
    [](const Surface& s)
    {
      const auto assembler = MakeAssembler(s);
      const TriangleMesh& mesh = assembler->Mesh();
      for (const double timeStep : { 0.1, 10.0, 1e4 })
      {
        for (const Metric metric : BothMetrics)
        {
          const auto flow = MakeFlow(assembler, PointData::FromValues(0.5 * Noise(mesh, 3)),
            NaturalSettings(mesh, timeStep, metric), Iterative(1e-3));
          double last = flow->Energy();
          const double first = last;
          for (int step = 0; step < 4; ++step)
          {
            flow->Advance(ProgressMonitor());
            EXPECT_LE(flow->Energy() - last, 1e-12 * first)
              << "step " << step << " of " << timeStep << " h^2";
            last = flow->Energy();
          }
          EXPECT_LT(last, first);
        }
      }
    });
}

TEST(BeltramiFlow, AnyToleranceLowersTheEnergyWithFidelity)
{
  const Surface s = Icosphere(4);
  const auto assembler = MakeAssembler(s);
  const TriangleMesh& mesh = assembler->Mesh();
  PointData data = PointData::FromValues(0.5 * Noise(mesh, 3));
  data.Missing.head(50) = true;
  for (const double tolerance : { 0.9, 0.1, 1e-8 })
  {
    for (const Metric metric : BothMetrics)
    {
      const auto flow =
        MakeFlow(assembler, data, NaturalSettings(mesh, 1e4, metric, 0.1), Iterative(tolerance));
      double last = flow->Energy();
      for (int step = 0; step < 20; ++step)
      {
        flow->Advance(ProgressMonitor());
        EXPECT_LE(flow->Energy() - last, 1e-13 * last) << "step " << step;
        last = flow->Energy();
      }
    }
  }
}

TEST(BeltramiFlow, KeepsEdgesThatLinearDiffusionLoses)
{
  const Surface s = Icosphere(4);
  const auto assembler = MakeAssembler(s);
  const TriangleMesh& mesh = assembler->Mesh();
  const Values cap = Cap(mesh, s, 1.0);
  const auto flow =
    MakeFlow(assembler, PointData::FromValues(cap), NaturalSettings(mesh, 2.0, Metric::Induced));
  Advance(*flow, 10);
  const double h = MeanEdge(mesh) * mesh.LengthUnit();
  const Values linear = Diffuse(assembler, PointData::FromValues(cap), 20.0 * h * h, 10);
  EXPECT_LT(RootMeanSquare(mesh, flow->State() - cap), 0.5 * RootMeanSquare(mesh, linear - cap));
}

TEST(BeltramiFlow, AxesRunAlongTheLevelLines)
{
  const Surface s = Plate(20, 1.0);
  const auto assembler = MakeAssembler(s);
  const TriangleMesh& mesh = assembler->Mesh();
  const Values f = Sample(mesh, s, [](const Eigen::RowVector3d& x) { return x[0] + 2.0 * x[1]; });
  const auto flow = MakeFlow(assembler, PointData::FromValues(f), NaturalSettings(mesh, 1.0));
  const Points axes = VectorsInSpace(mesh, s.Vertices, s.Faces, flow->Axes());
  EXPECT_LT((axes * Eigen::Vector3d(1.0, 2.0, 0.0)).cwiseAbs().maxCoeff(), 1e-12);
  EXPECT_NEAR(axes.rowwise().norm().minCoeff(), 1.0, 1e-12);
}
