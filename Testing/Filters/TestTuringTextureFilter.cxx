// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "FilterTest.h"

#include "vtkCallbackCommand.h"
#include "vtkCellData.h"
#include "vtkMultiBlockDataSet.h"
#include "vtkTuringTextureFilter.h"

#include <gtest/gtest.h>

#include <vector>

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

/// The number of connected components of the set where the array is above `level`.
int CountPieces(vtkPolyData* surface, vtkDataArray* array, double level)
{
  std::vector<vtkIdType> parent(surface->GetNumberOfPoints());
  for (vtkIdType i = 0; i < surface->GetNumberOfPoints(); ++i)
  {
    parent[i] = i;
  }
  const auto find = [&](vtkIdType i)
  {
    while (parent[i] != i)
    {
      i = parent[i] = parent[parent[i]];
    }
    return i;
  };
  const auto inside = [&](vtkIdType i) { return array->GetComponent(i, 0) > level; };
  vtkNew<vtkIdList> corners;
  for (vtkIdType c = 0; c < surface->GetNumberOfCells(); ++c)
  {
    surface->GetCellPoints(c, corners);
    for (int a = 0; a < 3; ++a)
    {
      const vtkIdType i = corners->GetId(a);
      const vtkIdType j = corners->GetId((a + 1) % 3);
      if (inside(i) && inside(j))
      {
        parent[find(i)] = find(j);
      }
    }
  }
  int pieces = 0;
  for (vtkIdType i = 0; i < surface->GetNumberOfPoints(); ++i)
  {
    pieces += inside(i) && find(i) == i;
  }
  return pieces;
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
  EXPECT_GT(CountPieces(sphere, u1, 4.2), 12);
  EXPECT_NEAR(
    filter->GetWavelength(), std::sqrt(4.0 * vtkMath::Pi()) / 8.0, 1e-3); // of coarse ones
  EXPECT_NEAR(filter->GetWavelengthGrowthRate(), 0.776, 1e-3);
}

TEST(TuringTextureFilter, IsKeptWhereTheSurfaceMovesByRoundOff)
{
  const auto moved = Sphere(4);
  for (vtkIdType i = 0; i < moved->GetNumberOfPoints(); ++i)
  {
    double x[3];
    moved->GetPoint(i, x);
    moved->GetPoints()->SetPoint(i, x[0] + 1e-12, x[1] - 1e-12 * (i % 3), x[2] + 1e-12 * (i % 2));
  }
  const auto filter = MakeFilter(Sphere(4));
  filter->Update();
  vtkSmartPointer<vtkDataArray> expected = Result(filter, "u1");
  filter->SetInputData(moved);
  filter->Update();
  EXPECT_LT(LargestDifference(Result(filter, "u1"), expected), 1e-6 * High(expected));
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

TEST(TuringTextureFilter, EveryKineticsMakesAPatternWithItsDefaults)
{
  auto sphere = Sphere(5);
  for (int kinetics = 0; kinetics < 6; ++kinetics)
  {
    const auto filter = MakeFilter(sphere, 1200);
    filter->SetKinetics(kinetics);
    filter->AutomaticTimeStepOn();
    filter->SetStopTolerance(0.02);
    EXPECT_EQ(WarningOf(filter), "") << filter->GetKineticsAsString();
    vtkDataArray* u2 = Result(filter, "u2");
    ASSERT_NE(u2, nullptr) << filter->GetKineticsAsString();
    const double size = std::max(std::abs(High(u2)), std::abs(Low(u2)));
    EXPECT_GT(High(u2) - Low(u2), 0.5 * size) << filter->GetKineticsAsString();
  }
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

TEST(TuringTextureFilter, RejectsInvalidSettings)
{
  auto sphere = Sphere(2);
  AddRough(sphere, 1);
  AddPointArray(sphere, "state", 2, [](vtkIdType, int) { return 4.0; });
  AddPointArray(sphere, "four", 4, [](vtkIdType, int) { return 1.0; });
  const auto cells = MakeArray(VTK_DOUBLE, "rates", sphere->GetNumberOfCells(), 4,
    [](vtkIdType i, int k) { return i == 7 && k == 2 ? -1.0 : 1.0; });
  sphere->GetCellData()->AddArray(cells);
  const auto across = MakeArray(VTK_DOUBLE, "across", sphere->GetNumberOfCells(), 4,
    [](vtkIdType, int k) { return k == 1 ? 10.0 : 20.0; });
  sphere->GetCellData()->AddArray(across);
  using Change = void (*)(vtkTuringTextureFilter*);
  const std::pair<Change, const char*> cases[] = {
    { [](auto* f) { f->SetDiffusionRate1(-1.0); }, "DiffusionRate1 is -1" },
    { [](auto* f) { f->SetDiffusionRate2(std::nan("")); }, "DiffusionRate2 is nan" },
    { [](auto* f) { f->SetDiffusionRateAcross1(-2.0); }, "DiffusionRateAcross1 is -2" },
    { [](auto* f) { f->SetDiffusionRateAcross2(1.0); }, "DirectionArray is not set" },
    { [](auto* f) { f->SetReactionRate(0.0); }, "ReactionRate is 0" },
    { [](auto* f) { f->SetFeatureSize(-1.0); }, "FeatureSize is -1" },
    { [](auto* f) { f->SetInitialNoise(-0.1); }, "InitialNoise is -0.1" },
    { [](auto* f) { f->SetStopTolerance(-1.0); }, "StopTolerance is -1" },
    { [](auto* f) { f->SetCoarseStartSize(-1); }, "CoarseStartSize is -1" },
    { [](auto* f) { f->SetKinetics(6); }, "Kinetics is 6" },
    { [](auto* f) { f->SetGrowthRate(0.0); }, "GrowthRate is 0" },
    { [](auto* f) { f->SetDecayRate(17.0); }, "no steady state" },
    { [](auto* f) { f->SetDecayRate(17.0), f->AutomaticTimeStepOn(); }, "no steady state" },
    { [](auto* f) { f->SetTextureChemical(2); }, "TextureChemical is 2" },
    { [](auto* f) { f->SetLowColor(0.0, 2.0, 0.0); }, "LowColor is 2" },
    { [](auto* f) { f->SetTimeIntegrator(2); }, "TimeIntegrator is 2" },
    { [](auto* f) { SetInputArray(f, 0, "f"); }, "InputArray \"f\" has 1 components" },
    { [](auto* f) { SetInputArray(f, 4, "four"); }, "DiffusionRateArray is a point array" },
    { [](auto* f) { SetInputArray(f, 4, "rates", true); }, "DiffusionRateArray is -1 at cell 7" },
    { [](auto* f) { SetInputArray(f, 4, "across", true); },
      "DiffusionRateArray has other rates across than along" },
    { [](auto* f) { SetInputArray(f, 3, "f"); }, "FixedArray is set but InputArray" },
  };
  for (const auto& [change, message] : cases)
  {
    const auto filter = MakeFilter(sphere, 2);
    change(filter);
    const std::string error = ErrorOf(filter);
    EXPECT_TRUE(Contains(error, message)) << error;
  }
  // A parameter of other kinetics is not read, even if it is invalid.
  const auto filter = MakeFilter(sphere, 2);
  filter->SetFeedRate(-1.0);
  Messages messages(filter);
  filter->Update();
  EXPECT_TRUE(messages.Errors.empty());
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

TEST(TuringTextureFilter, HistoryCountsConcentrationsHeldAtZero)
{
  const auto filter = MakeFilter(Sphere(4), 160);
  filter->Update();
  EXPECT_EQ(HistoryAt(filter, 1, "Clamped"), 0.0);
  EXPECT_GT(HistoryAt(filter, 160, "Clamped"), 20.0);
  EXPECT_NEAR(HistoryAt(filter, 160, "Time"), 10.0, 1e-12);
  const double total = Total(ControlAreas(filter->GetOutput()), Result(filter, "u2"));
  EXPECT_NEAR(HistoryAt(filter, 160, "Total_1"), total, 1e-9 * total);
  EXPECT_GT(HistoryAt(filter, 160, "Energy"), 10.0 * HistoryAt(filter, 24, "Energy"));
}

TEST(TuringTextureFilter, UnitsOnlyRelabelTheSameRun)
{
  const double rate = 3.0;
  auto sphere = Sphere(3);
  const auto natural = MakeFilter(sphere, 48);
  natural->SetReactionRate(rate);
  natural->SetDiffusionRate1(22.0); // the default has a size of the surface on coarse ones
  natural->Update();
  EXPECT_NEAR(natural->GetTimeUnit(), 1.0 / rate, 1e-15);
  const double h = natural->GetMeanEdgeLength();
  const auto absolute = MakeFilter(sphere, 48);
  absolute->SetUnitsToAbsolute();
  absolute->SetReactionRate(rate);
  absolute->SetTimeStep(natural->GetTimeStep() / rate);
  absolute->SetDiffusionRate1(22.0 * h * h * rate);
  absolute->SetDiffusionRate2(2.6 * h * h * rate);
  absolute->Update();
  EXPECT_EQ(absolute->GetTimeUnit(), 1.0);
  EXPECT_LT(LargestDifference(Result(natural, "u1"), Result(absolute, "u1")), 1e-9);
  EXPECT_NEAR(natural->GetWavelength(), absolute->GetWavelength(), 1e-12);
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

TEST(TuringTextureFilter, MissingValuesOfARemovedInitialStateAreForgotten)
{
  auto sphere = Sphere(2);
  AddPointArray(sphere, "state", 2, [](vtkIdType i, int) { return i == 9 ? std::nan("") : 4.0; });
  const auto filter = MakeFilter(sphere, 2);
  SetInputArray(filter, 0, "state");
  filter->Update();
  ASSERT_NE(Result(filter, "u1"), nullptr);
  SetInputArray(filter, 0, "");
  filter->Update();
  const auto fresh = MakeFilter(sphere, 2);
  fresh->Update();
  EXPECT_EQ(LargestDifference(Result(filter, "u1"), Result(fresh, "u1")), 0.0);
}

TEST(TuringTextureFilter, HoldsFixedPoints)
{
  auto sphere = Sphere(3);
  AddPointArray(sphere, "state", 2, [](vtkIdType, int k) { return k == 0 ? 3.0 : 5.0; });
  AddPointArray(sphere, "fixed", 1, [](vtkIdType i, int) { return i % 5 == 0; });
  const auto filter = MakeFilter(sphere, 32);
  SetInputArray(filter, 0, "state");
  SetInputArray(filter, 3, "fixed");
  filter->Update();
  for (vtkIdType i = 0; i < sphere->GetNumberOfPoints(); ++i)
  {
    const double u1 = Result(filter, "u1")->GetComponent(i, 0);
    EXPECT_EQ(std::abs(u1 - 3.0) < 1e-12, i % 5 == 0) << i;
  }
}

TEST(TuringTextureFilter, AnExcludedRegionIsIgnored)
{
  auto sphere = Sphere(4);
  const auto inRegion = [&](vtkIdType i) { return sphere->GetPoint(i)[2] > 0.5; };
  AddPointArray(sphere, "mask", 1, [&](vtkIdType i, int) { return inRegion(i); });
  const auto filter = MakeFilter(sphere, 16);
  filter->SetFeatureSize(1.0); // that the mesh resolves
  SetInputArray(filter, 1, "mask");
  EXPECT_TRUE(Contains(WarningOf(filter), "the mask changes nothing"));
  filter->SetMaskModeToExclude();
  EXPECT_EQ(WarningOf(filter), "");
  for (vtkIdType i = 0; i < sphere->GetNumberOfPoints(); ++i)
  {
    EXPECT_EQ(Result(filter, "u1")->GetComponent(i, 0) == 0.0, inRegion(i));
  }
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

  // Other rates in half of the cells change the result.
  for (vtkIdType c = 0; c < sphere->GetNumberOfCells(); c += 2)
  {
    cells->SetComponent(c, 0, 60.0);
  }
  cells->Modified();
  byCell->Update();
  EXPECT_GT(LargestDifference(Result(byCell, "u1"), Result(byProperty, "u1")), 1e-3);
  byCell->IntrinsicDelaunayOn();
  EXPECT_TRUE(Contains(ErrorOf(byCell), "IntrinsicDelaunay is on but DiffusionRateArray"));
}

TEST(TuringTextureFilter, ColorsInterpolateBetweenTwoColorsByTheTexture)
{
  const auto filter = MakeFilter(Sphere(4), 160);
  filter->ColorOutputOn();
  filter->SetTextureChemicalToU2();
  filter->SetLowColor(0.0, 0.2, 1.0);
  double red = 1.0, green = 1.0, blue = 0.0;
  filter->GetLowColor(red, green, blue);
  EXPECT_EQ(red, 0.0);
  EXPECT_EQ(green, 0.2);
  EXPECT_EQ(blue, 1.0);
  double low[3];
  filter->GetLowColor(low);
  EXPECT_EQ(low[1], 0.2);
  filter->SetHighColor(1.0, 0.4, 0.0);
  filter->SetResultArrayName("my");
  filter->Update();
  vtkDataArray* color = Result(filter, "myTextureColor");
  vtkDataArray* texture = Result(filter, "myTexture");
  ASSERT_NE(color, nullptr);
  EXPECT_EQ(color->GetDataType(), VTK_UNSIGNED_CHAR);
  EXPECT_EQ(color->GetNumberOfComponents(), 3);
  EXPECT_EQ(filter->GetOutput()->GetPointData()->GetScalars(), color);
  vtkDataArray* u2 = Result(filter, "myu2");
  double brightest = 0.0, darkest = 1.0;
  for (vtkIdType i = 0; i < color->GetNumberOfTuples(); ++i)
  {
    const double t = texture->GetComponent(i, 0);
    EXPECT_EQ(color->GetComponent(i, 0), std::round(255.0 * t));
    EXPECT_EQ(color->GetComponent(i, 2), std::round(255.0 * (1.0 - t)));
    brightest = u2->GetComponent(i, 0) == High(u2) ? t : brightest;
    darkest = u2->GetComponent(i, 0) == Low(u2) ? t : darkest;
  }
  EXPECT_EQ(brightest, 1.0);
  EXPECT_EQ(darkest, 0.0);
}

TEST(TuringTextureFilter, IntrinsicDelaunayChangesNoPointAndLittleElse)
{
  auto sphere = Sphere(4);
  const auto filter = MakeFilter(sphere, 32);
  filter->Update();
  const auto expected = Copy(Result(filter, "u1"));
  filter->IntrinsicDelaunayOn();
  filter->Update();
  EXPECT_LT(LargestDifference(Result(filter, "u1"), expected), 0.05);
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

TEST(TuringTextureFilter, ReportsTheCoarserMeshWithoutAWarning)
{
  const auto sphere = Sphere(4);
  vtkNew<vtkTuringTextureFilter> filter;
  filter->SetInputData(sphere);
  filter->SetNumberOfTimeSteps(8);
  filter->SetFeatureSize(1.35); // that the coarser mesh resolves
  Messages messages(filter);
  filter->Update();
  EXPECT_EQ(filter->GetCoarseStartVertices(), 0); // below CoarseStartSize
  filter->SetCoarseStartSize(100);
  filter->Update();
  EXPECT_GT(filter->GetCoarseStartVertices(), 10);
  EXPECT_LT(filter->GetCoarseStartVertices(), sphere->GetNumberOfPoints() / 2);
  filter->SetCoarseStartSize(0);
  filter->Update();
  EXPECT_EQ(filter->GetCoarseStartVertices(), 0);
  EXPECT_TRUE(messages.Warnings.empty() && messages.Errors.empty());
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

  // The same as that of a surface that was refined before
  vtkNew<vtkPolyData> refined;
  refined->CopyStructure(output);
  vtkNew<vtkTuringTextureFilter> again;
  again->SetInputData(refined);
  again->SetNumberOfTimeSteps(20);
  again->SetFeatureSize(0.4);
  again->Update();
  EXPECT_EQ(LargestDifference(output->GetPointData()->GetArray("u1"),
              again->GetOutput()->GetPointData()->GetArray("u1")),
    0.0);

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

TEST(TuringTextureFilter, SaysThatFeaturesAreLargerThanTheSurface)
{
  const auto sphere = Sphere(3); // of radius 1
  vtkNew<vtkTuringTextureFilter> filter;
  filter->SetInputData(sphere);
  filter->SetNumberOfTimeSteps(2);
  filter->SetFeatureSize(3.4);
  Messages messages(filter);
  filter->Update();
  EXPECT_EQ(messages.Warnings, std::vector<std::string>());
  filter->SetFeatureSize(3.5);
  filter->Update();
  ASSERT_EQ(messages.Warnings.size(), 1u);
  EXPECT_NE(
    messages.Warnings[0].find("FeatureSize is 3.5, but the surface is 3.4"), std::string::npos)
    << messages.Warnings[0];
  EXPECT_NE(messages.Warnings[0].find("no room for a pattern"), std::string::npos);
}
