// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Run/Sentinels.h"

#include "Core/Foundation/RobustRange.h"
#include "Run/Surface.h"

#include <array>
#include <cmath>

namespace SurfaceDiffusion
{

namespace
{

/// Of tables and rasters, of electroanatomical maps (-10000), of 16 bits, of ocean and climate models
/// (1e20, 1e30), of netCDF, and of grids of Surfer.
constexpr std::array<double, 10> Known = { -999.0, -9999.0, -99999.0, -10000.0, -32767.0, -32768.0,
  1e20, 1e30, 9.969209968386869e36, 1.70141e38 };
constexpr double Least = 999.0; ///< magnitude of all

/// The number of the sentinel that a value is up to single precision, with any sign of the large ones.
std::size_t SentinelOf(double value)
{
  constexpr double roundOff = 1e-6;
  constexpr double large = 1e19;
  const double size = std::abs(value);
  std::size_t k = size >= Least ? 0 : Known.size(); // none of NaN
  while (k < Known.size() &&
    std::abs((size > large ? size : value) - Known[k]) > roundOff * std::abs(Known[k]))
  {
    ++k;
  }
  return k;
}

} // namespace

std::vector<Sentence> AskForSentinels(
  const Surface& surface, const Fields& fields, const Reduction& processes)
{
  std::vector<Sentence> warnings;
  const PointSamples* const samples = fields.Samples.get();
  const Values& values = samples ? samples->Given : fields.Data.Values;
  const std::vector<double>& weights = samples ? samples->Weights : fields.FidelityFactors.Values;
  const bool isWeighted = weights.size() == static_cast<std::size_t>(values.rows());
  const bool onPoints = !samples && !fields.Data.OnCells;
  const Reduction& reduction = surface.InputMesh().GetReduction();
  std::array<double, Known.size()> counts = {};
  ValueBounds others;
  for (Eigen::Index i = 0; i < values.rows(); ++i)
  {
    const auto row = static_cast<std::size_t>(i);
    const bool isLeftOut = !samples &&
      (IsSet(fields.Missing, row) || IsSet(fields.Weightless, row) ||
        IsSet(fields.Mask.Values, row));
    if (isLeftOut || (isWeighted && weights[row] == 0.0))
    {
      continue;
    }
    std::array<bool, Known.size()> found = {};
    for (const double value : values.row(i))
    {
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
      const Index v = onPoints && found[k] ? surface.VertexOf(static_cast<Index>(i)) : -1;
      counts[k] += found[k] && (v < 0 || reduction.Owns(v)) ? 1.0 : 0.0;
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
        << counts[k] << (counts[k] == 1 ? " value of " : " values of ")
        << (samples ? Sentence("the points") : Sentence(fields.DataName))
        << (counts[k] == 1 ? " is " : " are ") << Known[k]
        << ", far from all others, and taken for measured (if it stands for no value, set NaN in "
           "its place"
        << (samples ? Sentence() : Sentence(", or mask it with ") << Word::Array("MaskArray"))
        << ")");
    }
  }
  return warnings;
}

} // namespace SurfaceDiffusion
