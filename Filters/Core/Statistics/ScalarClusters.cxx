// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Statistics/ScalarClusters.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace SurfaceDiffusion
{

namespace
{

using Number = std::pair<double, double>; ///< and its weight

constexpr double EqualNumbers = 1e-12; ///< relative difference of equal numbers

/// Takes another number into a mean.
void Add(const Number& number, Number& mean)
{
  mean.second += number.second;
  mean.first += number.second / mean.second * (number.first - mean.first);
}

/// Sorted numbers with one entry, their mean, for all of one key. keyOf: of the i-th of them.
template <typename Key>
std::vector<Number> Grouped(const std::vector<Number>& numbers, const Key& keyOf)
{
  std::vector<Number> groups;
  for (std::size_t i = 0; i < numbers.size(); ++i)
  {
    if (i > 0 && keyOf(i) == keyOf(i - 1))
    {
      Add(numbers[i], groups.back());
    }
    else
    {
      groups.push_back(numbers[i]);
    }
  }
  return groups;
}

std::vector<Number> DifferentNumbers(const std::vector<Number>& numbers)
{
  const double magnitude =
    std::max(std::abs(numbers.front().first), std::abs(numbers.back().first));
  std::vector<std::size_t> rank(numbers.size(), 0);
  for (std::size_t i = 1; i < numbers.size(); ++i)
  {
    const bool differs = numbers[i].first - numbers[i - 1].first > EqualNumbers * magnitude;
    rank[i] = rank[i - 1] + (differs ? 1 : 0);
  }
  return Grouped(numbers, [&](std::size_t i) { return rank[i]; });
}

/// Fewer groups if there are many.
std::vector<Number> Thinned(const std::vector<Number>& numbers, std::size_t clusters)
{
  const double groups = std::max(4096.0, 4.0 * static_cast<double>(clusters));
  if (static_cast<double>(numbers.size()) <= groups)
  {
    return numbers;
  }
  const double low = numbers.front().first;
  const double range = numbers.back().first - low;
  return Grouped(numbers,
    [&](std::size_t i)
    {
      const double ofRank = static_cast<double>(i) / static_cast<double>(numbers.size());
      return std::floor(0.5 * groups * (ofRank + (numbers[i].first - low) / range));
    });
}

/// The clusters of numbers, of which there are at least as many.
class Partition
{
public:
  explicit Partition(std::vector<Number> numbers)
    : Numbers(std::move(numbers))
    , Weights(Numbers.size() + 1, 0.0)
    , Firsts(Numbers.size() + 1, 0.0)
    , Seconds(Numbers.size() + 1, 0.0)
  {
    // Measured from the middle, so that differences of the sums lose few digits.
    const double origin = 0.5 * (this->Numbers.front().first + this->Numbers.back().first);
    for (std::size_t i = 0; i < this->Numbers.size(); ++i)
    {
      const auto& [number, weight] = this->Numbers[i];
      const double x = number - origin;
      this->Weights[i + 1] = this->Weights[i] + weight;
      this->Firsts[i + 1] = this->Firsts[i] + weight * x;
      this->Seconds[i + 1] = this->Seconds[i] + weight * x * x;
    }
  }

  std::vector<double> Means(std::size_t clusters)
  {
    const std::size_t count = this->Numbers.size();
    this->Least.assign(count + 1, std::numeric_limits<double>::infinity());
    this->Least[0] = 0.0;
    std::vector<std::vector<std::size_t>> begins;
    for (std::size_t k = 1; k <= clusters; ++k)
    {
      this->Next.assign(count + 1, std::numeric_limits<double>::infinity());
      this->Begin.assign(count + 1, 0);
      this->Extend(k, count, k - 1, count - 1);
      this->Least.swap(this->Next);
      begins.push_back(this->Begin);
    }
    std::vector<double> means(clusters);
    for (std::size_t k = clusters, end = count; k-- > 0;)
    {
      const std::size_t begin = begins[k][end];
      Number mean = this->Numbers[begin];
      for (std::size_t i = begin + 1; i < end; ++i)
      {
        Add(this->Numbers[i], mean);
      }
      means[k] = mean.first;
      end = begin;
    }
    return means;
  }

private:
  /// The sum of squares of the numbers begin .. end - 1 from their mean.
  double Cost(std::size_t begin, std::size_t end) const
  {
    const double weight = this->Weights[end] - this->Weights[begin];
    const double first = this->Firsts[end] - this->Firsts[begin];
    return std::max(0.0, this->Seconds[end] - this->Seconds[begin] - first * first / weight);
  }

  /// The best last cluster of the first low .. high numbers. Where it begins never falls as more
  /// numbers are taken, so that the range for it halves.
  void Extend(std::size_t low, std::size_t high, std::size_t from, std::size_t to)
  {
    if (low > high)
    {
      return;
    }
    const std::size_t end = low + (high - low) / 2;
    for (std::size_t begin = from; begin <= std::min(to, end - 1); ++begin)
    {
      const double cost = this->Least[begin] + this->Cost(begin, end);
      if (cost < this->Next[end])
      {
        this->Next[end] = cost;
        this->Begin[end] = begin;
      }
    }
    this->Extend(low, end - 1, from, this->Begin[end]);
    this->Extend(end + 1, high, this->Begin[end], to);
  }

  std::vector<Number> Numbers;
  std::vector<double> Weights, Firsts, Seconds; ///< sums over the numbers before
  std::vector<double> Least, Next; ///< of the first numbers, with one cluster fewer, and with all
  std::vector<std::size_t> Begin; ///< of the last cluster
};

} // namespace

std::vector<double> FindScalarClusters(
  std::vector<std::pair<double, double>> numbers, std::size_t clusters)
{
  if (numbers.empty())
  {
    return {};
  }
  std::sort(numbers.begin(), numbers.end());
  const std::vector<Number> different = DifferentNumbers(numbers);
  if (different.size() <= clusters)
  {
    std::vector<double> all;
    for (const Number& number : different)
    {
      all.push_back(number.first);
    }
    return all;
  }
  return Partition(Thinned(different, clusters)).Means(clusters);
}

} // namespace SurfaceDiffusion
