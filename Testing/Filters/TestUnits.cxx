// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "FilterTest.h"

#include "vtkFVMHeatFilter.h"
#include "vtkMultiBlockDataSet.h"
#include "vtkPartitionedDataSet.h"
#include "vtkPartitionedDataSetCollection.h"

#include <gtest/gtest.h>

using namespace FilterTest;

namespace
{

vtkSmartPointer<vtkFVMHeatFilter> MakeFilter(vtkDataObject* surface)
{
  auto filter = vtkSmartPointer<vtkFVMHeatFilter>::New();
  filter->SetInputDataObject(surface);
  return filter;
}

} // namespace

TEST(Units, AreMeasuredOnDistinctEdgesAndKnownValues)
{
  auto grid = Grid(3, 2, 2.0); // 4 edges along x, 3 along y, 2 diagonals
  AddPointArray(
    grid, "f", 2, [](vtkIdType i, int k) { return k == 1 ? -5.0 * static_cast<double>(i) : 0.0; });
  grid->GetPointData()->GetArray("f")->SetComponent(5, 1, -1e6);
  AddPointArray(grid, "mask", 1, [](vtkIdType i, int) { return i == 5; });
  auto filter = MakeFilter(grid);
  SetInputArray(filter, 0, "f");
  SetInputArray(filter, 1, "mask");
  filter->Update();
  const double h = (7.0 * 2.0 + 2.0 * 2.0 * std::sqrt(2.0)) / 9.0;
  EXPECT_NEAR(filter->GetMeanEdgeLength(), h, 1e-14);
  EXPECT_EQ(filter->GetValueRange(), 20.0); // range of the second component, from 0 to -20
  EXPECT_NEAR(filter->GetTimeUnit(), h * h, 1e-13);

  grid->GetPointData()->GetArray("f")->SetComponent(5, 0, std::nan(""));
  grid->GetPointData()->GetArray("f")->Modified();
  SetInputArray(filter, 1, "");
  filter->Update();
  EXPECT_EQ(filter->GetValueRange(), 20.0); // a NaN is missing
}

TEST(Units, RangeOfAConstantIsOne)
{
  auto grid = Grid(3, 3);
  AddPointArray(grid, "f", 1, [](vtkIdType, int) { return 7.0; });
  auto filter = MakeFilter(grid);
  SetInputArray(filter, 0, "f");
  filter->Update();
  EXPECT_EQ(filter->GetValueRange(), 1.0);
}

TEST(Units, AlphaDoesNotCountInTheRange)
{
  auto grid = Grid(3, 3);
  AddPointArray(
    grid, "f", 4,
    [](vtkIdType i, int k)
    { return k == 3 ? 31.0 * static_cast<double>(i) : 10.0 + static_cast<double>(i); },
    VTK_UNSIGNED_CHAR);
  auto filter = MakeFilter(grid);
  SetInputArray(filter, 0, "f");
  filter->Update();
  EXPECT_EQ(filter->GetValueRange(), 8.0);
}

TEST(Units, AbsoluteTimeUnitIsExactlyOne)
{
  auto grid = Grid(5, 4, 0.3);
  AddRough(grid);
  auto filter = MakeFilter(grid);
  filter->SetUnitsToAbsolute();
  filter->Update();
  EXPECT_EQ(filter->GetTimeUnit(), 1.0);
}

TEST(Units, NaturalIsAbsoluteInUnitsOfHSquared)
{
  auto sphere = Sphere(3);
  AddRough(sphere);
  auto filter = MakeFilter(sphere);
  filter->SetTimeStep(0.7);
  filter->SetFidelityWeight(0.2);
  filter->Update();
  const auto natural = Copy(Result(filter));
  const double unit = filter->GetTimeUnit();
  filter->SetUnitsToAbsolute();
  filter->SetTimeStep(0.7 * unit);
  filter->SetFidelityWeight(0.2 / unit);
  filter->Update();
  EXPECT_LT(LargestDifference(natural, Result(filter)), 1e-12);
}

TEST(Units, NaturalSettingsSuitAnySizeAndAnyRange)
{
  auto small = Sphere(3);
  vtkDataArray* f = AddRough(small);
  vtkNew<vtkPolyData> large;
  large->DeepCopy(small);
  for (vtkIdType i = 0; i < large->GetNumberOfPoints(); ++i)
  {
    double p[3];
    small->GetPoint(i, p);
    vtkMath::MultiplyScalar(p, 1e3);
    large->GetPoints()->SetPoint(i, p);
    large->GetPointData()->GetArray("f")->SetComponent(i, 0, 70.0 * f->GetComponent(i, 0) + 5.0);
  }
  auto ofSmall = MakeFilter(small);
  auto ofLarge = MakeFilter(large);
  for (vtkFVMHeatFilter* filter : { ofSmall.Get(), ofLarge.Get() })
  {
    filter->SetFidelityWeight(0.1);
    filter->Update();
  }
  for (vtkIdType i = 0; i < small->GetNumberOfPoints(); ++i)
  {
    EXPECT_NEAR(
      70.0 * Result(ofSmall)->GetComponent(i, 0) + 5.0, Result(ofLarge)->GetComponent(i, 0), 1e-10);
  }
}

TEST(Units, BlocksOfCompositeDataShareLengthAndRange)
{
  auto fine = Grid(9, 9, 0.5);
  auto coarse = Grid(5, 5, 3.0);
  for (vtkIdType i = 0; i < coarse->GetNumberOfPoints(); ++i)
  {
    double x[3];
    coarse->GetPoint(i, x);
    coarse->GetPoints()->SetPoint(i, x[0], x[1], 10.0); // partitions that touch are one surface
  }
  AddPointArray(fine, "f", 1, Rough);
  AddPointArray(coarse, "f", 1, [](vtkIdType i, int k) { return 40.0 * Rough(i, k); });
  vtkNew<vtkMultiBlockDataSet> blocks;
  vtkNew<vtkPartitionedDataSet> partitions;
  vtkNew<vtkPartitionedDataSetCollection> collection;
  vtkNew<vtkMultiBlockDataSet> nested;
  nested->SetBlock(0, coarse);
  blocks->SetBlock(0, fine);
  blocks->SetBlock(2, nested);
  partitions->SetPartition(0, fine);
  partitions->SetPartition(1, coarse);
  collection->SetPartition(0, 0, fine);
  collection->SetPartition(1, 0, coarse);
  const auto edges = [](double n) { return 2.0 * n * (n - 1.0) + (n - 1.0) * (n - 1.0); };
  const auto length = [](double n, double s)
  { return s * (2.0 * n * (n - 1.0) + std::sqrt(2.0) * (n - 1.0) * (n - 1.0)); };
  const double h = (length(9.0, 0.5) + length(5.0, 3.0)) / (edges(9.0) + edges(5.0));
  for (vtkDataObject* input :
    std::initializer_list<vtkDataObject*>{ blocks.Get(), partitions.Get(), collection.Get() })
  {
    auto filter = MakeFilter(input);
    SetInputArray(filter, 0, "f");
    filter->Update();
    EXPECT_NEAR(filter->GetMeanEdgeLength(), h, 1e-13);
    double range[2];
    coarse->GetPointData()->GetArray("f")->GetRange(range);
    EXPECT_EQ(filter->GetValueRange(), range[1] - range[0]);

    vtkDataObject* output = filter->GetOutputDataObject(0);
    ASSERT_STREQ(output->GetClassName(), input->GetClassName());
    vtkPolyData* results[2];
    if (auto* tree = vtkMultiBlockDataSet::SafeDownCast(output))
    {
      results[0] = vtkPolyData::SafeDownCast(tree->GetBlock(0));
      results[1] = vtkPolyData::SafeDownCast(
        vtkMultiBlockDataSet::SafeDownCast(tree->GetBlock(2))->GetBlock(0));
    }
    else if (auto* all = vtkPartitionedDataSetCollection::SafeDownCast(output))
    {
      results[0] = vtkPolyData::SafeDownCast(all->GetPartition(0, 0));
      results[1] = vtkPolyData::SafeDownCast(all->GetPartition(1, 0));
    }
    else
    {
      auto* set = vtkPartitionedDataSet::SafeDownCast(output);
      results[0] = vtkPolyData::SafeDownCast(set->GetPartition(0));
      results[1] = vtkPolyData::SafeDownCast(set->GetPartition(1));
    }
    double total = 0.0;
    int b = 0;
    for (vtkPolyData* block : { fine.Get(), coarse.Get() })
    {
      auto alone = MakeFilter(block);
      SetInputArray(alone, 0, "f");
      alone->SetUnitsToAbsolute();
      alone->SetTimeStep(filter->GetTimeUnit());
      alone->Update();
      vtkDataArray* result = results[b++]->GetPointData()->GetArray("fDiffused");
      ASSERT_NE(result, nullptr);
      EXPECT_LT(LargestDifference(result, Result(alone)), 1e-12);
      total += HistoryAt(alone, 10, "Total_0");
    }
    EXPECT_NEAR(HistoryAt(filter, 10, "Total_0"), total, 1e-9);
    EXPECT_EQ(fine->GetPointData()->GetArray("fDiffused"), nullptr); // the input is unchanged
  }
}

TEST(Units, BlocksWithoutTheArrayPassThroughAndBadOnesAreErrors)
{
  auto with = Grid(4, 4);
  auto without = Grid(5, 5);
  AddRough(with);
  vtkNew<vtkMultiBlockDataSet> blocks;
  blocks->SetBlock(0, without);
  blocks->SetBlock(1, with);
  blocks->SetBlock(2, vtkSmartPointer<vtkTable>::New());
  auto filter = MakeFilter(blocks);
  SetInputArray(filter, 0, "f");
  Messages messages(filter);
  filter->Update();
  auto* output = vtkMultiBlockDataSet::SafeDownCast(filter->GetOutputDataObject(0));
  EXPECT_TRUE(messages.Errors.empty());
  EXPECT_EQ(vtkPolyData::SafeDownCast(output->GetBlock(0))->GetPointData()->GetNumberOfArrays(), 0);
  EXPECT_TRUE(
    vtkPolyData::SafeDownCast(output->GetBlock(1))->GetPointData()->HasArray("fDiffused"));
  EXPECT_NE(vtkTable::SafeDownCast(output->GetBlock(2)), nullptr);

  SetInputArray(filter, 1, "nosuchmask"); // must not mean "no mask"
  filter->Update();
  ASSERT_EQ(messages.Errors.size(), 1u);
  EXPECT_NE(messages.Errors[0].find("nosuchmask"), std::string::npos) << messages.Errors[0];
  output = vtkMultiBlockDataSet::SafeDownCast(filter->GetOutputDataObject(0));
  EXPECT_FALSE(
    vtkPolyData::SafeDownCast(output->GetBlock(1))->GetPointData()->HasArray("fDiffused"));
}
