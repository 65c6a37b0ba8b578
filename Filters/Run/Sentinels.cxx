// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Run/Sentinels.h"

#include "Core/Foundation/RobustRange.h"
#include "Run/DistanceSources.h"
#include "Run/Surface.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <memory>
#include <utility>

namespace SurfaceDiffusion
{

namespace
{

/// Of tables and rasters, of electroanatomical maps (-10000), of 16 bits, of ocean and climate models
/// (1e20, 1e30), of netCDF, and of grids of Surfer.
constexpr std::array<double, 10> Known = { -999.0, -9999.0, -99999.0, -10000.0, -32767.0, -32768.0,
  1e20, 1e30, 9.969209968386869e36, 1.70141e38 };
constexpr double Least = 999.0; ///< magnitude of all

/// Up to single precision, and to the six digits that tables have of it.
bool AreSame(double value, double number)
{
  constexpr double roundOff = 1e-6;
  return std::abs(value - number) <= roundOff * std::abs(number);
}

/// The number of the sentinel that a value is, with any sign of the large ones.
std::size_t SentinelOf(double value)
{
  constexpr double large = 1e19;
  const double size = std::abs(value);
  std::size_t k = size >= Least ? 0 : Known.size(); // none of NaN
  while (k < Known.size() && !AreSame(size > large ? size : value, Known[k]))
  {
    ++k;
  }
  return k;
}

/// An array of numbers of an input, and which of its rows a result depends on.
struct Asked
{
  Sentence Name, Remedy;
  Eigen::Map<const Values> Numbers;
  std::vector<char> Counts; ///< per row
};

template <int Columns>
Eigen::Map<const Values> Map(
  const Eigen::Matrix<double, Eigen::Dynamic, Columns, Eigen::RowMajor>& numbers)
{
  return { numbers.data(), numbers.rows(), numbers.cols() };
}

Eigen::Map<const Values> Map(const std::vector<double>& numbers)
{
  return { numbers.data(), static_cast<Eigen::Index>(numbers.size()), 1 };
}

/// Per row of an array: it belongs to a triangle that takes part, and to this process.
std::vector<char> FindOwnRows(
  const Surface& surface, const Fields& fields, Place place, Eigen::Index rows)
{
  std::vector<char> own(static_cast<std::size_t>(rows), 0);
  const TriangleMesh& mesh = surface.InputMesh();
  for (std::size_t i = 0; place == Place::PerPoint && i < own.size(); ++i)
  {
    const Index v = surface.VertexOf(static_cast<Index>(i));
    own[i] = v >= 0 && mesh.GetReduction().Owns(v);
  }
  for (std::size_t t = 0;
       place != Place::PerPoint && !own.empty() && t < mesh.InputTriangle().size(); ++t)
  {
    const auto row = static_cast<std::size_t>(surface.InputTriangle(mesh.InputTriangle()[t]));
    own[place == Place::PerCell ? static_cast<std::size_t>(fields.Cells[row]) : row] = 1;
  }
  return own;
}

/// Rows of the data that the user has not left out already.
std::vector<char> FindKnownRows(const Surface& surface, const Fields& fields)
{
  const bool onCells = fields.Data.OnCells;
  std::vector<char> known = FindOwnRows(
    surface, fields, onCells ? Place::PerCell : Place::PerPoint, fields.Data.Values.rows());
  const std::vector<double>& weights = fields.FidelityFactors.Values;
  const bool areMarked = fields.Mask.OnCells == onCells;
  const bool areWeighted = fields.FidelityFactors.OnCells == onCells && !weights.empty();
  for (std::size_t i = 0; i < known.size(); ++i)
  {
    const bool isLeftOut = IsSet(fields.Missing, i) || IsSet(fields.Weightless, i) ||
      (areMarked && IsSet(fields.Mask.Values, i)) || (areWeighted && weights[i] == 0.0);
    known[i] = known[i] && !isLeftOut;
  }
  return known;
}

/// All numbers of an input but marks and labels: as many arrays in each process.
std::vector<Asked> ListNumbers(
  const Surface& surface, const Fields& fields, const Sentence& aboutData)
{
  std::vector<Asked> list;
  const auto add = [&](const char* name, const Eigen::Map<const Values>& numbers,
                     std::vector<char> counts) {
    list.push_back({ Word::Array(name), AboutNoValue(name), numbers, std::move(counts) });
  };
  const auto addLocated = [&](const char* name, const auto& numbers, Place ofCells, bool onCells)
  {
    const Place place = onCells ? ofCells : Place::PerPoint;
    add(name, numbers, FindOwnRows(surface, fields, place, numbers.rows()));
  };
  const auto all = [](std::size_t rows) { return std::vector<char>(rows, 1); };
  const auto& [weights, areOnCells] = fields.FidelityFactors;
  if (const PointSamples* const samples = fields.Samples.get())
  {
    std::vector<char> counts = all(static_cast<std::size_t>(samples->Given.rows()));
    std::transform(samples->Weights.begin(), samples->Weights.end(), counts.begin(),
      [](double weight) { return weight != 0.0; });
    list.push_back({ "the points", aboutData.Words().empty() ? AboutNoValue("") : aboutData,
      Map(samples->Given), std::move(counts) });
    add("FidelityArray", Map(samples->Weights), all(samples->Weights.size()));
  }
  else
  {
    list.push_back(
      { fields.DataName, aboutData.Words().empty() ? AboutNoValue("InputArray") : aboutData,
        Map(fields.Data.Values), FindKnownRows(surface, fields) });
    addLocated("FidelityArray", Map(weights), Place::PerCell, areOnCells);
  }
  addLocated(
    "DirectionArray", Map(fields.Directions.Values), Place::PerTriangle, fields.Directions.OnCells);
  addLocated("DiffusionRateArray", Map(fields.Rates), Place::PerTriangle, true);
  addLocated("SpeedArray", Map(fields.Speeds.Values), Place::PerCell, fields.Speeds.OnCells);
  addLocated(
    "AlongSpeedArray", Map(fields.AlongSpeeds.Values), Place::PerCell, fields.AlongSpeeds.OnCells);
  addLocated("AcrossSpeedArray", Map(fields.AcrossSpeeds.Values), Place::PerCell,
    fields.AcrossSpeeds.OnCells);
  const std::vector<double>& times =
    fields.Sources ? fields.Sources->StartTimes : fields.StartTimes;
  std::vector<char> areSources = all(times.size());
  for (std::size_t i = 0; i < times.size(); ++i)
  {
    const double mark = fields.Sources ? !IsSet(fields.Sources->Hidden, i)
                                       : fields.Data.Values(static_cast<Eigen::Index>(i), 0);
    areSources[i] = mark != 0.0 && !std::isnan(mark);
  }
  add("SourceTimes", Map(times), std::move(areSources));
  return list;
}

/// Append a warning for each sentinel of one array. Collective.
void Ask(const Asked& array, const Reduction& processes, std::vector<Sentence>& warnings)
{
  std::array<double, Known.size()> counts = {};
  ValueBounds others;
  for (Eigen::Index i = 0; i < array.Numbers.rows(); ++i)
  {
    std::array<bool, Known.size()> found = {};
    for (Eigen::Index c = 0; array.Counts[static_cast<std::size_t>(i)] && c < array.Numbers.cols();
         ++c)
    {
      const double value = array.Numbers(i, c);
      const std::size_t k = SentinelOf(value);
      if (k < Known.size())
      {
        found[k] = true;
      }
      else if (std::isfinite(value))
      {
        others.Widen({ value, value });
      }
    }
    for (std::size_t k = 0; k < Known.size(); ++k)
    {
      counts[k] += found[k] ? 1.0 : 0.0;
    }
  }
  processes.Sum(counts.data(), static_cast<int>(counts.size()));
  others = OfAllProcesses(others, processes);
  for (std::size_t k = 0; k < Known.size() && others.High >= others.Low; ++k)
  {
    constexpr double far = 0.5; // of the range
    const double distance = Known[k] > 0.0 ? Known[k] - others.High : others.Low - Known[k];
    if (counts[k] > 0 && distance > 0.0 && distance > far * others.Width())
    {
      warnings.push_back(Sentence()
        << counts[k] << (counts[k] == 1 ? " value of " : " values of ") << array.Name
        << (counts[k] == 1 ? " is " : " are ") << Known[k]
        << ", far from all others, and taken for measured (" << array.Remedy << ")");
    }
  }
}

} // namespace

Sentence AboutNoValue(const std::string& array)
{
  Sentence text("if it stands for no value, set ");
  if (array == "FidelityArray")
  {
    return text << "0 in its place";
  }
  if (array == "DiffusionRateArray")
  {
    return text << "the rate of its neighbours in its place";
  }
  if (array == "AlongSpeedArray" || array == "AcrossSpeedArray")
  {
    return text << "the speed of its neighbours in its place";
  }
  if (array == "SourceTimes")
  {
    return text << "its time, or let it be no source";
  }
  const Sentence mask = Sentence(", or mask it with ") << Word::Array("MaskArray");
  if (array == "SpeedArray")
  {
    return text << "0 in its place, which is a barrier" << mask;
  }
  return text << "NaN in its place" << (array == "InputArray" ? mask : Sentence());
}

Sentence AllowedFactors(const std::string& array)
{
  return Sentence("allowed: finite numbers, 0 or more (") << AboutNoValue(array) << ")";
}

std::vector<Sentence> AskForSentinels(const Surface& surface, const Fields& fields,
  const Reduction& processes, const Sentence& aboutData)
{
  std::vector<Sentence> warnings;
  for (const Asked& array : ListNumbers(surface, fields, aboutData))
  {
    Ask(array, processes, warnings);
  }
  return warnings;
}

bool StandsForNoValue(double value, const std::vector<double>& missing)
{
  return std::any_of(
    missing.begin(), missing.end(), [&](double number) { return AreSame(value, number); });
}

void ReplaceMissingValues(const std::vector<double>& missing, Fields& fields)
{
  const auto replace = [&](Values& values)
  {
    std::replace_if(
      values.data(), values.data() + values.size(),
      [&](double value) { return StandsForNoValue(value, missing); },
      std::numeric_limits<double>::quiet_NaN());
  };
  if (missing.empty())
  {
    return;
  }
  replace(fields.Data.Values);
  if (fields.Samples)
  {
    auto samples = std::make_shared<PointSamples>(*fields.Samples);
    replace(samples->Given);
    fields.Samples = std::move(samples);
  }
}

} // namespace SurfaceDiffusion
