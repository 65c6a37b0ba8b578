// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Core/Foundation/LoopWatch.h"
#include "Core/Foundation/Parallel.h"

#include "vtkSMPTools.h"

#include <algorithm>
#include <atomic>
#include <exception>
#include <mutex>

namespace SurfaceDiffusion
{

/// The core's loops on VTK's threads.
class SMPParallelFor : public ParallelFor
{
public:
  /// The std::thread back end starts new threads for every loop: shorter loops are faster on one.
  static constexpr Index Few = 24;

  void Run(Index count, LoopBody body) const override
  {
    LoopWatch* const watch = LoopWatch::OfThisThread();
    if (count < Few || LimitOfThisThread() == 1)
    {
      body(0, count);
    }
    else
    {
      RunOnThreads(count, 0, body, watch);
    }
    if (watch)
    {
      watch->Ask();
    }
  }

  void RunTasks(Index count, LoopBody body) const override
  {
    RunOnThreads(count, 1, body, LoopWatch::OfThisThread());
  }

  /// The largest number of threads of loops that this thread starts; 0: all of VTK's back end.
  static int& LimitOfThisThread()
  {
    static thread_local int limit = 0;
    return limit;
  }

  /// The object that all share, because the core keeps references to it.
  static const SMPParallelFor& Instance()
  {
    static const SMPParallelFor instance;
    return instance;
  }

private:
  /// grain: as for vtkSMPTools::For.
  static void RunOnThreads(Index count, vtkIdType grain, LoopBody body, LoopWatch* watch)
  {
    // An exception (not enough memory) that leaves a thread of VTK would end the program.
    std::exception_ptr failure;
    std::mutex ofFailure;
    std::atomic<bool> failed{ false };
    const int limit = LimitOfThisThread();
    if (limit > 0) // as many ranges as threads
    {
      grain = std::max<vtkIdType>(grain, (count + limit - 1) / limit);
    }
    const auto loop = [&](vtkIdType begin, vtkIdType end)
    {
      try
      {
        constexpr vtkIdType piece = 16; // blocks between two checks
        for (vtkIdType first = begin; first < end && !failed; first += piece)
        {
          const vtkIdType last = std::min(end, first + piece);
          body(static_cast<Index>(first), static_cast<Index>(last));
          if (watch && watch == LoopWatch::OfThisThread())
          {
            watch->Ask();
          }
        }
      }
      catch (...)
      {
        const std::lock_guard<std::mutex> lock(ofFailure);
        failure = std::current_exception();
        failed = true;
      }
    };
    vtkSMPTools::For(0, count, grain, loop);
    if (failure)
    {
      std::rethrow_exception(failure);
    }
  }
};

} // namespace SurfaceDiffusion
