// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "ModelRun.h"

#include "OutputTable.h"
#include "PythonProgress.h"
#include "Run/ErrorCauses.h"
#include "Run/Outputs.h"
#include "SettingsTable.h"

#include <nanobind/stl/string.h>
#include <nanobind/stl/vector.h>

#include <algorithm>

namespace nb = nanobind;

namespace SurfaceDiffusion
{

namespace
{

template <typename T>
nb::list MakeList(const std::vector<StepRecord>& records, T StepRecord::*member)
{
  nb::list list;
  for (const StepRecord& record : records)
  {
    list.append(record.*member);
  }
  return list;
}

/// The units of the runs of later updates must not depend on a run that failed.
template <typename Work>
void ClearOnFailure(Run& run, Settings& settings, const Work& work)
{
  try
  {
    NamingSettings(settings, work);
  }
  catch (const Aborted&)
  {
    throw; // a later update continues
  }
  catch (...)
  {
    run.Clear();
    throw;
  }
}

} // namespace

void ModelRun::Update(
  const nb::list& list, const nb::dict& settings, const nb::object& progress, bool history)
{
  const UseGuard guard(this->InUse);
  const std::vector<const PythonFields*> blocks = ListInputs(list);
  std::shared_ptr<RunSettings> own = MakeRunSettings(this->Name);
  AssignSettings(*own, settings);
  Problems problems;
  for (const PythonFields* fields : blocks)
  {
    const FieldSummary summary = fields->Summarize();
    own->Check(&summary, problems);
  }
  ThrowProblems(std::move(problems));
  this->Settings = std::move(own);
  this->Model.SetKeepsHistory(history);

  const bool excludes = this->Settings->MaskMode == MaskMode::Exclude;
  PythonProgress(progress).Run(
    [&](const ProgressMonitor& monitor)
    {
      std::vector<BlockInput> inputs;
      for (const PythonFields* const fields : blocks)
      {
        inputs.push_back(fields->Describe(excludes));
      }
      ClearOnFailure(this->Model, *this->Settings,
        [&] {
          this->Model.Update(inputs, this->Settings, Reduction::Serial(), monitor.Part(0.0, 0.25));
        });
    });
}

void ModelRun::Seek(int step, const nb::object& progress)
{
  const UseGuard guard(this->InUse);
  this->Step = step < 0 ? this->NumberOfSteps() : step;
  PythonProgress(progress).Run(
    [&](const ProgressMonitor& monitor)
    {
      ClearOnFailure(this->Model, *this->Settings,
        [&] { this->Model.Seek(this->Step, monitor.Part(0.25, 1.0)); });
    });
}

nb::list ModelRun::GetWarnings() const
{
  return ListSentences(this->Model.FindWarnings(Reduction::Serial()));
}

nb::list ModelRun::GetNewWarnings()
{
  return ListSentences(this->Reported.Report(this->Model.FindWarnings(Reduction::Serial())));
}

int ModelRun::FindLastStep(const nb::object& progress)
{
  const UseGuard guard(this->InUse);
  int last = 0;
  PythonProgress(progress).Run(
    [&](const ProgressMonitor& monitor)
    {
      ClearOnFailure(this->Model, *this->Settings,
        [&] { last = this->Model.FindLastStep(monitor.Part(0.25, 0.65)); });
    });
  return last;
}

nb::dict ModelRun::GetNumbers() const
{
  return ListNumbers(
    FindNumbers(this->Model, this->Model.MakeHistory(this->Step), Reduction::Serial()));
}

nb::dict ModelRun::GetHistory() const
{
  const History history = this->Model.MakeHistory(this->Step);
  nb::dict columns;
  columns["Time"] = nb::cast(history.Time);
  for (std::size_t k = 0; k < history.Totals.size(); ++k)
  {
    columns[("Total_" + std::to_string(k)).c_str()] = nb::cast(history.Totals[k]);
  }
  columns["Energy"] = MakeList(history.Records, &StepRecord::Energy);
  columns["Iterations"] = MakeList(history.Records, &StepRecord::Iterations);
  columns["Residual"] = MakeList(history.Records, &StepRecord::Residual);
  columns["Seconds"] = MakeList(history.Records, &StepRecord::Seconds);
  if (history.CountsClamped)
  {
    columns["Clamped"] = MakeList(history.Records, &StepRecord::Clamped);
  }
  if (history.BoundsError)
  {
    columns["ErrorBound"] = MakeList(history.Records, &StepRecord::ErrorBound);
  }
  return columns;
}

nb::dict ModelRun::GetResults(std::size_t block) const
{
  nb::dict numbers;
  numbers["time_unit"] = this->Model.TimeUnit();
  numbers["mean_edge_length"] = this->Model.Units().MeanEdgeLength;
  numbers["value_range"] = this->Model.Units().ValueRange;
  numbers["number_of_unused_points"] =
    this->Model.GetBlock(block).Surface->Diagnostics().UnusedPoints;
  return numbers;
}

nb::list ModelRun::ListOutputs(std::size_t block) const
{
  const Run::Block& from = this->Model.GetBlock(block);
  return SurfaceDiffusion::ListOutputs(from.Outputs, &from, this->Settings->DescribeModel());
}

void ModelRun::Write(std::size_t block, std::size_t number, const OutputArray& output,
  const PythonFields& input, int first, bool integers) const
{
  const Run::Block& from = this->Model.GetBlock(block);
  OutputSource source{ *from.Surface, PythonThreads::Instance() };
  if (input.Data())
  {
    const Eigen::Index count = first < 0 ? input.Components : from.Path->State().cols();
    source.ReadData = [&input, first, count] { return input.ReadData(std::max(first, 0), count); };
    source.DataAreFloats = !integers;
    source.AsBytes = output.dtype() == nb::dtype<std::uint8_t>();
  }
  source.Block = &from;
  source.Traits = this->Settings->DescribeModel();
  WithValueErrors([&] { WriteOutput(from.Outputs.at(number), source, input, output, first); });
}

} // namespace SurfaceDiffusion
