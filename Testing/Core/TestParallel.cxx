// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Foundation/Parallel.h"
#include "Core/Foundation/Random.h"
#include "ThreadedFor.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <set>

using namespace SurfaceDiffusion;
using namespace SurfaceDiffusion::Testing;

namespace
{

const Index Counts[] = { 0, 1, BlockSize - 1, BlockSize, 5 * BlockSize + 3, 50 * BlockSize };

} // namespace

TEST(Parallel, EveryIndexIsVisitedOnce)
{
  for (const Index count : Counts)
  {
    for (const int threads : { 1, 2, 4 })
    {
      std::vector<std::atomic<int>> visits(count);
      ForEach(ThreadedFor(threads), count, [&](Index i) { ++visits[i]; });
      for (const auto& v : visits)
      {
        EXPECT_EQ(v, 1);
      }
    }
  }
}

TEST(Parallel, EveryTaskRunsOnce)
{
  for (const Index count : { 0, 1, 2, 5 })
  {
    for (const bool threaded : { false, true })
    {
      const ThreadedFor threads(2);
      std::vector<std::atomic<int>> runs(count);
      ForEachTask(threaded ? threads : SerialFor(), count, [&](Index i) { ++runs[i]; });
      for (const auto& r : runs)
      {
        EXPECT_EQ(r, 1);
      }
    }
  }
}

TEST(Parallel, BlocksDoNotDependOnTheThreads)
{
  const Index count = 7 * BlockSize + 5;
  std::vector<std::array<Index, 2>> ranges(NumberOfBlocks(count));
  ForEachBlock(ThreadedFor(3), count,
    [&](Index block, Index begin, Index end) {
      ranges[block] = { begin, end };
    });
  for (Index block = 0; block < NumberOfBlocks(count); ++block)
  {
    EXPECT_EQ(ranges[block][0], block * BlockSize);
    EXPECT_EQ(ranges[block][1], std::min(count, (block + 1) * BlockSize));
  }
}

TEST(Parallel, SumsHaveTheSameBitsOnAnyNumberOfThreads)
{
  const auto f = [](Index i) { return std::sin(i) / (1.0 + i); };
  for (const Index count : Counts)
  {
    const double serial = Sum(SerialFor(), count, f);
    for (const int threads : { 1, 2, 4 })
    {
      EXPECT_EQ(Sum(ThreadedFor(threads), count, f), serial);
    }
  }
}

TEST(Parallel, SumsOfMoreThanOneSetOfBlocksAreComplete)
{
  const Index count = 1024 * BlockSize + 17; // more than the partial sums on the stack
  EXPECT_EQ(Sum(ThreadedFor(2), count, [](Index) { return 1.0; }), count);
  EXPECT_EQ(Sum(ThreadedFor(2), count, [&](Index i) { return i == count - 1 ? 5.0 : 0.0; }), 5.0);
}

TEST(Parallel, MaxFindsTheLargest)
{
  for (const Index count : Counts)
  {
    const double largest =
      Max(ThreadedFor(3), count, [&](Index i) { return i == count / 3 ? 9.0 : 1.0 / (1.0 + i); });
    EXPECT_EQ(largest, count > 0 ? 9.0 : 0.0);
  }
}

TEST(Random, NumbersAreUniformAndTellTheirArgumentsApart)
{
  double sum = 0.0;
  double squares = 0.0;
  std::set<double> seen;
  const int count = 20000;
  for (int i = 0; i < count; ++i)
  {
    const double r = UniformRandom(i % 3, i % 5, i / 15);
    EXPECT_GE(r, 0.0);
    EXPECT_LT(r, 1.0);
    seen.insert(r);
    sum += r;
    squares += r * r;
  }
  EXPECT_NEAR(sum / count, 1.0 / 2.0, 5.0 * std::sqrt(1.0 / 12.0 / count));
  EXPECT_NEAR(squares / count, 1.0 / 3.0, 5.0 * std::sqrt(4.0 / 45.0 / count));
  EXPECT_EQ(seen.size(), static_cast<std::size_t>(count));
}

TEST(Random, NumbersAreTheSameEverywhere)
{
  // SplitMix64 from the state 0, as published.
  EXPECT_EQ(MixBits(0), 0xe220a8397b1dcdafULL);
  EXPECT_EQ(MixBits(0x9e3779b97f4a7c15ULL), 0x6e789e6aa1b965f4ULL);
}
