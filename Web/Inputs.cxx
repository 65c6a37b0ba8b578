// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Engine.h"

#include "Json.h"
#include "Run/FieldChecks.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

using emscripten::val;

namespace SurfaceDiffusion
{

namespace
{

constexpr double NaN = std::numeric_limits<double>::quiet_NaN();

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

/// The marked points, in the order of their marks, which is that of clicks.
std::shared_ptr<const SourceShapes> MakePathPoints(
  const Files::FileArray& marks, const Points& points)
{
  if (marks.OnCells)
  {
    throw std::runtime_error("path_points is an array of cells; allowed: one of points");
  }
  std::vector<std::pair<double, Eigen::Index>> rows;
  for (std::size_t i = 0; i < marks.Numbers.size(); ++i)
  {
    if (marks.Numbers[i] != 0.0 && marks.Numbers[i] == marks.Numbers[i])
    {
      rows.emplace_back(marks.Numbers[i], static_cast<Eigen::Index>(i));
    }
  }
  std::sort(rows.begin(), rows.end());
  auto shapes = std::make_shared<SourceShapes>();
  shapes->Places.resize(static_cast<Eigen::Index>(rows.size()), 3);
  for (std::size_t k = 0; k < rows.size(); ++k)
  {
    shapes->Places.row(static_cast<Eigen::Index>(k)) = points.row(rows[k].second);
  }
  return shapes;
}

} // namespace

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

SurfaceData Engine::ReadInputs(const NamedSettings& model, const val& given, const Domain& domain,
  std::string& dataName, bool& excludes) const
{
  SurfaceData data;
  const std::string association =
    given["association"].isString() ? given["association"].as<std::string>() : "";
  const Eigen::Index points = this->Given.Points.rows();
  const std::string dataWord = model.Data;
  const std::vector<Index> cells = domain.OwnCells();

  // Each array by its name in Python, the data also as "array".
  const auto read = [&](const std::string& word, const val& value, double elsewhere)
  {
    if (value.isString())
    {
      const auto name = value.as<std::string>();
      const Files::FileArray* const known =
        this->Find(name, word == dataWord ? association : std::string());
      return domain.Carry(
        known ? *known : this->Array(name, ""), word == dataWord && word != "sources" ? "" : word);
    }
    return domain.Carry(ArrayOf(word, ReadChosen(word, value, points), points, elsewhere),
      word == dataWord && word != "sources" ? "" : word);
  };
  const auto isGiven = [](const val& value) { return !value.isUndefined() && !value.isNull(); };

  val ofData = isGiven(given["array"]) || dataWord.empty() ? given["array"] : given[dataWord];
  data.DataAreTerms = dataWord == "values" && isGiven(given["terms"]);
  ofData = data.DataAreTerms ? given["terms"] : ofData;
  if (ofData.isString() && this->ReadSamples(model, ofData.as<std::string>(), dataName, data))
  {
    ofData = val::null();
  }
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
    const Files::FileArray array = read(dataWord, ofData, dataWord == "sources" ? 0.0 : NaN);
    dataName = ofData.isString() ? array.Name : std::string();
    data.DataName = Word::Array("InputArray", dataName.empty() ? "" : " \"" + dataName + "\"");
    data.Data = { AsMatrix(array), array.OnCells };
    data.DataAreBytes = array.AreBytes;
  }
  else if (dataWord == "vectors")
  {
    data.Data.Values = PointNormals(domain.Points, domain.Triangles);
    dataName = "Normals";
  }

  for (const std::string& word : WordsOf(model.Inputs))
  {
    const val value = given[word];
    if (!isGiven(value) || word == "terms") // which are in place of the data
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
        data.Directions.Values = OnTriangles(data.Directions.Values, cells);
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
      data.Rates = OnTriangles(AsMatrix(array), cells);
      continue;
    }
    if (word == "error")
    {
      if (array.OnCells)
      {
        throw std::runtime_error("error is an array of cells; allowed: one of points");
      }
      data.SlopeErrors = AsMatrix(array);
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
    else if (word == "seeds" || word == "creases")
    {
      data.Seeds = AsLabels({ array.Numbers, array.OnCells },
        Word::Array(word == "seeds" ? "SeedArray" : "CreaseArray"));
    }
    else if (word == "speed")
    {
      data.Speeds = { array.Numbers, array.OnCells };
    }
    else if (word == "start")
    {
      data.StartTimes = array.Numbers;
    }
    else if (word == "path_points")
    {
      data.PathPoints = MakePathPoints(array, domain.Points);
    }
  }
  if (data.HasCells())
  {
    data.Cells = cells;
    data.NumberOfCells = domain.NumberOfCells;
  }
  if (domain.IsRefined) // values between given ones are no measurements
  {
    data.Between.assign(static_cast<std::size_t>(domain.Points.rows()), 0);
    std::fill(data.Between.end() - static_cast<std::ptrdiff_t>(domain.Parents.size()),
      data.Between.end(), char{ 1 });
    data.GivenCells = domain.Cells;
  }
  return data;
}

bool Engine::ReadSamples(const NamedSettings& model, const std::string& name, std::string& dataName,
  SurfaceData& data) const
{
  const auto found = std::find_if(this->Samples.Arrays.begin(), this->Samples.Arrays.end(),
    [&](const Files::FileArray& array) { return array.Name == name; });
  if (found == this->Samples.Arrays.end() || this->Find(name, "") ||
    !dynamic_cast<const InterpolationSettings*>(model.Make().get()))
  {
    return false;
  }
  auto samples = std::make_shared<PointSamples>();
  samples->Places = Eigen::Map<const SurfaceDiffusion::Points>(
    this->Samples.Points.data(), static_cast<Eigen::Index>(this->Samples.NumberOfPoints()), 3);
  samples->Given = AsMatrix(*found);
  samples->Name = name;
  data.Samples = std::move(samples);
  dataName = name;
  return true;
}

} // namespace SurfaceDiffusion
