// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Foundation/RobustRange.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <condition_variable>
#include <mutex>
#include <thread>
#include <vector>

using namespace SurfaceDiffusion;

namespace
{

std::vector<double> Ramp(int count)
{
  std::vector<double> values;
  for (int i = 0; i < count; ++i)
  {
    values.push_back(static_cast<double>((7 * i) % count)); // 7 does not divide the counts below
  }
  return values;
}

/// Processes that are threads.
class Threads
{
public:
  class Process : public Reduction
  {
  public:
    Process(Threads& all, int rank)
      : Reduction(Reduction::Kind::Distributed)
      , All(all)
      , Number(rank)
    {
    }
    using Reduction::Sum;
    void Sum(double* numbers, Index count) const override
    {
      this->Combine(numbers, count, [](double a, double b) { return a + b; });
    }
    void Max(double* numbers, Index count) const override
    {
      this->Combine(numbers, count, [](double a, double b) { return std::max(a, b); });
    }
    int Rank() const override { return this->Number; }
    std::vector<double> Gather(const std::vector<double>& here) const override
    {
      this->All.Given[static_cast<std::size_t>(this->Number)] = here;
      this->All.Meet();
      std::vector<double> all;
      for (const std::vector<double>& one : this->All.Given)
      {
        all.insert(all.end(), one.begin(), one.end());
      }
      this->All.Meet();
      return all;
    }

  private:
    template <typename Operation>
    void Combine(double* numbers, Index count, const Operation& operation) const
    {
      const std::vector<double> all = this->Gather({ numbers, numbers + count });
      std::copy_n(all.begin(), count, numbers);
      for (std::size_t i = static_cast<std::size_t>(count); i < all.size(); ++i)
      {
        double& number = numbers[i % static_cast<std::size_t>(count)];
        number = operation(number, all[i]);
      }
    }

    Threads& All;
    int Number;
  };

  /// work(process) in each.
  template <typename Work>
  void Run(int count, const Work& work)
  {
    this->Given.resize(static_cast<std::size_t>(count));
    std::vector<std::thread> threads;
    for (int rank = 0; rank < count; ++rank)
    {
      threads.emplace_back([this, rank, &work] { work(Process(*this, rank)); });
    }
    for (std::thread& thread : threads)
    {
      thread.join();
    }
  }

private:
  void Meet()
  {
    std::unique_lock<std::mutex> lock(this->Mutex);
    const int round = this->Round;
    if (++this->Waiting == static_cast<int>(this->Given.size()))
    {
      this->Waiting = 0;
      ++this->Round;
      this->All.notify_all();
    }
    this->All.wait(lock, [&] { return this->Round != round; });
  }

  std::vector<std::vector<double>> Given;
  std::mutex Mutex;
  std::condition_variable All;
  int Waiting = 0, Round = 0;
};

} // namespace

TEST(RobustRange, OfMostOfTheAreaIsThatOfAllProcesses)
{
  for (const int outliers : { 0, 90, 99, 101, 300 })
  {
    std::vector<AreaOfValue> all;
    ValueBounds bounds;
    for (int i = 0; i < 10000; ++i)
    {
      // Outliers and the negative zeros beside them are in the first process.
      const double value = i < outliers ? 1e3 + i % 7 : i < 400 ? -0.0 : std::cos(0.01 * i);
      all.push_back({ value, 1.0 + 1e-3 * (i % 5) });
      bounds.Widen({ value, value });
    }
    std::vector<AreaOfValue> values = all;
    const ValueBounds whole = BoundsOfMost(values, bounds);
    EXPECT_EQ(whole.Width() < 3.0, outliers < 101) << outliers;
    for (const int count : { 2, 3, 5 })
    {
      Threads().Run(count,
        [&](const Reduction& process)
        {
          const auto size = static_cast<std::ptrdiff_t>(all.size()) / (count - 1);
          const auto begin = std::min<std::ptrdiff_t>(
            size * process.Rank(), static_cast<std::ptrdiff_t>(all.size())); // the last has none
          const auto end = std::min(begin + size, static_cast<std::ptrdiff_t>(all.size()));
          std::vector<AreaOfValue> mine(all.begin() + begin, all.begin() + end);
          ValueBounds here;
          std::vector<double> areas;
          for (const AreaOfValue& value : mine)
          {
            here.Widen({ value.Value, value.Value });
            areas.push_back(value.Area);
          }
          const ValueBounds found = BoundsOfMost(mine, OfAllProcesses(here, process), process);
          EXPECT_EQ(found.Low, whole.Low) << count;
          EXPECT_EQ(found.High, whole.High) << count;
          EXPECT_EQ(Median(areas, process), 1.002);
        });
    }
  }
}

TEST(RobustRange, LeavesOutAThousandthAtEitherEnd)
{
  std::vector<double> values = Ramp(10000);
  const ValueBounds bounds = RobustBounds(values);
  EXPECT_EQ(bounds.Low, 10.0);
  EXPECT_EQ(bounds.High, 9989.0);
}

TEST(RobustRange, LeavesOutOneOutlierOfHundredValuesAndNoneOfFewer)
{
  std::vector<double> values = Ramp(100);
  values[50] = 1e6;
  EXPECT_LE(RobustBounds(values).High, 99.0);
  values = Ramp(99);
  values[50] = 1e6;
  EXPECT_EQ(RobustBounds(values).High, 1e6);
  values = { 3.0 };
  EXPECT_EQ(RobustBounds(values).Width(), 0.0);
  values.clear();
  EXPECT_EQ(RobustBounds(values).Width(), 0.0);
}
