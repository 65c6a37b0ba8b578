// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Operators/CotanWeights.h"
#include "Core/Operators/MeanCorrection.h"
#include "Core/Solvers/SolverChoice.h"
#include "Core/Surface/TangentVectors.h"
#include "Heat.h"
#include "TotalVariation.h"

#include <Eigen/LU>
#include <gtest/gtest.h>

#include <vector>

using namespace SurfaceDiffusion;
using namespace SurfaceDiffusion::Testing;

namespace
{

using Kind = EdgeFunctionKind;

constexpr ChannelCoupling BothCouplings[] = { ChannelCoupling::PerChannel, ChannelCoupling::Joint };

PointData ColourNoise(const TriangleMesh& mesh, Eigen::Index columns)
{
  Values u = Noise(mesh, columns);
  for (Eigen::Index k = 1; k < columns; ++k)
  {
    u.col(k) = 0.3 * u.col(k) + 0.5 * u.col(0);
  }
  return PointData::FromValues(u);
}

/// The matrix K(u) of (14) written out: entries sum of area grad(phi_i) . D grad(phi_j), the
/// gradients from the triangle's corners in space.
Eigen::MatrixXd DenseStiffness(const TriangleMesh& mesh, const Surface& s, const Values& u,
  const std::function<Eigen::Matrix3d(double squared, const Eigen::Vector3d& normal)>& diffusivity)
{
  const Index n = mesh.NumberOfVertices();
  Eigen::MatrixXd k = Eigen::MatrixXd::Zero(n, n);
  for (Index t = 0; t < mesh.NumberOfTriangles(); ++t)
  {
    const auto vertex = mesh.TriangleVertices().row(t);
    Eigen::Vector3d x[3], gradient[3];
    for (int a = 0; a < 3; ++a)
    {
      x[a] = s.Vertices.row(mesh.InputVertex()[vertex[a]]).transpose() / mesh.LengthUnit();
    }
    const Eigen::Vector3d twiceArea = (x[1] - x[0]).cross(x[2] - x[0]);
    double squared = 0.0;
    for (int a = 0; a < 3; ++a)
    {
      gradient[a] = twiceArea.cross(x[(a + 2) % 3] - x[(a + 1) % 3]) / twiceArea.squaredNorm();
    }
    for (Eigen::Index c = 0; c < u.cols(); ++c)
    {
      squared += (u(vertex[0], c) * gradient[0] + u(vertex[1], c) * gradient[1] +
        u(vertex[2], c) * gradient[2])
                   .squaredNorm();
    }
    const Eigen::Matrix3d d = diffusivity(squared, twiceArea.normalized());
    for (int a = 0; a < 3; ++a)
    {
      for (int b = 0; b < 3; ++b)
      {
        k(vertex[a], vertex[b]) += 0.5 * twiceArea.norm() * gradient[a].dot(d * gradient[b]);
      }
    }
  }
  return k;
}

} // namespace

TEST(NonlinearDiffusion, EnergyWithoutDirectionsIsThatOfTheGeometricMean)
{
  const auto assembler = MakeAssembler(Icosphere(3));
  const TriangleMesh& mesh = assembler->Mesh();
  const PointData data = PointData::FromValues(Noise(mesh));
  NonlinearDiffusion::Settings settings = LaggedSettings(mesh, 0.01);
  const auto energyOf = [&](double along, double across)
  {
    settings.AlongDiffusivity = along;
    settings.AcrossDiffusivity = across;
    NonlinearDiffusion model(assembler, TangentVectors::Zero(mesh.NumberOfTriangles(), 2), data,
      settings, MakeCholeskySolver());
    return model.Energy();
  };
  EXPECT_NEAR(energyOf(4.0, 1.0), energyOf(2.0, 2.0), 1e-12 * energyOf(2.0, 2.0));
  EXPECT_NEAR(energyOf(1.0, 9.0), energyOf(3.0, 3.0), 1e-12 * energyOf(3.0, 3.0));
}

TEST(NonlinearDiffusion, StepSolvesEquation11WithFidelityAndMask)
{
  const Surface s = Icosphere(2);
  const auto assembler = MakeAssembler(s);
  const TriangleMesh& mesh = assembler->Mesh();
  PointData data = ColourNoise(mesh, 3);
  data.Missing.head(9) = true;
  data.Start.topRows(9).setConstant(0.25);
  data.Given.topRows(9).setConstant(1e6); // never read
  const double dt = 0.3, lambda = 2.0;
  for (const Kind kind : { Kind::TotalVariation, Kind::PeronaMalikExponential,
         Kind::PeronaMalikRational, Kind::Charbonnier, Kind::Weickert, Kind::Constant })
  {
    for (const ChannelCoupling coupling : BothCouplings)
    {
      NonlinearDiffusion::Settings settings;
      settings.TimeStep = dt;
      settings.Fidelity = lambda;
      settings.Along = settings.Across = { kind, 1e-4, 2.0 };
      settings.Coupling = coupling;
      const auto model = MakeLagged(assembler, data, settings);
      model->Advance(ProgressMonitor());

      const Eigen::Index columns = coupling == ChannelCoupling::Joint ? 3 : 1;
      for (Eigen::Index first = 0; first < 3; first += columns)
      {
        const Values u = data.Start.middleCols(first, columns);
        Eigen::MatrixXd a = dt *
          DenseStiffness(mesh, s, u,
            [&](double squared, const Eigen::Vector3d&) -> Eigen::Matrix3d
            { return settings.Along(squared) * Eigen::Matrix3d::Identity(); });
        Eigen::MatrixXd b(u.rows(), columns);
        for (Index i = 0; i < mesh.NumberOfVertices(); ++i)
        {
          const double known = data.Missing[i] ? 0.0 : dt * lambda;
          a(i, i) += mesh.ControlAreas()[i] * (1.0 + known);
          b.row(i) =
            mesh.ControlAreas()[i] * (u.row(i) + known * data.Given.row(i).segment(first, columns));
        }
        const Eigen::MatrixXd expected = a.partialPivLu().solve(b);
        EXPECT_LT(
          (model->State().middleCols(first, columns) - expected).cwiseAbs().maxCoeff(), 1e-11)
          << static_cast<int>(kind);
      }
    }
  }
}

TEST(NonlinearDiffusion, StepSolvesEquation14WithFunctionsOfTheirOwn)
{
  const Surface s = Icosphere(2);
  const auto assembler = MakeAssembler(s);
  const TriangleMesh& mesh = assembler->Mesh();
  NonlinearDiffusion::Settings settings;
  settings.TimeStep = 0.2;
  settings.Along = { Kind::TotalVariation, 1e-2, 1.0 };
  settings.Across = { Kind::PeronaMalikRational, 0.0, 3.0 };
  settings.AlongDiffusivity = 2.0;
  settings.AcrossDiffusivity = 0.1;
  const PointData data = ColourNoise(mesh, 2);
  NonlinearDiffusion model(assembler, SkewFrames(mesh, s), data, settings, MakeCholeskySolver());
  model.Advance(ProgressMonitor());

  Eigen::MatrixXd a = 0.2 *
    DenseStiffness(mesh, s, data.Start,
      [&](double squared, const Eigen::Vector3d& normal) -> Eigen::Matrix3d
      {
        Eigen::Vector3d e1(1.0, 2.0, 3.0);
        e1 = (e1 - normal * normal.dot(e1)).normalized();
        const Eigen::Vector3d e2 = normal.cross(e1);
        return 2.0 * settings.Along(squared) * e1 * e1.transpose() +
          0.1 * settings.Across(squared) * e2 * e2.transpose();
      });
  a.diagonal() += mesh.ControlAreas();
  const Eigen::MatrixXd expected =
    a.partialPivLu().solve(mesh.ControlAreas().asDiagonal() * data.Start);
  EXPECT_LT((model.State() - expected).cwiseAbs().maxCoeff(), 1e-11);
}

TEST(NonlinearDiffusion, WithoutDirectionTheGeometricMeanActs)
{
  const Surface s = Icosphere(2);
  const auto assembler = MakeAssembler(s);
  NonlinearDiffusion::Settings settings;
  settings.TimeStep = 0.2;
  settings.AlongDiffusivity = 9.0;
  const PointData data = ColourNoise(assembler->Mesh(), 1);
  NonlinearDiffusion undirected(assembler, TangentVectors::Zero(s.NumberOfTriangles(), 2), data,
    settings, MakeCholeskySolver());
  undirected.Advance(ProgressMonitor());
  settings.AlongDiffusivity = 3.0;
  const auto mean = MakeLagged(assembler, data, settings);
  mean->Advance(ProgressMonitor());
  EXPECT_LT((undirected.State() - mean->State()).cwiseAbs().maxCoeff(), 1e-13);
}

TEST(NonlinearDiffusion, ConstantFunctionIsLinearDiffusion)
{
  const auto assembler = MakeAssembler(Icosphere(3));
  const PointData data = ColourNoise(assembler->Mesh(), 2);
  NonlinearDiffusion::Settings settings;
  settings.TimeStep = 0.05;
  settings.Fidelity = 3.0;
  settings.Along = settings.Across = { Kind::Constant, 0.0, 1.0 };
  const auto model = MakeLagged(assembler, data, settings);
  const auto heat = MakeHeat(assembler, data, { 0.05, 3.0, Scheme::BackwardEuler });
  Advance(*model, 3);
  Advance(*heat, 3);
  EXPECT_LT((model->State() - heat->State()).cwiseAbs().maxCoeff(), 1e-12);
  EXPECT_NEAR(model->Energy(), heat->Energy(), 1e-12 * heat->Energy());
}

TEST(NonlinearDiffusion, PerChannelIsARunOfEachChannel)
{
  const auto assembler = MakeAssembler(Icosphere(3));
  const PointData data = ColourNoise(assembler->Mesh(), 3);
  auto settings = LaggedSettings(assembler->Mesh(), 0.05, 2.0);
  settings.Coupling = ChannelCoupling::PerChannel;
  const auto all = MakeLagged(assembler, data, settings);
  Advance(*all, 3);
  for (Eigen::Index k = 0; k < 3; ++k)
  {
    const auto one = MakeLagged(assembler, PointData::FromValues(data.Start.col(k)), settings);
    Advance(*one, 3);
    EXPECT_TRUE(one->State() == all->State().col(k));
  }
}

TEST(NonlinearDiffusion, JointNormDoesNotKnowTheAxesOfColour)
{
  const auto assembler = MakeAssembler(Icosphere(3));
  const PointData data = ColourNoise(assembler->Mesh(), 3);
  const Eigen::Matrix3d turn =
    Eigen::AngleAxisd(1.0, Eigen::Vector3d(1.0, 2.0, 3.0).normalized()).toRotationMatrix();
  const PointData turned = PointData::FromValues(data.Start * turn);
  for (const FidelityNorm norm : { FidelityNorm::L2, FidelityNorm::L1 })
  {
    auto settings = LaggedSettings(assembler->Mesh(), 0.05, 2.0, 1e-3);
    settings.Norm = norm;
    const auto plain = MakeLagged(assembler, data, settings);
    const auto model = MakeLagged(assembler, turned, settings);
    Advance(*plain, 3);
    Advance(*model, 3);
    EXPECT_LT((model->State() - plain->State() * turn).cwiseAbs().maxCoeff(), 1e-10);
  }
}

TEST(NonlinearDiffusion, ConstantsStayToTheLastBit)
{
  for (const double beta : { 1e-24, 1e-12, 1e-6, 1.0 })
  {
    for (const double step : { 1e-6, 1.0, 1e6, 1e12 })
    {
      const auto assembler = MakeAssembler(Disk(8));
      auto settings = LaggedSettings(assembler->Mesh(), step, 1.0, beta);
      const Values constant = Values::Constant(assembler->Mesh().NumberOfVertices(), 2, 0.1);
      const auto model = MakeLagged(assembler, PointData::FromValues(constant), settings);
      Advance(*model, 2);
      EXPECT_LT((model->State() - constant).cwiseAbs().maxCoeff(), 1e-15) << beta << ' ' << step;
    }
  }
}

TEST(NonlinearDiffusion, KeepsTheSumWithAnySolver)
{
  const auto assembler = MakeAssembler(Joined(Disk(8), Torus(20, 10)));
  const TriangleMesh& mesh = assembler->Mesh();
  const PointData data = ColourNoise(mesh, 2);
  for (const bool direct : { true, false })
  {
    for (const double fidelity : { 0.0, 2.0 })
    {
      std::shared_ptr<LinearSolver> solver = MakeCholeskySolver();
      if (!direct)
      {
        solver = MakeConjugateGradientSolver();
        solver->SetLimits({ 1e-2, 1000 });
      }
      const auto model = MakeLagged(assembler, data, LaggedSettings(mesh, 0.1, fidelity), solver);
      Advance(*model, 5);
      const double scale = mesh.ControlAreas().dot(data.Start.col(0).cwiseAbs());
      EXPECT_NEAR(Total(mesh, model->State(), 0), Total(mesh, data.Start, 0), 1e-13 * scale);
    }
  }
}

TEST(NonlinearDiffusion, NeverBlowsUp)
{
  const auto assembler = MakeAssembler(Icosphere(3));
  const TriangleMesh& mesh = assembler->Mesh();
  const PointData data = ColourNoise(mesh, 1);
  for (const double beta : { 1e-12, 1e-9, 1e-6, 1e-3, 1.0 })
  {
    for (double step = 1e-4; step < 2e4; step *= 10.0)
    {
      for (const bool direct : { true, false })
      {
        std::shared_ptr<LinearSolver> solver = direct
          ? MakeCholeskySolver()
          : MakeSolver(SolverMethod::Automatic, { mesh.NumberOfVertices(), 1e-3, 1.0 });
        solver->SetLimits({ 1e-6, 300 });
        const auto model =
          MakeLagged(assembler, data, LaggedSettings(mesh, step, 1.0, beta), solver);
        Advance(*model, 3);
        ASSERT_TRUE(model->State().allFinite()) << beta << ' ' << step;
        EXPECT_LT(model->State().cwiseAbs().maxCoeff(), 1.02) << beta << ' ' << step;
        EXPECT_TRUE(std::isfinite(model->Energy()));
      }
    }
  }
}

TEST(NonlinearDiffusion, EnergyFalls)
{
  const Surface s = Icosphere(3);
  const auto assembler = MakeAssembler(s);
  const TriangleMesh& mesh = assembler->Mesh();
  for (const Kind kind : { Kind::TotalVariation, Kind::PeronaMalikExponential,
         Kind::PeronaMalikRational, Kind::Charbonnier, Kind::Constant })
  {
    for (const FidelityNorm norm : { FidelityNorm::L2, FidelityNorm::L1 })
    {
      NonlinearDiffusion::Settings settings;
      settings.TimeStep = 0.1;
      settings.Fidelity = 0.5;
      settings.Along = settings.Across = { kind, 1e-2, 5.0 };
      settings.Norm = norm;
      const auto model = MakeLagged(assembler, ColourNoise(mesh, 2), settings);
      double energy = model->Energy();
      for (int step = 0; step < 10; ++step)
      {
        model->Advance(ProgressMonitor());
        EXPECT_LT(model->Energy(), energy) << static_cast<int>(kind);
        energy = model->Energy();
      }
    }
  }
}

TEST(NonlinearDiffusion, PeronaMalikKeepsAnEdgeThatTheHeatEquationLoses)
{
  const Surface s = Icosphere(4);
  const auto assembler = MakeAssembler(s);
  const TriangleMesh& mesh = assembler->Mesh();
  const Values cap = Cap(mesh, s, 1.0);
  const double h = MeanEdge(mesh);
  for (const Kind kind :
    { Kind::PeronaMalikExponential, Kind::PeronaMalikRational, Kind::Weickert, Kind::Constant })
  {
    NonlinearDiffusion::Settings settings;
    settings.TimeStep = 2.0 * h * h;
    settings.Along = settings.Across = { kind, 0.0, 0.05 / h };
    const auto model =
      MakeLagged(assembler, PointData::FromValues(cap + 0.02 * Noise(mesh)), settings);
    Advance(*model, 5);
    const double error = RootMeanSquare(mesh, model->State() - cap);
    if (kind == Kind::Constant)
    {
      EXPECT_GT(error, 0.1);
    }
    else
    {
      EXPECT_LT(error, 0.02);
    }
  }
}

TEST(NonlinearDiffusion, L1FidelityReplacesImpulsesAndLeavesTheRest)
{
  const Surface s = Icosphere(4);
  const auto assembler = MakeAssembler(s);
  const TriangleMesh& mesh = assembler->Mesh();
  const Values clean = Cap(mesh, s, 1.0);
  Values noisy = clean;
  for (Index i = 0; i < mesh.NumberOfVertices(); i += 17)
  {
    noisy(i, 0) = i % 2;
  }
  auto settings = LaggedSettings(mesh, 1.0, 1.5 / MeanEdge(mesh) / mesh.LengthUnit());
  settings.Norm = FidelityNorm::L1;
  const auto model = MakeLagged(assembler, PointData::FromValues(noisy), settings);
  Advance(*model, 30);
  const Plateaus plateaus = MeasurePlateaus(mesh, s, model->State(), 1.0);
  EXPECT_NEAR(plateaus.Inside, 1.0, 1e-3); // L2 fidelity would lose contrast
  EXPECT_NEAR(plateaus.Outside, 0.0, 1e-3);
  EXPECT_LT(RootMeanSquare(mesh, model->State() - clean), // the rest is at the edge
    0.25 * RootMeanSquare(mesh, noisy - clean));
}

TEST(NonlinearDiffusion, FixedVerticesKeepTheirValuesAndShapeTheRest)
{
  // Steady between fixed ends, any g of |grad u| alone makes a line.
  const auto assembler = MakeAssembler(Strip(20, 3, 2.0, 0.3));
  const Surface s = Strip(20, 3, 2.0, 0.3);
  const TriangleMesh& mesh = assembler->Mesh();
  PointData data = PointData::FromValues(Noise(mesh));
  const Values x = Sample(mesh, s, [](const Eigen::RowVector3d& p) { return p[0]; });
  for (Index i = 0; i < mesh.NumberOfVertices(); ++i)
  {
    data.Fixed[i] = x(i, 0) == 0.0 || x(i, 0) == 2.0;
    if (data.Fixed[i])
    {
      data.Start(i, 0) = x(i, 0);
    }
  }
  NonlinearDiffusion::Settings settings;
  settings.TimeStep = 1e3;
  settings.Along = settings.Across = { Kind::Charbonnier, 0.0, 1.0 };
  const auto model = MakeLagged(assembler, data, settings);
  Advance(*model, 60);
  EXPECT_LT((model->State() - x).cwiseAbs().maxCoeff(), 1e-6);
  for (Index i = 0; i < mesh.NumberOfVertices(); ++i)
  {
    if (data.Fixed[i])
    {
      EXPECT_EQ(model->State()(i, 0), x(i, 0));
    }
  }
}
