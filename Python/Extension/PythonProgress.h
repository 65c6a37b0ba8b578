// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Core/Foundation/LoopWatch.h"
#include "Core/Foundation/ProgressMonitor.h"
#include "Run/Sentence.h"

#include <nanobind/nanobind.h>

#include <atomic>
#include <chrono>
#include <exception>
#include <functional>
#include <new>
#include <stdexcept>
#include <thread>

namespace SurfaceDiffusion
{

/// Do work, and throw nanobind::value_error instead of std::runtime_error, by which the library
/// reports errors of its input. An InputError stays, since Python words it.
template <typename Work>
void WithValueErrors(const Work& work)
{
  try
  {
    work();
  }
  catch (const InputError&)
  {
    throw;
  }
  catch (const std::runtime_error& error)
  {
    throw nanobind::value_error(error.what());
  }
}

/// Keeps an object from being used by the callable that reports the progress of its own work. Other
/// threads wait for the lock of the surface.
class UseGuard
{
public:
  explicit UseGuard(bool& inUse)
    : InUse(inUse)
  {
    if (inUse)
    {
      throw std::runtime_error("progress uses the surface whose work it reports; allowed: others");
    }
    inUse = true;
  }
  ~UseGuard() { this->InUse = false; }
  UseGuard(const UseGuard&) = delete;
  UseGuard& operator=(const UseGuard&) = delete;

private:
  bool& InUse;
};

/// Reports progress to Python and obeys Ctrl-C. At most every 50 ms it takes the interpreter's
/// lock, handles signals, and calls a Python callable with the fraction done. An exception of
/// either, such as KeyboardInterrupt, ends the work.
class PythonProgress
{
public:
  /// callable: None for no reports.
  explicit PythonProgress(nanobind::object callable);

  /// Do `work`, which takes a ProgressMonitor, without the interpreter's lock. Throws the exception
  /// of the callable or of a signal, exceptions of WithValueErrors(), and any other exception of
  /// the work.
  void Run(const std::function<void(const ProgressMonitor&)>& work);

private:
  bool Report(double fraction);
  void Ask();

  nanobind::object Callable;
  const std::thread::id Owner = std::this_thread::get_id();
  std::chrono::steady_clock::time_point Last;
  double Fraction = 0.0; ///< the largest one reported
  std::atomic<bool> Stopped{ false };
  std::exception_ptr Failure;
};

} // namespace SurfaceDiffusion
