// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Foundation/ThreadPool.h"

#include "Core/Foundation/LoopWatch.h"

#include <gtest/gtest.h>

#include <atomic>
#include <chrono>
#include <stdexcept>
#include <thread>
#include <vector>

#if defined(__linux__) && !defined(__SANITIZE_ADDRESS__) && !defined(__SANITIZE_THREAD__)
#define SURFACEDIFFUSION_LIMIT_MEMORY
#include <cstdlib>
#include <fstream>
#include <sys/resource.h>
#include <unistd.h>
#endif

using namespace SurfaceDiffusion;

namespace
{

std::vector<int> CountVisits(const ThreadPool& pool, Index count)
{
  std::vector<int> visits(static_cast<std::size_t>(count), 0);
  pool.Run(count,
    [&](Index begin, Index end)
    {
      for (Index i = begin; i < end; ++i)
      {
        ++visits[static_cast<std::size_t>(i)];
      }
    });
  return visits;
}

} // namespace

TEST(ThreadPool, VisitsEveryIndexOnceForAnyNumberOfThreads)
{
  for (const int threads : { 1, 2, 3, 8 })
  {
    const ThreadPool pool(threads);
    EXPECT_EQ(threads, pool.NumberOfThreads());
    for (const Index count : { 0, 1, 11, 12, 13, 97, 1000 })
    {
      for (int repeat = 0; repeat < 20; ++repeat)
      {
        EXPECT_EQ(std::vector<int>(static_cast<std::size_t>(count), 1), CountVisits(pool, count));
      }
    }
  }
}

TEST(ThreadPool, RunsTasksAtTheSameTime)
{
  const ThreadPool pool(2);
  std::atomic<int> arrived{ 0 };
  pool.RunTasks(2,
    [&](Index, Index)
    {
      ++arrived;
      while (arrived < 2) // each waits for the other
      {
        std::this_thread::yield();
      }
    });
  EXPECT_EQ(2, arrived);
}

TEST(ThreadPool, SumsHaveTheSameBitsForAnyNumberOfThreads)
{
  const auto term = [](Index i) { return 1.0 / (1.0 + i); };
  const double serial = Sum(SerialFor(), 1000000, term);
  for (const int threads : { 1, 2, 5 })
  {
    EXPECT_EQ(serial, Sum(ThreadPool(threads), 1000000, term));
  }
}

TEST(ThreadPool, RunsLoopsWithinLoopsAndLoopsOfOtherThreads)
{
  const ThreadPool pool(3);
  std::atomic<Index> visits{ 0 };
  const auto loops = [&]
  {
    pool.Run(50,
      [&](Index begin, Index end)
      {
        for (Index i = begin; i < end; ++i)
        {
          pool.Run(20, [&](Index first, Index last) { visits += last - first; });
        }
      });
  };
  std::thread other(loops);
  loops();
  other.join();
  EXPECT_EQ(2 * 50 * 20, visits);
}

TEST(ThreadPool, PassesExceptionsOnAndRunsTheNextLoop)
{
  const ThreadPool pool(2);
  EXPECT_THROW(pool.Run(100, [](Index, Index) { throw std::runtime_error("of the body"); }),
    std::runtime_error);
  EXPECT_EQ(std::vector<int>(100, 1), CountVisits(pool, 100));
}

TEST(ThreadPool, EndsALoopThatItsWatchStops)
{
  const ThreadPool pool(2);
  const LoopWatch watch([] { return false; });
  std::atomic<Index> visits{ 0 };
  const auto slow = [&](Index begin, Index end)
  {
    std::this_thread::sleep_for(std::chrono::milliseconds(20));
    visits += end - begin;
  };
  EXPECT_THROW(pool.RunTasks(1000, slow), Aborted);
  EXPECT_LT(visits, 1000);
}

#ifdef SURFACEDIFFUSION_LIMIT_MEMORY
TEST(ThreadPool, HasFewerThreadsWhereMemoryIsTooShort)
{
  testing::FLAGS_gtest_death_test_style = "threadsafe";
  const auto isComplete = []
  {
    std::size_t pages = 0;
    std::ifstream("/proc/self/statm") >> pages;
    constexpr std::size_t left = 40000000; // the stacks of a few threads
    const rlim_t limit = pages * static_cast<std::size_t>(sysconf(_SC_PAGESIZE)) + left;
    const rlimit memory{ limit, limit };
    setrlimit(RLIMIT_AS, &memory);
    const ThreadPool pool(64);
    return pool.NumberOfThreads() < 64 && CountVisits(pool, 1000) == std::vector<int>(1000, 1);
  };
  EXPECT_EXIT(std::exit(isComplete() ? 0 : 1), testing::ExitedWithCode(0), "");
}
#endif
