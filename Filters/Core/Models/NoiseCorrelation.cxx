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
  Residuals(
    const Assembler& assembler, const Eigen::Ref<const Points>& points, const PointData& data)
    : Mesh(assembler.Mesh())
    , Pattern(assembler.Pattern())
    , Combinations(static_cast<std::size_t>(Mesh.NumberOfVertices()))
  {
    Rings rings(this->Pattern);
    const Index n = this->Mesh.NumberOfVertices();
    const Index stride = BlockSize * (1 + n / LargestSample);
    for (Index begin = 0; begin < n; begin += stride)
    {
      for (Index i = begin; i < std::min(begin + BlockSize, n); ++i)
      {
        this->Add(i, rings, points, data);
      }
    }
  }

  /// Call f(i, j) for the pairs of vertices at a distance of `edges` edges that have residuals.
  template <typename F>
  void ForEachPair(int edges, const F& f) const
  {
    Rings rings(this->Pattern);
    for (const Index i : this->Centres)
    {
      for (const Index j : rings.Find(i, edges))
      {
        if (j > i && !this->Combinations[static_cast<std::size_t>(j)].empty())
        {
          f(i, j);
        }
      }
    }
  }

  const std::vector<Index>& Vertices() const { return this->Centres; }
  const Combination& At(Index i) const { return this->Combinations[static_cast<std::size_t>(i)]; }

private:
  void Add(Index i, Rings& rings, const Eigen::Ref<const Points>& points, const PointData& data)
  {
    if (data.Missing[i])
    {
      return;
    }
    Combination& combination = this->Combinations[static_cast<std::size_t>(i)];
    const LinearFit fit = FitAround(i, 1, this->Mesh, rings, points, data.Missing);
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

  const TriangleMesh& Mesh;
  const SparsePattern& Pattern;
  std::vector<Combination> Combinations; ///< per vertex; empty without a fit
  std::vector<Index> Centres;
};

/// The residuals of one column in their standard deviation; 0 at edges and outliers, where they are
/// large, and at the neighbours of those.
Vector StandardResiduals(
  const Residuals& residuals, const SparsePattern& pattern, const Eigen::Ref<const Vector>& f)
{
  Vector all = Vector::Zero(f.size());
  std::vector<double> sizes;
  for (const Index i : residuals.Vertices())
  {
    for (const auto& [j, weight] : residuals.At(i))
    {
      all[i] += weight * (f[j] - f[i]);
    }
    sizes.push_back(std::abs(all[i]));
  }
  const double limit = LargestResidual * RobustDeviation(sizes);
  Vector r = Vector::Zero(f.size());
  double sum = 0.0;
  double count = 0.0;
  for (const Index i : residuals.Vertices())
  {
    bool small = all[i] != 0.0;
    for (Index slot = pattern.Outer[i]; slot < pattern.Outer[i + 1] && small; ++slot)
    {
      small = std::abs(all[pattern.Inner[slot]]) <= limit; // i is among them
    }
    if (small)
    {
      r[i] = all[i];
      sum += r[i] * r[i];
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

ResidualCorrelation CorrelateResiduals(
  const Assembler& assembler, const Eigen::Ref<const Points>& points, const PointData& data)
{
  const Residuals residuals(assembler, points, data);
  ResidualCorrelation found;
  double* const excess[2] = { &found.OneEdge, &found.TwoEdges };
  std::vector<Vector> columns;
  for (Eigen::Index k = 0; k < data.Given.cols(); ++k)
  {
    columns.push_back(StandardResiduals(residuals, assembler.Pattern(), data.Given.col(k)));
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
          if (r[i] != 0.0 && r[j] != 0.0)
          {
            sum += r[i] * r[j] - white;
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
