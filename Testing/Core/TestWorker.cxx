// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Foundation/Worker.h"

#include <gtest/gtest.h>

#include <chrono>
#include <thread>

using namespace SurfaceDiffusion;

TEST(Worker, DoesItsTaskOncePerStartOnAThreadOfItsOwn)
{
  int done = 0;
  std::thread::id thread;
  Worker worker(
    [&]
    {
      ++done;
      thread = std::this_thread::get_id();
    });
  worker.Wait(); // nothing to wait for
  EXPECT_EQ(done, 0);
  std::thread::id first;
  for (int i = 1; i <= 1000; ++i)
  {
    worker.Start();
    worker.Wait();
    ASSERT_EQ(done, i);
    first = i == 1 ? thread : first;
    EXPECT_EQ(thread, first);
  }
  EXPECT_NE(thread, std::this_thread::get_id());
}

TEST(Worker, FinishesItsTaskBeforeItGoes)
{
  bool done = false;
  {
    Worker worker(
      [&]
      {
        std::this_thread::sleep_for(std::chrono::milliseconds(20));
        done = true;
      });
    worker.Start();
  }
  EXPECT_TRUE(done);
}
