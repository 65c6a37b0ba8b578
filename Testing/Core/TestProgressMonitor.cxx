// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Foundation/ProgressMonitor.h"

#include <gtest/gtest.h>

#include <atomic>
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <memory>
#include <stdexcept>
#include <thread>
#include <vector>

using namespace SurfaceDiffusion;

TEST(ProgressMonitor, WithoutACallbackItIsSilent)
{
  EXPECT_NO_THROW(ProgressMonitor().Report(0.5));
  EXPECT_NO_THROW(ProgressMonitor().Part(0.2, 0.4).Report(1.0));
}

TEST(ProgressMonitor, PartsFillTheirShare)
{
  double last = -1.0;
  const ProgressMonitor::Callback watch = [&](double fraction)
  {
    last = fraction;
    return true;
  };
  const ProgressMonitor progress(watch);
  progress.Report(0.25);
  EXPECT_EQ(last, 0.25);
  progress.Part(0.5, 1.0).Report(0.5);
  EXPECT_EQ(last, 0.75);
  progress.Part(0.5, 1.0).Part(0.5, 1.0).Report(0.5);
  EXPECT_EQ(last, 0.875);
}

TEST(ProgressMonitor, ThrowsWhenTheCallbackSaysStop)
{
  const ProgressMonitor::Callback stop = [](double) { return false; };
  EXPECT_THROW(ProgressMonitor(stop).Part(0.0, 0.5).Report(0.1), Aborted);
}

TEST(ProgressMonitor, WorkInTheBackgroundReportsUpwards)
{
  std::vector<double> reports;
  const ProgressMonitor::Callback watch = [&](double fraction)
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
    ProgressMonitor(watch));
  EXPECT_TRUE(done);
  ASSERT_GE(reports.size(), 3u);
  EXPECT_EQ(reports.back(), 1.0);
  for (std::size_t i = 1; i < reports.size(); ++i)
  {
    EXPECT_GT(reports[i], reports[i - 1]);
  }
}

TEST(ProgressMonitor, WorkInTheBackgroundIsLeftAloneByAnAbort)
{
  const ProgressMonitor::Callback stop = [](double) { return false; };
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
                 ProgressMonitor(stop)),
    Aborted); // returns although the task cannot end yet
  EXPECT_FALSE(*done);
  *go = true;
  while (!*done)
  {
    std::this_thread::yield();
  }
}

TEST(ProgressMonitor, TheEndOfTheProgramWaitsForAbortedWork)
{
  const auto abortAndExit = []
  {
    const ProgressMonitor::Callback stop = [](double) { return false; };
    try
    {
      RunInBackground(
        []
        {
          std::this_thread::sleep_for(std::chrono::milliseconds(500));
          std::fputs("the task has ended", stderr);
        },
        ProgressMonitor(stop));
    }
    catch (const Aborted&)
    {
      std::exit(0);
    }
  };
  GTEST_FLAG_SET(death_test_style, "threadsafe");
  EXPECT_EXIT(abortAndExit(), ::testing::ExitedWithCode(0), "the task has ended");
}

TEST(ProgressMonitor, AnExceptionInTheBackgroundIsPassedOn)
{
  EXPECT_THROW(
    RunInBackground([] { throw std::runtime_error("no"); }, ProgressMonitor()), std::runtime_error);
}
