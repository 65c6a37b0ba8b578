// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "ModelRun.h"

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

const char* NameOf(OutputType type)
{
  switch (type)
  {
    case OutputType::Data:
      return "data";
    case OutputType::Real:
      return "real";
    case OutputType::Integer:
      return "integer";
    case OutputType::Byte:
      return "byte";
    default:
      return "double";
  }
}

const char* NameOf(Role role)
{
  switch (role)
  {
    case Role::Scalars:
      return "scalars";
    case Role::Vectors:
      return "vectors";
    case Role::Coordinates:
      return "coordinates";
    default:
      return "";
  }
}

const char* NameOf(const Output& output, bool onCells)
{
  switch (output.Where)
  {
    case Place::PerCurvePoint:
      return "curve points";
    case Place::PerCurve:
      return "curves";
    case Place::Column:
      return "column";
    case Place::Number:
      return "number";
    default:
      return onCells ? "faces" : "points";
  }
}

nb::list ListAll(
  const OutputList& outputs, const Run::Block* block = nullptr, const ModelTraits& traits = {})
{
  nb::list list;
  for (const Output& output : outputs)
  {
    nb::dict entry;
    entry["name"] = output.Name;
    entry["place"] = NameOf(output, IsOnCells(output, block, traits));
    entry["kind"] = NameOf(output.Type);
    entry["role"] = NameOf(output.Active);
    entry["is_result"] = output.IsResult;
    entry["is_beside_result"] = output.IsBesideResult;
    entry["rows"] = output.Lines ? output.Lines->Points.rows() : output.Rows.rows();
    entry["columns"] = CountColumns(output, block);
    if (output.Lines)
    {
      entry["begin"] = nb::cast(output.Lines->Begin);
      entry["corners"] = nb::cast(output.Lines->Corners);
    }
    list.append(entry);
  }
  return list;
}

template <typename Matrix>
void WriteMatrix(const Matrix& from, const OutputArray& output)
{
  VisitElements(output,
    [&](auto* to)
    {
      using T = std::remove_pointer_t<decltype(to)>;
      std::transform(
        from.data(), from.data() + from.size(), to, [](double x) { return ConvertValue<T>(x); });
    });
}

/// first: as in ModelRun::Write().
void WriteOutput(const Output& from, OutputSource& source, const InputFields& input,
  const OutputArray& output, int first)
{
  if (from.Lines)
  {
    WriteMatrix(from.Lines->Points, output);
    return;
  }
  if (from.Where > Place::PerTriangle)
  {
    WriteMatrix(from.Rows, output);
    return;
  }
  source.NumberOfCells = static_cast<std::int64_t>(input.Surface->NumberOfFaces());
  source.CellOf = [&](Index t) { return input.Surface->FaceOf(t); };
  const OutputRows rows(from, source);
  const auto stride = static_cast<Eigen::Index>(output.shape(1));
  const auto write = [&](const auto& given)
  {
    VisitElements(
      output, [&](auto* to) { rows.Write(to, stride, first, given, PythonThreads::Instance()); });
  };
  if (!rows.TakesGiven())
  {
    write([](Index, Eigen::Index) { return 0.0; });
    return;
  }
  const auto columns = static_cast<Eigen::Index>(input.Data.Values->shape(1));
  const Eigen::Index start = std::max(first, 0);
  VisitElements(*input.Data.Values,
    [&](const auto* old)
    {
      write(
        [&](Index i, Eigen::Index k) { return static_cast<double>(old[i * columns + start + k]); });
    });
}

/// `count` columns of the data from `start` on.
Values ReadData(const InputArray& data, Eigen::Index start, Eigen::Index count)
{
  const auto columns = static_cast<Eigen::Index>(data.shape(1));
  Values given(static_cast<Eigen::Index>(data.shape(0)), count);
  VisitElements(data,
    [&](const auto* from)
    {
      for (Eigen::Index i = 0; i < given.rows(); ++i)
      {
        for (Eigen::Index k = 0; k < count; ++k)
        {
          given(i, k) = static_cast<double>(from[i * columns + start + k]);
        }
      }
    });
  return given;
}

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

nb::list SentencesOf(const std::vector<Warning>& warnings)
{
  nb::list sentences;
  for (const Warning& warning : warnings)
  {
    sentences.append(ListWords(warning.Sentence));
  }
  return sentences;
}

nb::list MakeList(const std::vector<double>& numbers)
{
  nb::list list;
  for (const double number : numbers)
  {
    list.append(number);
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
  std::vector<const InputFields*> blocks;
  for (const nb::handle& block : list)
  {
    blocks.push_back(nb::cast<const InputFields*>(block));
  }
  std::shared_ptr<RunSettings> own = MakeRunSettings(this->Name);
  AssignSettings(*own, settings);
  Problems problems;
  for (const InputFields* fields : blocks)
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
      std::vector<BlockInput> inputs(blocks.size());
      for (std::size_t b = 0; b < blocks.size(); ++b)
      {
        const InputFields& fields = *blocks[b];
        auto excluded = fields.Mask;
        if (!excludes)
        {
          excluded.Values.reset();
        }
        inputs[b].SurfaceVersion = fields.Surface->Version(excluded);
        inputs[b].FieldsVersion = fields.Version();
        inputs[b].ReadSurface = [&fields, excluded] { return fields.Surface->Read(excluded); };
        inputs[b].ReadFields = [&fields] { return fields.Read(); };
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
  return SentencesOf(this->Model.FindWarnings(Reduction::Serial()));
}

nb::dict ModelRun::GetHistory() const
{
  const History history = this->Model.MakeHistory(this->Step);
  nb::dict columns;
  columns["Time"] = MakeList(history.Time);
  for (std::size_t k = 0; k < history.Totals.size(); ++k)
  {
    columns[("Total_" + std::to_string(k)).c_str()] = MakeList(history.Totals[k]);
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
  return ListAll(from.Outputs, &from, this->Settings->DescribeModel());
}

void ModelRun::Write(std::size_t block, std::size_t number, const OutputArray& output,
  const InputFields& input, int first, bool integers) const
{
  const Run::Block& from = this->Model.GetBlock(block);
  OutputSource source{ *from.Surface, PythonThreads::Instance() };
  if (input.Data.Values)
  {
    const Eigen::Index count = first < 0 ? input.Components : from.Path->State().cols();
    source.ReadData = [&input, first, count]
    { return ReadData(*input.Data.Values, std::max(first, 0), count); };
    source.DataAreFloats = !integers;
    source.AsBytes = output.dtype() == nb::dtype<std::uint8_t>();
  }
  source.Block = &from;
  source.Traits = this->Settings->DescribeModel();
  WithValueErrors([&] { WriteOutput(from.Outputs.at(number), source, input, output, first); });
}

//------------------------------------------------------------------------------------------------
namespace
{

/// `input`, for as long as it lives. excludes: whether masked triangles are left out; otherwise the
/// mask is not read.
BlockInput MakeBlock(const InputFields& input, bool excludes)
{
  auto excluded = input.Mask;
  if (!excludes)
  {
    excluded.Values.reset();
  }
  BlockInput block;
  block.SurfaceVersion = input.Surface->Version(excluded);
  block.FieldsVersion = input.Version();
  block.ReadSurface = [&input, excluded] { return input.Surface->Read(excluded); };
  block.ReadFields = [&] { return input.Read(); };
  return block;
}

} // namespace

template <typename RunType, typename SettingsType>
void SingleRun<RunType, SettingsType>::Update(
  const InputFields& input, const nb::dict& values, const nb::object& progress)
{
  const UseGuard guard(this->InUse);
  SettingsType settings;
  AssignSettings(settings, values);
  Problems problems;
  const FieldSummary summary = input.Summarize();
  settings.Check(&summary, problems);
  ThrowProblems(std::move(problems));
  PythonProgress(progress).Run(
    [&](const ProgressMonitor& monitor)
    {
      NamingSettings(settings,
        [&]
        { this->Model.Update(MakeBlock(input, this->Model.ExcludesMasked()), settings, monitor); });
    });
}

template <typename RunType, typename SettingsType>
nb::list SingleRun<RunType, SettingsType>::GetWarnings() const
{
  return SentencesOf(this->Model.FindWarnings());
}

template <typename RunType, typename SettingsType>
nb::list SingleRun<RunType, SettingsType>::ListOutputs() const
{
  return ListAll(this->Model.Outputs());
}

template <typename RunType, typename SettingsType>
void SingleRun<RunType, SettingsType>::Write(
  std::size_t number, const OutputArray& output, const InputFields& input) const
{
  OutputSource source{ this->Model.GetSurface(), PythonThreads::Instance() };
  WithValueErrors(
    [&] { WriteOutput(this->Model.Outputs().at(number), source, input, output, -1); });
}

template class SingleRun<CurvatureRun, CurvatureSettings>;
template class SingleRun<DerivativesRun, DerivativesSettings>;
template class SingleRun<DirectionFieldRun, DirectionFieldSettings>;
template class SingleRun<DenoisingRun, DenoisingRunSettings>;

} // namespace SurfaceDiffusion
