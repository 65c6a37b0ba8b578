// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "FilterTest.h"

#include "vtkAppendPolyData.h"
#include "vtkCellData.h"
#include "vtkFVMHeatFilter.h"
#include "vtkMath.h"

#include <gtest/gtest.h>

using namespace FilterTest;

TEST(HeatFilter, UsePaperSchemeSetsThePapersReadingAndNothingElse)
{
  vtkNew<vtkFVMHeatFilter> filter;
  filter->SetMaskModeToExclude();
  filter->HoldKnownValuesOn();
  filter->SetModeToSteadyState();
  filter->SetUnitsToAbsolute();
  filter->SetTimeStep(0.25);
  filter->SetFidelityWeight(2.0);
  filter->SetSolverToDirect();
  filter->SetMassMatrixToMixed();
  filter->UsePaperScheme();
  EXPECT_STREQ(filter->GetMassMatrixAsString(), "Lumped");
  EXPECT_STREQ(filter->GetTimeIntegratorAsString(), "FirstOrder");
  EXPECT_STREQ(filter->GetMaskModeAsString(), "Inpaint");
  EXPECT_FALSE(filter->GetHoldKnownValues());
  EXPECT_STREQ(filter->GetInitialFillAsString(), "Input");
  EXPECT_STREQ(filter->GetModeAsString(), "TimeSteps");
  EXPECT_STREQ(filter->GetUnitsAsString(), "Absolute");
  EXPECT_EQ(filter->GetTimeStep(), 0.25);
  EXPECT_EQ(filter->GetFidelityWeight(), 2.0);
  EXPECT_STREQ(filter->GetSolverAsString(), "Direct");
}

TEST(HeatFilter, ToleranceBoundsTheErrorOfTenStepsAlsoBesideALargeHole)
{
  const auto sphere = Sphere(6);
  vtkDataArray* const f = AddPointArray(
    sphere, "f", 1, [&](vtkIdType i, int) { return sphere->GetPoint(i)[0] + 0.3 * Rough(i, 0); });
  sphere->GetPointData()->SetActiveScalars("f");
  for (const bool hasHole : { false, true })
  {
    for (vtkIdType i = 0; hasHole && i < f->GetNumberOfTuples(); ++i)
    {
      if (sphere->GetPoint(i)[2] < 0.8)
      {
        f->SetComponent(i, 0, vtkMath::Nan());
      }
    }
    const auto exact = MakeHeatFilter(sphere);
    exact->SetSolverToDirect();
    exact->Update();
    const auto filter = MakeHeatFilter(sphere);
    filter->SetSolverToConjugateGradient();
    filter->Update();
    const double error = LargestDifference(Result(filter), Result(exact)) / filter->GetValueRange();
    EXPECT_GT(error, 1e-9) << "there is nothing to bound";
    EXPECT_LT(error, 1.5 * filter->GetTolerance());
  }
}

TEST(HeatFilter, ToleranceBoundsTheErrorOnSmallComponentsToo)
{
  const auto spheres = vtkSmartPointer<vtkPolyData>::New();
  vtkNew<vtkAppendPolyData> append;
  for (const double size : { 1.0, 0.01 })
  {
    const auto sphere = Sphere(5);
    for (vtkIdType i = 0; i < sphere->GetNumberOfPoints(); ++i)
    {
      double x[3];
      sphere->GetPoint(i, x);
      sphere->GetPoints()->SetPoint(i, size * x[0] + 3.0 * size, size * x[1], size * x[2]);
    }
    append->AddInputData(sphere);
  }
  append->Update();
  spheres->ShallowCopy(append->GetOutput());
  AddPointArray(spheres, "f", 1, [&](vtkIdType i, int) { return Rough(i, 0); });
  spheres->GetPointData()->SetActiveScalars("f");
  for (const bool isSteady : { false, true })
  {
    const auto exact = MakeHeatFilter(spheres);
    const auto filter = MakeHeatFilter(spheres);
    for (vtkFVMHeatFilter* const each : { exact.Get(), filter.Get() })
    {
      each->SetTimeStep(0.01);
      each->SetMode(isSteady);
      each->SetFidelityWeight(isSteady ? 0.1 : 0.0);
    }
    exact->SetSolverToDirect();
    exact->Update();
    filter->SetSolverToConjugateGradient();
    filter->Update();
    const double error = LargestDifference(Result(filter), Result(exact)) / filter->GetValueRange();
    EXPECT_GT(error, 0.0);
    EXPECT_LT(error, isSteady ? 1e-9 : filter->GetTolerance());
  }
}
