// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "PythonRuns.h"

#include "NewArrays.h"
#include "OutputTable.h"
#include "PythonProgress.h"
#include "Run/BlockSentences.h"
#include "Run/ErrorCauses.h"
#include "Run/Solve.h"
#include "SettingsTable.h"
#include "Threads.h"

#include <cstdint>
#include <stdexcept>
#include <utility>

namespace nb = nanobind;

namespace SurfaceDiffusion
{

namespace
{

std::unique_ptr<SurfaceRun> MakeRun(const std::string& name)
{
  const NamedSettings* const model = FindModel(name);
  if (!model || !model->MakeRun)
  {
    throw nb::key_error(name.c_str());
  }
  return model->MakeRun(PythonThreads::Instance());
}

} // namespace

PythonRuns::PythonRuns(std::string name)
  : Name(std::move(name))
{
  MakeRun(this->Name);
}

std::unique_ptr<Settings> PythonRuns::TakeSettings(
  const nb::dict& values, const std::vector<FieldSummary>& summaries) const
{
  std::unique_ptr<Settings> settings = MakeSettings(this->Name);
  AssignSettings(*settings, values);
  Problems problems;
  for (const FieldSummary& summary : summaries)
  {
    settings->Check(&summary, problems);
  }
  ThrowProblems(std::move(problems));
  return settings;
}

void PythonRuns::Update(
  const nb::list& surfaces, const nb::dict& values, const nb::object& progress)
{
  const UseGuard guard(this->InUse);
  const std::vector<const PythonFields*> given = ListInputs(surfaces);
  std::vector<FieldSummary> summaries;
  for (const PythonFields* const fields : given)
  {
    summaries.push_back(fields->Summarize());
  }
  const std::unique_ptr<Settings> settings = this->TakeSettings(values, summaries);
  this->IsComplete = false;
  this->Runs.resize(given.size());
  PythonProgress(progress).Run(
    [&](const ProgressMonitor& monitor)
    {
      const auto count = static_cast<double>(given.size());
      std::vector<const DistanceRun*> distances;
      for (std::size_t s = 0; s < given.size(); ++s)
      {
        std::unique_ptr<SurfaceRun>& run = this->Runs[s];
        run = run ? std::move(run) : MakeRun(this->Name);
        const BlockInput input = given[s]->Describe(run->ExcludesMasked());
        const double first = static_cast<double>(s) / count;
        NameBlockInErrors(input.Name, *settings,
          [&]
          {
            NamingSettings(*settings,
              [&] { run->Update(input, *settings, monitor.Part(first, first + 0.95 / count)); });
          });
        if (const auto* const distance = dynamic_cast<const DistanceRun*>(run.get()))
        {
          distances.push_back(distance);
        }
      }
      if (!distances.empty())
      {
        DistanceRun::RequireSource(distances);
      }
    });
  this->BlockNames.clear();
  for (const PythonFields* const fields : given)
  {
    this->BlockNames.push_back(fields->Block);
  }
  this->IsComplete = true;
}

nb::tuple PythonRuns::FindEach(const PythonFields& surface, const nb::dict& values,
  const std::optional<LongArray>& points, double cutoff, const nb::object& progress)
{
  const UseGuard guard(this->InUse);
  FieldSummary summary = surface.Summarize();
  summary.Sources = true;
  const std::unique_ptr<Settings> settings = this->TakeSettings(values, { summary });
  std::vector<Index> rows;
  if (points)
  {
    rows.assign(points->data(), points->data() + points->size());
  }
  this->IsComplete = false;
  this->Runs.resize(1);
  this->Runs[0] = this->Runs[0] ? std::move(this->Runs[0]) : MakeRun(this->Name);
  auto& run = dynamic_cast<DistanceRun&>(*this->Runs[0]);
  DistanceRun::Matrix matrix;
  PythonProgress(progress).Run(
    [&](const ProgressMonitor& monitor)
    {
      const BlockInput input = surface.Describe(run.ExcludesMasked());
      NamingSettings(
        *settings, [&] { matrix = run.FindEach(input, *settings, rows, cutoff, monitor); });
      DistanceRun::RequireSource({ &run });
    });
  this->BlockNames = { surface.Block };
  this->IsComplete = true;
  return nb::make_tuple(NewArray(std::move(matrix.Data)), NewArray(std::move(matrix.Columns)),
    NewArray(std::move(matrix.Begin)));
}

const SurfaceRun& PythonRuns::RunOf(std::size_t surface) const
{
  if (!this->IsComplete)
  {
    throw std::runtime_error("there is no result: the last update was aborted or has failed");
  }
  return *this->Runs.at(surface);
}

void PythonRuns::Clear()
{
  this->Runs.clear();
  this->IsComplete = false;
}

std::vector<const SurfaceRun*> PythonRuns::ListRuns() const
{
  std::vector<const SurfaceRun*> runs;
  for (std::size_t s = 0; s < this->Runs.size(); ++s)
  {
    runs.push_back(&this->RunOf(s));
  }
  return runs;
}

std::vector<Warning> PythonRuns::FindWarnings() const
{
  return SurfaceRun::FindAllWarnings(this->ListRuns(), this->BlockNames);
}

nb::list PythonRuns::GetWarnings() const
{
  return ListSentences(this->FindWarnings());
}

nb::list PythonRuns::GetNewWarnings()
{
  return ListSentences(this->Reported.Report(this->FindWarnings()));
}

nb::dict PythonRuns::GetNumbers() const
{
  return ListNumbers(SurfaceRun::FindAllNumbers(this->ListRuns()));
}

nb::list PythonRuns::ListOutputs(std::size_t surface) const
{
  return SurfaceDiffusion::ListOutputs(this->RunOf(surface).Outputs());
}

void PythonRuns::Write(std::size_t surface, std::size_t number, const OutputArray& output,
  const PythonFields& input) const
{
  const SurfaceRun& run = this->RunOf(surface);
  OutputSource source{ run.GetSurface(), PythonThreads::Instance() };
  WithValueErrors([&] { WriteOutput(run.Outputs().at(number), source, input, output, -1); });
}

nb::object PythonRuns::TurnedTriangles(std::size_t surface) const
{
  std::vector<std::int64_t> rows;
  if (const auto* const relief = dynamic_cast<const ReliefRun*>(&this->RunOf(surface)))
  {
    const std::vector<char>& turned = relief->TurnedTriangles();
    for (std::size_t t = 0; t < turned.size(); ++t)
    {
      if (turned[t])
      {
        rows.push_back(relief->GetSurface().InputTriangle(static_cast<Index>(t)));
      }
    }
  }
  return NewArray(std::move(rows));
}

} // namespace SurfaceDiffusion
