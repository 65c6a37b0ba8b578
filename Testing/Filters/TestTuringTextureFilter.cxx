// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "FilterTest.h"

#include "vtkCallbackCommand.h"
#include "vtkCellData.h"
#include "vtkMultiBlockDataSet.h"
#include "vtkTuringTextureFilter.h"

#include <gtest/gtest.h>

#include <array>
#include <utility>

using namespace FilterTest;

namespace
{

vtkSmartPointer<vtkTuringTextureFilter> MakeFilter(vtkPolyData* surface, int steps = 16)
{
  auto filter = vtkSmartPointer<vtkTuringTextureFilter>::New();
  filter->SetInputData(surface);
  filter->SetNumberOfTimeSteps(steps);
  return filter;
}

double Low(vtkDataArray* array, int component = 0)
{
  return array->GetRange(component)[0];
}

double High(vtkDataArray* array, int component = 0)
{
  return array->GetRange(component)[1];
}

/// The only error of an update, whose output must be the unchanged input.
std::string ErrorOf(vtkTuringTextureFilter* filter)
{
  Messages messages(filter);
  filter->Update();
  EXPECT_EQ(messages.Errors.size(), 1u);
  EXPECT_EQ(Result(filter, "u1"), nullptr);
  EXPECT_GT(filter->GetOutput()->GetNumberOfPoints(), 0);
  return messages.Errors.empty() ? std::string() : messages.Errors.front();
}

std::string WarningOf(vtkTuringTextureFilter* filter)
{
  Messages messages(filter);
  filter->Update();
  EXPECT_TRUE(messages.Errors.empty()) << messages.Errors.front();
  EXPECT_LE(messages.Warnings.size(), 1u); // one per update
  return messages.Warnings.empty() ? std::string() : messages.Warnings.front();
}

bool Contains(const std::string& text, const std::string& part)
{
  return text.find(part) != std::string::npos;
}

} // namespace

TEST(TuringTextureFilter, GrowsSpotsFromNoise)
{
  auto sphere = Sphere(5);
  AddRough(sphere); // active scalars are no initial state
  const auto filter = MakeFilter(sphere, 320);
  EXPECT_EQ(WarningOf(filter), "");
  vtkDataArray* u1 = Result(filter, "u1");
  vtkDataArray* u2 = Result(filter, "u2");
  ASSERT_TRUE(AllFinite(u1) && AllFinite(u2));
  EXPECT_EQ(u1->GetDataType(), VTK_DOUBLE);
  EXPECT_EQ(filter->GetOutput()->GetPointData()->GetScalars(), Result(filter, "Texture"));
  EXPECT_GE(Low(u2), 0.0);
  EXPECT_GT(High(u2), 6.0); // around the steady state 4
  EXPECT_NEAR(Low(Result(filter, "Texture")), 0.0, 1e-12);
  EXPECT_NEAR(High(Result(filter, "Texture")), 1.0, 1e-12);
  EXPECT_EQ(Result(filter, "TextureColor"), nullptr);
  EXPECT_NEAR(
    filter->GetWavelength(), std::sqrt(4.0 * vtkMath::Pi()) / 8.0, 1e-3); // of coarse ones
  EXPECT_NEAR(filter->GetWavelengthGrowthRate(), 0.776, 1e-3);
}

/// Whose default is a size of the surface where this has few edges.
TEST(TuringTextureFilter, KeepsTheRatesOfFineSurfaces)
{
  const auto fine = MakeFilter(Grid(80, 80), 1);
  fine->Update();
  EXPECT_EQ(fine->GetDiffusionRateFactor(), 1.0);
  EXPECT_NEAR(fine->GetWavelength() / fine->GetMeanEdgeLength(), 11.2, 0.1);
  const auto coarse = MakeFilter(Grid(65, 65), 1);
  coarse->Update();
  EXPECT_NEAR(coarse->GetWavelength(), 8.0, 1e-9);
  coarse->SetDiffusionRate1(22.0);
  coarse->Update();
  EXPECT_EQ(coarse->GetDiffusionRateFactor(), 1.0);
}

TEST(TuringTextureFilter, WarnsOnceWhyNoPatternGrows)
{
  auto sphere = Sphere(4);
  auto filter = MakeFilter(sphere);
  filter->SetDiffusionRate1(3.0 * 2.6);
  EXPECT_TRUE(Contains(WarningOf(filter), "more than 4 times that of u2, and is 3 times"));
  filter->SetDiffusionRate1(0.0);
  filter->SetDiffusionRate2(0.0);
  EXPECT_TRUE(Contains(WarningOf(filter), "more than 4 times that of u2, and both are 0"));

  filter = MakeFilter(sphere);
  filter->SetDecayRate(14.0);
  EXPECT_TRUE(Contains(WarningOf(filter), "is unstable even without diffusion"));

  filter = MakeFilter(sphere);
  filter->SetFeatureSize(0.2);
  filter->SetRefineTo(0.0);
  const std::string tooSmall = WarningOf(filter);
  EXPECT_TRUE(Contains(tooSmall, "0.2 is only")) << tooSmall;
  EXPECT_TRUE(Contains(tooSmall, "cannot resolve")) << tooSmall;

  filter = MakeFilter(sphere);
  filter->SetDiffusionRate1(0.2);
  filter->SetFeatureSize(0.8);
  EXPECT_TRUE(Contains(WarningOf(filter), "FeatureSize has no effect"));

  filter = MakeFilter(sphere);
  filter->SetKineticsToBrusselator();
  filter->SetReactantB(0.5);
  EXPECT_TRUE(Contains(WarningOf(filter), "neither chemical promotes itself"));
}

TEST(TuringTextureFilter, AStationaryBlockWaitsForTheOthers)
{
  vtkNew<vtkMultiBlockDataSet> blocks;
  for (unsigned int b = 0; b < 2; ++b)
  {
    auto sphere = Sphere(2);
    AddPointArray(
      sphere, "state", 2, [&](vtkIdType i, int k) { return 4.0 + 0.5 * b * Rough(i, k); });
    blocks->SetBlock(b, sphere);
  }
  const auto filter = MakeFilter(nullptr, 8);
  filter->SetInputDataObject(blocks);
  SetInputArray(filter, 0, "state");
  filter->SetStopTolerance(1e-6);
  filter->Update();
  ASSERT_EQ(History(filter)->GetNumberOfRows(), 9);
  auto* output = vtkMultiBlockDataSet::SafeDownCast(filter->GetOutputDataObject(0));
  const auto u1 = [&](unsigned int b)
  { return vtkPolyData::SafeDownCast(output->GetBlock(b))->GetPointData()->GetArray("u1"); };
  EXPECT_NEAR(Low(u1(0)), 4.0, 1e-9); // a steady state from the start
  EXPECT_NEAR(High(u1(0)), 4.0, 1e-9);
  EXPECT_GT(High(u1(1)) - Low(u1(1)), 1e-3);
}

TEST(TuringTextureFilter, FeatureSizeOverridesTheScaleOfTheRates)
{
  auto sphere = Sphere(3);
  const auto filter = MakeFilter(sphere, 24);
  filter->SetFeatureSize(1.5);
  filter->Update();
  const auto expected = Copy(Result(filter, "u1"));
  filter->SetDiffusionRate1(2100.0);
  filter->SetDiffusionRate2(260.0);
  filter->Update();
  EXPECT_LT(LargestDifference(Result(filter, "u1"), expected), 1e-9);
}

TEST(TuringTextureFilter, StartsFromAnInitialState)
{
  auto sphere = Sphere(3);
  AddPointArray(
    sphere, "state", 2, [](vtkIdType i, int k) { return 4.0 + 0.2 * Rough(i, k); }, VTK_FLOAT);
  const auto filter = MakeFilter(sphere, 0);
  SetInputArray(filter, 0, "state");
  filter->Update();
  vtkDataArray* state = sphere->GetPointData()->GetArray("state");
  for (vtkIdType i = 0; i < sphere->GetNumberOfPoints(); ++i)
  {
    EXPECT_EQ(Result(filter, "u1")->GetComponent(i, 0), state->GetComponent(i, 0));
    EXPECT_EQ(Result(filter, "u2")->GetComponent(i, 0), state->GetComponent(i, 1));
  }
  EXPECT_EQ(Result(filter, "u1")->GetDataType(), VTK_FLOAT);
  filter->SetNumberOfTimeSteps(16);
  filter->Update();
  EXPECT_GT(LargestDifference(Result(filter, "u1"),
              MakeArray(VTK_DOUBLE, "", 258, 1, [](vtkIdType, int) { return 4.0; })),
    0.001);
}

TEST(TuringTextureFilter, EqualRatesPerCellGiveTheResultOfTheProperties)
{
  auto sphere = Sphere(3);
  AddPointArray(sphere, "e1", 3, [&](vtkIdType, int k) { return k == 2; });
  const double rates[4] = { 30.0, 15.0, 4.0, 2.0 };
  const auto cells = MakeArray(
    VTK_DOUBLE, "rates", sphere->GetNumberOfCells(), 4, [&](vtkIdType, int k) { return rates[k]; });
  sphere->GetCellData()->AddArray(cells);
  const auto byProperty = MakeFilter(sphere);
  SetInputArray(byProperty, 2, "e1");
  byProperty->SetDiffusionRate1(rates[0]);
  byProperty->SetDiffusionRateAcross1(rates[1]);
  byProperty->SetDiffusionRate2(rates[2]);
  byProperty->SetDiffusionRateAcross2(rates[3]);
  byProperty->Update();
  const auto byCell = MakeFilter(sphere);
  SetInputArray(byCell, 2, "e1");
  SetInputArray(byCell, 4, "rates", true);
  byCell->Update();
  ASSERT_TRUE(AllFinite(Result(byCell, "u1")));
  EXPECT_LT(LargestDifference(Result(byCell, "u1"), Result(byProperty, "u1")), 1e-12);
  const auto isotropic = MakeFilter(sphere);
  isotropic->Update();
  EXPECT_GT(LargestDifference(Result(byCell, "u1"), Result(isotropic, "u1")), 1e-3);

  byCell->IntrinsicDelaunayOn();
  EXPECT_TRUE(Contains(ErrorOf(byCell), "IntrinsicDelaunay is on but DiffusionRateArray"));
}

TEST(TuringTextureFilter, ColorsAreReadInTheWaysOfVTK)
{
  vtkNew<vtkTuringTextureFilter> filter;
  filter->SetLowColor(0.0, 0.2, 1.0);
  double red = 1.0, green = 1.0, blue = 0.0;
  filter->GetLowColor(red, green, blue);
  double low[3];
  filter->GetLowColor(low);
  EXPECT_EQ((std::array<double, 3>{ red, green, blue }), (std::array<double, 3>{ 0.0, 0.2, 1.0 }));
  EXPECT_EQ(low[1], 0.2);
}

TEST(TuringTextureFilter, PaperSchemeIsTheFirstOrderOne)
{
  vtkNew<vtkTuringTextureFilter> filter;
  filter->SetKineticsToBrusselator();
  filter->ClampToNonNegativeOff();
  filter->SetDiffusionRate1(5.0);
  filter->UsePaperScheme();
  EXPECT_STREQ(filter->GetKineticsAsString(), "Turing");
  EXPECT_STREQ(filter->GetTimeIntegratorAsString(), "FirstOrder");
  EXPECT_FALSE(filter->GetClampToNonNegative()); // unchanged
  EXPECT_EQ(filter->GetDiffusionRate1(), 5.0);
}

TEST(TuringTextureFilter, RefinesMeshesThatAreTooCoarseForTheFeatures)
{
  auto sphere = Sphere(3);
  vtkNew<vtkTuringTextureFilter> filter;
  filter->SetInputData(sphere);
  filter->SetNumberOfTimeSteps(20);
  Messages messages(filter);
  filter->SetFeatureSize(2.0); // that the mesh resolves
  filter->Update();
  EXPECT_TRUE(messages.Warnings.empty());
  EXPECT_EQ(filter->GetOutput()->GetPoints(), sphere->GetPoints());
  filter->SetFeatureSize(0.4);
  filter->Update();
  ASSERT_EQ(messages.Warnings.size(), 1u);
  EXPECT_NE(messages.Warnings[0].find("edges were bisected, to "), std::string::npos);
  EXPECT_NE(messages.Warnings[0].find("because FeatureSize is 0.4, only "), std::string::npos);
  EXPECT_LE(filter->GetMeanEdgeLength(), 0.05);
  vtkPolyData* const output = filter->GetOutput();
  EXPECT_GT(output->GetNumberOfPoints(), 10 * sphere->GetNumberOfPoints());
  EXPECT_EQ(
    output->GetPointData()->GetArray("Texture")->GetNumberOfTuples(), output->GetNumberOfPoints());
  EXPECT_NE(output->GetCellData()->GetArray("vtkOriginalCellIds"), nullptr);

  // An abort in the midst gives the unchanged input.
  filter->SetRefineTo(0.03);
  vtkNew<vtkCallbackCommand> abort;
  abort->SetCallback([](vtkObject* caller, unsigned long, void*, void*)
    { static_cast<vtkAlgorithm*>(caller)->SetAbortExecute(1); });
  filter->AddObserver(vtkCommand::ProgressEvent, abort);
  filter->Update();
  EXPECT_EQ(filter->GetOutput()->GetPoints(), sphere->GetPoints());
  EXPECT_EQ(filter->GetOutput()->GetPolys(), sphere->GetPolys());
}

TEST(TuringTextureFilter, NamesArraysThatItCannotTake)
{
  auto sphere = Sphere(2);
  AddRough(sphere, 1);
  AddPointArray(sphere, "four", 4, [](vtkIdType, int) { return 1.0; });
  const auto across = MakeArray(VTK_DOUBLE, "across", sphere->GetNumberOfCells(), 4,
    [](vtkIdType, int k) { return k == 1 ? 10.0 : 20.0; });
  sphere->GetCellData()->AddArray(across);
  using Change = void (*)(vtkTuringTextureFilter*);
  const std::pair<Change, const char*> cases[] = {
    { [](auto* f) { f->SetDiffusionRateAcross2(1.0); }, "DirectionArray is not set" },
    { [](auto* f) { SetInputArray(f, 0, "f"); }, "InputArray \"f\" has 1 components" },
    { [](auto* f) { SetInputArray(f, 4, "four"); }, "DiffusionRateArray is a point array" },
    { [](auto* f) { SetInputArray(f, 4, "across", true); },
      "DiffusionRateArray has other rates across than along" },
  };
  for (const auto& [change, message] : cases)
  {
    const auto filter = MakeFilter(sphere, 2);
    change(filter);
    const std::string error = ErrorOf(filter);
    EXPECT_TRUE(Contains(error, message)) << error;
  }
}
