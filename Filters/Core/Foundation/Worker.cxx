// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Foundation/Worker.h"

#include <utility>

namespace SurfaceDiffusion
{

Worker::Worker(std::function<void()> task)
  : Task(std::move(task))
  , Thread([this] { this->Run(); })
{
}

Worker::~Worker()
{
  this->Wait();
  this->Enter(Phase::Leaving);
  this->Thread.join();
}

void Worker::Start()
{
  this->Enter(Phase::Busy);
}

void Worker::Wait()
{
  std::unique_lock<std::mutex> lock(this->Mutex);
  this->Changed.wait(lock, [this] { return this->Now == Phase::Idle; });
}

void Worker::Enter(Phase phase)
{
  {
    const std::lock_guard<std::mutex> lock(this->Mutex);
    this->Now = phase;
  }
  this->Changed.notify_all();
}

void Worker::Run()
{
  while (true)
  {
    {
      std::unique_lock<std::mutex> lock(this->Mutex);
      this->Changed.wait(lock, [this] { return this->Now != Phase::Idle; });
      if (this->Now == Phase::Leaving)
      {
        return;
      }
    }
    this->Task();
    this->Enter(Phase::Idle);
  }
}

} // namespace SurfaceDiffusion
