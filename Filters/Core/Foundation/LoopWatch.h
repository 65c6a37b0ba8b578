// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Core/Foundation/ProgressMonitor.h"

#include <chrono>
#include <functional>
#include <utility>

namespace SurfaceDiffusion
{

/// During its lifetime, the loops of its thread check for an abort every 50 ms and throw Aborted
/// once. An abort is thus obeyed within loops, too, however rarely these report their progress.
class LoopWatch
{
public:
  explicit LoopWatch(std::function<bool()> goOn)
    : GoOn(std::move(goOn))
    , Outer(Current)
  {
    Current = this;
  }
  ~LoopWatch() { Current = this->Outer; }
  LoopWatch(const LoopWatch&) = delete;
  LoopWatch& operator=(const LoopWatch&) = delete;

  /// End the checks.
  void End() { this->Ended = true; }

  /// The watch of this thread; null for none.
  static LoopWatch* OfThisThread() { return Current; }

  void Ask()
  {
    const Clock::time_point now = Clock::now();
    if (this->Ended || now - this->Last < std::chrono::milliseconds(50))
    {
      return;
    }
    this->Last = now;
    if (!this->GoOn())
    {
      this->End(); // the cleanup may run loops
      throw Aborted();
    }
  }

private:
  using Clock = std::chrono::steady_clock;

  static inline thread_local LoopWatch* Current = nullptr;

  std::function<bool()> GoOn;
  LoopWatch* Outer;
  Clock::time_point Last = Clock::now();
  bool Ended = false;
};

} // namespace SurfaceDiffusion
