// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "FilterTest.h"

#include "vtkFVMHeatFilter.h"
#include "vtkIntrinsicTVFilter.h"
#include "vtkMultiBlockDataSet.h"

#include <gtest/gtest.h>

#include <functional>
#include <iostream>
#include <random>
#include <sstream>

using namespace FilterTest;

namespace
{

using Filter = vtkIntrinsicTVFilter;
using Setting = std::function<void(Filter*)>;

vtkSmartPointer<Filter> MakeFilter(vtkDataObject* surface)
{
  auto filter = vtkSmartPointer<Filter>::New();
  filter->SetInputDataObject(surface);
  return filter;
}

vtkDataArray* Result(Filter* filter)
{
  return FilterTest::Result(filter, "fTV");
}

/// The axis of the cap: its rim follows no edges of the mesh.
double Height(const double* p)
{
  return (p[0] + 2.0 * p[1] + 3.0 * p[2]) / std::sqrt(14.0);
}

/// 1 on the cap with cos(angle) > 1/2, 0 elsewhere.
double Cap(const double* p)
{
  return Height(p) > 0.5 ? 1.0 : 0.0;
}

void AddCap(vtkPolyData* sphere)
{
  AddPointArray(sphere, "f", 1, [&](vtkIdType i, int) { return Cap(sphere->GetPoint(i)); });
  sphere->GetPointData()->SetActiveScalars("f");
}

double LargestMagnitude(vtkDataArray* array)
{
  double largest = 0.0;
  for (vtkIdType i = 0; i < array->GetNumberOfTuples(); ++i)
  {
    for (int k = 0; k < array->GetNumberOfComponents(); ++k)
    {
      largest = std::max(largest, std::abs(array->GetComponent(i, k)));
    }
  }
  return largest;
}

} // namespace

// --- Properties ---

TEST(IntrinsicTVFilter, HasTheDocumentedDefaults)
{
  vtkNew<Filter> filter;
  EXPECT_EQ(filter->GetTimeStep(), 1.0);
  EXPECT_EQ(filter->GetNumberOfTimeSteps(), 10);
  EXPECT_EQ(filter->GetFidelityWeight(), 3.0);
  EXPECT_EQ(filter->GetTimeIntegrator(), Filter::TIME_INTEGRATOR_FIRST_ORDER);
  EXPECT_EQ(filter->GetMode(), Filter::MODE_TIME_STEPS);
  EXPECT_EQ(filter->GetEdgeFunction(), Filter::EDGE_FUNCTION_TOTAL_VARIATION);
  EXPECT_EQ(filter->GetAcrossEdgeFunction(), Filter::ACROSS_EDGE_FUNCTION_SAME);
  EXPECT_EQ(filter->GetBeta(), 1e-6);
  EXPECT_EQ(filter->GetEdgeThreshold(), 0.1);
  EXPECT_EQ(filter->GetChannelCoupling(), Filter::CHANNEL_COUPLING_JOINT);
  EXPECT_EQ(filter->GetFidelityNorm(), Filter::FIDELITY_NORM_L2);
  EXPECT_FALSE(filter->GetAutomaticFidelity());
  EXPECT_EQ(filter->GetNoiseLevel(), 0.0);
  EXPECT_EQ(filter->GetDiscretization(), Filter::DISCRETIZATION_LINEAR);
  EXPECT_EQ(filter->GetStopTolerance(), 1e-4);
}

TEST(IntrinsicTVFilter, EnumsAreNumberedInOrderAndHaveTexts)
{
  vtkNew<Filter> filter;
  const auto expect = [&](int value, const char* text, int wantedValue, const char* wantedText)
  {
    EXPECT_EQ(value, wantedValue) << wantedText;
    EXPECT_STREQ(text, wantedText);
  };
  const auto mode = [&](int v, const char* t)
  { expect(filter->GetMode(), filter->GetModeAsString(), v, t); };
  filter->SetModeToSteadyState();
  mode(1, "SteadyState");
  filter->SetModeToTimeSteps();
  mode(0, "TimeSteps");
  const auto edge = [&](int v, const char* t)
  { expect(filter->GetEdgeFunction(), filter->GetEdgeFunctionAsString(), v, t); };
  filter->SetEdgeFunctionToPeronaMalikExponential();
  edge(1, "PeronaMalikExponential");
  filter->SetEdgeFunctionToTotalVariation();
  edge(0, "TotalVariation");
  filter->SetEdgeFunctionToPeronaMalikRational();
  edge(2, "PeronaMalikRational");
  filter->SetEdgeFunctionToCharbonnier();
  edge(3, "Charbonnier");
  filter->SetEdgeFunctionToWeickert();
  edge(4, "Weickert");
  filter->SetEdgeFunctionToConstant();
  edge(5, "Constant");
  const auto across = [&](int v, const char* t)
  { expect(filter->GetAcrossEdgeFunction(), filter->GetAcrossEdgeFunctionAsString(), v, t); };
  filter->SetAcrossEdgeFunctionToTotalVariation();
  across(1, "TotalVariation");
  filter->SetAcrossEdgeFunctionToSame();
  across(0, "Same");
  filter->SetAcrossEdgeFunctionToPeronaMalikExponential();
  across(2, "PeronaMalikExponential");
  filter->SetAcrossEdgeFunctionToPeronaMalikRational();
  across(3, "PeronaMalikRational");
  filter->SetAcrossEdgeFunctionToCharbonnier();
  across(4, "Charbonnier");
  filter->SetAcrossEdgeFunctionToWeickert();
  across(5, "Weickert");
  filter->SetAcrossEdgeFunctionToConstant();
  across(6, "Constant");
  const auto coupling = [&](int v, const char* t)
  { expect(filter->GetChannelCoupling(), filter->GetChannelCouplingAsString(), v, t); };
  filter->SetChannelCouplingToPerChannel();
  coupling(0, "PerChannel");
  filter->SetChannelCouplingToJoint();
  coupling(1, "Joint");
  const auto norm = [&](int v, const char* t)
  { expect(filter->GetFidelityNorm(), filter->GetFidelityNormAsString(), v, t); };
  filter->SetFidelityNormToL1();
  norm(1, "L1");
  filter->SetFidelityNormToL2();
  norm(0, "L2");
  const auto space = [&](int v, const char* t)
  { expect(filter->GetDiscretization(), filter->GetDiscretizationAsString(), v, t); };
  filter->SetDiscretizationToCrouzeixRaviart();
  space(1, "CrouzeixRaviart");
  filter->SetDiscretizationToLinear();
  space(0, "Linear");
  const auto time = [&](int v, const char* t)
  { expect(filter->GetTimeIntegrator(), filter->GetTimeIntegratorAsString(), v, t); };
  filter->SetTimeIntegratorToImplicit();
  time(2, "Implicit");
  filter->SetTimeIntegratorToFirstOrder();
  time(0, "FirstOrder");
  filter->SetEdgeFunction(17), edge(17, "Unknown"); // setters neither clamp nor refuse
}

TEST(IntrinsicTVFilter, PrintSelfNamesEveryProperty)
{
  vtkNew<Filter> filter;
  std::ostringstream text;
  filter->Print(text);
  for (const char* property :
    { "TimeStep", "FidelityWeight", "Mode", "EdgeFunction", "AcrossEdgeFunction", "Beta",
      "EdgeThreshold", "ChannelCoupling", "FidelityNorm", "AutomaticFidelity", "NoiseLevel",
      "EffectiveFidelityWeight", "Discretization", "StopTolerance" })
  {
    EXPECT_NE(text.str().find(std::string(property) + ": "), std::string::npos) << property;
  }
}

TEST(IntrinsicTVFilter, UsePaperSchemeSetsThePapersReadingAndNothingElse)
{
  vtkNew<Filter> filter;
  filter->SetModeToSteadyState();
  filter->SetTimeIntegratorToImplicit();
  filter->SetEdgeFunctionToWeickert();
  filter->SetAcrossEdgeFunctionToConstant();
  filter->SetFidelityNormToL1();
  filter->AutomaticFidelityOn();
  filter->SetDiscretizationToCrouzeixRaviart();
  filter->SetMaskModeToExclude();
  filter->SetFidelityWeight(7.0);
  filter->SetBeta(0.25);
  filter->SetEdgeThreshold(0.5);
  filter->UsePaperScheme();
  EXPECT_STREQ(filter->GetModeAsString(), "TimeSteps");
  EXPECT_STREQ(filter->GetTimeIntegratorAsString(), "FirstOrder");
  EXPECT_STREQ(filter->GetEdgeFunctionAsString(), "TotalVariation");
  EXPECT_STREQ(filter->GetAcrossEdgeFunctionAsString(), "Same");
  EXPECT_STREQ(filter->GetChannelCouplingAsString(), "PerChannel");
  EXPECT_STREQ(filter->GetFidelityNormAsString(), "L2");
  EXPECT_FALSE(filter->GetAutomaticFidelity());
  EXPECT_STREQ(filter->GetDiscretizationAsString(), "Linear");
  EXPECT_STREQ(filter->GetMaskModeAsString(), "Inpaint");
  EXPECT_STREQ(filter->GetInitialFillAsString(), "Input");
  EXPECT_EQ(filter->GetFidelityWeight(), 7.0);
  EXPECT_EQ(filter->GetBeta(), 0.25);
  EXPECT_EQ(filter->GetEdgeThreshold(), 0.5);
}

TEST(IntrinsicTVFilter, BadPropertiesAreNamedWithTheirValueAndWhatIsAllowed)
{
  auto grid = Grid(4, 4);
  AddRough(grid);
  const std::pair<Setting, const char*> cases[] = {
    { [](Filter* f) { f->SetBeta(0.0); }, "Beta is 0; allowed: finite numbers above 0" },
    { [](Filter* f) { f->SetBeta(std::nan("")); }, "Beta is nan" },
    { [](Filter* f) { f->SetEdgeThreshold(-1.0); }, "EdgeThreshold is -1; allowed" },
    { [](Filter* f) { f->SetNoiseLevel(-0.5); }, "NoiseLevel is -0.5; allowed" },
    { [](Filter* f) { f->SetStopTolerance(1.0); }, "StopTolerance is 1; allowed" },
    { [](Filter* f) { f->SetMode(2); }, "Mode is 2; allowed: 0 TimeSteps, 1 SteadyState" },
    { [](Filter* f) { f->SetEdgeFunction(6); }, "EdgeFunction is 6; allowed: 0 TotalVariation" },
    { [](Filter* f) { f->SetAcrossEdgeFunction(-1); },
      "AcrossEdgeFunction is -1; allowed: 0 Same" },
    { [](Filter* f) { f->SetChannelCoupling(3); }, "ChannelCoupling is 3; allowed" },
    { [](Filter* f) { f->SetFidelityNorm(2); }, "FidelityNorm is 2; allowed: 0 L2, 1 L1" },
    { [](Filter* f) { f->SetDiscretization(2); }, "Discretization is 2; allowed: 0 Linear" },
    { [](Filter* f) { f->SetTimeIntegratorToSecondOrder(); },
      "TimeIntegrator is 1; allowed: 0 FirstOrder, 2 Implicit" },
    { [](Filter* f) { f->SetAcrossEdgeFunctionToConstant(); },
      "AcrossEdgeFunction is 6 but DirectionArray is not set" },
  };
  for (const auto& [set, text] : cases)
  {
    auto filter = MakeFilter(grid);
    set(filter);
    Messages messages(filter);
    filter->Update();
    ASSERT_EQ(messages.Errors.size(), 1u) << text;
    EXPECT_NE(messages.Errors[0].find(text), std::string::npos) << messages.Errors[0];
    EXPECT_EQ(Result(filter), nullptr) << text;
  }
}

TEST(IntrinsicTVFilter, WhatHasNoConvexEnergyIsNotMinimised)
{
  auto grid = Grid(4, 4);
  AddRough(grid);
  AddPointArray(grid, "e1", 3, [](vtkIdType, int k) { return k == 0; });
  const Setting purposes[] = { [](Filter* f) { f->SetModeToSteadyState(); },
    [](Filter* f) { f->SetTimeIntegratorToImplicit(); },
    [](Filter* f) { f->AutomaticFidelityOn(); } };
  const std::pair<Setting, const char*> cases[] = {
    { [](Filter* f) { f->SetEdgeFunctionToPeronaMalikExponential(); },
      "EdgeFunction is 1; allowed" },
    { [](Filter* f) { f->SetEdgeFunctionToPeronaMalikRational(); }, "EdgeFunction is 2; allowed" },
    { [](Filter* f) { f->SetEdgeFunctionToWeickert(); }, "EdgeFunction is 4; allowed" },
    { [](Filter* f) { f->SetAcrossEdgeFunctionToConstant(); }, "AcrossEdgeFunction is 6; allowed" },
    { [](Filter* f) { f->SetAlongDiffusivity(0.0), f->SetAcrossDiffusivity(0.0); },
      "AlongDiffusivity and AcrossDiffusivity is 0; allowed: one above 0" },
  };
  for (const Setting& choose : purposes)
  {
    for (const auto& [set, text] : cases)
    {
      auto filter = MakeFilter(grid);
      SetInputArray(filter, 2, "e1");
      choose(filter);
      set(filter);
      Messages messages(filter);
      filter->Update();
      ASSERT_EQ(messages.Errors.size(), 1u) << text;
      EXPECT_NE(messages.Errors[0].find(text), std::string::npos) << messages.Errors[0];
    }
  }
  auto filter = MakeFilter(grid);
  filter->AutomaticFidelityOn();
  filter->SetFidelityNormToL1();
  Messages messages(filter);
  filter->Update();
  ASSERT_EQ(messages.Errors.size(), 1u);
  EXPECT_NE(messages.Errors[0].find("FidelityNorm is 1; allowed: 0 L2"), std::string::npos);
}

// --- Units ---

TEST(IntrinsicTVFilter, UnitOfTimeIsHTimesROfTotalVariationAndHSquaredOtherwise)
{
  auto sphere = Sphere(2);
  AddPointArray(sphere, "f", 1, [](vtkIdType i, int k) { return 3.0 * Rough(i, k); });
  AddPointArray(sphere, "e1", 3, [](vtkIdType, int k) { return k == 2; });
  sphere->GetPointData()->SetActiveScalars("f");
  auto filter = MakeFilter(sphere);
  SetInputArray(filter, 2, "e1");
  for (int across = 0; across < 7; ++across)
  {
    filter->SetAcrossEdgeFunction(across);
    for (int edge = 0; edge < 6; ++edge)
    {
      filter->SetEdgeFunction(edge);
      filter->Update();
      const double h = filter->GetMeanEdgeLength();
      EXPECT_NEAR(filter->GetTimeUnit(), edge == 0 ? h * filter->GetValueRange() : h * h, 1e-14)
        << edge << ' ' << across;
    }
  }
  filter->SetUnitsToAbsolute();
  filter->Update();
  EXPECT_EQ(filter->GetTimeUnit(), 1.0);
}

TEST(IntrinsicTVFilter, NaturalSettingsAreTheAbsoluteOnesInTheirUnits)
{
  auto sphere = Sphere(3);
  AddPointArray(sphere, "f", 1, [](vtkIdType i, int k) { return 3.0 * Rough(i, k); });
  sphere->GetPointData()->SetActiveScalars("f");
  const Setting cases[] = { [](Filter*) {}, [](Filter* f) { f->SetFidelityNormToL1(); },
    [](Filter* f) { f->SetTimeIntegratorToImplicit(); },
    [](Filter* f) { f->SetModeToSteadyState(); },
    [](Filter* f) { f->SetModeToSteadyState(), f->SetFidelityNormToL1(); },
    [](Filter* f) { f->SetEdgeFunctionToPeronaMalikRational(); },
    [](Filter* f) { f->SetEdgeFunctionToCharbonnier(), f->SetFidelityNormToL1(); },
    [](Filter* f) { f->SetEdgeFunctionToCharbonnier(), f->SetTimeIntegratorToImplicit(); } };
  for (const Setting& set : cases)
  {
    auto filter = MakeFilter(sphere);
    set(filter);
    filter->SetTimeStep(0.3);
    filter->SetNumberOfTimeSteps(3);
    filter->SetBeta(1e-2);
    filter->SetFidelityWeight(0.7);
    filter->Update();
    const auto natural = Copy(Result(filter));
    const double unit = filter->GetTimeUnit();
    const double h = filter->GetMeanEdgeLength();
    const double range = filter->GetValueRange();
    filter->SetUnitsToAbsolute();
    filter->SetTimeStep(0.3 * unit);
    filter->SetBeta(1e-2 * range * range / (h * h));
    filter->SetEdgeThreshold(0.1 * range / h);
    filter->SetFidelityWeight(
      0.7 / unit * (filter->GetFidelityNorm() == Filter::FIDELITY_NORM_L1 ? range : 1.0));
    filter->Update();
    EXPECT_LT(LargestDifference(natural, Result(filter)), 1e-7);
  }
}

TEST(IntrinsicTVFilter, NaturalSettingsSuitAnySizeAndAnyRange)
{
  auto small = Sphere(3);
  vtkDataArray* f = AddRough(small);
  AddPointArray(small, "e1", 3, [](vtkIdType, int k) { return k == 2; });
  vtkNew<vtkPolyData> large;
  large->DeepCopy(small);
  for (vtkIdType i = 0; i < large->GetNumberOfPoints(); ++i)
  {
    double p[3];
    small->GetPoint(i, p);
    vtkMath::MultiplyScalar(p, 1e3);
    large->GetPoints()->SetPoint(i, p);
    large->GetPointData()->GetArray("f")->SetComponent(i, 0, 70.0 * f->GetComponent(i, 0));
  }
  const Setting cases[] = { [](Filter*) {}, [](Filter* g) { g->SetFidelityNormToL1(); },
    [](Filter* g) { g->SetTimeIntegratorToImplicit(); },
    [](Filter* g) { g->AutomaticFidelityOn(); }, [](Filter* g) { g->SetEdgeFunctionToWeickert(); },
    [](Filter* g) { g->SetDiscretizationToCrouzeixRaviart(); },
    [](Filter* g) { g->SetAcrossEdgeFunctionToConstant(); },
    [](Filter* g)
    {
      g->SetEdgeFunctionToConstant();
      g->SetAcrossEdgeFunctionToTotalVariation();
      g->SetBeta(0.1);
    } };
  for (const Setting& set : cases)
  {
    vtkSmartPointer<vtkDataArray> results[2];
    double fidelities[2];
    for (int i = 0; i < 2; ++i)
    {
      auto filter = MakeFilter(i == 0 ? small.Get() : large.Get());
      SetInputArray(filter, 2, "e1");
      set(filter);
      filter->SetNumberOfTimeSteps(3);
      filter->Update();
      ASSERT_NE(Result(filter), nullptr);
      results[i] = Copy(Result(filter));
      fidelities[i] = filter->GetEffectiveFidelityWeight();
    }
    EXPECT_NEAR(fidelities[1], fidelities[0], 1e-6 * fidelities[0]);
    for (vtkIdType i = 0; i < small->GetNumberOfPoints(); ++i)
    {
      ASSERT_NEAR(results[1]->GetComponent(i, 0) / 70.0, results[0]->GetComponent(i, 0), 1e-6);
    }
  }
}

// --- Models ---

TEST(IntrinsicTVFilter, ConstantEdgeFunctionIsTheHeatEquation)
{
  auto sphere = Sphere(3);
  AddRough(sphere, 2);
  vtkNew<vtkFVMHeatFilter> heat;
  heat->SetInputData(sphere);
  heat->SetTimeIntegratorToFirstOrder();
  auto filter = MakeFilter(sphere);
  filter->SetEdgeFunctionToConstant();
  heat->SetFidelityWeight(filter->GetFidelityWeight());
  heat->Update();
  filter->Update();
  EXPECT_LT(LargestDifference(Result(filter), FilterTest::Result(heat)), 1e-9);
  filter->SetTimeIntegratorToImplicit();
  filter->SetStopTolerance(1e-9);
  filter->Update();
  EXPECT_LT(LargestDifference(Result(filter), FilterTest::Result(heat)), 1e-4);
}

TEST(IntrinsicTVFilter, ConstantStaysConstant)
{
  auto sphere = Sphere(2);
  AddPointArray(sphere, "f", 2, [](vtkIdType, int k) { return k == 0 ? 1.0 / 3.0 : -7.7; });
  sphere->GetPointData()->SetActiveScalars("f");
  const auto given = Copy(sphere->GetPointData()->GetArray("f"));
  for (int edge = 0; edge < 6; ++edge)
  {
    auto filter = MakeFilter(sphere);
    filter->SetEdgeFunction(edge);
    filter->Update();
    EXPECT_EQ(LargestDifference(Result(filter), given), 0.0) << edge;
    if (edge == Filter::EDGE_FUNCTION_TOTAL_VARIATION || edge == Filter::EDGE_FUNCTION_CHARBONNIER)
    {
      filter->SetTimeIntegratorToImplicit();
      filter->SetDiscretizationToCrouzeixRaviart();
      filter->Update();
      EXPECT_LT(LargestDifference(Result(filter), given), 1e-12) << edge;
    }
  }
}

TEST(IntrinsicTVFilter, SumIsKept)
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

TEST(IntrinsicTVFilter, WhatIsConstantAlreadyStopsAtOnce)
{
  // The flow is extinct long before its last step; across e1 nothing flows at all.
  auto grid = Grid(12, 12);
  AddPointArray(grid, "f", 1, [](vtkIdType i, int) { return 1e3 + (i / 12 > 5 ? 1.0 : 0.0); });
  AddPointArray(grid, "e1", 3, [](vtkIdType, int k) { return k == 0; });
  for (const double across : { 1.0, 0.0 })
  {
    auto filter = MakeFilter(grid);
    SetInputArray(filter, 0, "f");
    SetInputArray(filter, 2, "e1");
    filter->SetTimeIntegratorToImplicit();
    filter->SetFidelityWeight(0.0);
    filter->SetTimeStep(5.0);
    filter->SetAcrossDiffusivity(across);
    Messages messages(filter);
    filter->Update();
    EXPECT_TRUE(messages.Warnings.empty()) << across;
    EXPECT_LE(HistoryAt(filter, 10, "Iterations"), 20.0) << across;
  }
}

TEST(IntrinsicTVFilter, EnergyFallsAndTheHistoryEndsWithThatOfTheState)
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

TEST(IntrinsicTVFilter, ACapShrinksAtItsRateWithCrouzeixRaviartCloserThanLinear)
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
      if (std::abs(z - 0.5) > 0.2) // plateaus, not the jump
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

TEST(IntrinsicTVFilter, SteadyStateIsTheLimitOfALongRun)
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

TEST(IntrinsicTVFilter, SteadyStateWithNothingHeldIsTheMean)
{
  auto sphere = Sphere(2);
  AddRough(sphere);
  for (int discretization = 0; discretization < 2; ++discretization)
  {
    auto filter = MakeFilter(sphere);
    filter->SetModeToSteadyState();
    filter->SetFidelityWeight(0.0);
    filter->SetDiscretization(discretization);
    filter->Update();
    const auto areas = ControlAreas(sphere);
    double area = 0.0;
    for (const double a : areas)
    {
      area += a;
    }
    const double mean = Total(areas, sphere->GetPointData()->GetArray("f")) / area;
    for (vtkIdType i = 0; i < sphere->GetNumberOfPoints(); ++i)
    {
      // On the way to the edges and back something is left of rough data, which is not lost.
      ASSERT_NEAR(Result(filter)->GetComponent(i, 0), mean, discretization == 0 ? 1e-12 : 0.02);
    }
  }
}

// --- Channels ---

TEST(IntrinsicTVFilter, PerChannelIsEachChannelAlone)
{
  auto sphere = Sphere(3);
  vtkDataArray* f = AddRough(sphere, 3);
  const Setting cases[] = { [](Filter*) {}, [](Filter* g) { g->SetTimeIntegratorToImplicit(); },
    [](Filter* g) { g->SetFidelityNormToL1(); } };
  for (const Setting& set : cases)
  {
    auto together = MakeFilter(sphere);
    together->SetChannelCouplingToPerChannel();
    together->SetUnitsToAbsolute();
    together->SetTimeStep(0.02);
    together->SetFidelityWeight(20.0);
    together->SetStopTolerance(1e-8);
    set(together);
    together->Update();
    for (int k = 0; k < 3; ++k)
    {
      vtkNew<vtkPolyData> channel;
      channel->ShallowCopy(sphere);
      AddPointArray(channel, "f", 1, [&](vtkIdType i, int) { return f->GetComponent(i, k); });
      auto alone = MakeFilter(channel);
      SetInputArray(alone, 0, "f");
      alone->SetUnitsToAbsolute();
      alone->SetTimeStep(0.02);
      alone->SetFidelityWeight(20.0);
      alone->SetStopTolerance(1e-8);
      set(alone);
      alone->Update();
      for (vtkIdType i = 0; i < sphere->GetNumberOfPoints(); ++i)
      {
        ASSERT_NEAR(Result(together)->GetComponent(i, k), Result(alone)->GetComponent(i, 0), 1e-3);
      }
    }
  }
}

TEST(IntrinsicTVFilter, JointCouplingKnowsNoDirectionsOfColorSpace)
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
  EXPECT_LT(difference([](Filter*) {}), 1e-7);
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

// --- Masks, fixed and held values ---

TEST(IntrinsicTVFilter, WhatIsMissingIsNotReadAndAnEdgeIsContinued)
{
  // A straight jump of height 1 along a grid line, its middle lost.
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

TEST(IntrinsicTVFilter, FixedAndHeldValuesStayToTheBit)
{
  auto sphere = Sphere(3);
  vtkDataArray* f = AddRough(sphere, 2);
  AddPointArray(
    sphere, "fixed", 1, [&](vtkIdType i, int) { return std::abs(sphere->GetPoint(i)[2]) > 0.7; });
  const Setting cases[] = { [](Filter*) {}, [](Filter* g) { g->SetTimeIntegratorToImplicit(); },
    [](Filter* g) { g->SetModeToSteadyState(); },
    [](Filter* g) { g->SetDiscretizationToCrouzeixRaviart(); },
    [](Filter* g)
    {
      g->SetDiscretizationToCrouzeixRaviart();
      g->SetModeToSteadyState();
      g->SetFidelityWeight(0.0);
    } };
  for (std::size_t c = 0; c < std::size(cases); ++c)
  {
    for (const bool hold : { false, true })
    {
      auto filter = MakeFilter(sphere);
      cases[c](filter);
      filter->SetHoldKnownValues(hold);
      // Held: what is not missing, which is where the mask is 0.
      SetInputArray(filter, hold ? 1 : 3, "fixed");
      filter->Update();
      ASSERT_NE(Result(filter), nullptr) << c;
      double change = 0.0;
      for (vtkIdType i = 0; i < f->GetNumberOfTuples(); ++i)
      {
        const bool kept = (std::abs(sphere->GetPoint(i)[2]) > 0.7) != hold;
        for (int k = 0; k < 2; ++k)
        {
          const double difference =
            std::abs(Result(filter)->GetComponent(i, k) - f->GetComponent(i, k));
          if (kept)
          {
            ASSERT_EQ(difference, 0.0) << c << ' ' << hold;
          }
          change = std::max(change, difference);
        }
      }
      EXPECT_GT(change, 0.1) << c << ' ' << hold;
    }
  }
}

TEST(IntrinsicTVFilter, L1RemovesImpulsesAndKeepsContrastAlsoWithAMask)
{
  // A half-and-half sphere with impulses on a twelfth of the points; a part is lost besides.
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

TEST(IntrinsicTVFilter, AcrossEdgeFunctionActsAcrossTheDirection)
{
  // Waves along x and along y; e1 = x. Constant across smooths those along y as heat does.
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
    for (vtkIdType i = 10; i < 20; ++i) // away from the corners, whose cells are not symmetric
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

TEST(IntrinsicTVFilter, DiffusivitiesAlongAndAcrossActInEveryScheme)
{
  // Data that vary along e2 only see the across diffusivity.
  auto grid = Grid(25, 24);
  AddPointArray(grid, "e1", 3, [](vtkIdType, int k) { return k == 0; });
  AddPointArray(grid, "f", 1, [](vtkIdType i, int) { return i / 25 > 11 ? 1.0 : 0.0; });
  for (const bool implicit : { false, true })
  {
    const auto plateau = [&](double along, double across)
    {
      auto filter = MakeFilter(grid);
      SetInputArray(filter, 0, "f");
      SetInputArray(filter, 2, "e1");
      filter->SetTimeIntegrator(
        implicit ? Filter::TIME_INTEGRATOR_IMPLICIT : Filter::TIME_INTEGRATOR_FIRST_ORDER);
      filter->SetAlongDiffusivity(along);
      filter->SetAcrossDiffusivity(across);
      filter->SetFidelityWeight(0.0);
      filter->SetTimeStep(0.1);
      filter->Update();
      return Result(filter)->GetComponent(12 + 25 * 3, 0);
    };
    // Half the grid, 11.5 high, rises at 1/11.5 per unit of time; h is 1.14.
    const double once = plateau(1.0, 1.0);
    EXPECT_NEAR(once, 1.14 / 11.5, 0.01) << implicit;
    EXPECT_NEAR(plateau(0.1, 1.0), once, 0.003) << implicit;
    EXPECT_NEAR(plateau(1.0, 2.0), 2.0 * once, 0.02) << implicit;
    EXPECT_NEAR(plateau(1.0, 0.0), 0.0, 0.003) << implicit;
  }
}

// --- Fidelity chosen automatically ---

TEST(IntrinsicTVFilter, AutomaticFidelityLeavesTheNoiseInTheResidual)
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
    const double wanted = noise > 0.0 ? noise : 0.25; // 0: estimated
    EXPECT_NEAR(discrepancy, wanted, (noise > 0.0 ? 0.02 : 0.1) * wanted);
  }
  // FidelityWeight is not read, and the one found gives the same run.
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

// --- Time ---

TEST(IntrinsicTVFilter, TimesInAnyOrderGiveTheSameBits)
{
  auto sphere = Sphere(2);
  AddRough(sphere, 2);
  const Setting cases[] = { [](Filter*) {}, [](Filter* f) { f->SetTimeIntegratorToImplicit(); },
    [](Filter* f) { f->SetDiscretizationToCrouzeixRaviart(); },
    [](Filter* f) { f->SetDiscretizationToCrouzeixRaviart(), f->SetTimeIntegratorToImplicit(); } };
  for (std::size_t c = 0; c < std::size(cases); ++c)
  {
    auto filter = MakeFilter(sphere);
    cases[c](filter);
    filter->GenerateTimeStepsOn();
    filter->SetTimeStep(0.25);
    filter->SetNumberOfTimeSteps(6);
    filter->SetCheckpointMemoryLimit(0); // seeking back starts anew
    EXPECT_EQ(PublishedTimes(filter).size(), 7u);
    std::map<double, vtkSmartPointer<vtkDataArray>> states;
    for (const double time : { 1.5, 0.5, 0.0, 1.0, 1.5, 0.5, 1.25, 0.0 })
    {
      UpdateAt(filter, time);
      const auto state = Copy(Result(filter));
      const auto known = states.emplace(time, state);
      EXPECT_TRUE(Identical(known.first->second, state)) << c << ' ' << time;
    }
    EXPECT_TRUE(Identical(states[0.0], sphere->GetPointData()->GetArray("f"))) << c;
    auto alone = MakeFilter(sphere);
    cases[c](alone);
    alone->SetTimeStep(0.25);
    alone->SetNumberOfTimeSteps(6);
    alone->Update();
    EXPECT_TRUE(Identical(Result(alone), states[1.5])) << c;
  }
}

TEST(IntrinsicTVFilter, SteadyStateIsOneStep)
{
  auto sphere = Sphere(2);
  AddRough(sphere);
  auto filter = MakeFilter(sphere);
  filter->SetModeToSteadyState();
  filter->GenerateTimeStepsOn();
  EXPECT_EQ(PublishedTimes(filter), (std::vector<double>{ 0.0, 1.0 }));
}

// --- Composite data, robustness ---

TEST(IntrinsicTVFilter, BlocksOfCompositeDataShareTheirUnits)
{
  auto coarse = Sphere(1);
  auto fine = Sphere(3);
  AddPointArray(coarse, "f", 1, [](vtkIdType i, int) { return 10.0 * Rough(i, 0); });
  AddPointArray(fine, "f", 1, [](vtkIdType i, int) { return Rough(i, 0); });
  vtkNew<vtkMultiBlockDataSet> blocks;
  blocks->SetBlock(0, coarse);
  blocks->SetBlock(1, fine);
  auto filter = MakeFilter(blocks);
  SetInputArray(filter, 0, "f");
  filter->Update();
  const double unit = filter->GetTimeUnit();
  EXPECT_NEAR(unit, filter->GetMeanEdgeLength() * filter->GetValueRange(), 1e-14);
  EXPECT_GT(filter->GetValueRange(), 15.0);
  const double beta = 1e-6 * std::pow(filter->GetValueRange() / filter->GetMeanEdgeLength(), 2);
  auto* output = vtkMultiBlockDataSet::SafeDownCast(filter->GetOutputDataObject(0));
  for (unsigned int b = 0; b < 2; ++b)
  {
    auto alone = MakeFilter(blocks->GetBlock(b));
    SetInputArray(alone, 0, "f");
    alone->SetUnitsToAbsolute();
    alone->SetTimeStep(unit);
    alone->SetFidelityWeight(3.0 / unit);
    alone->SetBeta(beta);
    alone->Update();
    vtkDataArray* together =
      vtkPolyData::SafeDownCast(output->GetBlock(b))->GetPointData()->GetArray("fTV");
    EXPECT_LT(LargestDifference(together, Result(alone)), 1e-7) << b;
  }
}

TEST(IntrinsicTVFilter, ColorsOfBytesStayBytesAndKeepAlpha)
{
  auto sphere = Sphere(3);
  AddPointArray(
    sphere, "f", 4, [](vtkIdType i, int k) { return std::floor(127.5 + 127.0 * Rough(i, k)); },
    VTK_UNSIGNED_CHAR);
  for (int discretization = 0; discretization < 2; ++discretization)
  {
    auto filter = MakeFilter(sphere);
    SetInputArray(filter, 0, "f");
    filter->SetDiscretization(discretization);
    filter->Update();
    vtkDataArray* f = sphere->GetPointData()->GetArray("f");
    ASSERT_EQ(Result(filter)->GetDataType(), VTK_UNSIGNED_CHAR);
    ASSERT_EQ(Result(filter)->GetNumberOfComponents(), 4);
    for (vtkIdType i = 0; i < f->GetNumberOfTuples(); ++i)
    {
      ASSERT_EQ(Result(filter)->GetComponent(i, 3), f->GetComponent(i, 3));
    }
    EXPECT_GT(LargestDifference(Result(filter), f), 20.0);
  }
}

TEST(IntrinsicTVFilter, AnyBetaAndTimeStepGiveFiniteValuesWithinBounds)
{
  auto grid = Grid(12, 12); // no obtuse angle
  AddRough(grid);
  for (const double beta : { 1e-12, 1e-6, 1.0 })
  {
    for (const double step : { 1e-4, 1.0, 1e4 })
    {
      auto filter = MakeFilter(grid);
      filter->SetBeta(beta);
      filter->SetTimeStep(step);
      filter->Update();
      ASSERT_TRUE(AllFinite(Result(filter))) << beta << ' ' << step;
      EXPECT_LE(LargestMagnitude(Result(filter)), 1.0 + 1e-6) << beta << ' ' << step;
    }
  }
}

TEST(IntrinsicTVFilter, AToleranceOutOfReachIsAWarningWithTheGap)
{
  auto grid = Grid(8, 8);
  AddRough(grid, 2);
  auto filter = MakeFilter(grid);
  filter->SetModeToSteadyState();
  filter->SetFidelityNormToL1();
  filter->SetStopTolerance(1e-300);
  Messages messages(filter);
  filter->Update();
  EXPECT_TRUE(messages.Errors.empty());
  ASSERT_EQ(messages.Warnings.size(), 1u);
  EXPECT_NE(messages.Warnings[0].find("duality gap"), std::string::npos);
  EXPECT_NE(Result(filter), nullptr);
}
