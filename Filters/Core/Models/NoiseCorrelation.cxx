// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Models/NoiseCorrelation.h"

#include "Core/Models/LinearFit.h"

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

namespace SurfaceDiffusion
{

namespace
{

constexpr Index LargestSample = 20000;
constexpr Index BlockSize = 1000; ///< neighbours have numbers that are close, mostly
constexpr double LargestResidual = 2.5; ///< in median deviations

/// Measured on smoothed white noise, and on ramps, waves and steps in white noise.
constexpr double LeastExcess = 0.03;
constexpr double StandardErrors = 4.0;
constexpr double ClearExcess = 0.4;
constexpr double SlopeOfWeak = -0.2; ///< of TwoEdges over OneEdge
constexpr double SlopeOfClear = 0.35;

/// The residual at one vertex: a combination of the values around it, of variance 1 for white noise.
using Combination = std::vector<std::pair<Index, double>>;

double Product(const Combination& a, const Combination& b)
{
  double product = 0.0;
  for (const auto& [i, weight] : a)
  {
    for (const auto& [j, other] : b)
    {
      product += i == j ? weight * other : 0.0;
    }
  }
  return product;
}

class Residuals
{
public:
  explicit Residuals(const FitData& data)
    : Data(data)
    , Combinations(static_cast<std::size_t>(data.Range.Size()))
  {
    Rings rings = data.MakeRings();
    const Index stride = BlockSize * (1 + data.Range.Size() / LargestSample);
    for (Index begin = data.Range.Begin; begin < data.Range.End; begin += stride)
    {
      for (Index i = begin; i < std::min(begin + BlockSize, data.Range.End); ++i)
      {
        this->Add(i, rings);
      }
    }
  }

  /// Call f(i, j) for the pairs of vertices at a distance of `edges` edges that have residuals.
  template <typename F>
  void ForEachPair(int edges, const F& f) const
  {
    Rings rings = this->Data.MakeRings();
    for (const Index i : this->Centres)
    {
      for (const Index j : rings.FindRing(i, edges))
      {
        if (j > i && !this->At(j).empty())
        {
          f(i, j);
        }
      }
    }
  }

  const std::vector<Index>& Vertices() const { return this->Centres; }
  const Combination& At(Index i) const { return this->Combinations[this->PlaceOf(i)]; }

private:
  std::size_t PlaceOf(Index i) const
  {
    return static_cast<std::size_t>(i - this->Data.Range.Begin);
  }

  void Add(Index i, Rings& rings)
  {
    if (this->Data.IsMissing(i))
    {
      return;
    }
    Combination& combination = this->Combinations[this->PlaceOf(i)];
    const LinearFit fit = FitAround(i, 1, rings, this->Data);
    if (fit.Weights.size() == 0)
    {
      return;
    }
    const double size = std::sqrt(1.0 + fit.Weights.squaredNorm());
    for (std::size_t j = 0; j < fit.Known.size(); ++j)
    {
      combination.emplace_back(fit.Known[j], fit.Weights[static_cast<Eigen::Index>(j)] / size);
    }
    combination.emplace_back(i, -1.0 / size);
    this->Centres.push_back(i);
  }

  const FitData& Data;
  std::vector<Combination> Combinations; ///< per vertex of the range; empty without a fit
  std::vector<Index> Centres;
};

/// The residuals of one column in their standard deviation, per vertex of the range; 0 at edges and
/// outliers, where they are large, and at the neighbours of those.
Vector StandardResiduals(const Residuals& residuals, const FitData& data, Eigen::Index column)
{
  const SparsePattern& pattern = data.Operators.Pattern();
  const Index first = data.Range.Begin;
  const auto f = data.Given.col(column);
  Vector all = Vector::Zero(data.Range.Size());
  std::vector<double> sizes;
  for (const Index i : residuals.Vertices())
  {
    for (const auto& [j, weight] : residuals.At(i))
    {
      all[i - first] += weight * (f[j] - f[i]);
    }
    sizes.push_back(std::abs(all[i - first]));
  }
  const double limit = LargestResidual * RobustDeviation(sizes);
  Vector r = Vector::Zero(data.Range.Size());
  double sum = 0.0;
  double count = 0.0;
  for (const Index i : residuals.Vertices())
  {
    bool small = all[i - first] != 0.0;
    for (Index slot = pattern.Outer[i]; slot < pattern.Outer[i + 1] && small; ++slot)
    {
      small = std::abs(all[pattern.Inner[slot] - first]) <= limit; // i is among them
    }
    if (small)
    {
      r[i - first] = all[i - first];
      sum += r[i - first] * r[i - first];
      count += 1.0;
    }
  }
  return sum > 0.0 ? Vector(r / std::sqrt(sum / count)) : r;
}

} // namespace

bool ResidualCorrelation::IsOfCorrelatedNoise() const
{
  const double least =
    std::max(LeastExcess, StandardErrors / std::sqrt(std::max(this->NumberOfPairs, 1.0)));
  const double slope = this->OneEdge < ClearExcess ? SlopeOfWeak : SlopeOfClear;
  return this->OneEdge > least && this->TwoEdges < slope * this->OneEdge;
}

ResidualCorrelation CorrelateResiduals(const FitData& data)
{
  const Residuals residuals(data);
  const Index first = data.Range.Begin;
  ResidualCorrelation found;
  double* const excess[2] = { &found.OneEdge, &found.TwoEdges };
  std::vector<Vector> columns;
  for (Eigen::Index k = 0; k < data.Given.cols(); ++k)
  {
    columns.push_back(StandardResiduals(residuals, data, k));
  }
  for (const int edges : { 1, 2 })
  {
    double sum = 0.0;
    double pairs = 0.0;
    residuals.ForEachPair(edges,
      [&](Index i, Index j)
      {
        const double white = Product(residuals.At(i), residuals.At(j));
        for (const Vector& r : columns)
        {
          if (r[i - first] != 0.0 && r[j - first] != 0.0)
          {
            sum += r[i - first] * r[j - first] - white;
            pairs += 1.0;
          }
        }
      });
    *excess[edges - 1] = pairs > 0.0 ? sum / pairs : 0.0;
    found.NumberOfPairs = edges == 1 ? pairs : found.NumberOfPairs;
  }
  return found;
}

} // namespace SurfaceDiffusion
