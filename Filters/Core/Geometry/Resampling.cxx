// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Geometry/Resampling.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>
#include <vector>

namespace SurfaceDiffusion
{

namespace
{

/// The rows of values of one target vertex with their weights.
template <typename T>
struct WeighedRows
{
  const RowWeights& Weights;
  const ColumnView<const T>& Source;
  Index Begin, End;

  const T* ValuesOf(Index entry) const
  {
    return this->Source.First + this->Weights.innerIndexPtr()[entry] * this->Source.Stride;
  }
  double WeightOf(Index entry) const { return this->Weights.valuePtr()[entry]; }
};

/// Call body(rows, values of the target vertex) for each vertex of the target.
template <typename T, typename Body>
void ForEachTarget(const RowWeights& weights, const ColumnView<const T>& source,
  const ColumnView<T>& target, const ParallelFor& parallel, const Body& body)
{
  ForEach(parallel, static_cast<Index>(weights.rows()),
    [&](Index t)
    {
      const Index* const begin = weights.outerIndexPtr() + t;
      body(WeighedRows<T>{ weights, source, begin[0], begin[1] }, target.First + t * target.Stride);
    });
}

/// Of one column in which values may be missing. unit: a power of two that their differences do not
/// overflow in.
template <typename T>
double MeanOfKnown(const WeighedRows<T>& rows, Eigen::Index column, double unit)
{
  double first = std::numeric_limits<double>::quiet_NaN();
  double difference = 0.0;
  double known = 0.0;
  for (Index entry = rows.Begin; entry < rows.End; ++entry)
  {
    const double value = rows.ValuesOf(entry)[column] / unit;
    if (std::isnan(value))
    {
      continue;
    }
    first = known == 0.0 ? value : first;
    known += rows.WeightOf(entry);
    difference += rows.WeightOf(entry) * (value - first);
  }
  return (known == 0.0 ? first : first + difference / known) * unit;
}

/// sums: room for pairs of a label and its weights.
double LargestLabel(const WeighedRows<double>& rows, Eigen::Index column,
  std::vector<std::pair<double, double>>& sums)
{
  sums.clear();
  for (Index entry = rows.Begin; entry < rows.End; ++entry)
  {
    const double label = rows.ValuesOf(entry)[column];
    const auto same =
      std::find_if(sums.begin(), sums.end(), [&](const auto& sum) { return sum.first == label; });
    if (same != sums.end())
    {
      same->second += rows.WeightOf(entry);
    }
    else if (!std::isnan(label))
    {
      sums.emplace_back(label, rows.WeightOf(entry));
    }
  }
  std::pair<double, double> largest{ std::numeric_limits<double>::quiet_NaN(), 0.0 };
  for (const auto& sum : sums)
  {
    if (sum.second > largest.second || (sum.second == largest.second && sum.first < largest.first))
    {
      largest = sum;
    }
  }
  return largest.first;
}

} // namespace

template <typename T>
void ResampleMeans(const RowWeights& weights, const ColumnView<const T>& source,
  const ColumnView<T>& target, const ParallelFor& parallel)
{
  ForEachTarget(weights, source, target, parallel,
    [&](const WeighedRows<T>& rows, T* const found)
    {
      constexpr Eigen::Index most = 16; // sums on the stack
      for (Eigen::Index start = 0; start < source.Columns; start += most)
      {
        const Eigen::Index count = std::min(most, source.Columns - start);
        double sums[most] = {};
        for (Index entry = rows.Begin; entry < rows.End; ++entry)
        {
          // From the first value on, so that a constant has no round-off.
          const T* const first = rows.ValuesOf(rows.Begin) + start;
          const T* const values = rows.ValuesOf(entry) + start;
          const double weight = rows.WeightOf(entry);
          for (Eigen::Index k = 0; k < count; ++k)
          {
            sums[k] += weight * (static_cast<double>(values[k]) - first[k]);
          }
        }
        for (Eigen::Index k = 0; k < count; ++k)
        {
          double mean = rows.Begin < rows.End ? rows.ValuesOf(rows.Begin)[start + k] + sums[k]
                                              : std::numeric_limits<double>::quiet_NaN();
          mean = std::isnan(mean) ? MeanOfKnown(rows, start + k, 1.0) : mean;
          mean = std::isfinite(mean) || std::isnan(mean) ? mean : MeanOfKnown(rows, start + k, 4.0);
          found[start + k] = static_cast<T>(mean);
        }
      }
    });
}

template void ResampleMeans(const RowWeights& weights, const ColumnView<const float>& source,
  const ColumnView<float>& target, const ParallelFor& parallel);
template void ResampleMeans(const RowWeights& weights, const ColumnView<const double>& source,
  const ColumnView<double>& target, const ParallelFor& parallel);

void ResampleLabels(const RowWeights& weights, const ColumnView<const double>& source,
  const ColumnView<double>& target, const ParallelFor& parallel)
{
  ForEachTarget(weights, source, target, parallel,
    [&](const WeighedRows<double>& rows, double* const found)
    {
      std::vector<std::pair<double, double>> sums;
      for (Eigen::Index k = 0; k < source.Columns; ++k)
      {
        found[k] = LargestLabel(rows, k, sums);
      }
    });
}

} // namespace SurfaceDiffusion
