// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "FilterTest.h"

#include "vtkFVMHeatFilter.h"
#include "vtkInformationVector.h"
#include "vtkIntrinsicTVFilter.h"
#include "vtkMultiBlockDataSet.h"
#include "vtkMumfordShahFilter.h"
#include "vtkObjectFactory.h"
#include "vtkStripper.h"
#include "vtkTuringTextureFilter.h"

#include <gtest/gtest.h>

#include <limits>
#include <utility>

using namespace FilterTest;
using Pipeline = vtkStreamingDemandDrivenPipeline;

namespace
{

vtkSmartPointer<vtkFVMHeatFilter> MakeFilter(vtkPolyData* surface, bool timeSteps = true)
{
  auto filter = vtkSmartPointer<vtkFVMHeatFilter>::New();
  filter->SetInputData(surface);
  filter->SetGenerateTimeSteps(timeSteps);
  return filter;
}

vtkSmartPointer<vtkPolyData> Halves()
{
  auto grid = Grid(12, 12);
  AddPointArray(grid, "f", 1, [](vtkIdType i, int) { return i % 12 < 6 ? 0.0 : 1.0; });
  grid->GetPointData()->SetActiveScalars("f");
  return grid;
}

double DataTime(vtkAlgorithm* filter, int port = 0)
{
  return filter->GetOutputDataObject(port)->GetInformation()->Get(vtkDataObject::DATA_TIME_STEP());
}

/// A source whose data are the time, and which counts its executions.
class TimeSource : public vtkPolyDataAlgorithm
{
public:
  static TimeSource* New();
  vtkTypeMacro(TimeSource, vtkPolyDataAlgorithm);

  int Executions = 0;
  bool HasTimes = true;
  bool HasSteps = true; ///< false: a time range without steps
  bool TimeWasAsked = false;
  double LastTime = -1.0;

protected:
  TimeSource() { this->SetNumberOfInputPorts(0); }

  int RequestInformation(
    vtkInformation*, vtkInformationVector**, vtkInformationVector* outputs) override
  {
    const double times[] = { 10.0, 20.0, 30.0 };
    const double range[] = { 10.0, 30.0 };
    if (this->HasTimes)
    {
      if (this->HasSteps)
      {
        outputs->GetInformationObject(0)->Set(Pipeline::TIME_STEPS(), times, 3);
      }
      outputs->GetInformationObject(0)->Set(Pipeline::TIME_RANGE(), range, 2);
    }
    return 1;
  }

  int RequestData(vtkInformation*, vtkInformationVector**, vtkInformationVector* outputs) override
  {
    ++this->Executions;
    vtkInformation* info = outputs->GetInformationObject(0);
    this->TimeWasAsked = info->Has(Pipeline::UPDATE_TIME_STEP());
    this->LastTime = this->TimeWasAsked ? info->Get(Pipeline::UPDATE_TIME_STEP())
      : this->HasTimes                  ? 10.0
                                        : 0.0;
    auto* output = vtkPolyData::GetData(outputs);
    output->ShallowCopy(Grid(5, 5));
    AddPointArray(output, "f", 1, [&](vtkIdType i, int k) { return this->LastTime + Rough(i, k); });
    output->GetPointData()->SetActiveScalars("f");
    if (this->HasTimes)
    {
      output->GetInformation()->Set(vtkDataObject::DATA_TIME_STEP(), this->LastTime);
    }
    return 1;
  }
};
vtkStandardNewMacro(TimeSource);

} // namespace

TEST(TimeContract, PublishesTheTimesOfItsStepsOnBothPorts)
{
  auto plane = Grid(6, 6);
  AddRough(plane);
  auto filter = MakeFilter(plane);
  filter->SetTimeStep(0.25);
  filter->SetNumberOfTimeSteps(4);
  const std::vector<double> times{ 0.0, 0.25, 0.5, 0.75, 1.0 };
  for (int port = 0; port < 2; ++port)
  {
    EXPECT_EQ(PublishedTimes(filter, port), times);
    const double* range = filter->GetOutputInformation(port)->Get(Pipeline::TIME_RANGE());
    ASSERT_NE(range, nullptr);
    EXPECT_EQ(range[0], 0.0);
    EXPECT_EQ(range[1], 1.0);
  }
  filter->GenerateTimeStepsOff();
  EXPECT_TRUE(PublishedTimes(filter).empty());
  EXPECT_FALSE(filter->GetOutputInformation(0)->Has(Pipeline::TIME_RANGE()));
}

TEST(TimeContract, FWHMPublishesItsOwnTimes)
{
  auto plane = Grid(6, 6);
  AddRough(plane);
  auto filter = MakeFilter(plane);
  filter->SetNumberOfTimeSteps(4);
  filter->SetFWHM(2.0);
  const double last = 4.0 / (16.0 * std::log(2.0)); // in coordinate units squared
  EXPECT_EQ(PublishedTimes(filter).size(), 5u);
  EXPECT_NEAR(PublishedTimes(filter).back(), last, 1e-15);
  filter->Update();
  EXPECT_NEAR(HistoryAt(filter, 4, "Time"), last, 1e-15);
}

TEST(TimeContract, ASteadyStateHasNoTimes)
{
  auto plane = Grid(6, 6);
  AddRough(plane);
  vtkNew<vtkFVMHeatFilter> heat;
  heat->SetModeToSteadyState();
  vtkNew<vtkIntrinsicTVFilter> variation;
  variation->SetModeToSteadyState();
  variation->SetFidelityWeight(0.0);
  for (vtkSurfaceDiffusionAlgorithm* filter : { static_cast<vtkSurfaceDiffusionAlgorithm*>(heat),
         static_cast<vtkSurfaceDiffusionAlgorithm*>(variation) })
  {
    filter->SetInputData(plane);
    filter->SetResultArrayName("u");
    filter->GenerateTimeStepsOn();
    EXPECT_TRUE(PublishedTimes(filter).empty());
    EXPECT_FALSE(filter->GetOutputInformation(0)->Has(Pipeline::TIME_RANGE()));
    UpdateAt(filter, 0.0);
    vtkDataArray* const u = Result(filter, "u");
    EXPECT_LT(u->GetRange()[1] - u->GetRange()[0], 1e-12);
    EXPECT_FALSE(filter->GetOutput()->GetInformation()->Has(vtkDataObject::DATA_TIME_STEP()));
    EXPECT_EQ(History(filter)->GetNumberOfRows(), 2); // its start and itself
    EXPECT_LT(HistoryAt(filter, 1, "Energy"), 1e-12 * HistoryAt(filter, 0, "Energy"));
  }
}

TEST(TimeContract, TheInputsOwnTimePassesThroughASteadyState)
{
  vtkNew<TimeSource> source;
  vtkNew<vtkFVMHeatFilter> filter;
  filter->SetInputConnection(source->GetOutputPort());
  filter->SetModeToSteadyState();
  filter->GenerateTimeStepsOn();
  EXPECT_EQ(PublishedTimes(filter), (std::vector<double>{ 10.0, 20.0, 30.0 }));
  UpdateAt(filter, 20.0);
  EXPECT_EQ(source->LastTime, 20.0);
  EXPECT_EQ(DataTime(filter), 20.0);
}

TEST(TimeContract, ARequestGetsTheLatestPublishedStateAtOrBeforeIt)
{
  auto plane = Grid(6, 6);
  AddRough(plane);
  std::vector<vtkSmartPointer<vtkDataArray>> states;
  for (int steps = 0; steps <= 10; ++steps)
  {
    auto filter = MakeFilter(plane, false);
    filter->SetTimeStep(0.5);
    filter->SetNumberOfTimeSteps(steps);
    filter->SetSolverToDirect();
    filter->Update();
    states.push_back(Result(filter));
  }
  auto filter = MakeFilter(plane);
  filter->SetTimeStep(0.5);
  filter->SetOutputInterval(4);
  filter->SetSolverToDirect();
  filter->Update(); // without a request: the last time
  EXPECT_TRUE(Identical(Result(filter), states[10]));
  EXPECT_EQ(DataTime(filter), 5.0);
  struct Case
  {
    double Asked;
    int Step;
  };
  for (const Case& c : { Case{ 0.0, 0 }, Case{ 1.9, 0 }, Case{ 2.0, 4 }, Case{ 3.99, 4 },
         Case{ 4.0, 8 }, Case{ 4.9, 8 }, Case{ 5.0, 10 }, Case{ 100.0, 10 }, Case{ -3.0, 0 },
         Case{ std::numeric_limits<double>::infinity(), 10 } })
  {
    UpdateAt(filter, c.Asked);
    EXPECT_TRUE(Identical(Result(filter), states[c.Step])) << c.Asked;
    EXPECT_EQ(DataTime(filter), 0.5 * c.Step) << c.Asked;
    EXPECT_EQ(DataTime(filter, 1), 0.5 * c.Step) << c.Asked;
    EXPECT_EQ(History(filter)->GetNumberOfRows(), c.Step + 1) << c.Asked;
  }
}

TEST(TimeContract, EveryPublishedTimeIsFoundAgain)
{
  auto plane = Grid(3, 3);
  AddRough(plane);
  auto filter = MakeFilter(plane);
  filter->SetTimeStep(0.1); // not a sum of powers of two
  filter->SetNumberOfTimeSteps(300);
  const std::vector<double> times = PublishedTimes(filter);
  ASSERT_EQ(times.size(), 301u);
  double sum = 0.0; // as in a program that adds up steps
  for (std::size_t step = 0; step < times.size(); step += 7)
  {
    UpdateAt(filter, times[step]);
    EXPECT_EQ(DataTime(filter), times[step]);
    UpdateAt(filter, sum);
    EXPECT_EQ(DataTime(filter), times[step]);
    for (int i = 0; i < 7; ++i)
    {
      sum += 0.1;
    }
  }
}

TEST(TimeContract, AnySeekAmongAThousandStepsRecomputesFew)
{
  auto plane = Grid(40, 40);
  AddRough(plane, 2); // 25 kB a state
  for (const int limit : { 1, 512 })
  {
    auto filter = MakeFilter(plane);
    filter->SetNumberOfTimeSteps(1000);
    filter->SetTimeIntegratorToFirstOrder();
    filter->SetSolverToDirect();
    filter->SetCheckpointMemoryLimit(limit);
    filter->Update();
    EXPECT_EQ(filter->GetNumberOfStepsComputed(), 1000);
    vtkIdType most = 0;
    for (const int step : { 0, 999, 998, 63, 62, 1, 1000, 500, 32, 31, 767, 250, 512, 511 })
    {
      const vtkIdType before = filter->GetNumberOfStepsComputed();
      UpdateAt(filter, step);
      EXPECT_EQ(DataTime(filter), step);
      most = std::max(most, filter->GetNumberOfStepsComputed() - before);
    }
    EXPECT_LE(most, 2.0 * std::sqrt(1000.0)) << limit << " MiB";
    EXPECT_EQ(most > 0, limit == 1); // 1 MiB holds 40 states, 512 MiB all
  }
}

TEST(TimeContract, DiffusionTimeDoesNotGoUpstream)
{
  for (const bool hasTimes : { false, true })
  {
    vtkNew<TimeSource> source;
    source->HasTimes = hasTimes;
    vtkNew<vtkFVMHeatFilter> filter;
    filter->SetInputConnection(source->GetOutputPort());
    filter->GenerateTimeStepsOn();
    EXPECT_EQ(PublishedTimes(filter).size(), 11u);
    for (const double time : { 3.0, 7.0, 0.0, 20.0 })
    {
      UpdateAt(filter, time);
      EXPECT_EQ(source->Executions, 1);
      EXPECT_EQ(source->LastTime, hasTimes ? 10.0 : 0.0); // the input's first time
      EXPECT_EQ(DataTime(filter), std::min(10.0, time));
    }
    EXPECT_EQ(source->TimeWasAsked, hasTimes);
    EXPECT_EQ(filter->GetNumberOfStepsComputed(), 3 + 4 + 0 + 3);
  }
}

TEST(TimeContract, AnInputWithARangeButNoStepsIsAskedForItsStart)
{
  vtkNew<TimeSource> source;
  source->HasSteps = false;
  vtkNew<vtkFVMHeatFilter> filter;
  filter->SetInputConnection(source->GetOutputPort());
  filter->GenerateTimeStepsOn();
  UpdateAt(filter, 5.0);
  UpdateAt(filter, 6.0);
  EXPECT_TRUE(source->TimeWasAsked);
  EXPECT_EQ(source->LastTime, 10.0);
  EXPECT_EQ(source->Executions, 1);
}

TEST(TimeContract, OneWarningSaysThatTheTimesOfTheInputAreNotFollowed)
{
  vtkNew<TimeSource> source;
  const auto first = MakeFilter(Halves());
  vtkNew<vtkFVMHeatFilter> behind;
  const std::pair<vtkAlgorithm*, const char*> producers[] = {
    { source,
      "GenerateTimeSteps is on and the input has times from 10 to 30: all results are of the "
      "input at 10; to follow its times, set GenerateTimeSteps to off" },
    { first,
      "GenerateTimeSteps is on and the input has times from 0 to 10: all results are of the "
      "input at 0;" },
  };
  for (const auto& [producer, words] : producers)
  {
    behind->SetInputConnection(producer->GetOutputPort());
    behind->GenerateTimeStepsOn();
    Messages messages(behind);
    UpdateAt(behind, 4.0);
    UpdateAt(behind, 7.0);
    ASSERT_EQ(messages.Warnings.size(), 1u) << words;
    EXPECT_NE(messages.Warnings[0].find(words), std::string::npos) << messages.Warnings[0];
    behind->GenerateTimeStepsOff();
    UpdateAt(behind, 20.0);
    EXPECT_EQ(messages.Warnings.size(), 1u);
  }
  Messages messages(first);
  UpdateAt(first, 3.0);
  EXPECT_TRUE(messages.Warnings.empty()) << "the input has no times";
}

TEST(TimeContract, TheInputsOwnTimePassesThroughWithoutTimeSteps)
{
  vtkNew<TimeSource> source;
  vtkNew<vtkFVMHeatFilter> filter;
  filter->SetInputConnection(source->GetOutputPort());
  EXPECT_EQ(PublishedTimes(filter), (std::vector<double>{ 10.0, 20.0, 30.0 }));
  EXPECT_EQ(filter->GetOutputInformation(0)->Get(Pipeline::TIME_RANGE())[1], 30.0);
  for (const double time : { 20.0, 30.0, 10.0 })
  {
    UpdateAt(filter, time);
    EXPECT_EQ(source->LastTime, time);
    EXPECT_EQ(DataTime(filter), time);
    EXPECT_NEAR(HistoryAt(filter, 0, "Total_0"), HistoryAt(filter, 10, "Total_0"), 1e-10);
    EXPECT_NEAR(HistoryAt(filter, 0, "Total_0") / 16.0, time, 1.0);
  }
  EXPECT_EQ(source->Executions, 3);
}

TEST(TimeContract, TheTimeOfCompositeDataPassesThroughToo)
{
  auto plane = Grid(6, 6);
  AddRough(plane);
  vtkNew<vtkMultiBlockDataSet> blocks;
  blocks->SetBlock(0, plane);
  blocks->GetInformation()->Set(vtkDataObject::DATA_TIME_STEP(), 20.0);
  vtkNew<vtkFVMHeatFilter> filter;
  filter->SetInputDataObject(blocks);
  filter->Update();
  EXPECT_EQ(DataTime(filter), 20.0);
  filter->GenerateTimeStepsOn();
  filter->Update();
  EXPECT_EQ(DataTime(filter), 10.0);
}

TEST(TimeContract, TheHistoryHasARowPerStepAndTheDocumentedColumns)
{
  const int n = 11;
  auto plane = Grid(n, n);
  AddPointArray(
    plane, "f", 2, [](vtkIdType i, int k) { return k == 0 ? static_cast<double>(i % n) : 3.0; });
  auto filter = MakeFilter(plane, false);
  SetInputArray(filter, 0, "f");
  filter->SetUnitsToAbsolute();
  filter->SetTimeStep(0.5);
  filter->SetSolverToConjugateGradient();
  filter->Update();
  vtkTable* history = History(filter);
  ASSERT_EQ(history->GetNumberOfRows(), 11);
  const std::vector<std::string> columns{ "Step", "Time", "Total_0", "Total_1", "Energy",
    "Iterations", "Residual", "Seconds" };
  ASSERT_EQ(history->GetNumberOfColumns(), static_cast<vtkIdType>(columns.size()));
  for (std::size_t c = 0; c < columns.size(); ++c)
  {
    EXPECT_EQ(columns[c], history->GetColumnName(static_cast<vtkIdType>(c)));
  }
  double iterations = 0.0;
  double residual = 0.0;
  for (int row = 0; row <= 10; ++row)
  {
    EXPECT_EQ(HistoryAt(filter, row, "Step"), row);
    EXPECT_EQ(HistoryAt(filter, row, "Time"), 0.5 * row);
    EXPECT_NEAR(HistoryAt(filter, row, "Total_0"), 500.0, 1e-9);
    EXPECT_NEAR(HistoryAt(filter, row, "Total_1"), 300.0, 1e-9);
    iterations += HistoryAt(filter, row, "Iterations");
    residual = std::max(residual, HistoryAt(filter, row, "Residual"));
    EXPECT_GE(HistoryAt(filter, row, "Seconds"), 0.0);
    if (row > 0)
    {
      EXPECT_LT(HistoryAt(filter, row, "Energy"), HistoryAt(filter, row - 1, "Energy"));
      EXPECT_GT(HistoryAt(filter, row, "Iterations"), 0);
    }
  }
  EXPECT_NEAR(HistoryAt(filter, 0, "Energy"), 50.0, 1e-9); // 1/2 int |grad x|^2
  EXPECT_EQ(filter->GetNumberOfIterations(), iterations);
  EXPECT_EQ(filter->GetResidual(), residual);
  EXPECT_GT(residual, 0.0);
  EXPECT_LE(residual, filter->GetTolerance());
}

TEST(TimeContract, ARunThatEndsEarlyPublishesTheStepsThatItHas)
{
  vtkNew<vtkMumfordShahFilter> shah;
  vtkNew<vtkTuringTextureFilter> texture;
  texture->SetStopTolerance(0.5);
  for (vtkSurfaceDiffusionAlgorithm* filter : { static_cast<vtkSurfaceDiffusionAlgorithm*>(shah),
         static_cast<vtkSurfaceDiffusionAlgorithm*>(texture) })
  {
    filter->SetInputData(Halves());
    filter->Update();
    const auto rows = static_cast<std::size_t>(History(filter)->GetNumberOfRows());
    const auto planned = static_cast<std::size_t>(filter->GetNumberOfTimeSteps()) + 1;
    ASSERT_LT(rows, planned);
    const char* const name = filter == shah.Get() ? "fMumfordShah" : "u1";
    const auto final = Copy(Result(filter, name));

    filter->GenerateTimeStepsOn();
    EXPECT_EQ(PublishedTimes(filter).size(), planned); // the plan
    UpdateAt(filter, 0.0);
    EXPECT_EQ(DataTime(filter), 0.0);
    const std::vector<double> times = PublishedTimes(filter);
    EXPECT_EQ(times.size(), rows);
    EXPECT_EQ(PublishedTimes(filter, 1), times);
    const vtkIdType computed = filter->GetNumberOfStepsComputed();
    UpdateAt(filter, times.back());
    EXPECT_EQ(DataTime(filter), times.back());
    EXPECT_TRUE(Identical(final, Result(filter, name)));
    UpdateAt(filter, 1e9); // outside the range
    EXPECT_EQ(DataTime(filter), times.back());
    EXPECT_TRUE(Identical(final, Result(filter, name)));
    EXPECT_LE(filter->GetNumberOfStepsComputed(), computed + static_cast<vtkIdType>(rows));

    filter->SetOutputInterval(4); // the end may lie between two intervals
    EXPECT_EQ(PublishedTimes(filter).back(), times.back());
    UpdateAt(filter, times.back());
    EXPECT_TRUE(Identical(final, Result(filter, name)));

    filter->SetOutputInterval(1);
    filter->SetNumberOfTimeSteps(3);
    EXPECT_EQ(PublishedTimes(filter).size(), 4u);
    UpdateAt(filter, 1e9);
    EXPECT_EQ(History(filter)->GetNumberOfRows(), 4);
  }
}

/// A filter that changes its times during an update is up to date after it.
TEST(TimeContract, TimesThatChangeAtAnUpdateCauseNoOther)
{
  vtkNew<vtkMumfordShahFilter> filter;
  vtkNew<vtkStripper> next;
  filter->SetInputData(Halves());
  filter->GenerateTimeStepsOn();
  next->SetInputConnection(filter->GetOutputPort());
  filter->Update();
  const vtkMTimeType time = filter->GetOutput()->GetMTime();
  filter->Update();
  EXPECT_EQ(filter->GetOutput()->GetMTime(), time);
  next->UpdateInformation();
  EXPECT_EQ(PublishedTimes(next), PublishedTimes(filter));
  EXPECT_LT(PublishedTimes(next).size(), 1001u);
  next->Update();
  EXPECT_EQ(filter->GetOutput()->GetMTime(), time);
  // Other data: the times are those of the new run after the next update.
  auto noisy = Halves();
  AddPointArray(noisy, "f", 1, [](vtkIdType i, int k) { return (i % 12 < 6) + 0.1 * Rough(i, k); });
  noisy->GetPointData()->SetActiveScalars("f");
  filter->SetInputData(noisy);
  filter->Update();
  EXPECT_EQ(
    PublishedTimes(filter).size(), static_cast<std::size_t>(History(filter)->GetNumberOfRows()));
}
