// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Monitor.h"

#include <gtest/gtest.h>

#include <atomic>
#include <chrono>
#include <memory>
#include <stdexcept>
#include <thread>
#include <vector>

using namespace SurfaceDiffusion;

TEST(Monitor, WithoutACallbackItIsSilent)
{
  EXPECT_NO_THROW(Monitor().Report(0.5));
  EXPECT_NO_THROW(Monitor().Part(0.2, 0.4).Report(1.0));
}

TEST(Monitor, PartsFillTheirShare)
{
  double last = -1.0;
  const Monitor::Callback watch = [&](double fraction)
  {
    last = fraction;
    return true;
  };
  const Monitor monitor(watch);
  monitor.Report(0.25);
  EXPECT_EQ(last, 0.25);
  monitor.Part(0.5, 1.0).Report(0.5);
  EXPECT_EQ(last, 0.75);
  monitor.Part(0.5, 1.0).Part(0.5, 1.0).Report(0.5);
  EXPECT_EQ(last, 0.875);
}

TEST(Monitor, ThrowsWhenTheCallbackSaysStop)
{
  const Monitor::Callback stop = [](double) { return false; };
  EXPECT_THROW(Monitor(stop).Part(0.0, 0.5).Report(0.1), Aborted);
}

TEST(Monitor, WorkInTheBackgroundReportsUpwards)
{
  std::vector<double> reports;
  const Monitor::Callback watch = [&](double fraction)
  {
    reports.push_back(fraction);
    return true;
  };
  std::atomic<bool> done{ false };
  RunInBackground(
    [&]
    {
      std::this_thread::sleep_for(std::chrono::milliseconds(200));
      done = true;
    },
    Monitor(watch));
  EXPECT_TRUE(done);
  ASSERT_GE(reports.size(), 3u);
  EXPECT_EQ(reports.back(), 1.0);
  for (std::size_t i = 1; i < reports.size(); ++i)
  {
    EXPECT_GT(reports[i], reports[i - 1]);
  }
}

TEST(Monitor, WorkInTheBackgroundIsLeftAloneByAnAbort)
{
  const Monitor::Callback stop = [](double) { return false; };
  const auto done = std::make_shared<std::atomic<bool>>(false);
  const auto go = std::make_shared<std::atomic<bool>>(false);
  EXPECT_THROW(RunInBackground(
                 [done, go]
                 {
                   while (!*go)
                   {
                     std::this_thread::yield();
                   }
                   *done = true;
                 },
                 Monitor(stop)),
    Aborted); // returns although the task cannot end yet
  EXPECT_FALSE(*done);
  *go = true;
  while (!*done)
  {
    std::this_thread::yield();
  }
}

TEST(Monitor, AnExceptionInTheBackgroundIsPassedOn)
{
  EXPECT_THROW(
    RunInBackground([] { throw std::runtime_error("no"); }, Monitor()), std::runtime_error);
}
