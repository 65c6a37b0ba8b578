// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "FilterTest.h"

#include "vtkCellData.h"
#include "vtkFVMHeatFilter.h"

#include <gtest/gtest.h>

#include <iostream>
#include <random>
#include <sstream>

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

TEST(HeatFilter, HasTheDocumentedDefaults)
{
  vtkNew<vtkFVMHeatFilter> filter;
  EXPECT_EQ(filter->GetTimeStep(), 1.0);
  EXPECT_EQ(filter->GetNumberOfTimeSteps(), 10);
  EXPECT_EQ(filter->GetUnits(), vtkFVMHeatFilter::UNITS_NATURAL);
  EXPECT_FALSE(filter->GetGenerateTimeSteps());
  EXPECT_EQ(filter->GetOutputInterval(), 1);
  EXPECT_EQ(filter->GetFidelityWeight(), 0.0);
  EXPECT_EQ(filter->GetMaskMode(), vtkFVMHeatFilter::MASK_MODE_INPAINT);
  EXPECT_EQ(filter->GetInitialFill(), vtkFVMHeatFilter::INITIAL_FILL_HARMONIC);
  EXPECT_FALSE(filter->GetHoldKnownValues());
  EXPECT_EQ(filter->GetRandomSeed(), 0);
  EXPECT_EQ(filter->GetAlongDiffusivity(), 1.0);
  EXPECT_EQ(filter->GetAcrossDiffusivity(), 1.0);
  EXPECT_EQ(filter->GetTimeIntegrator(), vtkFVMHeatFilter::TIME_INTEGRATOR_SECOND_ORDER);
  EXPECT_EQ(filter->GetSolver(), vtkFVMHeatFilter::SOLVER_AUTOMATIC);
  EXPECT_EQ(filter->GetTolerance(), 1e-10);
  EXPECT_EQ(filter->GetMaximumNumberOfIterations(), 1000);
  EXPECT_FALSE(filter->GetMergeCoincidentPoints());
  EXPECT_EQ(filter->GetMergeTolerance(), 0.0);
  EXPECT_STREQ(filter->GetResultArrayName(), "");
  EXPECT_EQ(filter->GetOutputPrecision(), vtkFVMHeatFilter::OUTPUT_PRECISION_INPUT);
  EXPECT_EQ(filter->GetCheckpointMemoryLimit(), 512);
  EXPECT_EQ(filter->GetMode(), vtkFVMHeatFilter::MODE_TIME_STEPS);
  EXPECT_EQ(filter->GetFWHM(), 0.0);
  EXPECT_FALSE(filter->GetAutomaticFidelity());
  EXPECT_EQ(filter->GetNoiseLevel(), 0.0);
  EXPECT_EQ(filter->GetBlurFWHM(), 0.0);
  EXPECT_EQ(filter->GetBlurSteps(), 4);
}

TEST(HeatFilter, EnumsAreNumberedInOrderAndHaveTexts)
{
  vtkNew<vtkFVMHeatFilter> filter;
  const auto expect = [&](int value, const char* text, int wantedValue, const char* wantedText)
  {
    EXPECT_EQ(value, wantedValue) << wantedText;
    EXPECT_STREQ(text, wantedText);
  };
  filter->SetUnitsToAbsolute();
  expect(filter->GetUnits(), filter->GetUnitsAsString(), 1, "Absolute");
  filter->SetUnitsToNatural();
  expect(filter->GetUnits(), filter->GetUnitsAsString(), 0, "Natural");
  filter->SetMaskModeToExclude();
  expect(filter->GetMaskMode(), filter->GetMaskModeAsString(), 1, "Exclude");
  filter->SetMaskModeToInpaint();
  expect(filter->GetMaskMode(), filter->GetMaskModeAsString(), 0, "Inpaint");
  filter->SetInitialFillToInput();
  expect(filter->GetInitialFill(), filter->GetInitialFillAsString(), 0, "Input");
  filter->SetInitialFillToMean();
  expect(filter->GetInitialFill(), filter->GetInitialFillAsString(), 1, "Mean");
  filter->SetInitialFillToNoise();
  expect(filter->GetInitialFill(), filter->GetInitialFillAsString(), 2, "Noise");
  filter->SetInitialFillToHarmonic();
  expect(filter->GetInitialFill(), filter->GetInitialFillAsString(), 3, "Harmonic");
  filter->SetTimeIntegratorToFirstOrder();
  expect(filter->GetTimeIntegrator(), filter->GetTimeIntegratorAsString(), 0, "FirstOrder");
  filter->SetTimeIntegratorToSecondOrder();
  expect(filter->GetTimeIntegrator(), filter->GetTimeIntegratorAsString(), 1, "SecondOrder");
  filter->SetSolverToAutomatic();
  expect(filter->GetSolver(), filter->GetSolverAsString(), 0, "Automatic");
  filter->SetSolverToDirect();
  expect(filter->GetSolver(), filter->GetSolverAsString(), 1, "Direct");
  filter->SetSolverToConjugateGradient();
  expect(filter->GetSolver(), filter->GetSolverAsString(), 2, "ConjugateGradient");
  filter->SetOutputPrecisionToSingle();
  expect(filter->GetOutputPrecision(), filter->GetOutputPrecisionAsString(), 0, "Single");
  filter->SetOutputPrecisionToDouble();
  expect(filter->GetOutputPrecision(), filter->GetOutputPrecisionAsString(), 1, "Double");
  filter->SetOutputPrecisionToInput();
  expect(filter->GetOutputPrecision(), filter->GetOutputPrecisionAsString(), 2, "Input");
  filter->SetModeToSteadyState();
  expect(filter->GetMode(), filter->GetModeAsString(), 1, "SteadyState");
  filter->SetModeToTimeSteps();
  expect(filter->GetMode(), filter->GetModeAsString(), 0, "TimeSteps");
  filter->SetMode(7); // setters neither clamp nor refuse
  expect(filter->GetMode(), filter->GetModeAsString(), 7, "Unknown");
}

TEST(HeatFilter, PrintSelfNamesEveryProperty)
{
  vtkNew<vtkFVMHeatFilter> filter;
  std::ostringstream text;
  filter->Print(text);
  for (const char* property : { "TimeStep", "NumberOfTimeSteps", "Units", "GenerateTimeSteps",
         "OutputInterval", "FidelityWeight", "MaskMode", "InitialFill", "HoldKnownValues",
         "RandomSeed", "AlongDiffusivity", "AcrossDiffusivity", "TimeIntegrator", "Solver",
         "Tolerance", "MaximumNumberOfIterations", "MergeCoincidentPoints", "MergeTolerance",
         "ResultArrayName", "OutputPrecision", "CheckpointMemoryLimit", "TimeUnit",
         "MeanEdgeLength", "ValueRange", "NumberOfIterations", "Residual", "NumberOfUnusedPoints",
         "FWHM", "AutomaticFidelity", "NoiseLevel", "Mode", "BlurFWHM", "BlurSteps" })
  {
    EXPECT_NE(text.str().find(std::string(property) + ": "), std::string::npos) << property;
  }
}

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

TEST(HeatFilter, ConstantStaysConstant)
{
  auto sphere = Sphere(3);
  AddPointArray(sphere, "f", 1, [](vtkIdType, int) { return 0.1; });
  auto filter = MakeFilter(sphere);
  SetInputArray(filter, 0, "f");
  filter->Update();
  double range[2];
  Result(filter)->GetRange(range);
  EXPECT_NEAR(range[0], 0.1, 1e-14);
  EXPECT_NEAR(range[1], 0.1, 1e-14);
}

TEST(HeatFilter, CosineOnAStripDecaysAtItsEigenvalue)
{
  const int n = 101;
  auto strip = Grid(n, 4);
  const double k = vtkMath::Pi() / (n - 1);
  AddPointArray(strip, "f", 1, [&](vtkIdType i, int) { return std::cos(k * (i % n)); });
  auto filter = MakeFilter(strip);
  SetInputArray(filter, 0, "f");
  filter->SetUnitsToAbsolute();
  filter->SetTimeStep(50.0);
  filter->SetNumberOfTimeSteps(20);
  filter->Update();
  EXPECT_NEAR(Result(filter)->GetComponent(0, 0), std::exp(-k * k * 1000.0), 2e-4);
}

TEST(HeatFilter, RealisesTheFWHMWithinOnePercent)
{
  const int n = 121;
  const int middle = n / 2;
  auto plane = Grid(n, n, 0.5);
  AddPointArray(
    plane, "f", 1, [&](vtkIdType i, int) { return i == middle + n * middle ? 1.0 : 0.0; });
  for (const int units : { vtkFVMHeatFilter::UNITS_NATURAL, vtkFVMHeatFilter::UNITS_ABSOLUTE })
  {
    auto filter = MakeFilter(plane);
    SetInputArray(filter, 0, "f");
    filter->SetUnits(units); // a width is in coordinate units, independent of Units
    filter->SetFWHM(10.0);
    filter->Update();
    const auto at = [&](int i) { return Result(filter)->GetComponent(i + n * middle, 0); };
    const double half = 0.5 * at(middle);
    int i = middle;
    while (at(i + 1) > half)
    {
      ++i;
    }
    // The logarithm of the Gaussian is interpolated, since it is closer to linear between two
    // points.
    const double part = std::log(at(i) / half) / std::log(at(i) / at(i + 1));
    const double width = 2.0 * 0.5 * (i - middle + part);
    std::cout << "FWHM 10 is realised as " << width << " with 20 solves\n";
    EXPECT_NEAR(width, 10.0, 0.1);
  }
}

TEST(HeatFilter, SteadyStateWithoutConstraintsIsTheMeanOfEachComponent)
{
  auto surface = Grid(6, 6);
  vtkNew<vtkPoints> points; // a second sheet above the first
  points->DeepCopy(surface->GetPoints());
  vtkNew<vtkCellArray> triangles;
  triangles->DeepCopy(surface->GetPolys());
  triangles->Append(surface->GetPolys(), 36);
  for (int i = 0; i < 36; ++i)
  {
    double p[3];
    surface->GetPoint(i, p);
    points->InsertNextPoint(p[0], p[1], 5.0);
  }
  surface->SetPoints(points);
  surface->SetPolys(triangles);
  vtkDataArray* f = AddRough(surface);
  const std::vector<double> areas = ControlAreas(surface);
  auto filter = MakeFilter(surface);
  filter->SetModeToSteadyState();
  filter->Update();
  for (const int first : { 0, 36 })
  {
    double mean = 0.0;
    for (int i = first; i < first + 36; ++i)
    {
      mean += areas[i] * f->GetComponent(i, 0) / 25.0;
    }
    for (int i = first; i < first + 36; ++i)
    {
      EXPECT_NEAR(Result(filter)->GetComponent(i, 0), mean, 1e-12);
    }
  }
}

TEST(HeatFilter, SteadyStateWithFidelityIsTheLimitOfManySteps)
{
  auto sphere = Sphere(3);
  AddRough(sphere);
  auto filter = MakeFilter(sphere);
  filter->SetFidelityWeight(0.5);
  filter->SetModeToSteadyState();
  filter->Update();
  EXPECT_EQ(History(filter)->GetNumberOfRows(), 2);
  const auto steady = Copy(Result(filter));
  filter->SetModeToTimeSteps();
  filter->SetTimeStep(4.0);
  filter->SetNumberOfTimeSteps(40);
  filter->Update();
  EXPECT_LT(LargestDifference(steady, Result(filter)), 1e-9);
}

TEST(HeatFilter, SteadyStateBetweenFixedEndsIsLinear)
{
  const int n = 21;
  auto strip = Grid(n, 5);
  AddPointArray(strip, "f", 1, [&](vtkIdType i, int) { return i % n == n - 1 ? 10.0 : 0.0; });
  AddPointArray(
    strip, "ends", 1, [&](vtkIdType i, int) { return i % n == 0 || i % n == n - 1; }, VTK_CHAR);
  auto filter = MakeFilter(strip);
  SetInputArray(filter, 0, "f");
  SetInputArray(filter, 3, "ends");
  filter->SetModeToSteadyState();
  filter->Update();
  for (vtkIdType i = 0; i < strip->GetNumberOfPoints(); ++i)
  {
    EXPECT_NEAR(Result(filter)->GetComponent(i, 0), 0.5 * static_cast<double>(i % n), 1e-9);
  }
}

TEST(HeatFilter, FixedPointsKeepTheirValueWhileOthersChange)
{
  auto sphere = Sphere(3);
  vtkDataArray* f = AddRough(sphere, 2);
  AddPointArray(sphere, "fixed", 1, [](vtkIdType i, int) { return i % 5 == 0 ? -2.0 : 0.0; });
  auto filter = MakeFilter(sphere);
  SetInputArray(filter, 3, "fixed");
  for (const int solver : { vtkFVMHeatFilter::SOLVER_DIRECT,
         vtkFVMHeatFilter::SOLVER_CONJUGATE_GRADIENT, vtkFVMHeatFilter::SOLVER_MULTIGRID })
  {
    for (const double fidelity : { 0.0, 1.0 })
    {
      filter->SetSolver(solver);
      filter->SetFidelityWeight(fidelity);
      filter->Update();
      for (vtkIdType i = 0; i < sphere->GetNumberOfPoints(); ++i)
      {
        for (int k = 0; k < 2; ++k)
        {
          const double change =
            std::abs(Result(filter)->GetComponent(i, k) - f->GetComponent(i, k));
          EXPECT_EQ(change == 0.0, i % 5 == 0) << i;
        }
      }
    }
  }
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

TEST(HeatFilter, ComponentsTogetherEqualSingleComponents)
{
  auto sphere = Sphere(4);
  vtkDataArray* f = AddRough(sphere, 5);
  for (int k = 0; k < 5; ++k)
  {
    AddPointArray(sphere, ("f" + std::to_string(k)).c_str(), 1,
      [&](vtkIdType i, int) { return f->GetComponent(i, k); });
  }
  for (const int solver : { vtkFVMHeatFilter::SOLVER_DIRECT,
         vtkFVMHeatFilter::SOLVER_CONJUGATE_GRADIENT, vtkFVMHeatFilter::SOLVER_MULTIGRID })
  {
    auto together = MakeFilter(sphere);
    together->SetSolver(solver);
    together->Update();
    ASSERT_EQ(Result(together)->GetNumberOfComponents(), 5);
    for (int k = 0; k < 5; ++k)
    {
      auto alone = MakeFilter(sphere);
      alone->SetSolver(solver);
      alone->SetUnitsToAbsolute(); // R differs, h is the same
      alone->SetTimeStep(together->GetTimeUnit());
      const std::string name = "f" + std::to_string(k);
      SetInputArray(alone, 0, name.c_str());
      together->SetUnitsToAbsolute();
      together->SetTimeStep(alone->GetTimeStep());
      together->Update();
      alone->Update();
      for (vtkIdType i = 0; i < sphere->GetNumberOfPoints(); ++i)
      {
        ASSERT_EQ(Result(together)->GetComponent(i, k),
          Result(alone, (name + "Diffused").c_str())->GetComponent(i, 0));
      }
    }
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
           vtkFVMHeatFilter::TIME_INTEGRATOR_SECOND_ORDER })
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

TEST(HeatFilter, IntegratorsDifferAndAgreeInTheLimit)
{
  auto sphere = Sphere(3);
  AddRough(sphere);
  double differences[2];
  for (const int refinement : { 0, 1 })
  {
    vtkSmartPointer<vtkDataArray> results[2];
    for (const int integrator : { 0, 1 })
    {
      auto filter = MakeFilter(sphere);
      filter->SetTimeIntegrator(integrator);
      filter->SetNumberOfTimeSteps(refinement ? 160 : 10);
      filter->SetTimeStep(10.0 / filter->GetNumberOfTimeSteps());
      filter->Update();
      results[integrator] = Result(filter);
    }
    differences[refinement] = LargestDifference(results[0], results[1]);
  }
  EXPECT_GT(differences[0], 1e-4);
  EXPECT_LT(differences[1], differences[0] / 8.0);
}
