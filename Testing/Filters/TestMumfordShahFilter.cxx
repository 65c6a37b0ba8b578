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
