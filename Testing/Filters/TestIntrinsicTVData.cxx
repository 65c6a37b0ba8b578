// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "IntrinsicTVTest.h"

#include <gtest/gtest.h>

#include <random>

using namespace IntrinsicTVTest;

// --- Masks, fixed and held values ---

TEST(IntrinsicTVData, MissingValuesAreNotReadAndAnEdgeIsContinued)
{
  // A straight jump of height 1 along a grid line, whose middle is missing.
  auto grid = Grid(21, 21);
  const auto jump = [](vtkIdType i) { return i % 21 > 10 ? 1.0 : 0.0; };
  const auto lost = [](vtkIdType i)
  { return std::abs(static_cast<double>(i % 21) - 10.5) < 4.0 && std::abs(i / 21 - 10) < 3; };
  AddPointArray(grid, "mask", 1, [&](vtkIdType i, int) { return lost(i); });
  const Setting cases[] = { [](Filter* f) { f->SetTimeStep(100.0), f->SetNumberOfTimeSteps(50); },
    [](Filter* f) { f->SetModeToSteadyState(); },
    [](Filter* f) { f->SetModeToSteadyState(), f->HoldKnownValuesOn(); },
    [](Filter* f) { f->SetModeToSteadyState(), f->SetFidelityNormToL1(); } };
  const auto run = [&](const Setting& set, double garbage)
  {
    AddPointArray(grid, "f", 1, [&](vtkIdType p, int) { return lost(p) ? garbage : jump(p); });
    auto filter = MakeFilter(grid);
    SetInputArray(filter, 0, "f");
    SetInputArray(filter, 1, "mask");
    filter->SetFidelityWeight(20.0);
    filter->SetStopTolerance(1e-6);
    set(filter);
    filter->Update();
    return Copy(Result(filter));
  };
  const auto error = [&](vtkDataArray* result)
  {
    double sum = 0.0;
    for (vtkIdType i = 0; i < grid->GetNumberOfPoints(); ++i)
    {
      sum += lost(i) ? std::abs(result->GetComponent(i, 0) - jump(i)) : 0.0;
    }
    return sum;
  };
  const double linear =
    error(run([](Filter* f) { f->SetEdgeFunctionToConstant(), f->SetModeToSteadyState(); }, 0.0));
  for (std::size_t c = 0; c < std::size(cases); ++c)
  {
    const auto result = run(cases[c], -1e4);
    EXPECT_EQ(LargestDifference(result, run(cases[c], std::nan(""))), 0.0) << c;
    EXPECT_LT(error(result), 0.5 * linear) << c << ' ' << linear;
  }
}

TEST(IntrinsicTVData, L1RemovesImpulsesAndKeepsContrastEvenWithAMask)
{
  // A sphere with two values, with impulses on a twelfth of the points and with missing points.
  auto sphere = Sphere(4);
  const auto clean = [&](vtkIdType i) { return sphere->GetPoint(i)[0] > 0.3 ? 0.75 : 0.25; };
  const auto impulse = [](vtkIdType i) { return Rough(i, 0) > 5.0 / 6.0; };
  AddPointArray(sphere, "f", 1,
    [&](vtkIdType i, int) { return impulse(i) ? static_cast<double>(i % 2) : clean(i); });
  AddPointArray(sphere, "mask", 1, [&](vtkIdType i, int) { return sphere->GetPoint(i)[1] > 0.9; });
  for (const bool steady : { true, false })
  {
    auto filter = MakeFilter(sphere);
    SetInputArray(filter, 0, "f");
    SetInputArray(filter, 1, "mask");
    filter->SetFidelityNormToL1();
    filter->SetFidelityWeight(1.5);
    filter->SetMode(steady ? Filter::MODE_STEADY_STATE : Filter::MODE_TIME_STEPS);
    filter->SetTimeStep(0.2);
    filter->SetNumberOfTimeSteps(30);
    filter->Update();
    double sum = 0.0;
    vtkIdType exact = 0;
    for (vtkIdType i = 0; i < sphere->GetNumberOfPoints(); ++i)
    {
      const double error = std::abs(Result(filter)->GetComponent(i, 0) - clean(i));
      sum += error;
      exact += error < 0.01;
    }
    const double count = static_cast<double>(sphere->GetNumberOfPoints());
    EXPECT_LT(sum / count, 0.02) << steady; // 0.04 with the impulses
    EXPECT_GT(static_cast<double>(exact), 0.9 * count) << steady;
  }
}

// --- Directions ---

TEST(IntrinsicTVData, AcrossEdgeFunctionActsAcrossTheDirection)
{
  // Waves along x and along y, with e1 = x. Constant across the direction smooths the waves along y
  // as linear diffusion does.
  auto grid = Grid(30, 30);
  AddPointArray(grid, "e1", 3, [](vtkIdType, int k) { return k == 0; });
  const auto decay = [&](bool alongX, const Setting& set)
  {
    AddPointArray(grid, "f", 1,
      [&](vtkIdType i, int) {
        return std::cos(vtkMath::Pi() * static_cast<double>(alongX ? i % 30 : i / 30) / 29.0 * 4.0);
      });
    auto filter = MakeFilter(grid);
    SetInputArray(filter, 0, "f");
    SetInputArray(filter, 2, "e1");
    filter->SetFidelityWeight(0.0);
    filter->SetTimeStep(0.3);
    set(filter);
    filter->Update();
    double largest = 0.0;
    for (vtkIdType i = 10; i < 20; ++i) // not at the corners, whose cells are asymmetric
    {
      for (vtkIdType j = 10; j < 20; ++j)
      {
        largest = std::max(largest, std::abs(Result(filter)->GetComponent(i + 30 * j, 0)));
      }
    }
    return largest;
  };
  const Setting constants = [](Filter* f) { f->SetEdgeFunctionToConstant(); };
  const Setting mixed = [](Filter* f)
  {
    f->SetEdgeFunctionToPeronaMalikRational(), f->SetEdgeThreshold(0.01),
      f->SetAcrossEdgeFunctionToConstant();
  };
  const Setting same = [](Filter* f)
  { f->SetEdgeFunctionToPeronaMalikRational(), f->SetEdgeThreshold(0.01); };
  EXPECT_NEAR(decay(false, mixed), decay(false, constants), 1e-3);
  EXPECT_NEAR(decay(true, mixed), decay(true, same), 1e-3);
  EXPECT_GT(decay(true, mixed), decay(true, constants) + 0.1);
}

// --- Fidelity chosen automatically ---

TEST(IntrinsicTVData, AutomaticFidelityLeavesTheNoiseInTheResidual)
{
  std::mt19937 random;
  std::normal_distribution<double> noiseOf(0.0, 0.25);
  auto sphere = Sphere(4);
  AddPointArray(sphere, "f", 2,
    [&](vtkIdType i, int) { return 2.0 * Cap(sphere->GetPoint(i)) + noiseOf(random); });
  sphere->GetPointData()->SetActiveScalars("f");
  const auto areas = ControlAreas(sphere);
  auto filter = MakeFilter(sphere);
  filter->SetModeToSteadyState();
  filter->AutomaticFidelityOn();
  for (const double noise : { 0.1, 0.2, 0.0 })
  {
    filter->SetNoiseLevel(noise);
    filter->Update();
    vtkDataArray* f = sphere->GetPointData()->GetArray("f");
    double square = 0.0;
    double area = 0.0;
    for (vtkIdType i = 0; i < f->GetNumberOfTuples(); ++i)
    {
      area += 2.0 * areas[i];
      for (int k = 0; k < 2; ++k)
      {
        square +=
          areas[i] * std::pow(Result(filter)->GetComponent(i, k) - f->GetComponent(i, k), 2);
      }
    }
    const double discrepancy = std::sqrt(square / area);
    const double wanted = noise > 0.0 ? noise : 0.25; // 0 means estimated
    EXPECT_NEAR(discrepancy, wanted, (noise > 0.0 ? 0.02 : 0.1) * wanted);
  }
  // FidelityWeight is ignored, and the weight that was found gives the same run.
  const auto found = Copy(Result(filter));
  const double fidelity = filter->GetEffectiveFidelityWeight();
  filter->SetFidelityWeight(1234.0);
  filter->Update();
  EXPECT_TRUE(Identical(Result(filter), found));
  filter->AutomaticFidelityOff();
  filter->SetFidelityWeight(fidelity);
  filter->Update();
  EXPECT_LT(LargestDifference(Result(filter), found), 1e-6);
}

TEST(IntrinsicTVData, AutomaticFidelityWorksWithOtherEdgeFunctions)
{
  auto sphere = Sphere(3);
  AddPointArray(sphere, "f", 1,
    [&](vtkIdType i, int k) { return Cap(sphere->GetPoint(i)) + 0.2 * Rough(i, k); });
  sphere->GetPointData()->SetActiveScalars("f");
  const auto areas = ControlAreas(sphere);
  auto filter = MakeFilter(sphere);
  filter->SetEdgeFunctionToCharbonnier();
  filter->SetModeToSteadyState();
  filter->AutomaticFidelityOn();
  filter->SetNoiseLevel(0.1);
  filter->Update();
  vtkDataArray* f = sphere->GetPointData()->GetArray("f");
  double square = 0.0;
  double area = 0.0;
  for (vtkIdType i = 0; i < f->GetNumberOfTuples(); ++i)
  {
    area += areas[i];
    square += areas[i] * std::pow(Result(filter)->GetComponent(i, 0) - f->GetComponent(i, 0), 2);
  }
  EXPECT_NEAR(std::sqrt(square / area), 0.1, 0.002);
}
