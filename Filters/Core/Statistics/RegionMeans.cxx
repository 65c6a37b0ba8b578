// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Statistics/RegionMeans.h"

#include "Core/Foundation/Random.h"
#include "Core/Statistics/ScalarClusters.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

namespace SurfaceDiffusion
{

namespace
{

constexpr int NumberOfStarts = 8;
constexpr double EqualValues = 1e-12; ///< relative difference of equal values
constexpr int IterationsOfStarts = 4; ///< which show the best one
constexpr int MaximumNumberOfIterations = 50;
constexpr double Settled = 1e-4; ///< relative decrease of the sum of squares

/// Clusters of the known values.
class Clusters
{
public:
  Clusters(const TriangleMesh& mesh, const PointData& data, const std::vector<Index>& seeds,
    const ParallelFor& parallel)
    : Mesh(mesh)
    , Data(data)
    , Seeds(seeds)
    , Parallel(parallel)
    , Distance(mesh.NumberOfVertices())
    , Nearest(static_cast<std::size_t>(mesh.NumberOfVertices()), 0)
  {
    for (Index i = 0; i < mesh.NumberOfVertices(); ++i)
    {
      const double smallest =
        this->Counts(i) ? std::pow(EqualValues, 2) * data.Given.row(i).squaredNorm() : 0.0;
      this->SmallestDistance = std::max(this->SmallestDistance, smallest);
    }
  }

  /// The means of the labels that have seeds. Returns which ones have.
  std::vector<bool> MeansOfSeeds(Values& means)
  {
    std::vector<bool> has(static_cast<std::size_t>(means.rows()), false);
    if (!this->Seeds.empty())
    {
      for (std::size_t i = 0; i < this->Seeds.size(); ++i)
      {
        this->Nearest[i] = this->Seeds[i] - 1;
      }
      const Vector weights = this->TakeMeans(means);
      for (std::size_t k = 0; k < has.size(); ++k)
      {
        has[k] = weights[static_cast<Eigen::Index>(k)] > 0.0;
      }
    }
    return has;
  }

  /// The known values with their weights.
  std::vector<std::pair<double, double>> WeightedNumbers() const
  {
    std::vector<std::pair<double, double>> numbers;
    for (Index i = 0; i < this->Mesh.NumberOfVertices(); ++i)
    {
      if (this->Counts(i))
      {
        numbers.emplace_back(this->Data.Given(i, 0), this->Weight(i));
      }
    }
    return numbers;
  }

  /// Greedy k-means++: each of the remaining means is the best of a few values drawn with
  /// probabilities in proportion to their squared distance from the means so far. Those for which no
  /// other value is left stay as they are.
  void DrawOthers(
    Values& means, std::vector<bool> has, std::int64_t seed, const std::vector<std::int64_t>& ids)
  {
    const int trials = 2 + static_cast<int>(std::log(static_cast<double>(means.rows())));
    this->Distance.setConstant(std::numeric_limits<double>::infinity());
    bool any = false;
    for (Eigen::Index k = 0; k < means.rows(); ++k)
    {
      if (has[static_cast<std::size_t>(k)])
      {
        this->AddMean(&means(k, 0));
        any = true;
      }
    }
    for (Eigen::Index k = 0; k < means.rows(); ++k)
    {
      if (has[static_cast<std::size_t>(k)])
      {
        continue;
      }
      double least = std::numeric_limits<double>::infinity();
      Index best = -1;
      for (int trial = 0; trial < (any ? trials : 1); ++trial)
      {
        const Index drawn = this->Draw(seed, k * trials + trial, ids, !any);
        const double sum = drawn < 0 ? least : this->SumWith(&this->Data.Given(drawn, 0));
        best = sum < least ? drawn : best;
        least = std::min(least, sum);
      }
      if (best >= 0)
      {
        means.row(k) = this->Data.Given.row(best);
        this->AddMean(&means(k, 0));
        any = true;
      }
    }
  }

  /// Lloyd's algorithm. Returns the sum of squares.
  double Settle(Values& means, int iterations = MaximumNumberOfIterations)
  {
    double sum = std::numeric_limits<double>::infinity();
    for (int iteration = 0; iteration < iterations; ++iteration)
    {
      const double former = sum;
      sum = this->Assign(means);
      this->TakeMeans(means);
      if (iteration > 0 && !(former - sum > Settled * former))
      {
        break;
      }
    }
    return sum;
  }

private:
  bool Counts(Index i) const { return this->Data.FidelityFactor(i) > 0.0; }
  double Weight(Index i) const
  {
    return this->Mesh.ControlAreas()[i] * this->Data.FidelityFactor(i);
  }

  /// Of a value from a mean.
  double SquaredDistance(Index i, const double* mean) const
  {
    const double* const f = &this->Data.Given(i, 0);
    double sum = 0.0;
    for (Eigen::Index c = 0; c < this->Data.Given.cols(); ++c)
    {
      sum += (f[c] - mean[c]) * (f[c] - mean[c]);
    }
    return sum;
  }

  void AddMean(const double* mean)
  {
    ForEach(this->Parallel, this->Mesh.NumberOfVertices(),
      [&](Index i)
      { this->Distance[i] = std::min(this->Distance[i], this->SquaredDistance(i, mean)); });
  }

  /// The sum of squared distances with one more mean.
  double SumWith(const double* mean) const
  {
    return Sum(this->Parallel, this->Mesh.NumberOfVertices(),
      [&](Index i)
      {
        return this->Counts(i)
          ? this->Weight(i) * std::min(this->Distance[i], this->SquaredDistance(i, mean))
          : 0.0;
      });
  }

  /// A vertex by its area and squared distance: the one whose exponentially distributed waiting
  /// time is over first, which does not depend on the numbering (P. Efraimidis, P. Spirakis, Inf.
  /// Process. Lett. 97, 2006). -1 without candidates.
  Index Draw(
    std::int64_t seed, std::int64_t draw, const std::vector<std::int64_t>& ids, bool first) const
  {
    Index chosen = -1;
    double shortest = std::numeric_limits<double>::infinity();
    for (Index i = 0; i < this->Mesh.NumberOfVertices(); ++i)
    {
      const double weight = this->Weight(i) * (first ? 1.0 : this->Distance[i]);
      if (this->Counts(i) && weight > 0.0 && this->Distance[i] > this->SmallestDistance)
      {
        const double time =
          -std::log1p(-UniformRandom(seed, draw, ids[static_cast<std::size_t>(i)])) / weight;
        if (time < shortest)
        {
          shortest = time;
          chosen = i;
        }
      }
    }
    return chosen;
  }

  double Assign(const Values& means)
  {
    return Sum(this->Parallel, this->Mesh.NumberOfVertices(),
      [&](Index i)
      {
        Index& nearest = this->Nearest[static_cast<std::size_t>(i)];
        nearest = -1;
        if (!this->Counts(i))
        {
          return 0.0;
        }
        const Index seed = this->Seeds.empty() ? 0 : this->Seeds[static_cast<std::size_t>(i)];
        double least = std::numeric_limits<double>::infinity();
        for (Index k = 0; k < static_cast<Index>(means.rows()); ++k)
        {
          const double distance = this->SquaredDistance(i, &means(k, 0));
          if (seed > 0 ? k == seed - 1 : distance < least)
          {
            least = distance;
            nearest = k;
          }
        }
        return this->Weight(i) * least;
      });
  }

  /// The means of the clusters, and their weights. Empty ones keep their mean.
  Vector TakeMeans(Values& means)
  {
    const Values& f = this->Data.Given;
    Vector weights = Vector::Zero(means.rows());
    Values sums = Values::Zero(means.rows(), means.cols());
    for (Index i = 0; i < this->Mesh.NumberOfVertices(); ++i)
    {
      const Index k = this->Nearest[static_cast<std::size_t>(i)];
      if (k >= 0 && this->Counts(i))
      {
        weights[k] += this->Weight(i);
        sums.row(k) += this->Weight(i) * f.row(i);
      }
    }
    for (Eigen::Index k = 0; k < means.rows(); ++k)
    {
      if (weights[k] > 0.0)
      {
        means.row(k) = sums.row(k) / weights[k];
      }
    }
    return weights;
  }

  const TriangleMesh& Mesh;
  const PointData& Data;
  const std::vector<Index>& Seeds;
  const ParallelFor& Parallel;
  Vector Distance; ///< squared, from the nearest mean
  double SmallestDistance = 0.0; ///< squared, of different values
  std::vector<Index> Nearest; ///< cluster per vertex
};

} // namespace

Values FindRegionMeans(const TriangleMesh& mesh, const PointData& data, Index regions,
  const std::vector<Index>& seeds, std::int64_t randomSeed, const std::vector<std::int64_t>& ids,
  const ParallelFor& parallel)
{
  Clusters clusters(mesh, data, seeds, parallel);
  Values ofSeeds =
    Values::Constant(regions, data.Given.cols(), std::numeric_limits<double>::quiet_NaN());
  const std::vector<bool> has = clusters.MeansOfSeeds(ofSeeds);
  const bool anySeed = std::find(has.begin(), has.end(), true) != has.end();
  Values best = ofSeeds;
  if (!anySeed && best.cols() == 1)
  {
    const std::vector<double> found =
      FindScalarClusters(clusters.WeightedNumbers(), static_cast<std::size_t>(regions));
    std::copy(found.begin(), found.end(), best.data());
    clusters.Settle(best); // with more than a few thousand different numbers
    return best;
  }
  double least = std::numeric_limits<double>::infinity();
  for (int start = 0; start < NumberOfStarts; ++start)
  {
    Values means = ofSeeds;
    clusters.DrawOthers(means, has, MixBits(static_cast<std::uint64_t>(randomSeed)) + start, ids);
    const double sum = clusters.Settle(means, IterationsOfStarts);
    if (sum < least)
    {
      least = sum;
      best = means;
    }
  }
  clusters.Settle(best);
  if (anySeed)
  {
    return best;
  }
  Values sorted = best;
  const std::vector<Eigen::Index> order = AscendingOrder(best);
  for (std::size_t k = 0; k < order.size(); ++k)
  {
    sorted.row(static_cast<Eigen::Index>(k)) = best.row(order[k]);
  }
  return sorted;
}

std::vector<Eigen::Index> AscendingOrder(const Values& means)
{
  const auto comesBefore = [&](Eigen::Index one, Eigen::Index other)
  {
    Eigen::Index c = 0;
    while (c + 1 < means.cols() && means(one, c) == means(other, c))
    {
      ++c;
    }
    return means(one, c) < means(other, c) || (!IsUsed(means, other) && IsUsed(means, one));
  };
  std::vector<Eigen::Index> order;
  const auto count = static_cast<std::size_t>(means.rows());
  for (std::size_t k = 0; k + 1 < count && order.empty(); ++k)
  {
    const auto next = static_cast<Eigen::Index>(k + 1);
    if (comesBefore(next, next - 1))
    {
      order.resize(count);
    }
  }
  std::iota(order.begin(), order.end(), 0);
  std::stable_sort(order.begin(), order.end(), comesBefore);
  return order;
}

double LargestSquare(const PointData& data)
{
  Eigen::RowVectorXd low, high;
  for (Index i = 0; i < static_cast<Index>(data.Given.rows()); ++i)
  {
    if (data.FidelityFactor(i) > 0.0)
    {
      const Eigen::RowVectorXd f = data.Given.row(i);
      low = low.size() > 0 ? low.cwiseMin(f).eval() : f;
      high = high.size() > 0 ? high.cwiseMax(f).eval() : f;
    }
  }
  const double square = (high - low).squaredNorm();
  return square > 0.0 ? square : 1.0;
}

bool IsUsed(const Values& means, Eigen::Index region)
{
  return !std::isnan(means(region, 0));
}

Values UsedMeans(const Values& means)
{
  Values used(means.rows(), means.cols());
  Eigen::Index count = 0;
  for (Eigen::Index k = 0; k < means.rows(); ++k)
  {
    if (IsUsed(means, k))
    {
      used.row(count++) = means.row(k);
    }
  }
  return used.topRows(count);
}

double MeanContrast(
  const TriangleMesh& mesh, const PointData& data, const Values& means, const ParallelFor& parallel)
{
  const Values& f = data.Given;
  const Eigen::Index regions = means.rows() > 0 ? means.rows() : f.cols();
  const auto contrastOf = [&](Index i)
  {
    double least = std::numeric_limits<double>::infinity();
    double second = least;
    for (Eigen::Index k = 0; k < regions; ++k)
    {
      const double term = means.rows() > 0 ? (f.row(i) - means.row(k)).squaredNorm() : f(i, k);
      if (!std::isnan(term))
      {
        second = std::min(second, std::max(least, term));
        least = std::min(least, term);
      }
    }
    return std::isfinite(second) ? second - least : 0.0;
  };
  const auto sumOf = [&](const auto& function)
  {
    return mesh.GetReduction().Sum(Sum(parallel, mesh.NumberOfVertices(),
      [&](Index i)
      {
        const double factor = data.FidelityFactor(i);
        return factor > 0.0 ? mesh.ControlAreas()[i] * factor * function(contrastOf(i)) : 0.0;
      }));
  };
  const double weight = sumOf([](double contrast) { return contrast > 0.0 ? 1.0 : 0.0; });
  return weight > 0.0 ? sumOf([](double contrast) { return contrast; }) / weight : 0.0;
}

} // namespace SurfaceDiffusion
