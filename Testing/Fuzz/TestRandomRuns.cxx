// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "RandomRun.h"

#include <gtest/gtest.h>

#include <random>
#include <vector>

using namespace SurfaceDiffusion::Testing;

TEST(RandomRuns, KeepWhatTheCorePromises)
{
  std::mt19937 random(2026); // the same numbers everywhere
  for (int run = 0; run < 1500; ++run)
  {
    std::vector<std::uint8_t> bytes(40 + random() % 360);
    for (std::uint8_t& byte : bytes)
    {
      byte = static_cast<std::uint8_t>(random() >> 11);
    }
    EXPECT_NO_THROW(RunFromBytes(bytes.data(), bytes.size())) << "run " << run;
  }
}
