// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "FilterTest.h"

#include "vtkCellData.h"
#include "vtkFVMHeatFilter.h"
#include "vtkIntArray.h"
#include "vtkIntrinsicTVFilter.h"
#include "vtkMultiBlockDataSet.h"
#include "vtkSurfaceSegmentationFilter.h"
#include "vtkTensorDiffusionFilter.h"
#include "vtkUnsignedCharArray.h"

#include <gtest/gtest.h>

using namespace FilterTest;

// Components without a known value: NaN or the input, label 0, and one warning.

namespace
{

constexpr vtkIdType Half = 66; ///< points of one sphere
constexpr vtkIdType HalfOfCells = 128;

/// Two spheres in one surface.
vtkSmartPointer<vtkPolyData> TwoSpheres()
{
  auto both = Sphere(2);
  EXPECT_EQ(both->GetNumberOfPoints(), Half);
  EXPECT_EQ(both->GetNumberOfCells(), HalfOfCells);
  const auto second = Sphere(2);
  for (vtkIdType i = 0; i < Half; ++i)
  {
    double x[3];
    second->GetPoint(i, x);
    both->GetPoints()->InsertNextPoint(5.0 + 2.0 * x[0], 2.0 * x[1], 2.0 * x[2]);
  }
  vtkNew<vtkIdList> corners;
  for (vtkIdType c = 0; c < HalfOfCells; ++c)
  {
    second->GetCellPoints(c, corners);
    both->GetPolys()->InsertNextCell(
      { Half + corners->GetId(0), Half + corners->GetId(1), Half + corners->GetId(2) });
  }
  return both;
}

/// A step, of which the second sphere has only NaN, or `below` under the mask "mask".
template <typename Array>
void AddStep(vtkPolyData* surface, bool onCells, double below)
{
  const vtkIdType count = onCells ? surface->GetNumberOfCells() : surface->GetNumberOfPoints();
  vtkNew<Array> data;
  data->SetName("f");
  vtkNew<vtkIntArray> mask;
  mask->SetName("mask");
  for (vtkIdType i = 0; i < count; ++i)
  {
    vtkIdType point = i;
    if (onCells)
    {
      vtkNew<vtkIdList> corners;
      surface->GetCellPoints(i, corners);
      point = corners->GetId(0);
    }
    const double step = surface->GetPoint(point)[2] > 0.1 ? 150.0 : 100.0;
    data->InsertNextTuple1(i < count / 2 ? step : below);
    mask->InsertNextTuple1(i < count / 2 ? 0.0 : 1.0);
  }
  vtkDataSetAttributes* attributes = surface->GetPointData();
  if (onCells)
  {
    attributes = surface->GetCellData();
  }
  attributes->SetScalars(data);
  attributes->AddArray(mask);
}

void ExpectNaNOnSecondOnly(vtkDataArray* result)
{
  ASSERT_NE(result, nullptr);
  const vtkIdType count = result->GetNumberOfTuples();
  for (vtkIdType i = 0; i < count; ++i)
  {
    EXPECT_EQ(std::isnan(result->GetComponent(i, 0)), i >= count / 2) << i;
  }
}

template <typename Filter>
void ExpectNaNOf(const char* name)
{
  for (const bool onCells : { false, true })
  {
    for (const bool masked : { false, true })
    {
      const auto surface = TwoSpheres();
      AddStep<vtkDoubleArray>(surface, onCells, masked ? 7.0 : std::nan(""));
      vtkNew<Filter> filter;
      filter->SetInputData(surface);
      if (masked)
      {
        SetInputArray(filter, 1, "mask", onCells);
      }
      const Messages messages(filter);
      filter->Update();
      EXPECT_TRUE(messages.Errors.empty());
      EXPECT_EQ(messages.Warnings.size(), 1u) << name << onCells << masked;
      EXPECT_NE(messages.Warnings.at(0).find("1 connected component has no known value"),
        std::string::npos);
      vtkPolyData* const output = filter->GetOutput();
      ExpectNaNOnSecondOnly(
        onCells ? output->GetCellData()->GetArray(name) : output->GetPointData()->GetArray(name));
    }
  }
}

} // namespace

TEST(Undetermined, FloatingPointResultsAreNaN)
{
  ExpectNaNOf<vtkFVMHeatFilter>("fDiffused");
  ExpectNaNOf<vtkIntrinsicTVFilter>("fTV");
  ExpectNaNOf<vtkTensorDiffusionFilter>("fBeltrami");
}

TEST(Undetermined, ResultsOnPointsOfDataOnCellsAreNaN)
{
  const auto surface = TwoSpheres();
  AddStep<vtkDoubleArray>(surface, true, std::nan(""));
  vtkNew<vtkFVMHeatFilter> filter;
  filter->SetInputData(surface);
  filter->ResultOnCellsOff();
  filter->Update();
  ExpectNaNOnSecondOnly(Result(filter));
}

TEST(Undetermined, IntegersKeepTheInput)
{
  for (const bool onCells : { false, true })
  {
    for (const bool bytes : { false, true })
    {
      const auto surface = TwoSpheres();
      (bytes ? AddStep<vtkUnsignedCharArray> : AddStep<vtkIntArray>)(surface, onCells, 7.0);
      vtkNew<vtkFVMHeatFilter> filter;
      filter->SetInputData(surface);
      SetInputArray(filter, 1, "mask", onCells);
      filter->Update();
      vtkDataArray* const u = onCells ? filter->GetOutput()->GetCellData()->GetScalars()
                                      : filter->GetOutput()->GetPointData()->GetScalars();
      EXPECT_EQ(u->GetDataType(), bytes ? VTK_UNSIGNED_CHAR : VTK_DOUBLE);
      for (vtkIdType i = 0; i < u->GetNumberOfTuples(); ++i)
      {
        EXPECT_EQ(u->GetComponent(i, 0) == 7.0, i >= u->GetNumberOfTuples() / 2) << i;
      }
    }
  }
}

TEST(Undetermined, RegionsAreNoneAndHaveNoBoundary)
{
  for (const bool onCells : { false, true })
  {
    const auto surface = TwoSpheres();
    AddStep<vtkDoubleArray>(surface, onCells, std::nan(""));
    for (const int regions : { 2, 4 })
    {
      vtkNew<vtkSurfaceSegmentationFilter> filter;
      filter->SetInputData(surface);
      filter->SetNumberOfRegions(regions);
      filter->AutomaticFidelityOff(); // the sphere has too few points for its weight
      filter->SetFidelityWeight(5.0);
      filter->Update();
      vtkDataSetAttributes* attributes = filter->GetOutput()->GetPointData();
      if (onCells)
      {
        attributes = filter->GetOutput()->GetCellData();
      }
      vtkDataArray* const labels = attributes->GetArray("RegionId");
      vtkDataArray* const probabilities = attributes->GetArray("RegionProbability");
      const vtkIdType count = labels->GetNumberOfTuples();
      for (vtkIdType i = 0; i < count; ++i)
      {
        EXPECT_EQ(labels->GetComponent(i, 0) == 0.0, i >= count / 2);
        for (int k = 0; i >= count / 2 && k < regions; ++k)
        {
          EXPECT_EQ(probabilities->GetComponent(i, k), 0.0);
        }
      }
      auto* const curves = vtkPolyData::SafeDownCast(filter->GetOutputDataObject(2));
      ASSERT_NE(curves, nullptr);
      EXPECT_GT(curves->GetNumberOfPoints(), 0);
      EXPECT_LT(curves->GetBounds()[1], 1.5) << "a curve on the second sphere";
    }
  }
}

TEST(Undetermined, ABlockOfThemLeavesTheOthersAsTheyAre)
{
  const auto known = Sphere(2);
  AddStep<vtkDoubleArray>(known, false, 3.0);
  const auto unknown = Sphere(2);
  AddStep<vtkDoubleArray>(unknown, false, 3.0);
  unknown->GetPointData()->GetScalars()->Fill(std::nan(""));
  vtkNew<vtkMultiBlockDataSet> blocks;
  blocks->SetBlock(0, unknown);
  blocks->SetBlock(1, known);
  vtkNew<vtkSurfaceSegmentationFilter> both;
  both->SetInputData(blocks);
  const Messages messages(both);
  both->Update();
  EXPECT_TRUE(messages.Errors.empty());
  EXPECT_EQ(messages.Warnings.size(), 1u);
  vtkNew<vtkSurfaceSegmentationFilter> alone;
  alone->SetInputData(known);
  alone->Update();
  EXPECT_EQ(both->GetEffectiveFidelityWeight(), alone->GetEffectiveFidelityWeight());
  EXPECT_EQ(both->GetEffectiveMean(1, 0), alone->GetEffectiveMean(1, 0));
  auto* const output = vtkMultiBlockDataSet::SafeDownCast(both->GetOutputDataObject(0));
  const auto labelsOf = [&](unsigned int block)
  {
    return vtkPolyData::SafeDownCast(output->GetBlock(block))->GetPointData()->GetArray("RegionId");
  };
  EXPECT_TRUE(Identical(labelsOf(1), alone->GetOutput()->GetPointData()->GetArray("RegionId")));
  double range[2];
  labelsOf(0)->GetRange(range);
  EXPECT_EQ(range[1], 0.0);
}
