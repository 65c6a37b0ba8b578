// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "IntrinsicTVTest.h"

#include <gtest/gtest.h>

using namespace IntrinsicTVTest;

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

TEST(IntrinsicTVFilter, OnlyMinimisersHaveTheColumnErrorBound)
{
  auto grid = Grid(8, 8);
  AddRough(grid);
  auto filter = MakeFilter(grid);
  filter->Update();
  EXPECT_EQ(History(filter)->GetColumnByName("ErrorBound"), nullptr);
  filter->SetModeToSteadyState();
  filter->Update();
  EXPECT_EQ(HistoryAt(filter, 0, "ErrorBound"), 0.0);
  EXPECT_GT(HistoryAt(filter, 1, "ErrorBound"), 0.0);
}
