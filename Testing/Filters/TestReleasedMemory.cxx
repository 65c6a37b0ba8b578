// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "FilterTest.h"

#include "vtkFVMHeatFilter.h"
#include "vtkHarmonicMapFilter.h"
#include "vtkIntrinsicTVFilter.h"
#include "vtkSurfaceDirectionFieldFilter.h"
#include "vtkTuringTextureFilter.h"

#include <gtest/gtest.h>

#ifdef __GLIBC__
#include <malloc.h>
#endif

using namespace FilterTest;

namespace
{

// Sanitizers have an allocator of their own, which mallinfo2() does not know.
#if defined(__GLIBC__) && !defined(__SANITIZE_ADDRESS__) && !defined(__SANITIZE_THREAD__)
constexpr bool CanMeasure = true;
double AllocatedBytes()
{
  const struct mallinfo2 info = mallinfo2();
  return static_cast<double>(info.uordblks) + static_cast<double>(info.hblkhd);
}
#else
constexpr bool CanMeasure = false;
double AllocatedBytes()
{
  return 0.0;
}
#endif

std::vector<vtkSmartPointer<vtkPolyDataAlgorithm>> MakeFilters(vtkPolyData* surface)
{
  vtkNew<vtkFVMHeatFilter> heat;
  heat->SetSolverToDirect();
  heat->GenerateTimeStepsOn();
  vtkNew<vtkIntrinsicTVFilter> flow;
  vtkNew<vtkHarmonicMapFilter> map;
  vtkNew<vtkTuringTextureFilter> texture;
  texture->SetNumberOfTimeSteps(3);
  vtkNew<vtkSurfaceDirectionFieldFilter> field;
  std::vector<vtkSmartPointer<vtkPolyDataAlgorithm>> filters = { heat, flow, map, texture, field };
  for (vtkPolyDataAlgorithm* filter : filters)
  {
    filter->SetInputData(surface);
  }
  return filters;
}

} // namespace

/// What is left is the result and small objects.
TEST(ReleasedMemory, IsAllThatAFilterKeepsBetweenUpdates)
{
  if (!CanMeasure)
  {
    GTEST_SKIP() << "this allocator does not report what it has given out";
  }
  auto sphere = Sphere(6); // 16386 points
  AddRough(sphere);
  const double points = 16386.0;
  for (const bool byFlag : { false, true })
  {
    for (vtkPolyDataAlgorithm* filter : MakeFilters(sphere))
    {
      const double before = AllocatedBytes();
      filter->SetReleaseDataFlag(byFlag);
      filter->Update();
      const double kept = AllocatedBytes() - before;
      if (!byFlag)
      {
        EXPECT_GT(kept, 200.0 * points) << filter->GetClassName(); // or nothing is measured
        vtkSurfaceFilter::SafeDownCast(filter)->ReleaseCache();
      }
      filter->GetOutputDataObject(0)->ReleaseData();
      EXPECT_LT(AllocatedBytes() - before, 20.0 * points) << filter->GetClassName();
    }
  }
}

TEST(ReleasedMemory, IsComputedAgainWithTheSameResult)
{
  auto sphere = Sphere(4);
  AddRough(sphere);
  vtkNew<vtkFVMHeatFilter> filter;
  filter->SetInputData(sphere);
  filter->GenerateTimeStepsOn();
  UpdateAt(filter, 4.0);
  const auto atFour = Copy(Result(filter));
  UpdateAt(filter, 6.0);
  filter->ReleaseCache();
  EXPECT_EQ(filter->GetNumberOfStepsComputed(), 6);
  UpdateAt(filter, 4.0);
  EXPECT_EQ(filter->GetNumberOfStepsComputed(), 10);
  EXPECT_TRUE(Identical(Result(filter), atFour));
  filter->ReleaseDataFlagOn();
  UpdateAt(filter, 6.0);
  UpdateAt(filter, 4.0);
  EXPECT_TRUE(Identical(Result(filter), atFour));
  EXPECT_EQ(History(filter)->GetNumberOfRows(), 5);
}

TEST(ReleasedMemory, RepeatsNoWarning)
{
  auto sphere = Sphere(3);
  sphere->GetPolys()->InsertNextCell({ vtkIdType(0), vtkIdType(0), vtkIdType(6) }); // zero area
  AddRough(sphere);
  vtkNew<vtkFVMHeatFilter> filter;
  filter->SetInputData(sphere);
  filter->ReleaseDataFlagOn();
  Messages messages(filter);
  for (const double step : { 1.0, 2.0, 3.0 })
  {
    filter->SetTimeStep(step);
    filter->Update();
  }
  EXPECT_EQ(messages.Warnings.size(), 1u);
}
