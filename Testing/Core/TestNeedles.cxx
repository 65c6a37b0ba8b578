// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "NeedleMeshes.h"
#include "RunInput.h"
#include "ThreadedFor.h"

#include "Core/Operators/CotanWeights.h"
#include "Core/Solvers/ConvergenceForecast.h"
#include "Core/Solvers/SolverChoice.h"
#include "Run/HeatSettings.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>
#include <vector>

using namespace SurfaceDiffusion;
using namespace SurfaceDiffusion::Testing;

namespace
{

constexpr int Steps = 10;

/// Backward Euler steps of c h^2 from noise.
struct HeatSteps
{
  std::shared_ptr<const TriangleMesh> Mesh;
  SparseMatrix Matrix;
  SolverTask Task;

  HeatSteps(const Testing::Surface& surface, double c)
    : Mesh(MakeMesh(surface))
  {
    const Assembler assembler(this->Mesh);
    const double h = MeanEdge(*this->Mesh);
    this->Matrix = ZeroMatrix(assembler.Pattern());
    assembler.Fill(this->Matrix, this->Mesh->ControlAreas(), c * h * h, CotanWeights(*this->Mesh));
    this->Task.NumberOfVertices = this->Mesh->NumberOfVertices();
    this->Task.DiffusionNumber = c;
    this->Task.NumberOfSolves = Steps;
  }

  /// The state after the steps, and the sum of the iterations. unit: of the data.
  Values Run(LinearSolver& solver, int& iterations, double unit = 1.0) const
  {
    solver.SetMatrix(this->Matrix);
    Values u = unit * Noise(*this->Mesh);
    iterations = 0;
    for (int step = 0; step < Steps; ++step)
    {
      const Values b = this->Mesh->ControlAreas().asDiagonal() * u;
      const SolveReport report = solver.Solve(b, u);
      EXPECT_NO_THROW(RequireAnswer(report, solver.GetLimits())) << report.Residual;
      iterations += report.Iterations;
    }
    return u;
  }

  int IterationsOf(SolverMethod method) const
  {
    int iterations = 0;
    this->Run(*MakeSolver(method, this->Task), iterations);
    return iterations;
  }
};

/// A run of heat diffusion with defaults.
SurfaceDiffusion::HeatSettings Heat(int steps)
{
  SurfaceDiffusion::HeatSettings settings;
  settings.NumberOfTimeSteps = steps;
  return settings;
}

} // namespace

// With the diagonal as preconditioner they take 2.5 to 10 times the iterations.
TEST(Needles, ConjugateGradientsTakeTheIterationsOfAnIrregularMesh)
{
  for (const double diffusionNumber : { 0.1, 1.0, 30.0 })
  {
    HeatSteps needles(LatitudeLongitudeSphere(200, 200), diffusionNumber);
    HeatSteps even(Icosphere(6), diffusionNumber);
    EXPECT_LE(needles.IterationsOf(SolverMethod::ConjugateGradient),
      3.0 * even.IterationsOf(SolverMethod::ConjugateGradient))
      << diffusionNumber;
    EXPECT_LE(needles.IterationsOf(SolverMethod::Automatic),
      3.0 * even.IterationsOf(SolverMethod::ConjugateGradient))
      << diffusionNumber;
  }
}

// Not one iteration is lost to conjugate gradients, which the matrix shows to be slow.
TEST(Needles, AutomaticSkipsConjugateGradientsThatTheMatrixShowsToBeSlow)
{
  const HeatSteps steps(ContourOfGrid(40), 10.0);
  SolverChoice choice;
  choice.Method = SolverMethod::ConjugateGradient;
  choice.FallsBack = true;
  choice.Next = SolverMethod::Multigrid;
  choice.ExpectedIterations = 100.0;
  choice.DiffusionNumber = 10.0;
  int given = 0, multigrid = 0;
  steps.Run(*MakeSolver(SolverMethod::Multigrid, steps.Task), multigrid);
  choice.Patience = 120; // of 160 that are forecast
  steps.Run(*MakeSolver(choice), given);
  EXPECT_EQ(given, multigrid);
  given = 0;
  choice.Patience = 200;
  steps.Run(*MakeSolver(choice), given);
  EXPECT_GT(given, multigrid);
}

// Iterations of methods that fail count, too: solvers report their progress after every eighth one.
TEST(Needles, AutomaticDoesLittleWorkOnATorusWithASeam)
{
  const HeatSteps steps(TorusWithSeam(150), 1.0);
  int reports = 0;
  const ProgressMonitor::Callback count = [&](double)
  {
    ++reports;
    return true;
  };
  const auto solver = MakeSolver(SolverMethod::Automatic, steps.Task);
  solver->SetMatrix(steps.Matrix);
  Values u = Noise(*steps.Mesh);
  for (int step = 0; step < Steps; ++step)
  {
    solver->Solve(steps.Mesh->ControlAreas().asDiagonal() * u, u, ProgressMonitor(count));
  }
  EXPECT_LE(reports, 100);
}

// An even mesh keeps the method that the model of times expects to be the fastest.
TEST(Needles, AutomaticStaysWithConjugateGradientsOnAnEvenMesh)
{
  const HeatSteps steps(Icosphere(5), 0.1);
  EXPECT_EQ(steps.IterationsOf(SolverMethod::Automatic),
    steps.IterationsOf(SolverMethod::ConjugateGradient));
}

TEST(Needles, MultigridFallsBackOnAFactorisation)
{
  for (const Testing::Surface& surface : { TorusWithSeam(60), ContourOfGrid(40) })
  {
    const HeatSteps steps(surface, 100.0);
    int iterations = 0;
    const Values u = steps.Run(*MakeSolver(SolverMethod::Multigrid, steps.Task), iterations);
    EXPECT_LE(iterations, 400);
    const Values direct = steps.Run(*MakeSolver(SolverMethod::Direct, steps.Task), iterations);
    EXPECT_LT((u - direct).cwiseAbs().maxCoeff(), 1e-5);
  }
}

// The last places of the solution leave more than the tolerance, and iterations do not change that.
TEST(Needles, NoIterationsFollowAFactorisationWhoseResidualIsRoundOff)
{
  for (const Testing::Surface& surface : { TorusWithSeam(90), ContourOfGrid(90) })
  {
    HeatSteps steps(surface, 100.0);
    steps.Task.NumberOfSolves = 100.0;
    const SolverChoice choice = ChooseSolver(SolverMethod::Automatic, steps.Task);
    EXPECT_EQ(choice.Method, SolverMethod::Direct);
    EXPECT_TRUE(choice.FallsBack);
    for (const double unit : { 1.0, 1e-160, 1e160 })
    {
      int iterations = 0;
      steps.Run(*MakeSolver(choice), iterations, unit);
      EXPECT_EQ(iterations, 0) << unit;
    }
  }
}

TEST(Needles, AutomaticHasTheSameBitsOnAnyNumberOfThreads)
{
  for (const Testing::Surface& surface :
    { LatitudeLongitudeSphere(100, 100), TorusWithSeam(80), CylinderWithFans(80, 80) })
  {
    const HeatSteps steps(surface, 1.0);
    int iterations = 0, threaded = 0;
    const Values one = steps.Run(*MakeSolver(SolverMethod::Automatic, steps.Task), iterations);
    const ThreadedFor threads(3);
    const Values three =
      steps.Run(*MakeSolver(SolverMethod::Automatic, steps.Task, threads), threaded);
    EXPECT_TRUE(one == three);
    EXPECT_EQ(iterations, threaded);
  }
}

// The first solve decides, and a new matrix is decided on its own.
TEST(Needles, AutomaticForgetsTheLastMatrix)
{
  const HeatSteps steps(LatitudeLongitudeSphere(100, 100), 1.0);
  int first = 0, second = 0;
  const auto solver = MakeSolver(SolverMethod::Automatic, steps.Task);
  const Values expected = steps.Run(*solver, first);
  EXPECT_TRUE(steps.Run(*solver, second) == expected);
  EXPECT_EQ(first, second);
}

TEST(Needles, StatesDoNotDependOnTheOrderInWhichTheyAreAskedFor)
{
  const RunInput input(LatitudeLongitudeSphere(100, 100));
  SurfaceDiffusion::Run run(SerialFor());
  StateOf(run, { input.Block() }, Heat(Steps));
  for (const int step : { 1, 4, 0, Steps })
  {
    run.Seek(step, ProgressMonitor());
    SurfaceDiffusion::Run fresh(SerialFor());
    StateOf(fresh, { input.Block() }, Heat(Steps));
    fresh.Seek(step, ProgressMonitor());
    EXPECT_TRUE(run.GetBlock(0).Path->State() == fresh.GetBlock(0).Path->State()) << step;
  }
}

TEST(Needles, ALongerRunHasTheStatesOfANewOne)
{
  for (const Testing::Surface& surface : { LatitudeLongitudeSphere(100, 100), Icosphere(5) })
  {
    const RunInput input(surface);
    SurfaceDiffusion::Run run(SerialFor());
    for (const int steps : { 1, 2, 12, 40 })
    {
      const Values longer = StateOf(run, { input.Block() }, Heat(steps));
      SurfaceDiffusion::Run fresh(SerialFor());
      EXPECT_TRUE(longer == StateOf(fresh, { input.Block() }, Heat(steps))) << steps;
    }
  }
}

// On an even mesh no step is computed again.
TEST(Needles, ALongerRunGoesOnFromTheStepsBefore)
{
  const RunInput input(Icosphere(5));
  SurfaceDiffusion::Run run(SerialFor());
  StateOf(run, { input.Block() }, Heat(8));
  const auto* const path = run.GetBlock(0).Path.get();
  StateOf(run, { input.Block() }, Heat(10));
  EXPECT_EQ(run.GetBlock(0).Path.get(), path);
  EXPECT_EQ(run.GetBlock(0).Path->NumberOfAdvances(), 10);
}

TEST(ConvergenceForecast, ExpectsTheIterationsOfAConstantRate)
{
  ConvergenceForecast forecast(1.0, { 1e-8, 200, true });
  EXPECT_FALSE(forecast.Update(31, 1.0)); // no forecast yet
  EXPECT_EQ(forecast.Largest(), 0.0);
  EXPECT_FALSE(forecast.Update(50, 1e-2));
  EXPECT_NEAR(forecast.Largest(), 200.0, 1e-9);
  EXPECT_FALSE(forecast.Update(60, 1e-2)); // the next one is that after 100 iterations
  EXPECT_TRUE(forecast.Update(100, 1e-3));
  EXPECT_NEAR(forecast.Largest(), std::sqrt((100.0 + 5.0 * 50.0) * (100.0 * 8.0 / 3.0)), 1e-9);
}

TEST(ConvergenceForecast, StopsEarlyOnlyWhereItIsAskedTo)
{
  ConvergenceForecast patient(1.0, { 1e-8, 200, false });
  EXPECT_FALSE(patient.Update(32, 2.0));
  EXPECT_EQ(patient.Largest(), std::numeric_limits<double>::infinity());
  ConvergenceForecast early(1.0, { 1e-8, 200, true });
  EXPECT_FALSE(early.Update(32, 2.0)); // before a quarter of the iterations that are allowed
  EXPECT_TRUE(early.Update(64, 2.0));
  ConvergenceForecast converged(1.0, { 1e-8, 10, true });
  EXPECT_FALSE(converged.Update(40, 1e-9));
}
