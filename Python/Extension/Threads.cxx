// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Threads.h"

#include <algorithm>
#include <thread>

namespace SurfaceDiffusion
{

PythonThreads& PythonThreads::Instance()
{
  static auto* const instance = new PythonThreads; // never deleted: no thread is waited for at exit
  return *instance;
}

PythonThreads::PythonThreads()
  : Mutex(std::make_unique<std::mutex>())
  , Number(static_cast<int>(std::max(1U, std::thread::hardware_concurrency())))
{
}

std::shared_ptr<const ThreadPool> PythonThreads::Pool() const
{
  const std::lock_guard<std::mutex> lock(*this->Mutex);
  if (!this->Threads)
  {
    this->Threads = std::make_shared<const ThreadPool>(this->Number);
  }
  return this->Threads;
}

int PythonThreads::NumberOfThreads() const
{
  const std::lock_guard<std::mutex> lock(*this->Mutex);
  return this->Number;
}

void PythonThreads::SetNumberOfThreads(int number)
{
  std::shared_ptr<const ThreadPool> old; // ends after the lock
  const std::lock_guard<std::mutex> lock(*this->Mutex);
  this->Number = number;
  old.swap(this->Threads);
}

void PythonThreads::AfterFork()
{
  // Neither can be destroyed: the mutex may be locked, and the threads cannot be joined.
  static_cast<void>(this->Mutex.release());
  this->Mutex = std::make_unique<std::mutex>();
  new std::shared_ptr<const ThreadPool>(std::move(this->Threads));
  this->Threads.reset();
}

} // namespace SurfaceDiffusion
