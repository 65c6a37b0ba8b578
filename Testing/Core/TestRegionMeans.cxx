// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Statistics/RegionMeans.h"
#include "Regions.h"
#include "Run/Solve.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <limits>
#include <string>

using namespace SurfaceDiffusion;
using namespace SurfaceDiffusion::Testing;

namespace
{

constexpr std::int64_t NumberOfSeeds = 20;

/// Patches around `count` random points, with random values and noise.
Values Patches(const Domain& sphere, Index count, Eigen::Index components, std::int64_t seed)
{
  Values f(sphere.Mesh.NumberOfVertices(), components);
  for (Index i = 0; i < sphere.Mesh.NumberOfVertices(); ++i)
  {
    const Index id = sphere.Mesh.InputVertex()[i];
    Index nearest = 0;
    double least = std::numeric_limits<double>::infinity();
    for (Index k = 0; k < count; ++k)
    {
      const Eigen::RowVector3d centre(UniformRandom(seed, 0, k) - 0.5,
        UniformRandom(seed, 1, k) - 0.5, UniformRandom(seed, 2, k) - 0.5);
      const double distance = (sphere.Shape.Vertices.row(id) - centre.normalized()).norm();
      nearest = distance < least ? k : nearest;
      least = std::min(least, distance);
    }
    for (Eigen::Index c = 0; c < components; ++c)
    {
      f(i, c) = UniformRandom(seed + 1, c, nearest) + 0.2 * UniformRandom(seed + 2, c, id);
    }
  }
  return f;
}

std::vector<std::int64_t> Ids(const Domain& sphere)
{
  return { sphere.Mesh.InputVertex().begin(), sphere.Mesh.InputVertex().end() };
}

double SumOfSquares(const Domain& sphere, const Values& f, const Values& means)
{
  double sum = 0.0;
  for (Index i = 0; i < sphere.Mesh.NumberOfVertices(); ++i)
  {
    sum += sphere.Mesh.ControlAreas()[i] *
      (means.rowwise() - f.row(i)).rowwise().squaredNorm().minCoeff();
  }
  return sum;
}

/// The least sum of squares of all divisions of sorted numbers into intervals.
double LeastOfIntervals(
  const std::vector<std::pair<double, double>>& numbers, std::size_t begin, std::size_t clusters)
{
  if (begin == numbers.size())
  {
    return 0.0;
  }
  double least = std::numeric_limits<double>::infinity();
  double weight = 0.0, first = 0.0, second = 0.0;
  for (std::size_t end = begin; end < numbers.size() && clusters > 0; ++end)
  {
    weight += numbers[end].second;
    first += numbers[end].second * numbers[end].first;
    second += numbers[end].second * numbers[end].first * numbers[end].first;
    least = std::min(
      least, second - first * first / weight + LeastOfIntervals(numbers, end + 1, clusters - 1));
  }
  return least;
}

/// `count` different values on a sphere, in bands.
Values Bands(const Testing::Surface& s, int count)
{
  Values f(s.NumberOfVertices(), 1);
  for (Index i = 0; i < s.NumberOfVertices(); ++i)
  {
    f(i, 0) = 3.0 + std::min(count - 1.0, std::floor(0.5 * count * (s.Vertices(i, 2) + 1.0)));
  }
  return f;
}

} // namespace

TEST(RegionMeans, OfAScalarHaveTheLeastSumOfSquares)
{
  const Domain sphere(Rotated(Icosphere(0))); // few enough to try all divisions
  for (std::int64_t seed = 0; seed < NumberOfSeeds; ++seed)
  {
    const Values f = Noise(sphere.Mesh, 1, seed);
    std::vector<std::pair<double, double>> numbers;
    for (Index i = 0; i < sphere.Mesh.NumberOfVertices(); ++i)
    {
      numbers.emplace_back(f(i, 0), sphere.Mesh.ControlAreas()[i]);
    }
    std::sort(numbers.begin(), numbers.end());
    for (const Index regions : { 1, 2, 3, 5, 8, 11 })
    {
      const Values means =
        FindRegionMeans(sphere.Mesh, PointData::FromValues(f), regions, {}, 0, Ids(sphere));
      EXPECT_NEAR(SumOfSquares(sphere, f, means), LeastOfIntervals(numbers, 0, regions), 1e-12)
        << regions;
    }
  }
}

TEST(RegionMeans, HardlyDependOnTheRandomSeed)
{
  const Domain sphere(Rotated(Icosphere(4)));
  for (const Eigen::Index components : { 1, 3 })
  {
    double widest = 0.0;
    for (const Index regions : { 2, 4, 8 })
    {
      const Values f = Patches(sphere, 10, components, 10 * regions);
      double least = std::numeric_limits<double>::infinity();
      double most = 0.0;
      for (std::int64_t seed = 0; seed < NumberOfSeeds; ++seed)
      {
        const double sum = SumOfSquares(sphere, f,
          FindRegionMeans(sphere.Mesh, PointData::FromValues(f), regions, {}, seed, Ids(sphere)));
        least = std::min(least, sum);
        most = std::max(most, sum);
      }
      widest = std::max(widest, most / least - 1.0);
    }
    std::printf(
      "%d components: sums of squares differ by %.4f\n", static_cast<int>(components), widest);
    EXPECT_LE(widest, components == 1 ? 0.0 : 0.1);
  }
}

TEST(RegionMeans, AreThoseOfTheValuesIfTheseAreFewerThanTheRegions)
{
  const Testing::Surface s = Rotated(Icosphere(4));
  for (const int count : { 1, 2, 3 })
  {
    for (const Eigen::Index components : { 1, 2 })
    {
      for (const int more : { 0, 1, 3 })
      {
        const int regions = std::max(2, count + more);
        SegmentationSettings settings;
        settings.NumberOfRegions = regions;
        const Values bands = Bands(s, count);
        const Solution found =
          Segment(s.Vertices, s.Faces, Values(bands.replicate(1, components)), settings);
        const Values& means = found.Numbers.at("Means");
        ASSERT_EQ(means.rows(), regions);
        for (int k = 0; k < regions; ++k)
        {
          // The alternation gives points at boundaries to both sides.
          EXPECT_TRUE(k < count ? std::abs(means(k, 0) - 3.0 - k) < 0.1 : std::isnan(means(k, 0)))
            << count << " values, " << regions << " regions: mean " << means(k, 0);
        }
        const Values& labels = found.Arrays.at("RegionId");
        EXPECT_TRUE((labels.array() + 2.0 == bands.array()).all());
        const auto warned = std::count_if(found.Warnings.begin(), found.Warnings.end(),
          [&](const std::string& text)
          {
            return text.find("only " + std::to_string(count) + " of " + std::to_string(regions) +
                     " regions") != std::string::npos;
          });
        EXPECT_EQ(warned, count < regions ? 1 : 0);
        EXPECT_EQ(found.Warnings.size(), static_cast<std::size_t>(warned));
      }
    }
  }
}

/// The alternation moves means of regions that all but vanish past others.
TEST(RegionMeans, AreInAscendingOrderAfterTheAlternation)
{
  const Domain sphere(Rotated(Icosphere(4)));
  for (const Eigen::Index components : { 1, 3 })
  {
    for (std::int64_t sample = 0; sample < 6; ++sample)
    {
      Values f(sphere.Mesh.NumberOfVertices(), components);
      const Values patches = Patches(sphere, 6, components, 10 * sample);
      for (Index i = 0; i < sphere.Mesh.NumberOfVertices(); ++i)
      {
        f.row(sphere.Mesh.InputVertex()[i]) = patches.row(i);
      }
      SegmentationSettings settings;
      settings.NumberOfRegions = 4;
      const Solution found = Segment(sphere.Shape.Vertices, sphere.Shape.Faces, f, settings);
      const Values& means = found.Numbers.at("Means");
      const Values& labels = found.Arrays.at("RegionId");
      const Values& u = found.Arrays.at("RegionProbability");
      for (Eigen::Index k = 1; k < means.rows(); ++k)
      {
        EXPECT_LE(means(k - 1, 0), means(k, 0)) << sample;
      }
      for (Eigen::Index i = 0; i < labels.rows(); ++i)
      {
        const auto label = static_cast<Eigen::Index>(labels(i, 0));
        EXPECT_EQ(u(i, label - 1), u.row(i).maxCoeff());
        EXPECT_EQ(found.Arrays.at("Segmented")(i, 0), means(label - 1, 0));
      }
    }
  }
}
