// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "IntrinsicTVTest.h"

#include <gtest/gtest.h>

#include <iostream>

using namespace IntrinsicTVTest;

// --- Models ---

TEST(IntrinsicTVModels, TotalIsConserved)
{
  auto sphere = Sphere(3);
  vtkDataArray* f = AddRough(sphere, 3);
  AddPointArray(sphere, "mask", 1, [](vtkIdType i, int) { return i % 7 == 0; });
  const auto areas = ControlAreas(sphere);
  const Setting without = [](Filter* g) { g->SetFidelityWeight(0.0); };
  const Setting implicit = [](Filter* g) { g->SetTimeIntegratorToImplicit(); };
  const Setting edges = [](Filter* g) { g->SetDiscretizationToCrouzeixRaviart(); };
  std::vector<std::vector<Setting>> cases{ {}, { implicit }, { edges }, { implicit, edges },
    { without }, { without, implicit }, { without, edges },
    { without, [](Filter* g) { SetInputArray(g, 1, "mask"); } },
    { [](Filter* g) { g->SetModeToSteadyState(); } },
    { without, [](Filter* g) { g->SetModeToSteadyState(); } } };
  for (int edge = 1; edge < 6; ++edge)
  {
    cases.push_back({ without, [edge](Filter* g) { g->SetEdgeFunction(edge); } });
  }
  for (std::size_t c = 0; c < cases.size(); ++c)
  {
    auto filter = MakeFilter(sphere);
    for (const Setting& set : cases[c])
    {
      set(filter);
    }
    filter->Update();
    ASSERT_NE(Result(filter), nullptr) << c;
    const double magnitude = TotalMagnitude(areas, f);
    for (int k = 0; k < 3; ++k)
    {
      const std::string total = "Total_" + std::to_string(k);
      const vtkIdType last = History(filter)->GetNumberOfRows() - 1;
      EXPECT_NEAR(HistoryAt(filter, last, total.c_str()), HistoryAt(filter, 0, total.c_str()),
        1e-12 * magnitude)
        << c;
      EXPECT_NEAR(
        Total(areas, Result(filter), k), HistoryAt(filter, last, total.c_str()), 1e-12 * magnitude)
        << c;
    }
    EXPECT_GT(LargestDifference(Result(filter), f), 0.01) << c;
  }
}

TEST(IntrinsicTVModels, EnergyDecreasesToThatOfTheFinalState)
{
  auto sphere = Sphere(3);
  AddRough(sphere);
  const Setting cases[] = { [](Filter* f) { f->SetBeta(0.01); },
    [](Filter* f) { f->SetTimeIntegratorToImplicit(); },
    [](Filter* f) { f->SetEdgeFunctionToCharbonnier(); } };
  for (const Setting& set : cases)
  {
    auto filter = MakeFilter(sphere);
    set(filter);
    filter->SetTimeStep(0.05);
    filter->Update();
    for (vtkIdType row = 1; row <= 10; ++row)
    {
      EXPECT_LT(HistoryAt(filter, row, "Energy"), HistoryAt(filter, row - 1, "Energy"));
    }
  }
}

TEST(IntrinsicTVModels, ACapShrinksAtItsRateWithCrouzeixRaviartCloserThanLinear)
{
  // The exact flow of a cap's indicator: the plateaus approach each other at perimeter/area.
  auto sphere = Sphere(5);
  AddCap(sphere);
  const auto areas = ControlAreas(sphere);
  const double time = 0.2;
  const double perimeter = 2.0 * vtkMath::Pi() * std::sqrt(0.75);
  const double inside = 1.0 - time * perimeter / vtkMath::Pi(); // area 2 pi (1 - 1/2)
  const double outside = time * perimeter / (3.0 * vtkMath::Pi()); // the rest of 4 pi
  const auto error = [&](int discretization)
  {
    auto filter = MakeFilter(sphere);
    filter->SetUnitsToAbsolute();
    filter->SetTimeIntegratorToImplicit();
    filter->SetTimeStep(time);
    filter->SetNumberOfTimeSteps(1);
    filter->SetFidelityWeight(0.0);
    filter->SetDiscretization(discretization);
    filter->SetOutputPrecisionToDouble();
    filter->Update();
    double sum = 0.0;
    double area = 0.0;
    for (vtkIdType i = 0; i < sphere->GetNumberOfPoints(); ++i)
    {
      const double z = Height(sphere->GetPoint(i));
      if (std::abs(z - 0.5) > 0.2) // only the plateaus, away from the jump
      {
        sum +=
          areas[i] * std::abs(Result(filter)->GetComponent(i, 0) - (z > 0.5 ? inside : outside));
        area += areas[i];
      }
    }
    return sum / area;
  };
  const double linear = error(Filter::DISCRETIZATION_LINEAR);
  const double crouzeixRaviart = error(Filter::DISCRETIZATION_CROUZEIX_RAVIART);
  std::cout << "mean error of the plateaus: Linear " << linear << ", CrouzeixRaviart "
            << crouzeixRaviart << "\n";
  EXPECT_LT(linear, 0.02);
  EXPECT_LT(crouzeixRaviart, 0.005);
  EXPECT_LT(crouzeixRaviart, 0.5 * linear);
}

TEST(IntrinsicTVModels, SteadyStateIsTheLimitOfALongRun)
{
  auto sphere = Sphere(3);
  AddRough(sphere, 2);
  auto steady = MakeFilter(sphere);
  steady->SetModeToSteadyState();
  steady->SetStopTolerance(1e-7);
  steady->Update();
  EXPECT_EQ(History(steady)->GetNumberOfRows(), 2);
  EXPECT_LE(steady->GetResidual(), 1e-7);

  auto implicit = MakeFilter(sphere);
  implicit->SetTimeIntegratorToImplicit();
  implicit->SetTimeStep(10.0);
  implicit->SetStopTolerance(1e-7);
  implicit->Update();
  EXPECT_LT(LargestDifference(Result(implicit), Result(steady)), 1e-3);
  EXPECT_NEAR(HistoryAt(implicit, 10, "Energy"), HistoryAt(steady, 1, "Energy"),
    1e-6 * HistoryAt(steady, 1, "Energy"));

  auto lagged = MakeFilter(sphere);
  lagged->SetTimeStep(10.0);
  lagged->SetNumberOfTimeSteps(60);
  lagged->SetBeta(1e-8);
  lagged->Update();
  EXPECT_LT(LargestDifference(Result(lagged), Result(steady)), 1e-2);
}

TEST(IntrinsicTVModels, TheColumnErrorBoundIsNotBelowTheError)
{
  auto sphere = Sphere(3);
  AddPointArray(sphere, "f", 2, [](vtkIdType i, int k) { return 100.0 * Rough(i, k); });
  sphere->GetPointData()->SetActiveScalars("f");
  const auto areas = ControlAreas(sphere);
  const auto solve = [&](double tolerance, bool implicit)
  {
    auto filter = MakeFilter(sphere);
    filter->SetStopTolerance(tolerance);
    if (implicit)
    {
      filter->SetTimeIntegratorToImplicit();
      filter->SetNumberOfTimeSteps(1);
    }
    else
    {
      filter->SetModeToSteadyState();
    }
    filter->Update();
    return filter;
  };
  for (const bool implicit : { false, true })
  {
    const auto exact = solve(1e-9, implicit);
    for (const double tolerance : { 1e-1, 1e-3 })
    {
      const auto filter = solve(tolerance, implicit);
      double area = 0.0;
      double sum = 0.0;
      for (vtkIdType i = 0; i < sphere->GetNumberOfPoints(); ++i)
      {
        for (int k = 0; k < 2; ++k)
        {
          const double error =
            Result(filter)->GetComponent(i, k) - Result(exact)->GetComponent(i, k);
          sum += areas[static_cast<std::size_t>(i)] * error * error;
        }
        area += areas[static_cast<std::size_t>(i)];
      }
      const double bound = HistoryAt(filter, 1, "ErrorBound"); // in the units of the array
      EXPECT_GE(bound + HistoryAt(exact, 1, "ErrorBound"), std::sqrt(sum / area)) << tolerance;
      EXPECT_GT(bound, HistoryAt(exact, 1, "ErrorBound"));
      EXPECT_LT(bound, 100.0);
      EXPECT_EQ(HistoryAt(filter, 0, "ErrorBound"), 0.0);
    }
  }
  auto lagged = MakeFilter(sphere);
  lagged->Update();
  EXPECT_EQ(History(lagged)->GetColumnByName("ErrorBound"), nullptr);
}

// --- Channels ---

TEST(IntrinsicTVModels, JointCouplingIsInvariantUnderRotationsOfColorSpace)
{
  auto sphere = Sphere(3);
  vtkDataArray* f = AddRough(sphere, 2);
  vtkNew<vtkPolyData> turned;
  turned->ShallowCopy(sphere);
  const double c = 0.6; // (c, s) is a turn by some 53 degrees
  const double s = 0.8;
  const auto turn = [&](vtkDataArray* array, vtkIdType i, int k)
  {
    const double x = array->GetComponent(i, 0);
    const double y = array->GetComponent(i, 1);
    return k == 0 ? c * x - s * y : s * x + c * y;
  };
  AddPointArray(turned, "f", 2, [&](vtkIdType i, int k) { return turn(f, i, k); });
  const auto difference = [&](const Setting& set)
  {
    vtkSmartPointer<vtkDataArray> results[2];
    for (int i = 0; i < 2; ++i)
    {
      auto filter = MakeFilter(i == 0 ? sphere.Get() : turned.Get());
      SetInputArray(filter, 0, "f");
      filter->SetUnitsToAbsolute();
      filter->SetTimeStep(0.05);
      filter->SetFidelityWeight(5.0);
      set(filter);
      filter->Update();
      results[i] = Copy(Result(filter));
    }
    double largest = 0.0;
    for (vtkIdType i = 0; i < f->GetNumberOfTuples(); ++i)
    {
      for (int k = 0; k < 2; ++k)
      {
        largest =
          std::max(largest, std::abs(turn(results[0], i, k) - results[1]->GetComponent(i, k)));
      }
    }
    return largest;
  };
  EXPECT_LT(difference([](Filter* g) { g->SetTolerance(1e-10); }), 1e-7);
  EXPECT_LT(difference(
              [](Filter* g)
              {
                g->SetFidelityNormToL1();
                g->SetTimeIntegratorToImplicit();
                g->SetStopTolerance(1e-5);
              }),
    0.02);
  EXPECT_GT(difference([](Filter* g) { g->SetChannelCouplingToPerChannel(); }), 1e-2);
}
