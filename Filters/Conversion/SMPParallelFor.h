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
#include <string>

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
    if (count < Few)
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

  /// The back end Sequential is ParaView's default, not a user's choice of one thread: a few long
  /// tasks then run on VTK's other back end.
  void RunTasks(Index count, LoopBody body) const override
  {
    const auto run = [&] { RunOnThreads(count, 1, body, LoopWatch::OfThisThread()); };
    if (std::string(vtkSMPTools::GetBackend()) == "Sequential")
    {
      vtkSMPTools::LocalScope(vtkSMPTools::Config(std::string("STDThread")), run);
    }
    else
    {
      run();
    }
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
