// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <exception>
#include <functional>

namespace SurfaceDiffusion
{

/// Thrown when the user asked to stop.
struct Aborted : std::exception
{
  const char* what() const noexcept override { return "aborted"; }
};

/// Reports the progress of long work and throws Aborted when the user asked to stop. Copies are
/// cheap and share the callback. Part() makes a monitor for a part of the work.
class ProgressMonitor
{
public:
  /// Called with the fraction done in [0, 1]; returns false to stop.
  using Callback = std::function<bool(double)>;

  ProgressMonitor() = default;
  /// The callback must outlive the monitor and its parts.
  explicit ProgressMonitor(const Callback& callback)
    : Call(&callback)
  {
  }

  /// Report that `fraction` of this monitor's work is done. Throws Aborted.
  void Report(double fraction) const
  {
    if (this->Call && !(*this->Call)(this->Begin + fraction * (this->End - this->Begin)))
    {
      throw Aborted();
    }
  }

  /// The monitor of the part [begin, end] of this one's work.
  ProgressMonitor Part(double begin, double end) const
  {
    ProgressMonitor part = *this;
    part.Begin = this->Begin + begin * (this->End - this->Begin);
    part.End = this->Begin + end * (this->End - this->Begin);
    return part;
  }

private:
  const Callback* Call = nullptr;
  double Begin = 0.0;
  double End = 1.0;
};

/// Run `task` on another thread and report progress meanwhile, for work that cannot be stopped. If
/// the report throws Aborted, this function returns at once, the task runs to its end alone, and
/// its result is dropped: it must own all data that it uses. The end of the program waits for such
/// tasks. An exception of the task is passed on.
void RunInBackground(std::function<void()> task, const ProgressMonitor& progress);

} // namespace SurfaceDiffusion
