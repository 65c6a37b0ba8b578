// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Foundation/ThreadPool.h"

#include "Core/Foundation/LoopWatch.h"

#include <algorithm>
#include <atomic>
#include <condition_variable>
#include <cstddef>
#include <cstdint>
#include <exception>
#include <mutex>
#include <system_error>
#include <thread>
#include <vector>

namespace SurfaceDiffusion
{

namespace
{

/// Ranges per thread: threads of different speed end at about the same time.
constexpr Index RangesPerThread = 4;

/// One loop: threads take ranges until none is left.
class Loop
{
public:
  Loop(Index count, Index piece, LoopBody body)
    : Count(count)
    , Piece(piece)
    , Body(body)
  {
  }

  /// watch: of the thread that asked for the loop; null on all others.
  void TakePart(LoopWatch* watch)
  {
    try
    {
      while (!this->Failed)
      {
        const std::int64_t begin = this->Next.fetch_add(this->Piece);
        if (begin >= this->Count)
        {
          return;
        }
        this->Body(static_cast<Index>(begin),
          static_cast<Index>(std::min<std::int64_t>(this->Count, begin + this->Piece)));
        if (watch)
        {
          watch->Ask();
        }
      }
    }
    catch (...)
    {
      const std::lock_guard<std::mutex> lock(this->OfFailure);
      this->Failure = std::current_exception();
      this->Failed = true;
    }
  }

  void RethrowFailure() const
  {
    if (this->Failure)
    {
      std::rethrow_exception(this->Failure);
    }
  }

private:
  const Index Count;
  const Index Piece;
  const LoopBody Body;
  std::atomic<std::int64_t> Next{ 0 };
  std::atomic<bool> Failed{ false };
  std::mutex OfFailure;
  std::exception_ptr Failure;
};

} // namespace

class ThreadPool::Workers
{
public:
  explicit Workers(int count)
  {
    this->Threads.reserve(static_cast<std::size_t>(count));
    try
    {
      for (int i = 0; i < count; ++i)
      {
        this->Threads.emplace_back([this] { this->Work(); });
      }
    }
    catch (const std::system_error&) // no memory for more, or their number is limited
    {
    }
  }

  ~Workers()
  {
    {
      const std::lock_guard<std::mutex> lock(this->Mutex);
      this->Ending = true;
    }
    this->Begin.notify_all();
    for (std::thread& thread : this->Threads)
    {
      thread.join();
    }
  }
  Workers(const Workers&) = delete;
  Workers& operator=(const Workers&) = delete;

  int Count() const { return static_cast<int>(this->Threads.size()); }

  /// Whether the loop was run; false if the workers have another one.
  bool Run(Loop& loop, LoopWatch* watch)
  {
    const std::unique_lock<std::mutex> mine(this->Busy, std::try_to_lock);
    if (!mine.owns_lock())
    {
      return false;
    }
    {
      const std::lock_guard<std::mutex> lock(this->Mutex);
      this->Current = &loop;
      ++this->Number;
    }
    this->Begin.notify_all();
    loop.TakePart(watch);
    std::unique_lock<std::mutex> lock(this->Mutex);
    this->Current = nullptr; // threads that wake up late have nothing to do
    this->End.wait(lock, [this] { return this->Active == 0; });
    return true;
  }

private:
  void Work()
  {
    std::int64_t last = 0;
    std::unique_lock<std::mutex> lock(this->Mutex);
    while (true)
    {
      this->Begin.wait(
        lock, [&] { return this->Ending || (this->Current != nullptr && this->Number != last); });
      if (this->Ending)
      {
        return;
      }
      last = this->Number;
      Loop* const loop = this->Current;
      ++this->Active;
      lock.unlock();
      loop->TakePart(nullptr);
      lock.lock();
      if (--this->Active == 0)
      {
        this->End.notify_one();
      }
    }
  }

  std::mutex Busy; ///< held during a loop
  std::mutex Mutex; ///< of the members below
  std::condition_variable Begin, End;
  Loop* Current = nullptr;
  std::int64_t Number = 0; ///< of the current loop
  int Active = 0; ///< workers in the current loop
  bool Ending = false;
  std::vector<std::thread> Threads; // last: they use the members above
};

ThreadPool::ThreadPool(int threads)
  : Threads(std::make_unique<Workers>(std::max(0, threads - 1)))
{
}

ThreadPool::~ThreadPool() = default;

int ThreadPool::NumberOfThreads() const
{
  return this->Threads->Count() + 1;
}

void ThreadPool::Run(Index count, LoopBody body) const
{
  const Index ranges = RangesPerThread * this->NumberOfThreads();
  this->RunOnThreads(count, count < Few ? count : std::max(1, count / ranges), body);
}

void ThreadPool::RunTasks(Index count, LoopBody body) const
{
  this->RunOnThreads(count, 1, body);
}

void ThreadPool::RunOnThreads(Index count, Index piece, LoopBody body) const
{
  LoopWatch* const watch = LoopWatch::OfThisThread();
  Loop loop(count, std::max(1, piece), body);
  if (count <= piece || this->Threads->Count() == 0 || !this->Threads->Run(loop, watch))
  {
    loop.TakePart(watch);
  }
  loop.RethrowFailure();
}

} // namespace SurfaceDiffusion
