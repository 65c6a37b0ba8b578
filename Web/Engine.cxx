// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Engine.h"

#include "Core/Foundation/LoopWatch.h"
#include "Core/Surface/Polygons.h"
#include "Json.h"
#include "Run/FieldChecks.h"

#include <algorithm>
#include <limits>
#include <map>
#include <utility>

using emscripten::val;

namespace SurfaceDiffusion
{

namespace
{

constexpr double NaN = std::numeric_limits<double>::quiet_NaN();

const char* PlaceOf(const Files::FileArray& array)
{
  return array.OnCells ? "cell" : "point";
}

std::string DescribeArray(const Files::FileArray& array)
{
  return "{\"name\":" + Json::Quoted(array.Name) + ",\"association\":\"" + PlaceOf(array) +
    "\",\"components\":" + std::to_string(array.Components) + "}";
}

double MeanEdgeLength(const Points& points, const Triangles& triangles)
{
  double sum = 0.0;
  for (Eigen::Index t = 0; t < triangles.rows(); ++t)
  {
    for (int k = 0; k < 3; ++k)
    {
      sum += (points.row(triangles(t, k)) - points.row(triangles(t, (k + 1) % 3))).norm();
    }
  }
  return triangles.rows() > 0 ? sum / (3.0 * static_cast<double>(triangles.rows())) : 0.0;
}

/// The normalised sums of the unit normals of the triangles at each point, in single precision as
/// numpy and VTK have them.
Values PointNormals(const Points& points, const Triangles& triangles)
{
  Values normals = Values::Zero(points.rows(), 3);
  for (Eigen::Index t = 0; t < triangles.rows(); ++t)
  {
    const Eigen::RowVector3d origin = points.row(triangles(t, 1));
    const Eigen::RowVector3d normal = (points.row(triangles(t, 2)) - origin)
                                        .cross(points.row(triangles(t, 0)) - origin)
                                        .stableNormalized();
    for (int k = 0; k < 3; ++k)
    {
      normals.row(triangles(t, k)) += normal;
    }
  }
  normals.rowwise().normalize();
  return normals.cast<float>().cast<double>();
}

std::vector<char> AsFlags(const std::vector<double>& numbers, bool isInverse)
{
  std::vector<char> flags(numbers.size());
  std::transform(numbers.begin(), numbers.end(), flags.begin(),
    [&](double x) { return isInverse ? x == 0.0 || x != x : x != 0.0; });
  return flags;
}

Values AsMatrix(const Files::FileArray& array)
{
  return Eigen::Map<const Values>(array.Numbers.data(), static_cast<Eigen::Index>(array.Rows()),
    static_cast<Eigen::Index>(array.Components));
}

/// Rows of cells for the triangles that they were cut into.
template <typename Matrix>
Matrix OnTriangles(const Matrix& ofCells, const std::vector<Index>& cells)
{
  Matrix rows(static_cast<Eigen::Index>(cells.size()), ofCells.cols());
  for (Eigen::Index t = 0; t < rows.rows(); ++t)
  {
    rows.row(t) = ofCells.row(cells[static_cast<std::size_t>(t)]);
  }
  return rows;
}

std::vector<std::string> WordsOf(const char* text)
{
  std::vector<std::string> words(1);
  for (; *text != 0; ++text)
  {
    if (*text == ' ')
    {
      words.emplace_back();
      continue;
    }
    words.back() += *text;
  }
  return words;
}

/// Chosen points, as a list of their numbers or {points, values}.
struct Chosen
{
  std::vector<Index> Points;
  std::vector<double> Values; ///< per point; empty: none are given
};

Chosen ReadChosen(const std::string& name, const val& given, Eigen::Index points)
{
  Chosen chosen;
  const val numbers = given.isArray() ? given : given["points"];
  if (!numbers.isArray())
  {
    throw std::runtime_error(
      name + " is neither the name of an array nor a list of points; allowed: one of these");
  }
  for (const double number : emscripten::vecFromJSArray<double>(numbers))
  {
    if (!(number >= 0.0 && number < static_cast<double>(points)) || number != std::floor(number))
    {
      throw std::runtime_error(name + " has the point " + Json::Number(number) +
        "; allowed: 0 to " + std::to_string(points - 1));
    }
    chosen.Points.push_back(static_cast<Index>(number));
  }
  if (!given.isArray() && given["values"].isArray())
  {
    chosen.Values = emscripten::vecFromJSArray<double>(given["values"]);
    if (chosen.Values.size() != chosen.Points.size())
    {
      throw std::runtime_error(name + " has " + std::to_string(chosen.Values.size()) +
        " values at " + std::to_string(chosen.Points.size()) + " points; allowed: one each");
    }
  }
  return chosen;
}

/// An array with a number at each of the chosen points, and `elsewhere` at all others.
Files::FileArray ArrayOf(
  const std::string& name, const Chosen& chosen, Eigen::Index points, double elsewhere)
{
  Files::FileArray array;
  array.Name = name;
  array.Numbers.assign(static_cast<std::size_t>(points), elsewhere);
  for (std::size_t k = 0; k < chosen.Points.size(); ++k)
  {
    array.Numbers[static_cast<std::size_t>(chosen.Points[k])] =
      chosen.Values.empty() ? static_cast<double>(k + 1) : chosen.Values[k];
  }
  return array;
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
  if (file.NumberOfPoints() > static_cast<std::size_t>(std::numeric_limits<Index>::max()))
  {
    throw std::runtime_error("the surface has more points than this library can number");
  }
  const SurfaceDiffusion::Points points = Eigen::Map<const SurfaceDiffusion::Points>(
    file.Points.data(), static_cast<Eigen::Index>(file.NumberOfPoints()), 3);
  RequireFiniteCoordinates(points);
  std::vector<Index> corners;
  std::vector<Index> cells;
  std::vector<Eigen::RowVector3d> polygon;
  corners.reserve(file.Corners.size());
  for (std::size_t c = 0; c < file.NumberOfCells(); ++c)
  {
    const std::int64_t* const cell = file.Corners.data() + file.Begin[c];
    const std::size_t size = file.Begin[c + 1] - file.Begin[c];
    std::vector<Corners> triangles = { { { 0, 1, 2 } } };
    if (size != 3)
    {
      polygon.clear();
      for (std::size_t k = 0; k < size; ++k)
      {
        polygon.emplace_back(points.row(static_cast<Eigen::Index>(cell[k])));
      }
      triangles = CutPolygon(polygon);
    }
    for (const Corners& triangle : triangles)
    {
      for (const int corner : triangle)
      {
        corners.push_back(static_cast<Index>(cell[corner]));
      }
      cells.push_back(static_cast<Index>(c));
    }
  }
  this->File = std::move(file);
  this->Coordinates = points;
  this->TriangleRows = Eigen::Map<const SurfaceDiffusion::Triangles>(
    corners.data(), static_cast<Eigen::Index>(corners.size() / 3), 3);
  this->Cells = std::move(cells);
  this->TakeResults({}, {});
}

void Engine::AddValues(Files::SurfaceFile file)
{
  if (this->Cells.empty())
  {
    throw std::runtime_error("the file has values and no surface; open its surface first");
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
  return "{\"points\":" + std::to_string(this->Coordinates.rows()) +
    ",\"triangles\":" + std::to_string(this->TriangleRows.rows()) +
    ",\"polygons\":" + Json::List(sizes, describeSize) +
    ",\"arrays\":" + Json::List(this->File.Arrays, DescribeArray) +
    ",\"kind\":" + Json::Quoted(this->File.Kind) + ",\"unit\":" + Json::Quoted(this->File.Unit) +
    ",\"meanEdgeLength\":" + Json::Number(MeanEdgeLength(this->Coordinates, this->TriangleRows)) +
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

SurfaceData Engine::ReadInputs(
  const NamedSettings& model, const val& given, std::string& dataName, bool& excludes) const
{
  SurfaceData data;
  const std::string association =
    given["association"].isString() ? given["association"].as<std::string>() : "";
  const Eigen::Index points = this->Coordinates.rows();
  const std::string dataWord = model.Data;

  // Each array by its name in Python, the data also as "array".
  const auto read = [&](const std::string& word, const val& value, double elsewhere)
  {
    if (value.isString())
    {
      const auto name = value.as<std::string>();
      const Files::FileArray* const known =
        this->Find(name, word == dataWord ? association : std::string());
      return known ? *known : this->Array(name, "");
    }
    return ArrayOf(word, ReadChosen(word, value, points), points, elsewhere);
  };
  const auto isGiven = [](const val& value) { return !value.isUndefined() && !value.isNull(); };

  val ofData = isGiven(given["array"]) || dataWord.empty() ? given["array"] : given[dataWord];
  data.DataAreTerms = dataWord == "values" && isGiven(given["terms"]);
  ofData = data.DataAreTerms ? given["terms"] : ofData;
  const bool takesPoints = dataWord == "sources" && isGiven(ofData) && !ofData.isString();
  if (takesPoints)
  {
    const Chosen chosen = ReadChosen(dataWord, ofData, points);
    auto sources = std::make_shared<SourceShapes>();
    sources->OfPoints = chosen.Points;
    sources->StartTimes = chosen.Values;
    data.Sources = std::move(sources);
  }
  else if (isGiven(ofData) && !dataWord.empty())
  {
    const Files::FileArray array = read(dataWord, ofData, NaN);
    dataName = ofData.isString() ? array.Name : std::string();
    data.DataName = Word::Array("InputArray", dataName.empty() ? "" : " \"" + dataName + "\"");
    data.Data = { AsMatrix(array), array.OnCells };
    data.DataAreBytes = array.AreBytes;
  }
  else if (dataWord == "vectors")
  {
    data.Data.Values = PointNormals(this->Coordinates, this->TriangleRows);
    dataName = "Normals";
  }

  for (const std::string& word : WordsOf(model.Inputs))
  {
    const val value = given[word];
    if (!isGiven(value))
    {
      continue;
    }
    const Files::FileArray array = read(word, value, 0.0);
    const auto require = [&](std::size_t components)
    {
      if (array.Components != components)
      {
        throw std::runtime_error(word + " " + array.Name + " has " +
          std::to_string(array.Components) + " components; allowed: " + std::to_string(components));
      }
    };
    if (word == "directions" || word == "hints")
    {
      require(3);
      data.Directions = { AsMatrix(array), array.OnCells };
      if (array.OnCells)
      {
        data.Directions.Values = OnTriangles(data.Directions.Values, this->Cells);
      }
      continue;
    }
    if (word == "rates")
    {
      require(4);
      if (!array.OnCells)
      {
        throw std::runtime_error("rates is an array of points; allowed: one of cells");
      }
      data.Rates = OnTriangles(AsMatrix(array), this->Cells);
      continue;
    }
    require(1);
    if (word == "mask" || word == "roi")
    {
      excludes = excludes || word == "roi";
      data.Mask = { AsFlags(array.Numbers, word == "roi"), array.OnCells };
    }
    else if (word == "fixed")
    {
      data.Fixed = { AsFlags(array.Numbers, false), array.OnCells };
    }
    else if (word == "fidelity")
    {
      data.FidelityFactors = { array.Numbers, array.OnCells };
    }
    else if (word == "seeds")
    {
      data.Seeds = AsLabels({ array.Numbers, array.OnCells }, Word::Array("SeedArray"));
    }
    else if (word == "speed")
    {
      data.Speeds = { array.Numbers, array.OnCells };
    }
    else if (word == "start")
    {
      data.StartTimes = array.Numbers;
    }
  }
  if (data.HasCells())
  {
    data.Cells = this->Cells;
    data.NumberOfCells = static_cast<Index>(this->File.NumberOfCells());
  }
  return data;
}

std::string Engine::Run(
  const std::string& name, const val& given, const ProgressMonitor::Callback& progress)
{
  const NamedSettings* const model = FindModel(name);
  if (!model)
  {
    throw std::runtime_error("there is no model " + name);
  }
  if (this->Cells.empty())
  {
    throw std::runtime_error("there is no surface; open the file of one first");
  }
  std::unique_ptr<Settings> settings = model->Make();
  std::vector<std::string> others = WordsOf(model->Inputs);
  others.insert(others.end(), { "array", "association", model->Data });
  if (std::string(model->Inputs).find("seeds") != std::string::npos)
  {
    others.emplace_back("terms");
  }
  AssignSettings(*model, *settings, given, others);
  std::string dataName;
  bool excludes = false;
  const SurfaceData data = this->ReadInputs(*model, given, dataName, excludes);
  if (auto* const ofRun = dynamic_cast<RunSettings*>(settings.get()); ofRun && excludes)
  {
    ofRun->MaskMode = MaskMode::Exclude;
  }

  double reached = 0.0;
  const ProgressMonitor::Callback report = [&](double fraction)
  {
    reached = std::max(reached, fraction);
    return progress(reached);
  };
  Solution solution;
  {
    const LoopWatch watch([&] { return progress(reached); });
    solution = SolveModel(*model, this->Coordinates, this->TriangleRows, data, std::move(settings),
      SerialFor(), ProgressMonitor(report));
  }
  this->TakeResults(solution, dataName);

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
  return "{\"arrays\":" + Json::List(this->Results, DescribeArray) +
    ",\"points\":" + Json::Bool(!this->MovedPoints.empty()) + ",\"history\":" +
    Json::List(history,
      [](const auto& column)
      {
        return "{\"name\":" + Json::Quoted(column.first) +
          ",\"values\":" + Json::List(column.second) + "}";
      }) +
    ",\"times\":" + Json::List(steps.Time) + ",\"numbers\":{" +
    [&]
  {
    std::string numbers;
    for (const auto& [label, matrix] : solution.Numbers)
    {
      numbers += (numbers.empty() ? "" : ",") + Json::Quoted(label) + ":" + writeMatrix(matrix);
    }
    return numbers;
  }() +
    "},\"warnings\":" + Json::List(solution.Warnings, Json::Quoted) + "}";
}

void Engine::TakeResults(const Solution& solution, const std::string& dataName)
{
  this->Results.clear();
  this->MovedPoints.clear();
  this->Turned = solution.Turned;
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

Files::Bytes Engine::Write(const std::string& name) const
{
  if (this->Cells.empty())
  {
    throw std::runtime_error("there is no surface to write");
  }
  Files::SurfaceFile file = this->File;
  if (!this->MovedPoints.empty())
  {
    file.Points = this->MovedPoints;
  }
  for (const Index t : this->Turned)
  {
    const std::size_t first =
      file.Begin[static_cast<std::size_t>(this->Cells[static_cast<std::size_t>(t)])];
    std::swap(file.Corners[first + 1], file.Corners[first + 2]);
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
  return Files::WriteFile(name, file);
}

} // namespace SurfaceDiffusion
