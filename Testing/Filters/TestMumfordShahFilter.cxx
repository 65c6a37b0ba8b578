// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "FilterTest.h"

#include "vtkCellData.h"
#include "vtkMultiBlockDataSet.h"
#include "vtkMumfordShahFilter.h"

#include <gtest/gtest.h>

using namespace FilterTest;

namespace
{

const double Height = 0.5;
const double Circle = 2.0 * vtkMath::Pi() * std::sqrt(1.0 - Height * Height);

/// The unit sphere with the data "f": low below z = Height, high above, and rough noise.
vtkSmartPointer<vtkPolyData> SphereWithCap(
  int levels, double low, double high, double noise, int type = VTK_DOUBLE)
{
  auto sphere = Sphere(levels);
  AddPointArray(
    sphere, "f", 1,
    [&](vtkIdType i, int k)
    { return (sphere->GetPoint(i)[2] > Height ? high : low) + noise * Rough(i, k); },
    type);
  sphere->GetPointData()->SetActiveScalars("f");
  return sphere;
}

vtkSmartPointer<vtkMumfordShahFilter> MakeFilter(vtkDataObject* data)
{
  auto filter = vtkSmartPointer<vtkMumfordShahFilter>::New();
  filter->SetInputDataObject(data);
  return filter;
}

vtkPolyData* Curves(vtkAlgorithm* filter)
{
  return vtkPolyData::SafeDownCast(filter->GetOutputDataObject(2));
}

} // namespace

TEST(MumfordShahFilter, GivesTheResultItsEdgesTheHistoryAndOneCurve)
{
  for (const int levels : { 5, 6 })
  {
    const auto sphere = SphereWithCap(levels, 3.0, 7.0, 0.2);
    const auto filter = MakeFilter(sphere);
    Messages messages(filter);
    filter->Update();
    EXPECT_TRUE(messages.Errors.empty() && messages.Warnings.empty());
    vtkPolyData* const output = filter->GetOutput();
    ASSERT_EQ(output->GetPointData()->GetScalars(), Result(filter, "fMumfordShah"));
    vtkDataArray* const edges = Result(filter, "Edges");
    ASSERT_TRUE(edges);
    EXPECT_GE(edges->GetRange()[0], 0.0);
    EXPECT_LE(edges->GetRange()[1], 1.0);
    EXPECT_GT(edges->GetRange()[1], 0.95);
    for (vtkIdType i = 0; i < sphere->GetNumberOfPoints(); ++i)
    {
      const double z = sphere->GetPoint(i)[2];
      const double u = Result(filter, "fMumfordShah")->GetComponent(i, 0);
      if (std::abs(z - Height) > 3.0 * filter->GetMeanEdgeLength())
      {
        ASSERT_NEAR(u, z > Height ? 7.0 : 3.0, 0.2);
      }
    }
    vtkPolyData* const curves = Curves(filter);
    ASSERT_EQ(curves->GetNumberOfLines(), 1);
    EXPECT_NEAR(filter->GetEdgeLength(), Circle, 0.01 * Circle);
    EXPECT_EQ(
      curves->GetCellData()->GetArray("Length")->GetComponent(0, 0), filter->GetEdgeLength());
    EXPECT_GT(curves->GetPointData()->GetArray("Edges")->GetRange()[0], 0.9);
    vtkNew<vtkIdList> line;
    curves->GetCellPoints(0, line);
    EXPECT_EQ(line->GetId(0), line->GetId(line->GetNumberOfIds() - 1)); // closed
    EXPECT_EQ(line->GetNumberOfIds(), curves->GetNumberOfPoints() + 1);
    const vtkIdType rows = History(filter)->GetNumberOfRows();
    EXPECT_GT(rows, 6);
    EXPECT_LT(rows, 100);
    EXPECT_NEAR(
      HistoryAt(filter, rows - 1, "Total_0") / HistoryAt(filter, 0, "Total_0"), 1.0, 1e-12);
  }
}

TEST(MumfordShahFilter, NaturalUnitsAreThoseOfTheMeshAndTheData)
{
  const auto sphere = SphereWithCap(4, 3.0, 7.0, 0.1);
  const auto natural = MakeFilter(sphere);
  natural->AutomaticThresholdOff();
  natural->Update();
  const auto absolute = MakeFilter(sphere);
  absolute->SetUnitsToAbsolute();
  absolute->AutomaticThresholdOff();
  absolute->SetSmoothingLength(8.0 * natural->GetMeanEdgeLength());
  absolute->SetEdgeWidth(2.0 * natural->GetMeanEdgeLength());
  absolute->SetEdgeThreshold(0.2 * natural->GetValueRange());
  absolute->Update();
  EXPECT_LT(LargestDifference(Result(natural, "Edges"), Result(absolute, "Edges")), 1e-9);
  EXPECT_EQ(natural->GetEffectiveEdgeThreshold(), 0.2);
  EXPECT_EQ(natural->GetEffectiveSmoothingLength(), 8.0);
  natural->AutomaticThresholdOn();
  natural->Update();
  absolute->AutomaticThresholdOn();
  absolute->SetSmoothingLength(8.0); // the default, which is ignored
  absolute->SetEdgeThreshold(0.2);
  absolute->Update();
  EXPECT_LT(LargestDifference(Result(natural, "Edges"), Result(absolute, "Edges")), 1e-9);
  EXPECT_NEAR(absolute->GetEffectiveEdgeThreshold(),
    natural->GetEffectiveEdgeThreshold() * natural->GetValueRange(), 1e-9);
  EXPECT_NEAR(absolute->GetEffectiveSmoothingLength(),
    natural->GetEffectiveSmoothingLength() * natural->GetMeanEdgeLength(), 1e-9);
  EXPECT_EQ(absolute->GetEstimatedNoiseLevel(), natural->GetEstimatedNoiseLevel());
  EXPECT_EQ(natural->GetTimeUnit(), 1.0);
  EXPECT_EQ(absolute->GetTimeUnit(), 1.0);
}

TEST(MumfordShahFilter, ColorsShareTheirEdgesAndKeepTheirTypeAndAlpha)
{
  auto sphere = Sphere(6);
  AddPointArray(
    sphere, "rgba", 4,
    [&](vtkIdType i, int k)
    {
      const double* p = sphere->GetPoint(i);
      const bool inside = k == 0 ? p[2] > Height : p[0] > Height;
      return k == 3 ? i % 256 : inside ? 220.0 : 30.0;
    },
    VTK_UNSIGNED_CHAR);
  sphere->GetPointData()->SetActiveScalars("rgba");
  const auto filter = MakeFilter(sphere);
  filter->Update();
  vtkDataArray* const u = Result(filter, "rgbaMumfordShah");
  ASSERT_TRUE(u);
  EXPECT_EQ(u->GetDataType(), VTK_UNSIGNED_CHAR);
  for (vtkIdType i = 0; i < u->GetNumberOfTuples(); ++i)
  {
    ASSERT_EQ(u->GetComponent(i, 3), i % 256);
  }
  EXPECT_EQ(Result(filter, "Edges")->GetDataType(), VTK_DOUBLE);
  EXPECT_EQ(Result(filter, "Edges")->GetNumberOfComponents(), 1);
  EXPECT_NEAR(filter->GetEdgeLength(), 2.0 * Circle, 0.05 * Circle);
}

TEST(MumfordShahFilter, NoiseAboveTheThresholdIsReported)
{
  const auto sphere = SphereWithCap(4, 0.0, 0.0, 1.0); // of range 2, sigma 0.58
  const auto filter = MakeFilter(sphere);
  filter->AutomaticThresholdOff();
  Messages messages(filter);
  filter->Update();
  ASSERT_EQ(messages.Warnings.size(), 1u);
  EXPECT_NE(
    messages.Warnings[0].find("the noise is above a third of EdgeThreshold"), std::string::npos);
  filter->SetEdgeThreshold(1.5);
  filter->Update();
  EXPECT_EQ(messages.Warnings.size(), 1u);
  EXPECT_EQ(Curves(filter)->GetNumberOfLines(), 0);
  filter->SetEdgeThreshold(0.2);
  filter->SetEdgeWidth(0.5);
  filter->Update();
  EXPECT_NE(
    messages.Warnings.back().find("EdgeWidth is below the mean edge length"), std::string::npos);
}

TEST(MumfordShahFilter, PropertiesAreCheckedAndLeaveNoCurves)
{
  const auto sphere = SphereWithCap(3, 0.0, 1.0, 0.0);
  const auto filter = MakeFilter(sphere);
  filter->AutomaticThresholdOff();
  filter->Update();
  EXPECT_EQ(Curves(filter)->GetNumberOfLines(), 1);
  using Set = void (vtkMumfordShahFilter::*)(double);
  const std::vector<std::pair<const char*, Set>> setters = {
    { "SmoothingLength", &vtkMumfordShahFilter::SetSmoothingLength },
    { "EdgeThreshold", &vtkMumfordShahFilter::SetEdgeThreshold },
    { "EdgeWidth", &vtkMumfordShahFilter::SetEdgeWidth },
    { "StopTolerance", &vtkMumfordShahFilter::SetStopTolerance },
  };
  for (const auto& [name, set] : setters)
  {
    for (const double bad : { 0.0, -1.0, vtkMath::Nan() })
    {
      const auto wrong = MakeFilter(sphere);
      (wrong.Get()->*set)(bad);
      Messages messages(wrong);
      wrong->Update();
      ASSERT_EQ(messages.Errors.size(), 1u) << name << bad;
      EXPECT_NE(messages.Errors[0].find(name), std::string::npos);
      EXPECT_FALSE(Result(wrong, "fMumfordShah"));
      EXPECT_EQ(Curves(wrong)->GetNumberOfCells(), 0);
    }
  }
  filter->SetEdgeWidth(-1.0);
  Messages messages(filter);
  filter->Update();
  EXPECT_EQ(messages.Errors.size(), 1u);
  EXPECT_EQ(Curves(filter)->GetNumberOfCells(), 0);
}

TEST(MumfordShahFilter, EdgeCurvesAreOptionalAndNeedNoNewSteps)
{
  const auto filter = MakeFilter(SphereWithCap(4, 0.0, 1.0, 0.0));
  filter->EdgeCurvesOff();
  filter->Update();
  EXPECT_EQ(Curves(filter)->GetNumberOfCells(), 0);
  EXPECT_EQ(filter->GetEdgeLength(), 0.0);
  const vtkIdType steps = filter->GetNumberOfStepsComputed();
  filter->EdgeCurvesOn();
  filter->Update();
  EXPECT_EQ(Curves(filter)->GetNumberOfCells(), 1);
  EXPECT_EQ(filter->GetNumberOfStepsComputed(), steps);
}

TEST(MumfordShahFilter, BlocksShareUnitsAndTheOutputOfCurves)
{
  vtkNew<vtkMultiBlockDataSet> blocks;
  blocks->SetBlock(0, SphereWithCap(5, 0.0, 1.0, 0.0));
  blocks->SetBlock(1, SphereWithCap(5, 0.5, 1.5, 0.0));
  const auto filter = MakeFilter(blocks);
  filter->Update();
  EXPECT_EQ(Curves(filter)->GetNumberOfLines(), 2);
  EXPECT_NEAR(filter->GetEdgeLength(), 2.0 * Circle, 0.02 * Circle);
  vtkDataArray* const block = Curves(filter)->GetCellData()->GetArray("Block");
  ASSERT_NE(block, nullptr);
  EXPECT_EQ(block->GetComponent(0, 0), 0.0);
  EXPECT_EQ(block->GetComponent(1, 0), 1.0);
}

TEST(MumfordShahFilter, MaskedPointsAreFilledWithEdgesOrKeptOut)
{
  auto sphere = SphereWithCap(5, 0.0, 1.0, 0.0);
  AddPointArray(sphere, "mask", 1,
    [&](vtkIdType i, int)
    {
      const double* p = sphere->GetPoint(i);
      return std::hypot(p[0] - 0.866, p[1], p[2] - Height) < 0.2;
    });
  auto damaged = vtkSmartPointer<vtkPolyData>::New();
  damaged->ShallowCopy(sphere);
  AddPointArray(damaged, "f", 1,
    [&](vtkIdType i, int)
    {
      return sphere->GetPointData()->GetArray("mask")->GetComponent(i, 0) != 0.0
        ? 100.0
        : sphere->GetPointData()->GetArray("f")->GetComponent(i, 0);
    });
  damaged->GetPointData()->SetActiveScalars("f");
  const auto filter = MakeFilter(damaged);
  SetInputArray(filter, 1, "mask");
  filter->Update();
  ASSERT_EQ(Curves(filter)->GetNumberOfLines(), 1);
  EXPECT_NEAR(filter->GetEdgeLength(), Circle, 0.02 * Circle);
  EXPECT_LT(Result(filter, "fMumfordShah")->GetRange()[1], 1.05);
  filter->SetMaskModeToExclude();
  filter->Update();
  EXPECT_EQ(Curves(filter)->GetNumberOfLines(), 1);
  EXPECT_NEAR(filter->GetEdgeLength(), Circle - 0.4, 0.05 * Circle);
  EXPECT_EQ(Result(filter, "fMumfordShah")->GetRange()[1], 100.0);
}

TEST(MumfordShahFilter, AutomaticThresholdIgnoresGivenOnesAndServesEachBlock)
{
  const auto sphere = SphereWithCap(5, 0.0, 1.0, 0.1);
  const auto alone = MakeFilter(sphere);
  alone->Update();
  EXPECT_NEAR(alone->GetEffectiveEdgeThreshold(), 0.12, 0.01); // of the range with noise
  EXPECT_NEAR(alone->GetEstimatedNoiseLevel(), 0.07, 0.02);
  vtkNew<vtkMultiBlockDataSet> blocks;
  blocks->SetBlock(0, sphere);
  blocks->SetBlock(1, SphereWithCap(5, 0.0, 100.0, 10.0));
  const auto both = MakeFilter(blocks);
  both->Update();
  EXPECT_EQ(Curves(both)->GetNumberOfLines(), 2);
  EXPECT_NEAR(both->GetEdgeLength(), 2.0 * Circle, 0.02 * Circle);
  const auto given = MakeFilter(sphere);
  given->SetEdgeThreshold(0.7);
  Messages messages(given);
  given->Update();
  ASSERT_EQ(messages.Warnings.size(), 1u);
  EXPECT_NE(messages.Warnings[0].find("EdgeThreshold is 0.7 but AutomaticThreshold finds it"),
    std::string::npos);
  EXPECT_TRUE(Identical(Result(given, "Edges"), Result(alone, "Edges")));
}
