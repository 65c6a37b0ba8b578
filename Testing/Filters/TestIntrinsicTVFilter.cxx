// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "IntrinsicTVTest.h"

#include <gtest/gtest.h>

using namespace IntrinsicTVTest;

// --- Properties ---

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
  filter->SetColorModelToOpponent();
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
  EXPECT_STREQ(filter->GetColorModelAsString(), "RGB");
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
    { [](Filter* f) { f->SetBlurFWHM(-1.0); }, "BlurFWHM is -1; allowed" },
    { [](Filter* f) { f->SetBlurSteps(1); }, "BlurSteps is 1; allowed: 2 to 64" },
    { [](Filter* f) { f->SetBlurFWHM(1.0); }, "Mode is 0; allowed: 1 SteadyState together with" },
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

TEST(IntrinsicTVFilter, NonconvexEnergiesAreNotMinimised)
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
    const double energy = HistoryAt(filter, 1, "Energy");
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
    if (filter->GetMode() == Filter::MODE_STEADY_STATE &&
      filter->GetFidelityNorm() == Filter::FIDELITY_NORM_L1)
    {
      // The minimiser is not unique, and the last bits of h determine the result.
      EXPECT_NEAR(HistoryAt(filter, 1, "Energy"), energy, filter->GetStopTolerance() * energy);
      continue;
    }
    EXPECT_LT(LargestDifference(natural, Result(filter)), 1e-7) << "case " << (&set - cases);
  }
}

namespace
{

/// The natural settings on a surface and data of two sizes give the same result up to this number.
void ExpectSameInNaturalUnits(double size, double range, double largestDifference)
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
    vtkMath::MultiplyScalar(p, size);
    large->GetPoints()->SetPoint(i, p);
    large->GetPointData()->GetArray("f")->SetComponent(i, 0, range * f->GetComponent(i, 0));
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
      ASSERT_NEAR(
        results[1]->GetComponent(i, 0) / range, results[0]->GetComponent(i, 0), largestDifference);
    }
  }
}

} // namespace

TEST(IntrinsicTVFilter, NaturalSettingsSuitAnySizeAndAnyRange)
{
  ExpectSameInNaturalUnits(1024.0, 64.0, 1e-12);
  // Other numbers have another round-off in the points, which are single precision, and in linear
  // solves to 1e-3 in single precision.
  ExpectSameInNaturalUnits(1e3, 70.0, 1e-5);
}

// --- Composite data, robustness ---

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

TEST(IntrinsicTVFilter, AnUnreachableToleranceIsAWarningWithTheGap)
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
