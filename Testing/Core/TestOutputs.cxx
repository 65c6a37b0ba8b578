// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
//
// What models return, at its place and in the types of arrays.
#include "CellRun.h"
#include "RunInput.h"

#include "Run/HeatSettings.h"
#include "Run/Outputs.h"

#include <gtest/gtest.h>

#include <utility>

using namespace SurfaceDiffusion;
using namespace SurfaceDiffusion::Testing;

namespace
{

/// The heat filter with further results: the squares of the state, and the largest of them.
struct WithSquares : HeatSettings
{
  std::vector<Output> Finish(const RunState& state, RunResult& result) const override
  {
    std::vector<Output> outputs = this->HeatSettings::Finish(state, result);
    const Values squares = state.Path.State().array().square();
    outputs.push_back({ "Squares", Place::PerVertex, OutputType::Real, squares });
    outputs.push_back(Output::OfNumber("LargestSquare", squares.maxCoeff(), Combination::Largest));
    return outputs;
  }
};

OutputSource SourceOf(
  const SurfaceDiffusion::Run& run, const HeatSettings& settings, const Values& data)
{
  OutputSource source{ *run.GetBlock(0).Surface, SerialFor() };
  source.ReadData = [data] { return data; };
  source.DataAreFloats = true;
  source.Block = &run.GetBlock(0);
  source.Traits = settings.DescribeModel();
  return source;
}

/// The output as doubles, one row per point or cell.
Values Written(const Output& output, const OutputSource& source)
{
  const OutputRows rows(output, source);
  const Values data = source.ReadData();
  Values written(rows.Count(), rows.Columns());
  rows.Write(
    written.data(), written.cols(), -1, [&](Index i, Eigen::Index k) { return data(i, k); },
    SerialFor());
  return written;
}

} // namespace

TEST(Outputs, FurtherOutputsOfAModelStandBesideItsState)
{
  RunInput input(Testing::Icosphere(2));
  SurfaceDiffusion::Run run(SerialFor());
  const WithSquares settings;
  const Values state = StateOf(run, { input.Block() }, settings);
  const std::vector<Output>& outputs = run.GetBlock(0).Outputs;
  ASSERT_GE(outputs.size(), 4U);
  EXPECT_EQ(outputs[0].Name, "Diffused");
  EXPECT_TRUE(outputs[0].IsResult);
  EXPECT_EQ(outputs[1].Name, "Squares");
  EXPECT_EQ(FindNumber(outputs, "EffectiveFidelityWeight"), 0.0);
  EXPECT_NE(FindOutput(outputs, "EffectiveFidelityWeight", Place::Number), nullptr);
  EXPECT_DOUBLE_EQ(FindNumber(outputs, "LargestSquare"), state.array().square().maxCoeff());

  const OutputSource source = SourceOf(run, settings, input.Data.Data.Values);
  const Values u = Written(outputs[0], source);
  const Values squares = Written(outputs[1], source);
  for (Index i = 0; i < static_cast<Index>(u.rows()); ++i)
  {
    EXPECT_EQ(u(i, 0), state(run.GetBlock(0).Surface->VertexOf(i), 0));
    EXPECT_EQ(squares(i, 0), u(i, 0) * u(i, 0));
  }
}

TEST(Outputs, PointsThatTakeNoPartKeepTheDataAndAreZeroInOtherOutputs)
{
  RunInput input(Testing::Icosphere(2));
  const Eigen::Index n = input.Vertices.rows();
  input.Vertices.conservativeResize(n + 1, 3);
  input.Vertices.row(n) << 5.0, 5.0, 5.0; // of no triangle
  input.Data.Data.Values.conservativeResize(n + 1, 1);
  input.Data.Data.Values(n, 0) = 7.25;
  SurfaceDiffusion::Run run(SerialFor());
  const WithSquares settings;
  StateOf(run, { input.Block() }, settings);
  std::vector<Output> outputs = run.GetBlock(0).Outputs;
  OutputSource source = SourceOf(run, settings, input.Data.Data.Values);
  EXPECT_EQ(Written(outputs[0], source)(n, 0), 7.25);
  EXPECT_EQ(Written(outputs[1], source)(n, 0), 0.0);
  outputs[1].Elsewhere = Values::Constant(1, 1, -1.0);
  EXPECT_EQ(Written(outputs[1], source)(n, 0), -1.0);
}

TEST(Outputs, OutputsAtVerticesGoToTheCellsOfDataOnCells)
{
  CellInput input(Testing::Icosphere(2));
  SurfaceDiffusion::Run run(SerialFor());
  WithSquares settings;
  const Values state = StateOf(run, { input.Block() }, settings);
  const SurfaceDiffusion::Run::Block& block = run.GetBlock(0);
  const OutputSource onCells = SourceOf(run, settings, input.Data.Data.Values);
  const Values squares = Written(block.Outputs[1], onCells);
  EXPECT_EQ(squares, block.Cells->Transfer.ToCells(state.array().square()));
  EXPECT_EQ(Written(block.Outputs[0], onCells),
    block.CellResult(input.Data.Data.Values, true, SerialFor())); // with the detail
  settings.ResultOnCells = false;
  const OutputSource onPoints = SourceOf(run, settings, input.Data.Data.Values);
  EXPECT_EQ(Written(block.Outputs[1], onPoints).rows(), input.Vertices.rows());
}

TEST(Outputs, NumbersOfSeveralSurfacesAreCombinedAsTheySay)
{
  const auto list = [](double x, double weight)
  {
    OutputList outputs;
    for (const auto& [name, over] : { std::pair{ "first", Combination::Reported },
           std::pair{ "sum", Combination::Sum }, std::pair{ "largest", Combination::Largest },
           std::pair{ "mean", Combination::Mean }, std::pair{ "common", Combination::Common } })
    {
      outputs.push_back(Output::OfNumber(name, x, over));
      outputs.back().Weight = weight;
    }
    return outputs;
  };
  const OutputList a = list(1.0, 3.0), b = list(5.0, 1.0);
  const auto numbers = CombineNumbers({ &a, &b }, 1);
  EXPECT_EQ(numbers.at("first")(0, 0), 5.0);
  EXPECT_EQ(numbers.at("sum")(0, 0), 6.0);
  EXPECT_EQ(numbers.at("largest")(0, 0), 5.0);
  EXPECT_EQ(numbers.at("mean")(0, 0), 2.0);
  EXPECT_EQ(numbers.at("common")(0, 0), 0.0);
  EXPECT_EQ(CombineNumbers({ &b, &b }, 0).at("common")(0, 0), 5.0);
  const OutputList none = list(0.0, 1.0);
  EXPECT_EQ(CombineNumbers({ &none, &b, &none }, 0).at("common")(0, 0), 5.0);
  EXPECT_EQ(CombineNumbers({ &a, &b, &b }, 0).at("common")(0, 0), 0.0);
  EXPECT_EQ(CombineNumbers({ &a }, 0).at("mean")(0, 0), 1.0);
}
