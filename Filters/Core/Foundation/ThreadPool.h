// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Core/Foundation/Parallel.h"

#include <memory>

namespace SurfaceDiffusion
{

/// Loops on threads of this library's own, for programs without VTK. Loops of the watched thread
/// obey its LoopWatch. A loop within a loop, and one that finds the threads busy with a loop of
/// another thread, runs on its own thread alone; no bit of a result depends on that.
class ThreadPool : public ParallelFor
{
public:
  /// threads: 1 or more, the calling thread included. There are fewer if the system starts no more.
  explicit ThreadPool(int threads);
  ~ThreadPool() override;
  ThreadPool(const ThreadPool&) = delete;
  ThreadPool& operator=(const ThreadPool&) = delete;

  /// Loops with fewer blocks take less time than waking the threads.
  static constexpr Index Few = 12;

  void Run(Index count, LoopBody body) const override;
  void RunTasks(Index count, LoopBody body) const override;

  int NumberOfThreads() const;

private:
  class Workers;

  void RunOnThreads(Index count, Index piece, LoopBody body) const;

  std::unique_ptr<Workers> Threads;
};

} // namespace SurfaceDiffusion
