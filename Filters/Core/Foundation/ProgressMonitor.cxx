// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Foundation/ProgressMonitor.h"

#include <chrono>
#include <future>
#include <thread>
#include <utility>

namespace SurfaceDiffusion
{

void RunInBackground(std::function<void()> task, const ProgressMonitor& progress)
{
  std::packaged_task<void()> packaged(std::move(task));
  std::future<void> result = packaged.get_future();
  std::thread(std::move(packaged)).detach();
  // How long the task takes is unknown: the reports close half of the gap every half second.
  double remaining = 1.0;
  while (result.wait_for(std::chrono::milliseconds(50)) != std::future_status::ready)
  {
    remaining *= 0.933;
    progress.Report(1.0 - remaining);
  }
  result.get();
  progress.Report(1.0);
}

} // namespace SurfaceDiffusion
