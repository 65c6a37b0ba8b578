// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Conversion/SMPParallelFor.h"

#include <gtest/gtest.h>

#include <chrono>
#include <thread>

using namespace SurfaceDiffusion;

namespace
{

/// Loops of `blocks` blocks for a tenth of a second.
void LoopForAWhile(Index blocks)
{
  const auto start = std::chrono::steady_clock::now();
  while (std::chrono::steady_clock::now() - start < std::chrono::milliseconds(100))
  {
    SMPParallelFor::Instance().Run(blocks, [](Index, Index) {});
  }
}

} // namespace

TEST(LoopWatch, EndsLoopsShortAndLongOnce)
{
  for (const Index blocks : { 3, 1000 })
  {
    int questions = 0;
    LoopWatch watch(
      [&]
      {
        ++questions;
        return false;
      });
    EXPECT_THROW(LoopForAWhile(blocks), Aborted);
    EXPECT_NO_THROW(LoopForAWhile(blocks)); // clean-up does not abort
    EXPECT_EQ(questions, 1);
  }
  EXPECT_NO_THROW(LoopForAWhile(1000));
}

TEST(LoopWatch, EndsALoopInItsMiddle)
{
  LoopWatch watch([] { return false; });
  int pieces = 0;
  const std::thread::id here = std::this_thread::get_id();
  const auto slow = [&](Index, Index)
  {
    if (std::this_thread::get_id() == here)
    {
      ++pieces;
    }
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
  };
  EXPECT_THROW(SMPParallelFor::Instance().Run(16000, slow), Aborted);
  EXPECT_LT(pieces, 1000);
}

TEST(LoopWatch, AsksNothingWhereAllMayGoOnOrItHasEnded)
{
  int questions = 0;
  LoopWatch watch(
    [&]
    {
      ++questions;
      return true;
    });
  LoopForAWhile(100);
  EXPECT_GE(questions, 1);
  EXPECT_LE(questions, 3); // not once per block
  watch.End();
  questions = 0;
  LoopForAWhile(100);
  EXPECT_EQ(questions, 0);
}

TEST(LoopWatch, LeavesOtherThreadsAlone)
{
  LoopWatch watch([] { return false; });
  std::thread other([] { EXPECT_NO_THROW(LoopForAWhile(1000)); });
  other.join();
}
