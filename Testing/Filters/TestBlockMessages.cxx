// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "FilterTest.h"

#include "vtkCompositeDataSet.h"
#include "vtkFVMHeatFilter.h"
#include "vtkImageData.h"
#include "vtkMultiBlockDataSet.h"
#include "vtkPartitionedDataSet.h"
#include "vtkPartitionedDataSetCollection.h"
#include "vtkStringArray.h"
#include "vtkSurfaceDenoisingFilter.h"
#include "vtkSurfaceDerivativesFilter.h"
#include "vtkSurfaceDirectionFieldFilter.h"
#include "vtkSurfaceDistanceFilter.h"
#include "vtkSurfaceReliefFilter.h"
#include "vtkSurfaceSegmentationFilter.h"
#include "vtkTuringTextureFilter.h"
#include "vtkUnstructuredGrid.h"

#include <gtest/gtest.h>

#include <limits>

using namespace FilterTest;

namespace
{

vtkSmartPointer<vtkPolyData> RoughGrid()
{
  auto grid = Grid(6, 5);
  AddRough(grid);
  return grid;
}

/// Blocks "wing", "tail", and one without a name inside of the third block.
vtkSmartPointer<vtkMultiBlockDataSet> ThreeBlocks()
{
  auto blocks = vtkSmartPointer<vtkMultiBlockDataSet>::New();
  vtkNew<vtkMultiBlockDataSet> inner;
  blocks->SetBlock(0, RoughGrid());
  blocks->SetBlock(1, RoughGrid());
  inner->SetBlock(1, RoughGrid());
  blocks->SetBlock(2, inner);
  blocks->GetMetaData(0u)->Set(vtkCompositeDataSet::NAME(), "wing");
  blocks->GetMetaData(1u)->Set(vtkCompositeDataSet::NAME(), "tail");
  return blocks;
}

vtkPolyData* BlockOf(vtkMultiBlockDataSet* blocks, unsigned int b)
{
  return b < 2 ? vtkPolyData::SafeDownCast(blocks->GetBlock(b))
               : vtkPolyData::SafeDownCast(
                   vtkMultiBlockDataSet::SafeDownCast(blocks->GetBlock(2))->GetBlock(1));
}

vtkPolyData* OutputOf(vtkAlgorithm* filter, unsigned int b)
{
  return BlockOf(vtkMultiBlockDataSet::SafeDownCast(filter->GetOutputDataObject(0)), b);
}

std::string Join(const std::vector<std::string>& texts)
{
  std::string all;
  for (const std::string& text : texts)
  {
    all += text + "\n";
  }
  return all;
}

bool Contains(const std::vector<std::string>& texts, const std::string& part)
{
  return Join(texts).find(part) != std::string::npos;
}

const auto First = [](vtkIdType i, int) { return i < 6 ? 1.0 : 0.0; };

} // namespace

TEST(BlockMessages, AMaskThatOneBlockLacksCountsAsNotSetThere)
{
  auto blocks = ThreeBlocks();
  AddPointArray(BlockOf(blocks, 0), "mask", 1, First);
  vtkNew<vtkFVMHeatFilter> filter;
  filter->SetInputDataObject(blocks);
  SetInputArray(filter, 1, "mask");
  Messages messages(filter);
  filter->Update();
  EXPECT_EQ(messages.Errors, std::vector<std::string>());
  ASSERT_EQ(messages.Warnings.size(), 1u);
  EXPECT_TRUE(Contains(messages.Warnings,
    "MaskArray \"mask\" counts as not set on blocks \"tail\", 2/1, without such a numeric array"))
    << Join(messages.Warnings);
  for (unsigned int b = 0; b < 3; ++b)
  {
    EXPECT_TRUE(AllFinite(OutputOf(filter, b)->GetPointData()->GetArray("fDiffused"))) << b;
  }
  const auto expected = Copy(OutputOf(filter, 1)->GetPointData()->GetArray("fDiffused"));
  AddPointArray(BlockOf(blocks, 1), "mask", 1, [](vtkIdType, int) { return 0.0; });
  BlockOf(blocks, 1)->Modified();
  filter->Modified();
  filter->Update();
  EXPECT_TRUE(Identical(expected, OutputOf(filter, 1)->GetPointData()->GetArray("fDiffused")));
  EXPECT_TRUE(Contains(messages.Warnings, "not set on block 2/1, without"));
}

TEST(BlockMessages, OptionalArraysOfEveryFilterMayLackOnABlock)
{
  const auto update = [](vtkAlgorithm* filter, int index, const char* property, const char* result)
  {
    auto blocks = ThreeBlocks();
    AddPointArray(BlockOf(blocks, 0), "a", index == 2 ? 3 : 1, First);
    filter->SetInputDataObject(blocks);
    SetInputArray(filter, index, "a");
    Messages messages(filter);
    filter->Update();
    EXPECT_EQ(messages.Errors, std::vector<std::string>()) << property;
    EXPECT_TRUE(Contains(messages.Warnings,
      std::string(property) + " \"a\" counts as not set on blocks \"tail\", 2/1"))
      << Join(messages.Warnings);
    for (unsigned int b = 0; b < 3; ++b)
    {
      EXPECT_TRUE(OutputOf(filter, b)->GetPointData()->HasArray(result)) << property << b;
    }
  };
  update(vtkNew<vtkFVMHeatFilter>(), 3, "FixedArray", "fDiffused");
  vtkNew<vtkFVMHeatFilter> weighted;
  weighted->SetFidelityWeight(1.0);
  update(weighted, 5, "FidelityArray", "fDiffused");
  update(vtkNew<vtkSurfaceSegmentationFilter>(), 6, "SeedArray", "RegionId");
  update(vtkNew<vtkSurfaceDenoisingFilter>(), 3, "FixedArray", "Displacement");
  vtkNew<vtkTuringTextureFilter> texture;
  texture->SetNumberOfTimeSteps(2);
  update(texture, 1, "MaskArray", "u1");
}

/// As where the direction is zero, which is documented.
TEST(BlockMessages, DiffusionIsIsotropicOnABlockWithoutDirections)
{
  auto blocks = ThreeBlocks();
  AddPointArray(BlockOf(blocks, 0), "along", 3, [](vtkIdType, int k) { return k == 0; });
  vtkNew<vtkFVMHeatFilter> filter, isotropic;
  filter->SetInputDataObject(blocks);
  filter->SetAlongDiffusivity(4.0);
  filter->SetNumberOfTimeSteps(1);
  SetInputArray(filter, 2, "along");
  Messages messages(filter);
  filter->Update();
  EXPECT_EQ(messages.Errors, std::vector<std::string>());
  isotropic->SetInputDataObject(ThreeBlocks());
  isotropic->SetNumberOfTimeSteps(1);
  isotropic->SetAlongDiffusivity(2.0);
  isotropic->SetAcrossDiffusivity(2.0);
  isotropic->Update();
  vtkDataArray* const expected = OutputOf(isotropic, 1)->GetPointData()->GetArray("fDiffused");
  EXPECT_LT(
    LargestDifference(OutputOf(filter, 1)->GetPointData()->GetArray("fDiffused"), expected), 1e-12);
  EXPECT_GT(
    LargestDifference(OutputOf(filter, 0)->GetPointData()->GetArray("fDiffused"), expected), 1e-3);
}

TEST(BlockMessages, ABlockWithoutDataOrWithDataOfAnotherTypeIsNamed)
{
  auto blocks = ThreeBlocks();
  BlockOf(blocks, 1)->GetPointData()->RemoveArray("f");
  vtkNew<vtkStringArray> text;
  text->SetName("f");
  text->SetNumberOfValues(30);
  BlockOf(blocks, 2)->GetPointData()->RemoveArray("f");
  BlockOf(blocks, 2)->GetPointData()->AddArray(text);
  vtkNew<vtkFVMHeatFilter> filter;
  filter->SetInputDataObject(blocks);
  SetInputArray(filter, 0, "f");
  Messages messages(filter);
  filter->Update();
  EXPECT_EQ(messages.Errors, std::vector<std::string>());
  ASSERT_EQ(messages.Warnings.size(), 1u);
  EXPECT_TRUE(
    Contains(messages.Warnings, "block \"tail\": InputArray \"f\" is not among the point"))
    << Join(messages.Warnings);
  EXPECT_TRUE(Contains(messages.Warnings, "block 2/1: InputArray \"f\" is a vtkStringArray"));
  EXPECT_TRUE(OutputOf(filter, 0)->GetPointData()->HasArray("fDiffused"));
  EXPECT_FALSE(OutputOf(filter, 1)->GetPointData()->HasArray("fDiffused"));
  filter->SetTimeStep(2.0);
  filter->Update();
  EXPECT_EQ(messages.Warnings.size(), 1u); // once
}

TEST(BlockMessages, ErrorsNameTheirBlockUnlessTheyHoldForAll)
{
  auto blocks = ThreeBlocks();
  AddPointArray(BlockOf(blocks, 0), "mask", 1, First);
  AddPointArray(BlockOf(blocks, 1), "mask", 2, First);
  vtkNew<vtkFVMHeatFilter> filter;
  filter->SetInputDataObject(blocks);
  SetInputArray(filter, 1, "mask");
  Messages messages(filter);
  filter->Update();
  EXPECT_TRUE(Contains(messages.Errors, "block \"tail\": MaskArray \"mask\" has 2 components"))
    << Join(messages.Errors);

  SetInputArray(filter, 1, "nosuch");
  filter->Update();
  ASSERT_EQ(messages.Errors.size(), 2u);
  EXPECT_NE(messages.Errors[1].find("MaskArray \"nosuch\" is not among"), std::string::npos);
  EXPECT_EQ(messages.Errors[1].find("block"), std::string::npos) << messages.Errors[1];

  SetInputArray(filter, 1, "");
  BlockOf(blocks, 2)->GetPointData()->GetArray("f")->SetComponent(
    7, 0, std::numeric_limits<double>::infinity());
  BlockOf(blocks, 2)->GetPointData()->GetArray("f")->Modified();
  filter->Modified();
  filter->Update();
  ASSERT_EQ(messages.Errors.size(), 3u);
  EXPECT_NE(messages.Errors[2].find("block 2/1: "), std::string::npos) << messages.Errors[2];
}

/// As that of other filters without a model, which have one superclass.
TEST(BlockMessages, ErrorsOfDerivativesNameTheirBlockIfAnotherHasNoData)
{
  auto blocks = ThreeBlocks();
  BlockOf(blocks, 0)->GetPointData()->RemoveArray("f");
  BlockOf(blocks, 1)->GetPointData()->AddArray(MakeArray(VTK_DOUBLE, "f", 29, 1, First));
  vtkNew<vtkSurfaceDerivativesFilter> filter;
  filter->SetInputDataObject(blocks);
  SetInputArray(filter, 0, "f");
  Messages messages(filter);
  filter->Update();
  ASSERT_EQ(messages.Errors.size(), 1u);
  EXPECT_TRUE(Contains(messages.Errors, "block \"tail\": InputArray \"f\" has 29 tuples"))
    << Join(messages.Errors);
}

TEST(BlockMessages, ASettingThatIsNotAllowedIsReportedOnceIfABlockHasNoData)
{
  auto blocks = ThreeBlocks();
  AddPointArray(BlockOf(blocks, 0), "sources", 1, First);
  AddPointArray(BlockOf(blocks, 2), "sources", 1, First);
  vtkNew<vtkSurfaceDistanceFilter> filter;
  filter->SetInputDataObject(blocks);
  filter->SetMethodToHeat(); // which has no speeds
  filter->SetMaximumDistance(-1.0);
  filter->SetAlongSpeed(2.0);
  filter->SetAcrossSpeed(2.0);
  SetInputArray(filter, 0, "sources");
  Messages messages(filter);
  filter->Update();
  ASSERT_EQ(messages.Errors.size(), 1u);
  const std::string& error = messages.Errors[0];
  EXPECT_EQ(error.find("MaximumDistance"), error.rfind("MaximumDistance")) << error;
  EXPECT_NE(error.find("Method is "), std::string::npos) << error;
  EXPECT_EQ(error.find("block"), std::string::npos) << error;
}

TEST(BlockMessages, MembersOfCollectionsHaveTheirNames)
{
  vtkNew<vtkPartitionedDataSetCollection> collection;
  for (unsigned int m = 0; m < 2; ++m)
  {
    vtkNew<vtkPartitionedDataSet> partitions;
    partitions->SetPartition(0, RoughGrid());
    collection->SetPartitionedDataSet(m, partitions);
    collection->GetMetaData(m)->Set(vtkCompositeDataSet::NAME(), m == 0 ? "left" : "right");
  }
  AddPointArray(
    vtkPolyData::SafeDownCast(collection->GetPartitionAsDataObject(0, 0)), "mask", 1, First);
  vtkNew<vtkFVMHeatFilter> filter;
  filter->SetInputDataObject(collection);
  SetInputArray(filter, 1, "mask");
  Messages messages(filter);
  filter->Update();
  EXPECT_TRUE(Contains(messages.Warnings, "not set on block \"right\"")) << Join(messages.Warnings);
}

TEST(BlockMessages, OtherTypesOfDataSayWhatToDo)
{
  vtkNew<vtkUnstructuredGrid> grid;
  vtkNew<vtkPoints> points;
  for (int i = 0; i < 4; ++i)
  {
    points->InsertNextPoint(i == 1, i == 2, i == 3);
  }
  grid->SetPoints(points);
  const vtkIdType corners[] = { 0, 1, 2, 3 };
  grid->InsertNextCell(VTK_TETRA, 4, corners);
  vtkNew<vtkImageData> image;
  image->SetDimensions(3, 3, 3);
  vtkNew<vtkTable> table;
  vtkNew<vtkMultiBlockDataSet> blocks;
  blocks->SetBlock(0, grid);
  const std::pair<vtkDataObject*, std::string> cases[] = {
    { grid, "the input is vtkUnstructuredGrid; " }, { image, "the input is vtkImageData; " },
    { table, "the input is vtkTable; " }, { blocks, "the blocks are vtkUnstructuredGrid; " }
  };
  for (const auto& [input, text] : cases)
  {
    for (vtkSmartPointer<vtkAlgorithm> filter :
      { vtkSmartPointer<vtkAlgorithm>(vtkSmartPointer<vtkFVMHeatFilter>::New()),
        vtkSmartPointer<vtkAlgorithm>(vtkSmartPointer<vtkSurfaceDenoisingFilter>::New()) })
    {
      filter->SetInputDataObject(input);
      Messages messages(filter), ofExecutive(filter->GetExecutive());
      filter->Update();
      EXPECT_TRUE(Contains(messages.Errors, text)) << Join(messages.Errors);
      EXPECT_TRUE(Contains(messages.Errors, "apply Extract Surface"));
      EXPECT_EQ(ofExecutive.Errors, std::vector<std::string>());
    }
  }
}

TEST(BlockMessages, WithoutInputThereIsOneClearLine)
{
  for (vtkSmartPointer<vtkAlgorithm> filter :
    { vtkSmartPointer<vtkAlgorithm>(vtkSmartPointer<vtkFVMHeatFilter>::New()),
      vtkSmartPointer<vtkAlgorithm>(vtkSmartPointer<vtkSurfaceSegmentationFilter>::New()),
      vtkSmartPointer<vtkAlgorithm>(vtkSmartPointer<vtkSurfaceDirectionFieldFilter>::New()) })
  {
    if (auto* model = vtkSurfaceDiffusionAlgorithm::SafeDownCast(filter))
    {
      model->GenerateTimeStepsOn();
    }
    Messages messages(filter), ofExecutive(filter->GetExecutive());
    filter->Update();
    const std::string all = Join(messages.Errors) + Join(ofExecutive.Errors);
    EXPECT_NE(all.find("has 0 connections"), std::string::npos) << all;
    EXPECT_EQ(messages.Errors.size() + ofExecutive.Errors.size(), 1u);
    EXPECT_EQ(all.find("vtkInformation"), std::string::npos) << all;
  }
}

/// As a block without the array.
TEST(BlockMessages, ABlockWhoseArrayIsNotNumericIsLeftOut)
{
  const auto update = [](vtkAlgorithm* filter, const char* result)
  {
    auto blocks = ThreeBlocks();
    BlockOf(blocks, 1)->GetPointData()->RemoveArray("f");
    vtkNew<vtkStringArray> names;
    names->SetName("f");
    names->SetNumberOfValues(BlockOf(blocks, 1)->GetNumberOfPoints());
    BlockOf(blocks, 1)->GetPointData()->AddArray(names);
    filter->SetInputDataObject(blocks);
    SetInputArray(filter, 0, "f");
    Messages messages(filter);
    filter->Update();
    EXPECT_EQ(messages.Errors, std::vector<std::string>()) << result;
    ASSERT_EQ(messages.Warnings.size(), 1u) << result;
    EXPECT_TRUE(Contains(messages.Warnings, "on block \"tail\", without such a numeric array"))
      << Join(messages.Warnings);
    for (unsigned int b = 0; b < 3; ++b)
    {
      EXPECT_EQ(OutputOf(filter, b)->GetPointData()->HasArray(result), b != 1) << result << b;
    }
    BlockOf(blocks, 0)->GetPointData()->RemoveArray("f");
    BlockOf(blocks, 2)->GetPointData()->RemoveArray("f");
    BlockOf(blocks, 0)->GetPointData()->AddArray(names);
    filter->Modified();
    filter->Update();
    EXPECT_EQ(messages.Errors.size(), 1u) << result;
  };
  update(vtkNew<vtkSurfaceDerivativesFilter>(), "fGradient");
  update(vtkNew<vtkSurfaceDistanceFilter>(), "Distance");
  vtkNew<vtkSurfaceReliefFilter> relief;
  relief->SetHeight(0.0);
  update(relief, "ReliefHeight");
}
