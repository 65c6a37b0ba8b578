// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <condition_variable>
#include <functional>
#include <mutex>
#include <thread>

namespace SurfaceDiffusion
{

/// A thread that does one task again and again beside its owner. It waits between: to start a
/// thread anew for every time step would cost time and memory.
class Worker
{
public:
  /// The task must not throw.
  explicit Worker(std::function<void()> task);
  ~Worker();
  Worker(const Worker&) = delete;
  Worker& operator=(const Worker&) = delete;

  /// Do the task once. Wait() comes before the next Start().
  void Start();
  /// Until the task is done.
  void Wait();

private:
  enum class Phase
  {
    Idle,
    Busy,
    Leaving
  };

  void Run();
  void Enter(Phase phase);

  std::function<void()> Task;
  std::mutex Mutex;
  std::condition_variable Changed;
  Phase Now = Phase::Idle;
  std::thread Thread; // last: it uses the others
};

} // namespace SurfaceDiffusion
