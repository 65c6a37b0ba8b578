// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "FilterTest.h"

#include "vtkFVMHeatFilter.h"
#include "vtkFieldData.h"
#include "vtkIntrinsicTVFilter.h"
#include "vtkMultiBlockDataSet.h"
#include "vtkSurfaceDirectionFieldFilter.h"
#include "vtkTuringTextureFilter.h"

#include <gtest/gtest.h>

#include <functional>

using namespace FilterTest;

namespace
{

/// A sphere with a point that no triangle uses and a triangle of zero area.
vtkSmartPointer<vtkPolyData> DefectiveSphere()
{
  auto sphere = Sphere(3);
  sphere->GetPoints()->InsertNextPoint(5.0, 0.0, 0.0);
  sphere->GetPolys()->InsertNextCell({ vtkIdType(0), vtkIdType(0), vtkIdType(6) });
  AddRough(sphere);
  return sphere;
}

std::size_t NumberOfWarnings(vtkAlgorithm* filter, const std::function<void()>& update)
{
  Messages messages(filter);
  update();
  EXPECT_TRUE(messages.Errors.empty());
  return messages.Warnings.size();
}

} // namespace

TEST(Warnings, OfDirectionFieldsAppearOnceForAllEditsAndBlocks)
{
  vtkNew<vtkMultiBlockDataSet> blocks;
  blocks->SetBlock(0, DefectiveSphere());
  blocks->SetBlock(1, DefectiveSphere());
  vtkNew<vtkSurfaceDirectionFieldFilter> filter;
  filter->SetInputData(blocks);
  Messages messages(filter);
  for (const double angle : { 0.0, 45.0, 90.0 })
  {
    filter->SetAngle(angle);
    filter->Update();
  }
  ASSERT_EQ(messages.Warnings.size(), 1u);
  EXPECT_NE(
    messages.Warnings[0].find("2 triangles of zero area get no direction"), std::string::npos)
    << messages.Warnings[0];
}

TEST(Warnings, OfARunAppearOnceForAllRequestedTimes)
{
  const auto sphere = Sphere(3);
  AddRough(sphere);
  vtkNew<vtkTuringTextureFilter> filter;
  filter->SetInputData(sphere);
  filter->GenerateTimeStepsOn();
  filter->SetDiffusionRate1(0.5); // a wavelength below the mesh width
  filter->SetDiffusionRate2(0.05);
  filter->SetNumberOfTimeSteps(8);
  EXPECT_EQ(NumberOfWarnings(filter, [&] { filter->Update(); }), 1u);
  for (const double time : { 0.25, 0.125, 0.5 })
  {
    EXPECT_EQ(NumberOfWarnings(filter, [&] { UpdateAt(filter, time); }), 0u) << time;
  }
  filter->SetRandomSeed(5);
  EXPECT_EQ(NumberOfWarnings(filter, [&] { filter->Update(); }), 0u);
  filter->SetDiffusionRate1(0.6);
  EXPECT_EQ(NumberOfWarnings(filter, [&] { filter->Update(); }), 1u);
}

/// Blocks share their units, and the read-only values are those of the first block, regardless of
/// the block that was edited last.
TEST(ReportedValues, AreThoseOfTheFirstBlockWhicheverWasEditedLast)
{
  const auto makeBlock = [](double noise)
  {
    auto sphere = Sphere(4);
    AddPointArray(sphere, "f", 1,
      [&](vtkIdType i, int)
      { return sphere->GetPoints()->GetPoint(i)[2] + (i == 0 ? 9.0 : noise * Rough(i, 0)); });
    sphere->GetPointData()->SetActiveScalars("f");
    return sphere;
  };
  const vtkSmartPointer<vtkPolyData> spheres[2] = { makeBlock(0.1), makeBlock(0.4) };
  vtkNew<vtkMultiBlockDataSet> blocks;
  blocks->SetBlock(0, spheres[0]);
  blocks->SetBlock(1, spheres[1]);
  const auto weightOf = [&](vtkIntrinsicTVFilter* filter)
  {
    filter->Update();
    return filter->GetEffectiveFidelityWeight();
  };
  const auto makeFilter = [&]
  {
    auto filter = vtkSmartPointer<vtkIntrinsicTVFilter>::New();
    filter->SetInputData(blocks);
    filter->AutomaticFidelityOn();
    filter->SetNumberOfTimeSteps(1);
    return filter;
  };
  const auto filter = makeFilter();
  const double before = weightOf(filter);
  const auto edit = [&](int block)
  {
    spheres[block]->GetPointData()->GetScalars()->SetComponent(9, 0, 0.5);
    spheres[block]->Modified();
    blocks->Modified();
  };
  edit(1);
  EXPECT_EQ(weightOf(filter), before);
  edit(0);
  const double after = weightOf(filter);
  EXPECT_NE(after, before);
  EXPECT_EQ(after, weightOf(makeFilter()));
}

/// AutomaticFidelity finds a weight for each block, from its own noise.
TEST(ReportedValues, EachBlockHasItsFidelityWeightAsFieldData)
{
  const auto makeBlock = [](double noise)
  {
    auto sphere = Sphere(4);
    AddPointArray(sphere, "f", 1,
      [&](vtkIdType i, int) { return sphere->GetPoint(i)[2] + noise * Rough(i, 0); });
    sphere->GetPointData()->SetActiveScalars("f");
    return sphere;
  };
  vtkNew<vtkMultiBlockDataSet> blocks;
  blocks->SetBlock(0, makeBlock(0.05));
  blocks->SetBlock(1, makeBlock(0.3));
  const auto weightOf = [](vtkIntrinsicTVFilter* filter, unsigned int b, const char* name)
  {
    filter->Update();
    auto* output = vtkMultiBlockDataSet::SafeDownCast(filter->GetOutputDataObject(0));
    vtkDataArray* const weight = output->GetBlock(b)->GetFieldData()->GetArray(name);
    return weight ? weight->GetComponent(0, 0) : -1.0;
  };
  vtkNew<vtkIntrinsicTVFilter> filter;
  filter->SetInputData(blocks);
  filter->SetNumberOfTimeSteps(1);
  filter->AutomaticFidelityOff();
  EXPECT_EQ(weightOf(filter, 0, "EffectiveFidelityWeight"), -1.0); // one weight for all
  filter->AutomaticFidelityOn();
  const double first = weightOf(filter, 0, "EffectiveFidelityWeight");
  const double second = weightOf(filter, 1, "EffectiveFidelityWeight");
  EXPECT_EQ(first, filter->GetEffectiveFidelityWeight());
  EXPECT_GT(first, second); // more noise, less fidelity
  EXPECT_GT(second, 0.0);
  filter->SetResultArrayName("my");
  EXPECT_EQ(weightOf(filter, 1, "myEffectiveFidelityWeight"), second);
  EXPECT_FALSE(blocks->GetBlock(0)->GetFieldData()->HasArray("myEffectiveFidelityWeight"));
}
