// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "FilterTest.h"

#include "vtkAppendPolyData.h"
#include "vtkCellData.h"
#include "vtkFVMHeatFilter.h"
#include "vtkMath.h"

#include <gtest/gtest.h>

#include <random>

using namespace FilterTest;

namespace
{

vtkSmartPointer<vtkFVMHeatFilter> MakeFilter(vtkPolyData* surface)
{
  auto filter = vtkSmartPointer<vtkFVMHeatFilter>::New();
  filter->SetInputData(surface);
  return filter;
}

} // namespace

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
  filter->UsePaperScheme();
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

TEST(HeatFilter, HeldValuesKeepTheirBitsAndALinearFunctionIsFilledExactly)
{
  const int n = 21;
  auto plane = Grid(n, n);
  vtkDataArray* f =
    AddPointArray(plane, "f", 1, [&](vtkIdType i, int) { return 0.3 * (i % n) - 0.7 * (i / n); });
  const auto truth = Copy(f);
  const auto inHole = [&](vtkIdType i)
  { return std::abs(i % n - 10) < 5 && std::abs(i / n - 10) < 5; };
  AddPointArray(
    plane, "mask", 1, [&](vtkIdType i, int) { return inHole(i); }, VTK_UNSIGNED_CHAR);
  for (vtkIdType i = 0; i < f->GetNumberOfTuples(); ++i)
  {
    if (inHole(i))
    {
      f->SetComponent(i, 0, 99.0);
    }
  }
  auto filter = MakeFilter(plane);
  SetInputArray(filter, 0, "f");
  SetInputArray(filter, 1, "mask");
  filter->HoldKnownValuesOn();
  filter->SetModeToSteadyState();
  filter->Update();
  EXPECT_LT(LargestDifference(Result(filter), truth), 1e-8);
  filter->SetModeToTimeSteps();
  filter->Update();
  for (vtkIdType i = 0; i < f->GetNumberOfTuples(); ++i)
  {
    if (!inHole(i))
    {
      EXPECT_EQ(Result(filter)->GetComponent(i, 0), f->GetComponent(i, 0));
    }
  }
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
    const auto exact = MakeFilter(sphere);
    exact->SetSolverToDirect();
    exact->Update();
    const auto filter = MakeFilter(sphere);
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
    const auto exact = MakeFilter(spheres);
    const auto filter = MakeFilter(spheres);
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

TEST(HeatFilter, TotalIsConservedByEverySolverAndIntegrator)
{
  auto sphere = Sphere(4);
  // The surface has slivers and obtuse angles. A loose tolerance must not affect the total.
  for (vtkIdType i = 0; i < sphere->GetNumberOfPoints(); ++i)
  {
    double p[3];
    sphere->GetPoint(i, p);
    sphere->GetPoints()->SetPoint(i, p[0], p[1] * p[1] * p[1], 10.0 * p[2]);
  }
  vtkDataArray* f = AddRough(sphere, 3);
  const std::vector<double> areas = ControlAreas(sphere);
  for (const int solver : { vtkFVMHeatFilter::SOLVER_AUTOMATIC, vtkFVMHeatFilter::SOLVER_DIRECT,
         vtkFVMHeatFilter::SOLVER_CONJUGATE_GRADIENT, vtkFVMHeatFilter::SOLVER_MULTIGRID })
  {
    for (const int integrator : { vtkFVMHeatFilter::TIME_INTEGRATOR_FIRST_ORDER,
           vtkFVMHeatFilter::TIME_INTEGRATOR_SECOND_ORDER,
           vtkFVMHeatFilter::TIME_INTEGRATOR_EXPONENTIAL })
    {
      for (const double fidelity : { 0.0, 0.1 })
      {
        auto filter = MakeFilter(sphere);
        filter->SetSolver(solver);
        filter->SetTimeIntegrator(integrator);
        filter->SetFidelityWeight(fidelity);
        filter->SetTolerance(1e-3);
        filter->SetNumberOfTimeSteps(20);
        filter->Update();
        for (int k = 0; k < 3; ++k)
        {
          const double allowed = 1e-12 * TotalMagnitude(areas, f, k);
          EXPECT_NEAR(Total(areas, Result(filter), k), Total(areas, f, k), allowed);
          const std::string column = "Total_" + std::to_string(k);
          EXPECT_NEAR(HistoryAt(filter, 20, column.c_str()), Total(areas, f, k), allowed);
        }
        EXPECT_GT(LargestDifference(Result(filter), f), 0.1);
      }
    }
  }
}

TEST(HeatFilter, AlongDiffusivityAloneDiffusesOnlyAlongTheDirection)
{
  const int n = 41;
  auto plane = Grid(n, n);
  const double k = vtkMath::Pi() / (n - 1);
  AddPointArray(plane, "f", 2,
    [&](vtkIdType i, int c) { return std::cos(k * static_cast<double>(c == 0 ? i % n : i / n)); });
  // The directions have other lengths, components out of the plane, and alternating signs. Only
  // their line in the plane matters.
  const auto direction = [](vtkIdType i, int c) {
    return (i % 2 ? -1.0 : 1.0) * (c == 0 ? 3.0 : c == 2 ? 0.7 : 0.0);
  };
  AddPointArray(plane, "e1", 3, direction);
  plane->GetCellData()->AddArray(
    MakeArray(VTK_FLOAT, "e1", plane->GetNumberOfCells(), 3, direction));
  for (const bool onCells : { false, true })
  {
    auto filter = MakeFilter(plane);
    SetInputArray(filter, 0, "f");
    SetInputArray(filter, 2, "e1", onCells);
    filter->SetUnitsToAbsolute();
    filter->SetTimeStep(10.0);
    filter->SetAlongDiffusivity(2.0);
    filter->SetAcrossDiffusivity(0.0);
    filter->Update();
    const vtkIdType left = n * (n / 2); // in the middle of an edge
    const vtkIdType bottom = n / 2;
    EXPECT_NEAR(Result(filter)->GetComponent(left, 0), std::exp(-k * k * 200.0), 1e-3);
    EXPECT_NEAR(Result(filter)->GetComponent(bottom, 1), 1.0, 1e-12);
    filter->SetAlongDiffusivity(0.0);
    filter->SetAcrossDiffusivity(2.0);
    filter->Update();
    EXPECT_NEAR(Result(filter)->GetComponent(left, 0), 1.0, 1e-12);
    EXPECT_NEAR(Result(filter)->GetComponent(bottom, 1), std::exp(-k * k * 200.0), 1e-3);
  }
}

TEST(HeatFilter, ZeroDirectionsGiveIsotropicDiffusionWithTheGeometricMean)
{
  auto plane = Grid(12, 12);
  AddRough(plane);
  AddPointArray(plane, "zero", 3, [](vtkIdType, int) { return 0.0; });
  AddPointArray(plane, "nan", 3, [](vtkIdType, int) { return std::nan(""); });
  AddPointArray(plane, "normal", 3, [](vtkIdType, int c) { return c == 2 ? 1.0 : 0.0; });
  auto isotropic = MakeFilter(plane);
  isotropic->SetAlongDiffusivity(6.0);
  isotropic->SetAcrossDiffusivity(6.0);
  isotropic->Update();
  for (const char* name : { "zero", "nan", "normal" })
  {
    auto filter = MakeFilter(plane);
    SetInputArray(filter, 2, name);
    filter->SetAlongDiffusivity(9.0);
    filter->SetAcrossDiffusivity(4.0);
    filter->Update();
    ASSERT_NE(Result(filter), nullptr) << name;
    EXPECT_LT(LargestDifference(Result(filter), Result(isotropic)), 1e-9) << name;
  }
}

TEST(HeatFilter, AutomaticFidelityLeavesTheNoiseInTheResidual)
{
  auto sphere = Sphere(4);
  vtkDataArray* f = AddPointArray(sphere, "f", 1,
    [&](vtkIdType i, int k) { return 100.0 * sphere->GetPoint(i)[2] + 10.0 * Rough(i, k); });
  const std::vector<double> areas = ControlAreas(sphere);
  for (const int units : { vtkFVMHeatFilter::UNITS_NATURAL, vtkFVMHeatFilter::UNITS_ABSOLUTE })
  {
    auto filter = MakeFilter(sphere);
    SetInputArray(filter, 0, "f");
    filter->SetUnits(units);
    filter->AutomaticFidelityOn();
    filter->SetModeToSteadyState();
    filter->SetNoiseLevel(4.0);
    filter->Update();
    double sum = 0.0;
    double area = 0.0;
    for (vtkIdType i = 0; i < f->GetNumberOfTuples(); ++i)
    {
      sum += areas[i] * std::pow(Result(filter)->GetComponent(i, 0) - f->GetComponent(i, 0), 2);
      area += areas[i];
    }
    EXPECT_NEAR(std::sqrt(sum / area), 4.0, 0.04);
    // The weight that was found gives the same result if it is set explicitly.
    const auto automatic = Copy(Result(filter));
    filter->AutomaticFidelityOff();
    filter->SetFidelityWeight(filter->GetEffectiveFidelityWeight());
    filter->Update();
    EXPECT_LT(LargestDifference(automatic, Result(filter)), 1e-8);
  }
}

TEST(HeatFilter, AutomaticFidelityEstimatesTheNoise)
{
  auto sphere = Sphere(5);
  vtkDataArray* truth = AddPointArray(
    sphere, "truth", 1, [&](vtkIdType i, int) { return 50.0 * sphere->GetPoint(i)[2]; });
  std::mt19937 random(1);
  std::normal_distribution<double> gaussian(0.0, 5.0);
  vtkDataArray* f = AddPointArray(
    sphere, "f", 1, [&](vtkIdType i, int) { return truth->GetComponent(i, 0) + gaussian(random); });
  auto filter = MakeFilter(sphere);
  SetInputArray(filter, 0, "f");
  filter->AutomaticFidelityOn();
  filter->SetModeToSteadyState();
  filter->Update();
  double before = 0.0;
  double after = 0.0;
  for (vtkIdType i = 0; i < sphere->GetNumberOfPoints(); ++i)
  {
    before += std::pow(f->GetComponent(i, 0) - truth->GetComponent(i, 0), 2);
    after += std::pow(Result(filter)->GetComponent(i, 0) - truth->GetComponent(i, 0), 2);
  }
  EXPECT_LT(std::sqrt(after), 0.4 * std::sqrt(before));
}
