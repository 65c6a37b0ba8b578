// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Models/Trajectory.h"
#include "Core/Operators/MeanCorrection.h"
#include "Heat.h"
#include "Meshes.h"

#include <gtest/gtest.h>

using namespace SurfaceDiffusion;
using namespace SurfaceDiffusion::Testing;

namespace
{

const std::size_t Plenty = std::size_t(1) << 29;

std::unique_ptr<Trajectory> MakeTrajectory(std::shared_ptr<const Assembler> assembler,
  std::size_t memoryLimit, int columns = 1,
  std::shared_ptr<LinearSolver> solver = MakeConjugateGradientSolver())
{
  const TriangleMesh& mesh = assembler->Mesh();
  auto heat = MakeHeat(assembler, PointData::FromValues(Noise(mesh, columns)),
    HeatSettings(mesh, 1e-4, 1.0), std::move(solver));
  return std::make_unique<Trajectory>(assembler->SharedMesh(), std::move(heat), memoryLimit);
}

/// Counts its steps, and costs nothing.
class Counter : public Model
{
public:
  const Values& State() const override { return this->U; }
  StepReport Advance(const ProgressMonitor& progress) override
  {
    this->U(0, 0) = -1.0; // half a step on, when the progress throws
    progress.Report(0.5);
    this->U(0, 0) = ++this->Step;
    return StepReport();
  }
  double Energy() const override { return this->U(0, 0); }
  void Restore(const double* checkpoint) override
  {
    this->U(0, 0) = *checkpoint;
    this->Step = *checkpoint;
  }

private:
  Values U = Values::Zero(1, 1);
  double Step = 0.0;
};

/// A mesh with as many vertices as the counter has values.
std::shared_ptr<const TriangleMesh> NoMesh()
{
  return std::make_shared<TriangleMesh>(Points(0, 3), Triangles(0, 3));
}

} // namespace

TEST(Trajectory, SeekingGivesTheBitsOfSteppingThrough)
{
  const auto assembler = MakeAssembler(Icosphere(2));
  const auto through = MakeTrajectory(assembler, Plenty, 2);
  std::vector<Values> states;
  for (Index step = 0; step <= 50; ++step)
  {
    through->Seek(step);
    states.push_back(through->State());
  }
  const auto jumping = MakeTrajectory(assembler, 3 * states[0].size() * sizeof(double), 2);
  for (const Index step : { 40, 10, 40, 0, 50, 49, 3, 25, 50, 0 })
  {
    jumping->Seek(step);
    EXPECT_TRUE(jumping->State() == states[static_cast<std::size_t>(step)]) << step;
  }
}

TEST(Trajectory, AnySeekAmongAThousandStepsRecomputesAtMostTwiceTheRoot)
{
  // Room for the root of the number of steps.
  Trajectory trajectory(NoMesh(), std::make_unique<Counter>(), 32 * sizeof(double));
  trajectory.Reserve(1000);
  trajectory.Seek(1000);
  EXPECT_EQ(trajectory.NumberOfAdvances(), 1000);
  Index most = 0;
  for (int jump = 0; jump < 3000; ++jump)
  {
    const Index step = static_cast<Index>(1001 * UniformRandom(1, 0, jump));
    const Index before = trajectory.NumberOfAdvances();
    trajectory.Seek(step);
    EXPECT_EQ(trajectory.State()(0, 0), step);
    most = std::max(most, trajectory.NumberOfAdvances() - before);
  }
  EXPECT_LE(most, 2.0 * std::sqrt(1000.0));
}

/// Every second checkpoint is dropped when the room is full, the last one kept.
TEST(Trajectory, AnOddNumberOfCheckpointsReachesToTheEnd)
{
  for (const std::size_t room : { 3, 5, 7 })
  {
    Trajectory trajectory(NoMesh(), std::make_unique<Counter>(), room * sizeof(double));
    trajectory.Reserve(1000);
    trajectory.Seek(1000);
    EXPECT_LE(trajectory.NumberOfStepsTo(999), 512) << room;
    trajectory.Seek(999);
    EXPECT_EQ(trajectory.State()(0, 0), 999.0);
  }
}

TEST(Trajectory, WithRoomForAllNothingIsRecomputed)
{
  Trajectory trajectory(NoMesh(), std::make_unique<Counter>(), Plenty);
  trajectory.Reserve(200);
  trajectory.Seek(200);
  for (const Index step : { 3, 199, 0, 77 })
  {
    trajectory.Seek(step);
    EXPECT_EQ(trajectory.State()(0, 0), step);
  }
  EXPECT_EQ(trajectory.NumberOfAdvances(), 200);
}

TEST(Trajectory, WithoutReserveItGrowsAsItGoes)
{
  Trajectory trajectory(NoMesh(), std::make_unique<Counter>(), 10 * sizeof(double));
  trajectory.Seek(300);
  trajectory.Seek(123);
  EXPECT_EQ(trajectory.State()(0, 0), 123.0);
}

TEST(Trajectory, WithRoomForOneItStartsAgain)
{
  Trajectory trajectory(NoMesh(), std::make_unique<Counter>(), 0);
  trajectory.Seek(20);
  trajectory.Seek(5);
  EXPECT_EQ(trajectory.NumberOfAdvances(), 25);
  EXPECT_EQ(trajectory.State()(0, 0), 5.0);
}

TEST(Trajectory, RecordsEveryStepOnce)
{
  const auto assembler = MakeAssembler(Icosphere(2));
  const auto trajectory = MakeTrajectory(assembler, Plenty, 2);
  trajectory->Seek(10);
  trajectory->Seek(4);
  trajectory->Seek(12);
  ASSERT_EQ(trajectory->Records().size(), 13u);
  const double size = Total(assembler->Mesh(), Noise(assembler->Mesh(), 2).cwiseAbs(), 0);
  for (Index step = 0; step <= 12; ++step)
  {
    const StepRecord& record = trajectory->Records()[step];
    EXPECT_EQ(record.Iterations > 0, step > 0);
    EXPECT_LE(record.Residual, 1e-10);
    EXPECT_GE(record.Seconds, 0.0);
    EXPECT_TRUE(step == 0 || record.Energy < trajectory->Records()[step - 1].Energy);
    EXPECT_NEAR(trajectory->TotalAt(step, 1), trajectory->TotalAt(0, 1), 1e-12 * size);
    EXPECT_NE(trajectory->TotalAt(step, 0), trajectory->TotalAt(step, 1));
  }
}

TEST(Trajectory, AnAbortInsideAStepGoesBackToAKnownState)
{
  Trajectory trajectory(NoMesh(), std::make_unique<Counter>(), Plenty);
  trajectory.Seek(3);
  const ProgressMonitor::Callback stop = [](double) { return false; };
  EXPECT_THROW(trajectory.Seek(9, ProgressMonitor(stop)), Aborted);
  EXPECT_EQ(trajectory.Step(), 3);
  EXPECT_EQ(trajectory.State()(0, 0), 3.0);
}

TEST(Trajectory, AnAbortBetweenCheckpointsGoesBackToOne)
{
  Trajectory trajectory(NoMesh(), std::make_unique<Counter>(), 4 * sizeof(double));
  trajectory.Seek(11); // kept: 0, 4, 8
  const ProgressMonitor::Callback stop = [](double) { return false; };
  EXPECT_THROW(trajectory.Seek(15, ProgressMonitor(stop)), Aborted);
  EXPECT_EQ(trajectory.State()(0, 0), trajectory.Step());
  trajectory.Seek(15);
  EXPECT_EQ(trajectory.State()(0, 0), 15.0);
}

TEST(Trajectory, AFailedSolveLeavesItUsable)
{
  const auto assembler = MakeAssembler(Icosphere(2));
  std::shared_ptr<LinearSolver> solver = MakeConjugateGradientSolver();
  const auto trajectory = MakeTrajectory(assembler, Plenty, 1, solver);
  solver->SetLimits({ 1e-10, 1 });
  EXPECT_THROW(trajectory->Seek(1), NotConverged);
  EXPECT_EQ(trajectory->Step(), 0);
  EXPECT_TRUE(trajectory->State() == Noise(assembler->Mesh()));
  solver->SetLimits({});
  trajectory->Seek(1);
  EXPECT_EQ(trajectory->Step(), 1);
}

TEST(Trajectory, ProgressRisesEvenlyOverTheSteps)
{
  Trajectory trajectory(NoMesh(), std::make_unique<Counter>(), Plenty);
  std::vector<double> reports{ 0.0 };
  const ProgressMonitor::Callback watch = [&](double fraction)
  {
    reports.push_back(fraction);
    return true;
  };
  trajectory.Seek(20, ProgressMonitor(watch));
  EXPECT_GE(reports.size(), 10u);
  EXPECT_NEAR(reports.back(), 1.0, 1e-15);
  for (std::size_t i = 1; i < reports.size(); ++i)
  {
    EXPECT_GE(reports[i], reports[i - 1]);
    EXPECT_LE(reports[i] - reports[i - 1], 0.1);
  }
}
