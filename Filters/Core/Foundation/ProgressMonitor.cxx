// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Foundation/ProgressMonitor.h"

#include <algorithm>
#include <chrono>
#include <future>
#include <mutex>
#include <thread>
#include <utility>
#include <vector>

#if defined(__EMSCRIPTEN__) && !defined(__EMSCRIPTEN_PTHREADS__)
#define SURFACEDIFFUSION_HAS_THREADS 0
#else
#define SURFACEDIFFUSION_HAS_THREADS 1
#endif

namespace SurfaceDiffusion
{

#if SURFACEDIFFUSION_HAS_THREADS

namespace
{

struct Work
{
  std::thread Thread;
  std::future<void> Result;

  bool IsReadyWithin(std::chrono::milliseconds time) const
  {
    return this->Result.wait_for(time) == std::future_status::ready;
  }
};

/// The threads of aborted work. Each is joined once it has ended, at the latest when the library is
/// unloaded or the program ends: no thread outlives the code that it runs.
class AbortedWork
{
public:
  AbortedWork() = default;
  ~AbortedWork()
  {
    for (Work& work : this->Running)
    {
      work.Thread.join();
    }
  }
  AbortedWork(const AbortedWork&) = delete;
  AbortedWork& operator=(const AbortedWork&) = delete;

  static AbortedWork& Instance()
  {
    static AbortedWork instance;
    return instance;
  }

  void Take(Work work)
  {
    const std::lock_guard<std::mutex> lock(this->Mutex);
    const auto ended = std::partition(this->Running.begin(), this->Running.end(),
      [](const Work& running) { return !running.IsReadyWithin(std::chrono::milliseconds(0)); });
    std::for_each(ended, this->Running.end(), [](Work& running) { running.Thread.join(); });
    this->Running.erase(ended, this->Running.end());
    this->Running.push_back(std::move(work));
  }

private:
  std::mutex Mutex;
  std::vector<Work> Running;
};

} // namespace

void RunInBackground(std::function<void()> task, const ProgressMonitor& progress)
{
  AbortedWork& aborted = AbortedWork::Instance(); // made now: it must be there for an abort
  std::packaged_task<void()> packaged(std::move(task));
  Work work;
  work.Result = packaged.get_future();
  work.Thread = std::thread(std::move(packaged));
  try
  {
    // The duration of the task is unknown: the reports close half of the gap every half second.
    double remaining = 1.0;
    while (!work.IsReadyWithin(std::chrono::milliseconds(50)))
    {
      remaining *= 0.933;
      progress.Report(1.0 - remaining);
    }
  }
  catch (...)
  {
    aborted.Take(std::move(work));
    throw;
  }
  work.Thread.join();
  work.Result.get();
  progress.Report(1.0);
}

#else // a page: who wants to stop the task ends the worker that it runs in

void RunInBackground(std::function<void()> task, const ProgressMonitor& progress)
{
  task();
  progress.Report(1.0);
}

#endif

} // namespace SurfaceDiffusion
