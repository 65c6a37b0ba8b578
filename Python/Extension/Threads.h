// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Core/Foundation/ThreadPool.h"

#include <atomic>
#include <memory>
#include <mutex>

namespace SurfaceDiffusion
{

/// The loops of all runs of this Python process, on threads that are started by the first loop.
class PythonThreads : public ParallelFor
{
public:
  /// The object that all share, because the numerics keep references to it.
  static PythonThreads& Instance();

  void Run(Index count, LoopBody body) const override { this->Pool()->Run(count, body); }
  void RunTasks(Index count, LoopBody body) const override { this->Pool()->RunTasks(count, body); }

  int NumberOfThreads() const;
  /// For later loops. Loops that run keep their threads.
  void SetNumberOfThreads(int number);
  /// A forked process has none of the threads of its parent: forget them.
  void AfterFork();

private:
  PythonThreads();
  std::shared_ptr<const ThreadPool> Pool() const;

  mutable std::unique_ptr<std::mutex> Mutex; ///< of the members below
  mutable std::shared_ptr<const ThreadPool> Threads;
  int Number = 1;
};

} // namespace SurfaceDiffusion
