// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Core/Foundation/LoopWatch.h"
#include "Core/Foundation/Parallel.h"
#include "Core/Foundation/ThreadPool.h"

#include "vtkSMPTools.h"

#include <algorithm>
#include <atomic>
#include <exception>
#include <functional>
#include <memory>
#include <mutex>
#include <utility>

namespace SurfaceDiffusion
{

/// The core's loops on the threads of an update: the library's own or those of VTK.
class SMPParallelFor : public ParallelFor
{
public:
  /// The std::thread back end starts new threads for every loop: shorter loops are faster on one. Tests
  /// lower it.
  static inline std::atomic<Index> Few = 24;

  /// The threads of the loops that one thread starts.
  struct Team
  {
    /// The number of the library's own threads; 0: those of VTK.
    int Own = 0;
    /// The largest number of VTK's threads; 0: all of its back end.
    int Limit = 0;
    std::unique_ptr<ThreadPool> Pool; ///< the own threads, from the first long loop on
  };

  /// Makes a team that of this thread, until the scope ends.
  class TeamScope
  {
  public:
    explicit TeamScope(Team& team)
      : Before(TeamOfThisThread())
    {
      TeamOfThisThread() = &team;
    }
    ~TeamScope() { TeamOfThisThread() = this->Before; }
    TeamScope(const TeamScope&) = delete;
    TeamScope& operator=(const TeamScope&) = delete;

  private:
    Team* const Before;
  };

  void Run(Index count, LoopBody body) const override
  {
    LoopWatch* const watch = LoopWatch::OfThisThread();
    const bool isOwn = HasOwnThreads();
    if (count < (isOwn ? ThreadPool::Few : Few.load(std::memory_order_relaxed)))
    {
      body(0, count);
    }
    else if (isOwn)
    {
      OwnThreads().Run(count, body);
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
    if (HasOwnThreads())
    {
      OwnThreads().RunTasks(count, body);
    }
    else
    {
      RunOnThreads(count, 1, body, LoopWatch::OfThisThread());
    }
  }

  std::function<void()> ForOtherThread(std::function<void()> task) const override
  {
    const Team* const here = TeamOfThisThread();
    if (!here)
    {
      return task;
    }
    return [task = std::move(task), own = here->Own, limit = here->Limit]
    {
      Team there; // the update may end before the task
      there.Own = own;
      there.Limit = limit;
      const TeamScope scope(there);
      task();
    };
  }

  /// The object that all share, because the core keeps references to it.
  static const SMPParallelFor& Instance()
  {
    static const SMPParallelFor instance;
    return instance;
  }

private:
  /// Null, as outside of updates: all threads of VTK.
  static Team*& TeamOfThisThread()
  {
    static thread_local Team* team = nullptr;
    return team;
  }

  static bool HasOwnThreads() { return TeamOfThisThread() && TeamOfThisThread()->Own > 0; }

  static const ThreadPool& OwnThreads()
  {
    Team& team = *TeamOfThisThread();
    if (!team.Pool)
    {
      team.Pool = std::make_unique<ThreadPool>(team.Own);
    }
    return *team.Pool;
  }

  /// On threads of VTK. grain: as for vtkSMPTools::For.
  static void RunOnThreads(Index count, vtkIdType grain, LoopBody body, LoopWatch* watch)
  {
    // An exception (not enough memory) that leaves a thread of VTK would end the program.
    std::exception_ptr failure;
    std::mutex ofFailure;
    std::atomic<bool> failed{ false };
    const int limit = TeamOfThisThread() ? TeamOfThisThread()->Limit : 0;
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
