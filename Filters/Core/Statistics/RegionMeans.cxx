// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Statistics/RegionMeans.h"

#include "Core/Foundation/Random.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace SurfaceDiffusion
{

namespace
{

constexpr int NumberOfStarts = 8;
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

  /// k-means++: the remaining means are values drawn with probabilities in proportion to their
  /// squared distance from the means so far.
  void DrawOthers(
    Values& means, std::vector<bool> has, std::int64_t seed, const std::vector<std::int64_t>& ids)
  {
    this->Distance.setConstant(std::numeric_limits<double>::infinity());
    bool any = false;
    for (Eigen::Index k = 0; k < means.rows(); ++k)
    {
      if (has[static_cast<std::size_t>(k)])
      {
        this->AddMean(means.row(k));
        any = true;
      }
    }
    for (Eigen::Index k = 0; k < means.rows(); ++k)
    {
      if (!has[static_cast<std::size_t>(k)])
      {
        const Index drawn = this->Draw(seed, k, ids, !any);
        if (drawn >= 0)
        {
          means.row(k) = this->Data.Given.row(drawn);
        }
        this->AddMean(means.row(k));
        any = true;
      }
    }
  }

  /// Lloyd's algorithm. Returns the sum of squares.
  double Settle(Values& means)
  {
    double sum = std::numeric_limits<double>::infinity();
    for (int iteration = 0; iteration < MaximumNumberOfIterations; ++iteration)
    {
      const double former = sum;
      sum = this->Assign(means);
      this->TakeMeans(means);
      if (!(former - sum > Settled * former))
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

  void AddMean(const Eigen::Ref<const Eigen::RowVectorXd>& mean)
  {
    ForEach(this->Parallel, this->Mesh.NumberOfVertices(),
      [&](Index i)
      {
        this->Distance[i] =
          std::min(this->Distance[i], (this->Data.Given.row(i) - mean).squaredNorm());
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
      if (this->Counts(i) && weight > 0.0)
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
          const double distance = (this->Data.Given.row(i) - means.row(k)).squaredNorm();
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
  std::vector<Index> Nearest; ///< cluster per vertex
};

void SortRows(Values& means)
{
  std::vector<Eigen::RowVectorXd> rows;
  for (Eigen::Index k = 0; k < means.rows(); ++k)
  {
    rows.emplace_back(means.row(k));
  }
  std::sort(rows.begin(), rows.end(),
    [](const Eigen::RowVectorXd& a, const Eigen::RowVectorXd& b)
    {
      return std::lexicographical_compare(
        a.data(), a.data() + a.size(), b.data(), b.data() + b.size());
    });
  for (Eigen::Index k = 0; k < means.rows(); ++k)
  {
    means.row(k) = rows[static_cast<std::size_t>(k)];
  }
}

} // namespace

Values FindRegionMeans(const TriangleMesh& mesh, const PointData& data, Index regions,
  const std::vector<Index>& seeds, std::int64_t randomSeed, const std::vector<std::int64_t>& ids,
  const ParallelFor& parallel)
{
  Clusters clusters(mesh, data, seeds, parallel);
  const Values none = Values::Zero(regions, data.Given.cols());
  Values best = none;
  double least = std::numeric_limits<double>::infinity();
  bool anySeed = false;
  for (int start = 0; start < NumberOfStarts; ++start)
  {
    Values means = none;
    const std::vector<bool> has = clusters.MeansOfSeeds(means);
    anySeed = std::find(has.begin(), has.end(), true) != has.end();
    clusters.DrawOthers(means, has, MixBits(static_cast<std::uint64_t>(randomSeed)) + start, ids);
    const double sum = clusters.Settle(means);
    if (sum < least)
    {
      least = sum;
      best = means;
    }
  }
  if (!anySeed)
  {
    SortRows(best);
  }
  return best;
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
      second = std::min(second, std::max(least, term));
      least = std::min(least, term);
    }
    return second - least;
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
