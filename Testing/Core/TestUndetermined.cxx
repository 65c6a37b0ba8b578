// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "CellRun.h"
#include "RunInput.h"

#include "Run/HarmonicMapSettings.h"
#include "Run/HeatSettings.h"
#include "Run/MumfordShahSettings.h"
#include "Run/SegmentationSettings.h"
#include "Run/TensorDiffusionSettings.h"
#include "Run/TotalVariationSettings.h"

#include <gtest/gtest.h>

#include <limits>
#include <memory>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

// Connected components without a known value take no part: the other components have the result
// that they have alone.

namespace SurfaceDiffusion
{

namespace
{

using Testing::Alone;
using Testing::RunInput;

constexpr double NaN = std::numeric_limits<double>::quiet_NaN();

Testing::Surface FirstSphere()
{
  return Testing::Icosphere(3);
}

/// Another size, and coarser in coordinates and in its number of triangles.
Testing::Surface SecondSphere()
{
  return Testing::Moved(Testing::Icosphere(2, 2.5), { 5.0, 0.0, 0.0 });
}

/// A step and noise on two spheres, with `columns` columns.
RunInput TwoSpheres(Eigen::Index columns = 1)
{
  RunInput input(Testing::Joined(FirstSphere(), SecondSphere()));
  input.Data.Data.Values.resize(input.Vertices.rows(), columns);
  for (Eigen::Index i = 0; i < input.Vertices.rows(); ++i)
  {
    for (Eigen::Index k = 0; k < columns; ++k)
    {
      input.Data.Data.Values(i, k) =
        100.0 + (input.Vertices(i, 2) > 0.2 ? 1.0 : 0.0) + 0.1 * std::cos(37.0 * (3.0 * i + k));
    }
  }
  return input;
}

Index SizeOfFirst()
{
  return FirstSphere().NumberOfVertices();
}

/// The first sphere of `both`, alone.
RunInput First(const RunInput& both)
{
  RunInput input(FirstSphere());
  input.Data = both.Data;
  input.Data.Data.Values = both.Data.Data.Values.topRows(SizeOfFirst()).eval();
  if (!both.Data.Mask.Values.empty())
  {
    input.Data.Mask.Values.resize(static_cast<std::size_t>(SizeOfFirst()));
  }
  return input;
}

/// One row per input point, NaN where nothing determines a value.
Values AtPoints(const SurfaceDiffusion::Run::Block& block)
{
  const Values& u = block.Path->State();
  Values ofPoints = Values::Constant(block.Surface->Points().rows(), u.cols(), NaN);
  for (Index i = 0; i < static_cast<Index>(ofPoints.rows()); ++i)
  {
    const Index v = block.Surface->VertexOf(i);
    EXPECT_EQ(v < 0, block.Surface->IsUndetermined(i));
    if (v >= 0)
    {
      ofPoints.row(i) = u.row(v);
    }
  }
  return ofPoints;
}

std::vector<std::string> Update(SurfaceDiffusion::Run& run, const std::vector<BlockInput>& inputs,
  const std::shared_ptr<RunSettings>& settings)
{
  run.Update(inputs, settings, Alone, ProgressMonitor());
  run.Seek(settings->DescribeModel().NumberOfSteps, ProgressMonitor());
  std::vector<std::string> sentences;
  for (const Warning& warning : run.FindWarnings(Alone))
  {
    sentences.push_back(warning.Sentence.Text());
  }
  return sentences;
}

int Count(const std::vector<std::string>& sentences, const std::string& part)
{
  int count = 0;
  for (const std::string& sentence : sentences)
  {
    count += sentence.find(part) != std::string::npos;
  }
  return count;
}

/// The first sphere has the result that it has alone, and the second one none.
void ExpectFirstAsAlone(const RunInput& both, const std::shared_ptr<RunSettings>& settings,
  double tolerance, const std::string& what)
{
  SurfaceDiffusion::Run run(SerialFor());
  const std::vector<std::string> warnings = Update(run, { both.Block() }, settings);
  EXPECT_EQ(Count(warnings, "1 connected component has no known value"), 1) << what;
  const RunInput first = First(both);
  SurfaceDiffusion::Run alone(SerialFor());
  EXPECT_EQ(Count(Update(alone, { first.Block() }, settings), "no known value"), 0) << what;
  const Values u = AtPoints(run.GetBlock(0));
  const Values expected = AtPoints(alone.GetBlock(0));
  EXPECT_LE((u.topRows(SizeOfFirst()) - expected).cwiseAbs().maxCoeff(), tolerance) << what;
  EXPECT_TRUE(u.bottomRows(u.rows() - SizeOfFirst()).array().isNaN().all()) << what;
}

template <typename ModelSettings, typename Change>
std::shared_ptr<RunSettings> Make(const Change& change)
{
  auto settings = std::make_shared<ModelSettings>();
  if constexpr (std::is_base_of_v<TimeSettings, ModelSettings>)
  {
    settings->NumberOfTimeSteps = 3;
  }
  change(*settings);
  return settings;
}

std::vector<std::pair<std::string, std::shared_ptr<RunSettings>>> AllModels()
{
  const double width = 0.4;
  return {
    { "heat", Make<HeatSettings>([](HeatSettings&) {}) },
    { "steady heat",
      Make<HeatSettings>(
        [](HeatSettings& s)
        {
          s.Mode = HeatMode::SteadyState;
          s.FidelityWeight = 1.0;
        }) },
    { "deblurring",
      Make<HeatSettings>(
        [&](HeatSettings& s)
        {
          s.Mode = HeatMode::SteadyState;
          s.FidelityWeight = 10.0;
          s.Blur.FWHM = width;
        }) },
    { "automatic heat",
      Make<HeatSettings>(
        [](HeatSettings& s)
        {
          s.Mode = HeatMode::SteadyState;
          s.AutomaticFidelity = true;
        }) },
    { "TV", Make<TotalVariationSettings>([](TotalVariationSettings&) {}) },
    { "steady TV",
      Make<TotalVariationSettings>(
        [](TotalVariationSettings& s) { s.Mode = TotalVariationMode::SteadyState; }) },
    { "implicit TV",
      Make<TotalVariationSettings>(
        [](TotalVariationSettings& s) { s.TimeIntegrator = TimeIntegrator::Implicit; }) },
    { "TV-L1",
      Make<TotalVariationSettings>(
        [](TotalVariationSettings& s)
        {
          s.Mode = TotalVariationMode::SteadyState;
          s.FidelityNorm = FidelityNorm::L1;
        }) },
    { "TV deblurring",
      Make<TotalVariationSettings>(
        [&](TotalVariationSettings& s)
        {
          s.Mode = TotalVariationMode::SteadyState;
          s.Blur.FWHM = width;
        }) },
    { "Crouzeix-Raviart",
      Make<TotalVariationSettings>(
        [](TotalVariationSettings& s) { s.Discretization = Discretization::CrouzeixRaviart; }) },
    { "Mumford-Shah",
      Make<MumfordShahSettings>(
        [](MumfordShahSettings& s)
        {
          s.FidelityWeight = 1.0;
          s.NumberOfTimeSteps = 100;
        }) },
    { "Beltrami", Make<TensorDiffusionSettings>([](TensorDiffusionSettings&) {}) },
    { "coherence",
      Make<TensorDiffusionSettings>(
        [](TensorDiffusionSettings& s) { s.Model = TensorModel::CoherenceEnhancing; }) },
    { "segmentation", Make<SegmentationSettings>([](SegmentationSettings&) {}) },
  };
}

} // namespace

TEST(Undetermined, ComponentsTakeNoPartInAnyModel)
{
  RunInput input = TwoSpheres();
  input.Data.Data.Values.bottomRows(input.Vertices.rows() - SizeOfFirst()).setConstant(NaN);
  for (const auto& [name, settings] : AllModels())
  {
    ExpectFirstAsAlone(input, settings, name == "segmentation" ? 1e-3 : 2e-3, name);
  }
}

TEST(Undetermined, MaskedValuesAreUnknown)
{
  RunInput input = TwoSpheres();
  input.Data.Mask.Values.assign(static_cast<std::size_t>(input.Vertices.rows()), 1);
  std::fill_n(input.Data.Mask.Values.begin(), SizeOfFirst(), char{ 0 });
  input.Data.Mask.Values[3] = 1;
  for (const InitialFill fill :
    { InitialFill::Input, InitialFill::Mean, InitialFill::Noise, InitialFill::Harmonic })
  {
    const auto settings = Make<HeatSettings>([&](HeatSettings& s) { s.InitialFill = fill; });
    ExpectFirstAsAlone(input, settings, 1e-8, "fill " + std::to_string(static_cast<int>(fill)));
  }
}

TEST(Undetermined, ChannelsWithoutAKnownValueMakeAComponentUndetermined)
{
  RunInput input = TwoSpheres(3);
  input.Data.Data.Values.col(1).tail(input.Vertices.rows() - SizeOfFirst()).setConstant(NaN);
  for (const auto& [name, settings] : AllModels())
  {
    if (name == "heat" || name == "steady TV" || name == "Beltrami" || name == "segmentation")
    {
      ExpectFirstAsAlone(input, settings, 2e-3, name);
    }
  }
}

TEST(Undetermined, VectorsWithoutDirectionsAreUnknown)
{
  RunInput input = TwoSpheres(3);
  input.Data.Data.Values = input.Vertices;
  input.Data.Data.Values.bottomRows(input.Vertices.rows() - SizeOfFirst()).setZero();
  ExpectFirstAsAlone(
    input, Make<HarmonicMapSettings>([](HarmonicMapSettings&) {}), 1e-6, "zero vectors");
  input.Data.Data.Values.bottomRows(1).setConstant(NaN);
  ExpectFirstAsAlone(input,
    Make<HarmonicMapSettings>([](HarmonicMapSettings& s) { s.LineField = true; }), 1e-6, "lines");
}

TEST(Undetermined, FixedAndSeededPointsDetermineTheirComponent)
{
  RunInput input = TwoSpheres();
  const auto n = static_cast<std::size_t>(input.Vertices.rows());
  input.Data.Mask.Values.assign(n, 1);
  std::fill_n(input.Data.Mask.Values.begin(), SizeOfFirst(), char{ 0 });
  input.Data.Fixed.Values.assign(n, 0);
  input.Data.Fixed.Values.back() = 1;
  const auto heat = Make<HeatSettings>([](HeatSettings& s) { s.Mode = HeatMode::SteadyState; });
  SurfaceDiffusion::Run run(SerialFor());
  EXPECT_EQ(Count(Update(run, { input.Block() }, heat), "no known value"), 0);
  EXPECT_NEAR(AtPoints(run.GetBlock(0))(SizeOfFirst(), 0), input.Data.Data.Values(n - 1, 0), 1e-6);

  input.Data.Fixed.Values.clear();
  input.Data.Seeds.Values.assign(n, 0);
  input.Data.Seeds.Values.back() = 2;
  SurfaceDiffusion::Run segmentation(SerialFor());
  const auto regions = Make<SegmentationSettings>([](SegmentationSettings&) {});
  EXPECT_EQ(Count(Update(segmentation, { input.Block() }, regions), "no known value"), 0);
  EXPECT_GT(AtPoints(segmentation.GetBlock(0))(SizeOfFirst(), 1), 0.99);
}

TEST(Undetermined, DataWithoutAnyKnownValueAreAnError)
{
  for (const auto& [name, settings] : AllModels())
  {
    RunInput input = TwoSpheres();
    input.Data.Data.Values.setConstant(NaN);
    SurfaceDiffusion::Run run(SerialFor());
    EXPECT_THROW(
      try {
        Update(run, { input.Block(), input.Block() }, settings);
      } catch (const std::runtime_error& error) {
        EXPECT_NE(
          std::string(error.what()).find("InputArray has no known value"), std::string::npos);
        throw;
      },
      std::runtime_error)
      << name;
  }
}

TEST(Undetermined, BlocksWithoutAKnownValueAreCountedWithTheOthers)
{
  RunInput known = TwoSpheres();
  known.Data.Data.Values.bottomRows(known.Vertices.rows() - SizeOfFirst()).setConstant(NaN);
  RunInput unknown = TwoSpheres();
  unknown.Data.Data.Values.setConstant(NaN);
  for (const auto& [name, settings] : AllModels())
  {
    SurfaceDiffusion::Run run(SerialFor());
    const std::vector<std::string> warnings =
      Update(run, { unknown.Block(), known.Block() }, settings);
    EXPECT_EQ(Count(warnings, "3 connected components have no known value"), 1) << name;
    EXPECT_TRUE(AtPoints(run.GetBlock(0)).array().isNaN().all()) << name;
    const Values u = AtPoints(run.GetBlock(1));
    EXPECT_FALSE(u.topRows(SizeOfFirst()).hasNaN()) << name;
    const RunInput first = First(known);
    SurfaceDiffusion::Run alone(SerialFor());
    Update(alone, { first.Block() }, settings);
    EXPECT_EQ(run.Units().MeanEdgeLength, alone.Units().MeanEdgeLength) << name;
    EXPECT_EQ(run.Units().ValueRange, alone.Units().ValueRange) << name;
  }
}

TEST(Undetermined, LaterDataAreThoseOfANewRun)
{
  const RunInput known = TwoSpheres();
  RunInput second = known;
  second.Data.Data.Values.bottomRows(known.Vertices.rows() - SizeOfFirst()).setConstant(NaN);
  RunInput first = known;
  first.Data.Data.Values.topRows(SizeOfFirst()).setConstant(NaN);
  const auto settings = Make<HeatSettings>([](HeatSettings&) {});
  SurfaceDiffusion::Run run(SerialFor());
  const std::vector<const RunInput*> inputs = { &known, &second, &second, &first, &known, &first };
  for (const RunInput* const input : inputs)
  {
    const std::vector<std::string> warnings = Update(run, { input->Block() }, settings);
    EXPECT_EQ(Count(warnings, "no known value"), input == &known ? 0 : 1);
    SurfaceDiffusion::Run fresh(SerialFor());
    Update(fresh, { input->Block() }, settings);
    const Values u = AtPoints(run.GetBlock(0));
    const Values expected = AtPoints(fresh.GetBlock(0));
    EXPECT_TRUE(((u.array() == expected.array()) || u.array().isNaN()).all());
    EXPECT_TRUE((u.array().isNaN() == expected.array().isNaN()).all());
  }
}

TEST(Undetermined, SurfacesAreNotMadeAgainForDataWithTheSameUnknownComponents)
{
  RunInput input = TwoSpheres();
  input.Data.Data.Values.bottomRows(input.Vertices.rows() - SizeOfFirst()).setConstant(NaN);
  const auto settings = Make<HeatSettings>([](HeatSettings&) {});
  SurfaceDiffusion::Run run(SerialFor());
  Update(run, { input.Block() }, settings);
  const Surface* const made = run.GetBlock(0).Surface.get();
  input.Data.Data.Values *= 2.0;
  Update(run, { input.Block() }, settings);
  EXPECT_EQ(run.GetBlock(0).Surface.get(), made);
}

TEST(Undetermined, CellsWithoutAKnownValueTakeNoPart)
{
  Testing::CellInput input(Testing::Joined(FirstSphere(), SecondSphere()));
  const Index ofFirst = FirstSphere().NumberOfTriangles();
  input.Data.Data.Values.bottomRows(input.Data.NumberOfCells - ofFirst).setConstant(NaN);
  for (const auto& [name, settings] : AllModels())
  {
    SurfaceDiffusion::Run run(SerialFor());
    const std::vector<std::string> warnings = Update(run, { input.Block() }, settings);
    EXPECT_EQ(Count(warnings, "1 connected component has no known value"), 1) << name;
    const CellState& cells = *run.GetBlock(0).Cells;
    for (Index c = 0; c < input.Data.NumberOfCells; ++c)
    {
      EXPECT_EQ(cells.IsUndetermined(c), c >= ofFirst) << name;
      EXPECT_EQ(cells.Transfer.Participates(c), c < ofFirst) << name;
    }
  }
}

TEST(Undetermined, HoldingKnownValuesIsNoErrorWhereComponentsAreUnknown)
{
  RunInput input = TwoSpheres();
  input.Data.Data.Values.bottomRows(input.Vertices.rows() - SizeOfFirst()).setConstant(NaN);
  const auto settings = Make<HeatSettings>([](HeatSettings& s) { s.HoldKnownValues = true; });
  SurfaceDiffusion::Run run(SerialFor());
  EXPECT_EQ(Count(Update(run, { input.Block() }, settings), "no known value"), 1);
  EXPECT_EQ(AtPoints(run.GetBlock(0))(5, 0), input.Data.Data.Values(5, 0));
}

} // namespace SurfaceDiffusion
