// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Foundation/RobustRange.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <vector>

using namespace SurfaceDiffusion;

namespace
{

std::vector<double> Ramp(int count)
{
  std::vector<double> values;
  for (int i = 0; i < count; ++i)
  {
    values.push_back(static_cast<double>((7 * i) % count)); // 7 does not divide the counts below
  }
  return values;
}

} // namespace

TEST(RobustRange, LeavesOutAThousandthAtEitherEnd)
{
  std::vector<double> values = Ramp(10000);
  const ValueBounds bounds = RobustBounds(values);
  EXPECT_EQ(bounds.Low, 10.0);
  EXPECT_EQ(bounds.High, 9989.0);
}

TEST(RobustRange, LeavesOutOneOutlierOfHundredValuesAndNoneOfFewer)
{
  std::vector<double> values = Ramp(100);
  values[50] = 1e6;
  EXPECT_LE(RobustBounds(values).High, 99.0);
  values = Ramp(99);
  values[50] = 1e6;
  EXPECT_EQ(RobustBounds(values).High, 1e6);
  values = { 3.0 };
  EXPECT_EQ(RobustBounds(values).Width(), 0.0);
  values.clear();
  EXPECT_EQ(RobustBounds(values).Width(), 0.0);
}

TEST(RobustRange, IsThatOfTheWidestColumnOverTheKnownRows)
{
  const Index n = 2000;
  Values values(n, 2);
  for (Index i = 0; i < n; ++i)
  {
    values.row(i) << 1e-3 * i, 5.0 - 2e-3 * i;
  }
  Flags missing = Flags::Constant(n, false);
  EXPECT_NEAR(RobustRange(values, missing, Reduction::Serial()), 4.0, 0.02);
  missing.tail(n / 2) = true;
  EXPECT_NEAR(RobustRange(values, missing, Reduction::Serial()), 2.0, 0.02);
  missing.fill(true);
  EXPECT_EQ(RobustRange(values, missing, Reduction::Serial()), 0.0);
}
