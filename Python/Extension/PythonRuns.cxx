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

std::vector<SurfacePlace> ReadPlaces(const std::vector<std::string>& names, const LongArray& points,
  const LongArray& triangles, const DoubleArray& coordinates)
{
  std::vector<SurfacePlace> places;
  for (std::size_t k = 0; k < names.size(); ++k)
  {
    const double* const x = coordinates.data() + 3 * k;
    places.push_back({ names[k], static_cast<Index>(points.data()[k]),
      static_cast<Index>(triangles.data()[k]), { x[0], x[1], x[2] } });
  }
  return places;
}

nb::object NewPoints(const Points& points)
{
  return NewArray(std::vector<double>(points.data(), points.data() + points.size()),
    { static_cast<std::size_t>(points.rows()), 3 });
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

template <typename Find>
void PythonRuns::WithDistances(
  const PythonFields& surface, const nb::dict& values, const nb::object& progress, const Find& find)
{
  const UseGuard guard(this->InUse);
  FieldSummary summary = surface.Summarize();
  summary.Sources = true;
  const std::unique_ptr<Settings> settings = this->TakeSettings(values, { summary });
  this->IsComplete = false;
  this->Runs.resize(1);
  this->Runs[0] = this->Runs[0] ? std::move(this->Runs[0]) : MakeRun(this->Name);
  auto& run = dynamic_cast<DistanceRun&>(*this->Runs[0]);
  PythonProgress(progress).Run(
    [&](const ProgressMonitor& monitor)
    {
      const BlockInput input = surface.Describe(run.ExcludesMasked());
      NamingSettings(*settings, [&] { find(run, input, *settings, monitor); });
      DistanceRun::RequireSource({ &run });
    });
  this->BlockNames = { surface.Block };
  this->IsComplete = true;
}

nb::tuple PythonRuns::FindEach(const PythonFields& surface, const nb::dict& values,
  const std::optional<LongArray>& points, double cutoff, const nb::object& progress)
{
  std::vector<Index> rows;
  if (points)
  {
    rows.assign(points->data(), points->data() + points->size());
  }
  DistanceRun::Matrix matrix;
  this->WithDistances(surface, values, progress,
    [&](
      DistanceRun& run, const BlockInput& input, Settings& settings, const ProgressMonitor& monitor)
    { matrix = run.FindEach(input, settings, rows, cutoff, monitor); });
  return nb::make_tuple(NewArray(std::move(matrix.Data)), NewArray(std::move(matrix.Columns)),
    NewArray(std::move(matrix.Begin)));
}

nb::tuple PythonRuns::FindPath(const PythonFields& surface, const nb::dict& values,
  const std::vector<std::string>& names, const LongArray& points, const LongArray& triangles,
  const DoubleArray& coordinates, bool closed, const nb::object& progress)
{
  const std::vector<SurfacePlace> places = ReadPlaces(names, points, triangles, coordinates);
  SurfacePath path;
  this->WithDistances(surface, values, progress,
    [&](
      DistanceRun& run, const BlockInput& input, Settings& settings, const ProgressMonitor& monitor)
    { path = run.FindPath(input, settings, places, closed, monitor); });
  std::vector<std::int64_t> faces;
  for (const Index t : path.Triangles)
  {
    faces.push_back(surface.Surface->FaceOf(t));
  }
  return nb::make_tuple(NewPoints(path.Points), NewArray(std::move(faces)), path.Length);
}

nb::tuple PythonRuns::FindDisk(const PythonFields& surface, const nb::dict& values,
  const std::vector<std::string>& names, const LongArray& points, const LongArray& triangles,
  const DoubleArray& coordinates, double radius, const nb::object& progress)
{
  const std::vector<SurfacePlace> places = ReadPlaces(names, points, triangles, coordinates);
  SurfaceDisk disk;
  this->WithDistances(surface, values, progress,
    [&](
      DistanceRun& run, const BlockInput& input, Settings& settings, const ProgressMonitor& monitor)
    { disk = run.FindDisk(input, settings, places.at(0), radius, monitor); });
  nb::list boundary;
  for (const Points& curve : disk.Boundary)
  {
    boundary.append(NewPoints(curve));
  }
  return nb::make_tuple(disk.Area, boundary);
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

nb::object PythonRuns::Walls(std::size_t surface) const
{
  const auto* const relief = dynamic_cast<const ReliefRun*>(&this->RunOf(surface));
  std::vector<double> walls = relief ? relief->PointWalls() : std::vector<double>();
  return NewArray(std::move(walls));
}

} // namespace SurfaceDiffusion
