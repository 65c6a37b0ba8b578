// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Operators/CotanWeights.h"
#include "Core/Operators/MeanCorrection.h"
#include "Core/Statistics/ValueRange.h"
#include "Core/Surface/TangentVectors.h"
#include "Heat.h"
#include "TotalVariation.h"

#include <gtest/gtest.h>

#include <array>
#include <vector>

using namespace SurfaceDiffusion;
using namespace SurfaceDiffusion::Testing;

namespace
{

using Kind = EdgeFunctionKind;

const double CapAngle = Pi / 3.0;

/// A cap on a sphere of 2562 vertices.
struct CapProblem
{
  Surface Sphere = Icosphere(4);
  std::shared_ptr<const Assembler> Operators = MakeAssembler(Sphere);
  const TriangleMesh& Mesh = Operators->Mesh();
  PointData Data = PointData::FromValues(Cap(Mesh, Sphere, CapAngle));

  Plateaus Measure(const Values& u) const
  {
    return MeasurePlateaus(this->Mesh, this->Sphere, u, CapAngle);
  }
};

double TotalVariationOf(const TriangleMesh& mesh, const Values& u)
{
  double sum = 0.0;
  for (Index t = 0; t < mesh.NumberOfTriangles(); ++t)
  {
    const auto corners = mesh.TriangleVertices().row(t);
    const Eigen::Vector2d gradient =
      Gradient(mesh.Shapes()[t], u(corners[0], 0), u(corners[1], 0), u(corners[2], 0));
    sum += mesh.Shapes()[t].Area() * gradient.norm();
  }
  return sum;
}

} // namespace

TEST(TotalVariationFlow, CapFallsAtItsPerimeterOverItsArea)
{
  // P1 finds edges that cut across triangles too long: 5 % at this size.
  const CapProblem cap;
  for (const int steps : { 1, 4 })
  {
    const auto flow = MakeExact(cap.Operators, cap.Data, ExactSettings(cap.Mesh, 0.2 / steps));
    Advance(*flow, steps);
    EXPECT_LT(PlateauError(cap.Measure(flow->State()), ExactPlateaus(CapAngle, 0.2)), 0.05);
    EXPECT_NEAR(Total(cap.Mesh, flow->State(), 0), Total(cap.Mesh, cap.Data.Start, 0), 1e-12);
  }
}

TEST(TotalVariationFlow, SteadyCapLosesHeightByTheFidelity)
{
  const CapProblem cap;
  const auto flow = MakeExact(cap.Operators, cap.Data, ExactSettings(cap.Mesh, 0.0, 5.0));
  flow->Advance(ProgressMonitor());
  EXPECT_LT(PlateauError(cap.Measure(flow->State()), ExactPlateaus(CapAngle, 0.2)), 0.05);
  EXPECT_NEAR(Total(cap.Mesh, flow->State(), 0), Total(cap.Mesh, cap.Data.Start, 0), 1e-12);
}

TEST(TotalVariationFlow, CapMeetsItsSurroundingsAtTheMean)
{
  // T = a/2 sin(theta0) = 0.433.
  const CapProblem cap;
  const auto flow = MakeExact(cap.Operators, cap.Data, ExactSettings(cap.Mesh, 0.5));
  flow->Advance(ProgressMonitor());
  const double mean = Total(cap.Mesh, cap.Data.Start, 0) / cap.Mesh.ControlAreas().sum();
  EXPECT_LT((flow->State().array() - mean).abs().maxCoeff(), 5e-3);
}

TEST(TotalVariationFlow, WithL1TheCapVanishesBelowItsPerimeterOverItsAreaAndOnlyThere)
{
  const CapProblem cap;
  const double critical = 1.0 / std::tan(0.5 * CapAngle);
  for (const double factor : { 0.9, 1.15 })
  {
    auto settings = ExactSettings(cap.Mesh, 0.0, factor * critical);
    settings.Norm = FidelityNorm::L1;
    const auto flow = MakeExact(cap.Operators, cap.Data, settings);
    flow->Advance(ProgressMonitor());
    const Plateaus plateaus = cap.Measure(flow->State());
    EXPECT_NEAR(plateaus.Inside, factor > 1.0 ? 1.0 : 0.0, 0.01) << factor;
    EXPECT_NEAR(plateaus.Outside, 0.0, 0.01) << factor;
  }
}

TEST(TotalVariationFlow, TimeStepsWithL1EndAtItsSteadyState)
{
  CapProblem cap;
  for (Index i = 0; i < cap.Mesh.NumberOfVertices(); i += 19)
  {
    cap.Data.Given(i, 0) = cap.Data.Start(i, 0) = i % 2; // impulses
  }
  auto settings = ExactSettings(cap.Mesh, 0.0, 20.0, 1e-5);
  settings.Norm = FidelityNorm::L1;
  const auto steady = MakeExact(cap.Operators, cap.Data, settings);
  steady->Advance(ProgressMonitor());
  settings.SteadyState = false;
  settings.TimeStep = 0.2;
  const auto flow = MakeExact(cap.Operators, cap.Data, settings);
  Advance(*flow, 6);
  EXPECT_NEAR(flow->Energy(), steady->Energy(), 1e-3 * steady->Energy());
}

TEST(TotalVariationFlow, GapOfADiskInADiskClosesAtTheExactRate)
{
  // 2 L^2/(R (L^2 - R^2)); the jump lies on a ring of edges.
  const double r = 0.5, large = 1.0;
  const Surface s = Disk(32, large);
  const auto assembler = MakeAssembler(s);
  const TriangleMesh& mesh = assembler->Mesh();
  const Values u = Sample(mesh, s,
    [&](const Eigen::RowVector3d& x) { return x.norm() < r * (1.0 - 0.5 / 16.0) ? 1.0 : 0.0; });
  const double effective = r * (1.0 - 0.5 / 16.0); // between the rings
  const double time = 0.05;
  const auto flow =
    MakeExact(assembler, PointData::FromValues(u), ExactSettings(mesh, time, 0.0, 1e-5));
  flow->Advance(ProgressMonitor());
  double inside = 0.0, outside = 0.0;
  int insideCount = 0, outsideCount = 0;
  for (Index i = 0; i < mesh.NumberOfVertices(); ++i)
  {
    const double radius = Eigen::RowVector3d(s.Vertices.row(mesh.InputVertex()[i])).norm();
    if (radius < r - 0.15)
    {
      inside += flow->State()(i, 0);
      ++insideCount;
    }
    else if (radius > r + 0.15)
    {
      outside += flow->State()(i, 0);
      ++outsideCount;
    }
  }
  const double gap = inside / insideCount - outside / outsideCount;
  const double rate = 2.0 * large * large / (effective * (large * large - effective * effective));
  EXPECT_NEAR((1.0 - gap) / (rate * time), 1.0, 0.03);
}

TEST(TotalVariationFlow, CharbonnierMinimiserStaysUnderTheLaggedScheme)
{
  // Both solve (17) with this g: the steady state of one is a fixed point of the other.
  const auto assembler = MakeAssembler(Icosphere(3));
  const TriangleMesh& mesh = assembler->Mesh();
  const PointData data = PointData::FromValues(Noise(mesh, 2));
  const EdgeFunction function{ Kind::Charbonnier, 0.0, 2.0 };
  auto settings = ExactSettings(mesh, 0.0, 20.0, 1e-9);
  settings.Function = function;
  settings.AlongDiffusivity = settings.AcrossDiffusivity = 3.0;
  const auto steady = MakeExact(assembler, data, settings);
  steady->Advance(ProgressMonitor());

  NonlinearDiffusion::Settings lagged;
  lagged.TimeStep = 100.0;
  lagged.Fidelity = settings.Fidelity;
  lagged.Along = lagged.Across = function;
  lagged.AlongDiffusivity = lagged.AcrossDiffusivity = 3.0;
  PointData start = data;
  start.Start = steady->State();
  const auto model = MakeLagged(assembler, start, lagged);
  EXPECT_NEAR(model->Energy(), steady->Energy(), 1e-9 * steady->Energy());
  model->Advance(ProgressMonitor());
  EXPECT_LT((model->State() - steady->State()).cwiseAbs().maxCoeff(), 1e-3);
}

TEST(TotalVariationFlow, ConstantFunctionIsLinearDiffusion)
{
  const auto assembler = MakeAssembler(Icosphere(3));
  const TriangleMesh& mesh = assembler->Mesh();
  PointData data = PointData::FromValues(Noise(mesh, 2));
  data.Missing.head(30) = true;
  data.Fixed.tail(20) = true;
  for (const bool steady : { true, false })
  {
    TotalVariationFlow::Settings settings;
    settings.SteadyState = steady;
    settings.TimeStep = 0.01;
    settings.Fidelity = 5.0;
    settings.Function.Kind = Kind::Constant;
    settings.StopTolerance = 1e-10;
    const auto flow = MakeExact(assembler, data, settings);
    const auto heat = MakeHeat(
      assembler, data, { 0.01, 5.0, steady ? Scheme::SteadyState : Scheme::BackwardEuler });
    for (int step = 0; step < 2; ++step)
    {
      EXPECT_LE(flow->Advance(ProgressMonitor()).Residual, settings.StopTolerance);
      heat->Advance(ProgressMonitor());
    }
    EXPECT_LT((flow->State() - heat->State()).cwiseAbs().maxCoeff(), 1e-3) << steady;
    EXPECT_NEAR(flow->Energy(), heat->Energy(), 1e-5 * heat->Energy());
  }
}

TEST(TotalVariationFlow, DiffusivityActsLikeTime)
{
  const CapProblem cap;
  auto settings = ExactSettings(cap.Mesh, 0.1, 1.0);
  const auto flow = MakeExact(cap.Operators, cap.Data, settings);
  settings.TimeStep /= 2.0;
  settings.Fidelity *= 2.0;
  settings.AlongDiffusivity = settings.AcrossDiffusivity = 2.0;
  const auto faster = MakeExact(cap.Operators, cap.Data, settings);
  Advance(*flow, 2);
  Advance(*faster, 2);
  EXPECT_LT((flow->State() - faster->State()).cwiseAbs().maxCoeff(), 1e-10);
  EXPECT_NEAR(faster->Energy(), 2.0 * flow->Energy(), 1e-9);
}

TEST(TotalVariationFlow, StripesFallAtTheDiffusivityAcrossThem)
{
  // A jump along y on a torus-like strip: only the flow along x counts, whose direction is e1.
  const Surface s = Strip(40, 10, 4.0, 1.0);
  const auto assembler = MakeAssembler(s);
  const TriangleMesh& mesh = assembler->Mesh();
  const Values u =
    Sample(mesh, s, [](const Eigen::RowVector3d& x) { return x[0] < 2.05 ? 1.0 : 0.0; });
  TangentVectors frames(mesh.NumberOfTriangles(), 2);
  const Points x = Eigen::RowVector3d(1.0, 0.0, 0.0).replicate(s.NumberOfTriangles(), 1);
  frames = TangentVectorsFromTriangleVectors(mesh, s.Vertices, s.Faces, x);
  for (const auto& [along, across] :
    { std::array<double, 2>{ 1.0, 0.2 }, { 3.0, 0.2 }, { 1.0, 0.0 } })
  {
    auto settings = ExactSettings(mesh, 0.1, 0.0, 1e-6);
    settings.AlongDiffusivity = along;
    settings.AcrossDiffusivity = across;
    TotalVariationFlow flow(assembler, frames, PointData::FromValues(u), settings);
    flow.Advance(ProgressMonitor());
    // The left part, 2 long, loses `along` per time and length of its edge.
    double left = 0.0;
    int count = 0;
    for (Index i = 0; i < mesh.NumberOfVertices(); ++i)
    {
      if (s.Vertices(mesh.InputVertex()[i], 0) < 1.5)
      {
        left += flow.State()(i, 0);
        ++count;
      }
    }
    EXPECT_NEAR(1.0 - left / count, 0.1 * along / 2.05, 2e-3);
  }
}

TEST(TotalVariationFlow, MissingDataAreNotReadAndFilled)
{
  CapProblem cap;
  for (Index i = 0; i < cap.Mesh.NumberOfVertices(); ++i)
  {
    const double z = cap.Sphere.Vertices(cap.Mesh.InputVertex()[i], 2);
    if (std::abs(z - 0.5) < 0.05 || i % 11 == 0) // a scratch along the edge, and spots
    {
      cap.Data.Missing[i] = true;
      cap.Data.Given(i, 0) = 1e6;
      cap.Data.Start(i, 0) = 0.3;
    }
  }
  const auto flow = MakeExact(cap.Operators, cap.Data, ExactSettings(cap.Mesh, 0.0, 100.0));
  flow->Advance(ProgressMonitor());
  EXPECT_LT(PlateauError(cap.Measure(flow->State()), ExactPlateaus(CapAngle, 0.01)), 0.2);
  EXPECT_GT(flow->State().minCoeff(), -0.01);
  EXPECT_LT(flow->State().maxCoeff(), 1.01);
}

TEST(TotalVariationFlow, SteadyStateWithoutConditionsIsTheMean)
{
  const auto assembler = MakeAssembler(Joined(Disk(5), Icosphere(2)));
  const TriangleMesh& mesh = assembler->Mesh();
  const PointData data = PointData::FromValues(Noise(mesh, 2));
  const auto flow = MakeExact(assembler, data, ExactSettings(mesh, 0.0));
  const auto report = flow->Advance(ProgressMonitor());
  EXPECT_LE(report.Residual, 1e-4);
  for (Index c = 0; c < 2; ++c)
  {
    const Index begin = mesh.ComponentsBegin()[c];
    const Index size = mesh.ComponentsBegin()[c + 1] - begin;
    const auto areas = mesh.ControlAreas().segment(begin, size);
    const Eigen::RowVectorXd mean =
      areas.transpose() * data.Start.middleRows(begin, size) / areas.sum();
    EXPECT_LT(
      (flow->State().middleRows(begin, size).rowwise() - mean).cwiseAbs().maxCoeff(), 1e-12);
  }
}

TEST(TotalVariationFlow, ConstantsStayAndNeedNoIteration)
{
  const auto assembler = MakeAssembler(Disk(8));
  const TriangleMesh& mesh = assembler->Mesh();
  const Values constant = Values::Constant(mesh.NumberOfVertices(), 3, 0.1);
  for (const double timeStep : { 0.0, 1e-4, 1e4 })
  {
    for (const FidelityNorm norm : { FidelityNorm::L2, FidelityNorm::L1 })
    {
      auto settings = ExactSettings(mesh, timeStep, 1.0);
      settings.Norm = norm;
      const auto flow = MakeExact(assembler, PointData::FromValues(constant), settings);
      EXPECT_EQ(flow->Advance(ProgressMonitor()).Iterations, 0);
      EXPECT_LT((flow->State() - constant).cwiseAbs().maxCoeff(), 1e-15);
    }
  }
}

TEST(TotalVariationFlow, NeverBlowsUp)
{
  const auto assembler = MakeAssembler(Icosphere(2));
  const TriangleMesh& mesh = assembler->Mesh();
  const PointData data = PointData::FromValues(Noise(mesh, 2));
  for (double step = 1e-4; step < 2e4; step *= 10.0)
  {
    for (const FidelityNorm norm : { FidelityNorm::L2, FidelityNorm::L1 })
    {
      for (const double fidelity : { 0.0, 1e-6, 1.0, 1e6 })
      {
        auto settings = ExactSettings(mesh, step, fidelity, 1e-3);
        settings.Norm = norm;
        const auto flow = MakeExact(assembler, data, settings);
        const StepReport report = flow->Advance(ProgressMonitor());
        EXPECT_LE(report.Residual, 1e-3) << step << ' ' << fidelity;
        EXPECT_LT(report.Iterations, 2000) << step << ' ' << fidelity;
        EXPECT_LE(flow->State().cwiseAbs().maxCoeff(), 1.01) << step << ' ' << fidelity;
      }
    }
  }
}

TEST(TotalVariationFlow, ConstantsWithAHoleNeedNoIteration)
{
  // The mean that fills the hole differs from the constant by round-off.
  const auto assembler = MakeAssembler(Icosphere(3));
  const Index n = assembler->Mesh().NumberOfVertices();
  PointData data = PointData::FromValues(Values::Constant(n, 1, 7.3));
  data.Missing.head(40) = true;
  data.Start.topRows(40).setConstant(7.3 * (1.0 + 4e-16));
  for (const double timeStep : { 0.0, 1.0 })
  {
    const auto flow = MakeExact(assembler, data, ExactSettings(assembler->Mesh(), timeStep, 1.0));
    EXPECT_EQ(flow->Advance(ProgressMonitor()).Iterations, 0);
  }
}

TEST(TotalVariationFlow, OutliersAtMostDoubleTheIterations)
{
  const CapProblem cap;
  const auto iterations = [&](FidelityNorm norm, double outlier)
  {
    PointData data = PointData::FromValues(cap.Data.Start + 0.1 * Noise(cap.Mesh));
    data.Given(1234, 0) += outlier;
    data.Start(1234, 0) += outlier;
    auto settings = ExactSettings(cap.Mesh, 0.0, norm == FidelityNorm::L1 ? 30.0 : 10.0);
    settings.Norm = norm;
    const auto flow = MakeExact(cap.Operators, data, settings);
    const StepReport report = flow->Advance(ProgressMonitor());
    EXPECT_LE(report.Residual, settings.StopTolerance);
    return report.Iterations;
  };
  for (const FidelityNorm norm : { FidelityNorm::L2, FidelityNorm::L1 })
  {
    const int without = iterations(norm, 0.0);
    for (const double outlier : { 10.0, 100.0, 1e3, 1e4 })
    {
      EXPECT_LE(iterations(norm, outlier), 2 * without) << outlier;
    }
  }
}

TEST(TotalVariationFlow, ShortStepsCostLessEachThanLongOnes)
{
  const CapProblem cap;
  const auto iterationsPerStep = [&](int steps)
  {
    const auto flow = MakeExact(cap.Operators, cap.Data, ExactSettings(cap.Mesh, 0.2 / steps));
    int sum = 0;
    for (int step = 0; step < steps; ++step)
    {
      sum += flow->Advance(ProgressMonitor()).Iterations;
    }
    EXPECT_LT(PlateauError(cap.Measure(flow->State()), ExactPlateaus(CapAngle, 0.2)), 0.05);
    return static_cast<double>(sum) / steps;
  };
  const double few = iterationsPerStep(4);
  EXPECT_LT(few, 100.0);
  EXPECT_LT(iterationsPerStep(64), 0.4 * few);
}

TEST(TotalVariationFlow, EachOfSeveralChannelsComesOutAsIfAlone)
{
  const CapProblem cap;
  Values channels(cap.Mesh.NumberOfVertices(), 3);
  channels << cap.Data.Start + 0.1 * Noise(cap.Mesh), 1e-3 * Noise(cap.Mesh, 1, 8),
    1e-6 * cap.Data.Start;
  const PointData all = PointData::FromValues(channels);
  for (const double timeStep : { 0.0, 0.1 })
  {
    for (const FidelityNorm norm : { FidelityNorm::L2, FidelityNorm::L1 })
    {
      auto settings = ExactSettings(cap.Mesh, timeStep, 10.0, 1e-3);
      settings.Norm = norm;
      settings.Coupling = ChannelCoupling::PerChannel;
      const auto together = MakeExact(cap.Operators, all, settings);
      together->Advance(ProgressMonitor());
      for (Eigen::Index k = 0; k < 3; ++k)
      {
        const auto alone =
          MakeExact(cap.Operators, PointData::FromValues(channels.col(k)), settings);
        alone->Advance(ProgressMonitor());
        EXPECT_TRUE(alone->State().col(0) == together->State().col(k)) << k;
      }
    }
  }
}

/// What data on cells diffuse by.
TEST(TotalVariationFlow, DiffusionWeightsHaveTheFactorOfBothDirections)
{
  const auto assembler = MakeAssembler(Icosphere(3));
  const TriangleMesh& mesh = assembler->Mesh();
  TotalVariationFlow::Settings settings = ExactSettings(mesh, 0.05);
  const PointData data = PointData::FromValues(Noise(mesh));
  const CornerWeights one = MakeExact(assembler, data, settings)->DiffusionWeights(0);
  settings.AlongDiffusivity = settings.AcrossDiffusivity = 3.0;
  const CornerWeights three = MakeExact(assembler, data, settings)->DiffusionWeights(0);
  EXPECT_GT(one.cwiseAbs().maxCoeff(), 0.0);
  EXPECT_LT((three - 3.0 * one).cwiseAbs().maxCoeff(), 1e-12 * three.cwiseAbs().maxCoeff());
}

TEST(TotalVariationFlow, StartOfAbsoluteFidelityClipsOutliersAlone)
{
  const auto mesh = MakeMesh(Icosphere(4));
  Values f = Noise(*mesh, 2);
  EXPECT_EQ(WithoutOutliers(f, mesh->GetReduction()), f);
  f(7, 0) = 1e3;
  f(8, 1) = -1e3;
  const Values clipped = WithoutOutliers(f, mesh->GetReduction());
  EXPECT_LT(clipped.cwiseAbs().maxCoeff(), 4.0);
  f(7, 0) = clipped(7, 0);
  f(8, 1) = clipped(8, 1);
  EXPECT_EQ(clipped, f);
}

/// Of channels that are minimised one by one, in the norm over all of them.
TEST(TotalVariationFlow, ErrorBoundOfEqualChannelsGrowsAsTheRootOfTheirNumber)
{
  const auto assembler = MakeAssembler(Icosphere(3));
  const TriangleMesh& mesh = assembler->Mesh();
  TotalVariationFlow::Settings settings = ExactSettings(mesh, 0.05, 1.0, 1e-2);
  settings.Coupling = ChannelCoupling::PerChannel;
  const Values f = Noise(mesh);
  const auto boundOf = [&](int channels)
  {
    const auto flow =
      MakeExact(assembler, PointData::FromValues(f.replicate(1, channels)), settings);
    return flow->Advance(ProgressMonitor()).ErrorBound;
  };
  const double one = boundOf(1);
  EXPECT_GT(one, 0.0);
  EXPECT_NEAR(boundOf(2), std::sqrt(2.0) * one, 1e-9 * one);
  EXPECT_NEAR(boundOf(5), std::sqrt(5.0) * one, 1e-9 * one);
}

TEST(TotalVariationFlow, ErrorBoundIsBetweenTheErrorAndThatOfTheTolerance)
{
  const CapProblem cap;
  PointData data = PointData::FromValues(cap.Data.Start + 0.1 * Noise(cap.Mesh));
  for (const double timeStep : { 0.0, 0.02 })
  {
    const auto run = [&](double tolerance)
    {
      const auto flow =
        MakeExact(cap.Operators, data, ExactSettings(cap.Mesh, timeStep, 10.0, tolerance));
      const double bound = flow->Advance(ProgressMonitor()).ErrorBound;
      return std::make_pair(flow->State(), bound);
    };
    const auto [exact, least] = run(1e-8);
    EXPECT_LT(least, 1e-3);
    for (const double tolerance : { 1e-1, 1e-2, 1e-3 })
    {
      const auto [u, bound] = run(tolerance);
      const double error = RootMeanSquare(cap.Mesh, u - exact);
      EXPECT_GE(bound + least, error);
      // E of the state, from which the gap is at most `tolerance` E
      const double weight =
        (10.0 + (timeStep > 0.0 ? 1.0 / timeStep : 0.0)) * cap.Mesh.LengthUnit();
      const double area = cap.Mesh.ControlAreas().sum();
      const double distance = RootMeanSquare(cap.Mesh, u - data.Start);
      const double energy =
        TotalVariationOf(cap.Mesh, u) + 0.5 * weight * area * distance * distance;
      const double largest = std::sqrt(2.0 * tolerance * energy / (weight * area));
      EXPECT_LT(bound - largest, 1e-9 * largest);
    }
  }
  auto settings = ExactSettings(cap.Mesh, 0.0, 10.0, 1e-1);
  settings.Norm = FidelityNorm::L1; // not strongly convex
  EXPECT_TRUE(
    std::isinf(MakeExact(cap.Operators, data, settings)->Advance(ProgressMonitor()).ErrorBound));
}
