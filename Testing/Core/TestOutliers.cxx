// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "CellRun.h"
#include "RunInput.h"

#include "Run/HeatSettings.h"
#include "Run/SegmentationSettings.h"
#include "Run/TensorDiffusionSettings.h"
#include "Run/TotalVariationSettings.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <string>
#include <vector>

// The range R, a natural unit, leaves outliers out, or a warning says that it is theirs.

namespace SurfaceDiffusion
{

namespace
{

using Testing::Alone;
using Testing::RunInput;

int CountIn(const SurfaceDiffusion::Run& run)
{
  int count = 0;
  for (const Warning& warning : run.FindWarnings(Alone))
  {
    const std::string text = warning.Sentence.Text();
    count += text.find("the values have outliers: the range R") != std::string::npos ||
      text.find("is that of outliers") != std::string::npos;
  }
  return count;
}

template <typename ModelSettings>
int NumberOfWarnings(const std::vector<BlockInput>& blocks, const ModelSettings& settings)
{
  SurfaceDiffusion::Run run(SerialFor());
  run.Update(blocks, std::make_shared<ModelSettings>(settings), Alone, ProgressMonitor());
  return CountIn(run);
}

double RangeOf(const RunInput& input)
{
  SurfaceDiffusion::Run run(SerialFor());
  run.Update({ input.Block() }, std::make_shared<HeatSettings>(), Alone, ProgressMonitor());
  return run.Units().ValueRange;
}

RunInput Sampled(int level, const std::function<double(Index, const Eigen::RowVector3d&)>& f)
{
  RunInput input(Testing::Icosphere(level));
  for (Eigen::Index i = 0; i < input.Vertices.rows(); ++i)
  {
    input.Data.Data.Values(i, 0) = f(static_cast<Index>(i), input.Vertices.row(i));
  }
  return input;
}

double Step(Index i, const Eigen::RowVector3d& x)
{
  return (x[2] > 0.3 ? 1.0 : 0.0) + 0.05 * (UniformRandom(1, 0, i) - 0.5);
}

} // namespace

TEST(Outliers, OfOnePointAreAWarning)
{
  for (const int level : { 2, 3, 4 })
  {
    RunInput input = Sampled(level, Step);
    EXPECT_EQ(NumberOfWarnings({ input.Block() }, TensorDiffusionSettings()), 0);
    input.Data.Data.Values(40, 0) = 50.0;
    EXPECT_EQ(NumberOfWarnings({ input.Block() }, TensorDiffusionSettings()), 1) << level;
    EXPECT_EQ(NumberOfWarnings({ input.Block() }, TotalVariationSettings()), 1);
    SegmentationSettings segmentation;
    EXPECT_EQ(NumberOfWarnings({ input.Block() }, segmentation), 0) << "its weight is found";
    segmentation.AutomaticFidelity = false;
    EXPECT_EQ(NumberOfWarnings({ input.Block() }, segmentation), 1);
    EXPECT_EQ(NumberOfWarnings({ input.Block() }, HeatSettings()), 0) << "R has no effect";
    TensorDiffusionSettings absolute;
    absolute.Units = UnitsMode::Absolute;
    EXPECT_EQ(NumberOfWarnings({ input.Block() }, absolute), 0);
    input.Data.Mask.Values.assign(static_cast<std::size_t>(input.Vertices.rows()), 0);
    input.Data.Mask.Values[40] = 1;
    EXPECT_EQ(NumberOfWarnings({ input.Block() }, TensorDiffusionSettings()), 0) << "masked";
  }
}

TEST(Outliers, AreNotFoundInOrdinaryData)
{
  const auto gaussian = [](Index i)
  {
    return std::sqrt(-2.0 * std::log(1.0 - UniformRandom(3, 0, i))) *
      std::cos(2.0 * Testing::Pi * UniformRandom(3, 1, i));
  };
  const std::vector<std::function<double(Index, const Eigen::RowVector3d&)>> data = {
    [](Index, const Eigen::RowVector3d& x) { return x[2]; },
    [](Index, const Eigen::RowVector3d& x) { return std::exp(3.0 * x[2]); },
    [](Index, const Eigen::RowVector3d&) { return 4.0; },
    [](Index, const Eigen::RowVector3d& x) { return x[2] > 0.95 ? 1.0 : 0.0; },
    [&](Index i, const Eigen::RowVector3d&) { return gaussian(i); },
    [&](Index i, const Eigen::RowVector3d&) { return std::exp(gaussian(i)); },
    [&](Index i, const Eigen::RowVector3d&)
    { return std::copysign(std::log(1.0 - UniformRandom(5, 0, i)), gaussian(i)); }, // Laplace
    [](Index i, const Eigen::RowVector3d& x) { return i % 50 == 0 ? 50.0 : x[2]; },
    [](Index i, const Eigen::RowVector3d&) { return i == 7 ? 1.0 : 0.0; },
  };
  for (std::size_t d = 0; d < data.size(); ++d)
  {
    for (const int level : { 1, 3, 4 })
    {
      const RunInput input = Sampled(level, data[d]);
      EXPECT_EQ(NumberOfWarnings({ input.Block() }, TensorDiffusionSettings()), 0)
        << d << ' ' << level;
    }
  }
}

TEST(Outliers, AreLeftOutOfTheRangeIfItIsTenTimesAsLargeWithThem)
{
  for (const double outlier : { 3.0, 5.0, 11.0, 50.0, -1e6 })
  {
    RunInput input = Sampled(4, Step);
    const double range = RangeOf(input);
    for (const Eigen::Index i : { 40, 41, 900 })
    {
      input.Data.Data.Values(i, 0) = outlier;
    }
    const bool isLeftOut = std::abs(outlier) > 10.0 * range;
    EXPECT_NEAR(
      RangeOf(input), isLeftOut ? range : outlier - input.Data.Data.Values.minCoeff(), 0.02)
      << outlier;
    EXPECT_EQ(NumberOfWarnings({ input.Block() }, TensorDiffusionSettings()), outlier != 3.0);
  }
  const RunInput sparse =
    Sampled(4, [](Index i, const Eigen::RowVector3d&) { return i == 7 ? 1.0 : 0.0; });
  EXPECT_EQ(RangeOf(sparse), 1.0) << "the rest has no range";
}

TEST(Outliers, AreThoseOfAllBlocksTogether)
{
  RunInput outlier = Sampled(3, Step);
  outlier.Data.Data.Values(40, 0) = 50.0;
  const RunInput ordinary = Sampled(3, Step);
  EXPECT_EQ(NumberOfWarnings({ ordinary.Block(), outlier.Block() }, TensorDiffusionSettings()), 1);
  const RunInput large =
    Sampled(3, [](Index i, const Eigen::RowVector3d& x) { return 50.0 * Step(i, x); });
  EXPECT_EQ(NumberOfWarnings({ large.Block(), outlier.Block() }, TensorDiffusionSettings()), 0)
    << "the other block has values as large";
}

TEST(Outliers, OfOneCellAreAWarning)
{
  Testing::CellInput input(Testing::Icosphere(3));
  input.SetData([](Index c, const Eigen::RowVector3d& x) { return c == 40 ? 50.0 : x[2]; });
  EXPECT_EQ(NumberOfWarnings({ input.Block() }, TensorDiffusionSettings()), 1);
}

} // namespace SurfaceDiffusion
