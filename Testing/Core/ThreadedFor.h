// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Core/Foundation/Parallel.h"

#include <atomic>
#include <thread>
#include <vector>

namespace SurfaceDiffusion::Testing
{

/// Runs a loop on several threads, in ranges of different lengths and from last to first, which
/// reveals results that depend on the order or on the number of threads.
class ThreadedFor : public ParallelFor
{
public:
  explicit ThreadedFor(int threads)
    : NumberOfThreads(threads)
  {
  }

  void Run(Index count, LoopBody body) const override
  {
    std::atomic<Index> left{ count };
    const auto work = [&](Index piece)
    {
      while (true)
      {
        const Index end = left.fetch_sub(piece);
        if (end <= 0)
        {
          return;
        }
        body(std::max(0, end - piece), end);
      }
    };
    std::vector<std::thread> threads;
    for (int i = 1; i < this->NumberOfThreads; ++i)
    {
      threads.emplace_back(work, i + 1);
    }
    work(1);
    for (std::thread& thread : threads)
    {
      thread.join();
    }
  }

  void RunTasks(Index count, LoopBody body) const override
  {
    std::vector<std::thread> threads;
    for (Index i = 0; i < count; ++i)
    {
      threads.emplace_back([i, body] { body(i, i + 1); });
    }
    for (std::thread& thread : threads)
    {
      thread.join();
    }
  }

private:
  int NumberOfThreads;
};

} // namespace SurfaceDiffusion::Testing
