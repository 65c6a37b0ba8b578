// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Engine.h"

#include "Core/Foundation/LoopWatch.h"
#include "Json.h"
#include "Run/InputSentences.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <utility>

using emscripten::val;

namespace SurfaceDiffusion
{

namespace
{

const char* PlaceOf(const Files::FileArray& array)
{
  return array.OnCells ? "cell" : "point";
}

std::string ArrayAsJson(const Files::FileArray& array)
{
  return "{\"name\":" + Json::Quoted(array.Name) + ",\"association\":\"" + PlaceOf(array) +
    "\",\"components\":" + std::to_string(array.Components) + "}";
}

} // namespace

std::string Engine::Open(const std::string& name, const Files::Bytes& content)
{
  Files::SurfaceFile file;
  try
  {
    file = Files::ReadFile(name, content.data(), content.size());
  }
  catch (const Files::FileError& error)
  {
    throw Files::FileError(name + ": " + error.what());
  }
  if (file.NumberOfCells() == 0)
  {
    this->AddValues(std::move(file));
  }
  else
  {
    this->TakeSurface(std::move(file));
  }
  return this->Describe();
}

void Engine::TakeSurface(Files::SurfaceFile file)
{
  this->Given = Domain::Of(file);
  this->File = std::move(file);
  this->Fine = Domain();
  this->Samples = Files::SurfaceFile();
  this->TakeResults({}, {});
}

void Engine::AddValues(Files::SurfaceFile file)
{
  if (this->Given.Cells.empty())
  {
    throw std::runtime_error("the file has values and no surface; open its surface first");
  }
  Files::Spread(file, this->File.NumberOfPoints());
  const std::size_t places = file.NumberOfPoints();
  if (places > 0 && places != this->File.NumberOfPoints())
  {
    this->Samples = std::move(file); // places with values, for interpolation
    return;
  }
  for (Files::FileArray& array : file.Arrays)
  {
    const std::size_t rows = array.Rows();
    if (rows != this->File.NumberOfPoints() && rows != this->File.NumberOfCells())
    {
      throw std::runtime_error("the file has " + std::to_string(rows) +
        " rows of values; allowed: " + std::to_string(this->File.NumberOfPoints()) +
        ", one per point of the surface");
    }
    array.OnCells = rows != this->File.NumberOfPoints();
    std::vector<Files::FileArray>& known = this->File.Arrays;
    known.erase(std::remove_if(known.begin(), known.end(),
                  [&](const Files::FileArray& old)
                  { return old.Name == array.Name && old.OnCells == array.OnCells; }),
      known.end());
    known.push_back(std::move(array));
  }
  this->File.Warnings = file.Warnings;
}

std::string Engine::Describe() const
{
  std::map<std::size_t, std::size_t> sizes;
  for (std::size_t c = 0; c < this->File.NumberOfCells(); ++c)
  {
    ++sizes[this->File.Begin[c + 1] - this->File.Begin[c]];
  }
  const auto describeSize = [](const std::pair<const std::size_t, std::size_t>& entry)
  {
    return "{\"corners\":" + std::to_string(entry.first) +
      ",\"count\":" + std::to_string(entry.second) + "}";
  };
  return "{\"points\":" + std::to_string(this->Given.Points.rows()) +
    ",\"triangles\":" + std::to_string(this->Given.Triangles.rows()) +
    ",\"polygons\":" + Json::List(sizes, describeSize) +
    ",\"arrays\":" + Json::List(this->File.Arrays, ArrayAsJson) +
    ",\"samples\":" + Json::List(this->Samples.Arrays, ArrayAsJson) +
    ",\"kind\":" + Json::Quoted(this->File.Kind) + ",\"unit\":" + Json::Quoted(this->File.Unit) +
    ",\"meanEdgeLength\":" + Json::Number(this->Given.MeanEdgeLength()) +
    ",\"warnings\":" + Json::List(this->File.Warnings, Json::Quoted) + "}";
}

const Files::FileArray* Engine::Find(const std::string& name, const std::string& association) const
{
  const Files::FileArray* found = nullptr;
  for (const Files::FileArray& array : this->File.Arrays)
  {
    if (array.Name == name && (association.empty() || association == PlaceOf(array)) &&
      (!found || found->OnCells))
    {
      found = &array;
    }
  }
  return found;
}

const Files::FileArray& Engine::Array(const std::string& name, const std::string& association) const
{
  const Files::FileArray* const found = this->Find(name, association);
  if (!found)
  {
    throw std::runtime_error("there is no array " + name + "; choose one of the file");
  }
  return *found;
}

const Files::FileArray& Engine::ResultArray(const std::string& name) const
{
  for (const Files::FileArray& array : this->Results)
  {
    if (array.Name == name)
    {
      return array;
    }
  }
  throw std::runtime_error("there is no result " + name);
}

const Domain& Engine::Refine(const val& given, const Settings& settings,
  const ProgressMonitor& progress, std::vector<std::string>& warnings)
{
  this->Fine = Domain();
  const auto* const texture = dynamic_cast<const TextureSettings*>(&settings);
  const auto read = [&](const char* name, double otherwise)
  {
    const val value = given[name];
    if (value.isUndefined())
    {
      return otherwise;
    }
    return value.isNumber() ? value.as<double>() : std::numeric_limits<double>::quiet_NaN();
  };
  double length = read("refine_to", texture ? -1.0 : 0.0);
  const double limit = read("maximum_number_of_triangles", 4e6);
  const int most = limit >= 1.0 && limit < 2147483647.0 && limit == std::floor(limit)
    ? static_cast<int>(limit)
    : 0;
  Problems problems;
  CheckSurfaceProperties(0.0, length, texture != nullptr, most, 0, problems);
  ThrowProblems(problems);
  const double mean = this->Given.MeanEdgeLength();
  const bool isAutomatic = length < 0.0;
  if (isAutomatic)
  {
    length = texture->FeatureSize > 0.0 ? texture->EdgeLengthForFeatures(mean) : 0.0;
  }
  if (length > 0.0)
  {
    this->Fine = this->Given.Refined(length, most, progress, warnings);
  }
  if (!this->Fine.IsRefined)
  {
    this->Fine = Domain();
    return this->Given;
  }
  if (isAutomatic)
  {
    const double size = texture->FeatureSize;
    warnings.push_back(
      Say("Bisected", this->Fine.NumberOfCells, Say("Features", size, size / mean)).Text());
  }
  return this->Fine;
}

std::string Engine::Run(
  const std::string& name, const val& given, const ProgressMonitor::Callback& progress)
{
  const NamedSettings* const model = FindModel(name);
  if (!model)
  {
    throw std::runtime_error("there is no model " + name);
  }
  if (this->Given.Cells.empty())
  {
    throw std::runtime_error("there is no surface; open the file of one first");
  }
  std::unique_ptr<Settings> settings = model->Make();
  std::vector<std::string> others = WordsOf(model->Inputs);
  others.insert(others.end(),
    { "array", "association", model->Data, "refine_to", "maximum_number_of_triangles" });
  AssignSettings(*model, *settings, given, others);
  const bool isTexture = dynamic_cast<const TextureSettings*>(settings.get()) != nullptr;
  double reached = 0.0;
  const ProgressMonitor::Callback report = [&](double fraction)
  {
    reached = std::max(reached, fraction);
    return progress(reached);
  };
  Solution solution;
  std::string dataName;
  std::vector<std::string> warnings;
  {
    const LoopWatch watch([&] { return progress(reached); });
    const ProgressMonitor monitor(report);
    const Domain& domain = this->Refine(given, *settings, monitor.Part(0.0, 0.1), warnings);
    bool excludes = false;
    const SurfaceData data = this->ReadInputs(*model, given, domain, dataName, excludes);
    if (auto* const ofRun = dynamic_cast<RunSettings*>(settings.get()); ofRun && excludes)
    {
      ofRun->MaskMode = MaskMode::Exclude;
    }
    solution = SolveModel(
      *model, domain.Points, domain.Triangles, data, std::move(settings), SerialFor(), monitor);
  }
  solution.Warnings.insert(solution.Warnings.begin(), warnings.begin(), warnings.end());
  this->TakeResults(solution, dataName);
  this->Pattern = isTexture ? "Texture" : "";

  std::vector<std::pair<std::string, std::vector<double>>> history;
  const History& steps = solution.Steps;
  const auto addColumn = [&](const char* column, const auto& member)
  {
    std::vector<double> numbers;
    for (const StepRecord& record : steps.Records)
    {
      numbers.push_back(static_cast<double>(record.*member));
    }
    history.emplace_back(column, std::move(numbers));
  };
  if (!steps.Time.empty())
  {
    history.emplace_back("Time", steps.Time);
    for (std::size_t k = 0; k < steps.Totals.size(); ++k)
    {
      history.emplace_back("Total_" + std::to_string(k), steps.Totals[k]);
    }
    addColumn("Energy", &StepRecord::Energy);
    addColumn("Iterations", &StepRecord::Iterations);
    addColumn("Residual", &StepRecord::Residual);
    addColumn("Seconds", &StepRecord::Seconds);
  }
  const auto writeMatrix = [](const Values& matrix)
  {
    const std::vector<double> numbers(matrix.data(), matrix.data() + matrix.size());
    return matrix.size() == 1 ? Json::Number(numbers[0]) : Json::List(numbers);
  };
  std::string numbers;
  for (const auto& [label, matrix] : solution.Numbers)
  {
    numbers += (numbers.empty() ? "" : ",") + Json::Quoted(label) + ":" + writeMatrix(matrix);
  }
  return "{\"arrays\":" + Json::List(this->Results, ArrayAsJson) +
    ",\"points\":" + Json::Bool(this->ResultPoints() != nullptr) +
    ",\"paths\":" + PathsAsJson(this->Paths) + ",\"refined\":" + Json::Bool(this->Fine.IsRefined) +
    ",\"history\":" +
    Json::List(history,
      [](const auto& column)
      {
        return "{\"name\":" + Json::Quoted(column.first) +
          ",\"values\":" + Json::List(column.second) + "}";
      }) +
    ",\"times\":" + Json::List(steps.Time) + ",\"numbers\":{" + numbers +
    "},\"warnings\":" + Json::List(solution.Warnings, Json::Quoted) + "}";
}

void Engine::TakeResults(const Solution& solution, const std::string& dataName)
{
  this->Results.clear();
  this->MovedPoints.clear();
  this->Turned = solution.Turned;
  this->Paths = PathsOf(solution);
  this->Pattern.clear();
  for (const auto& [name, values] : solution.Arrays)
  {
    const ArrayTraits& traits = solution.Traits.at(name);
    if (traits.ArePoints)
    {
      this->MovedPoints.assign(values.data(), values.data() + values.size());
      continue;
    }
    if (values.size() == 0)
    {
      continue;
    }
    Files::FileArray array;
    array.Name = traits.IsOfData ? dataName + name : name;
    array.OnCells = traits.OnCells;
    array.Components = static_cast<std::size_t>(values.cols());
    array.Numbers.assign(values.data(), values.data() + values.size());
    this->Results.push_back(std::move(array));
  }
}

const double* Engine::ResultPoints() const
{
  return this->MovedPoints.empty() ? (this->Fine.IsRefined ? this->Fine.Points.data() : nullptr)
                                   : this->MovedPoints.data();
}

Files::SurfaceFile Engine::WithResults() const
{
  if (this->Given.Cells.empty())
  {
    throw std::runtime_error("there is no surface to write");
  }
  Files::SurfaceFile file = this->File;
  const Domain& domain = this->ResultSurface();
  if (domain.IsRefined)
  {
    for (Files::FileArray& array : file.Arrays)
    {
      array = domain.Carry(std::move(array), "");
    }
    file.Corners.assign(domain.Triangles.data(), domain.Triangles.data() + domain.Triangles.size());
    file.Begin = { 0 };
    for (std::size_t end = 3; end <= file.Corners.size(); end += 3)
    {
      file.Begin.push_back(end);
    }
  }
  if (const double* const points = this->ResultPoints())
  {
    file.Points.assign(points, points + domain.Points.size());
  }
  const std::vector<Index> cells = domain.OwnCells();
  for (const Index t : this->Turned)
  {
    const auto cell = static_cast<std::size_t>(cells[static_cast<std::size_t>(t)]);
    if (file.Begin[cell + 1] - file.Begin[cell] == 3)
    {
      std::swap(file.Corners[file.Begin[cell] + 1], file.Corners[file.Begin[cell] + 2]);
    }
  }
  for (const Files::FileArray& result : this->Results)
  {
    std::vector<Files::FileArray>& arrays = file.Arrays;
    arrays.erase(std::remove_if(arrays.begin(), arrays.end(),
                   [&](const Files::FileArray& old)
                   { return old.Name == result.Name && old.OnCells == result.OnCells; }),
      arrays.end());
    arrays.push_back(result);
  }
  return file;
}

Files::Bytes Engine::Write(const std::string& name) const
{
  Files::SurfaceFile file = this->WithResults();
  for (const Files::FileArray& result : this->Results)
  {
    if (result.Name != this->Pattern)
    {
      continue;
    }
    // The pattern in grey, which PLY and OBJ have as colours of the points
    const auto [low, high] = std::minmax_element(result.Numbers.begin(), result.Numbers.end());
    const double range = *high > *low ? *high - *low : 1.0;
    Files::FileArray colors{ "RGB", result.OnCells, 3 };
    colors.AreBytes = true;
    for (const double number : result.Numbers)
    {
      colors.Numbers.insert(colors.Numbers.end(), 3, std::round(255.0 * (number - *low) / range));
    }
    file.Arrays.push_back(std::move(colors));
  }
  return Files::WriteFile(name, file);
}

} // namespace SurfaceDiffusion
