// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Pieces.h"

#include "vtkFVMHeatFilter.h"
#include "vtkSurfaceInterpolationFilter.h"
#include "vtkTuringTextureFilter.h"

#include "vtkCellData.h"
#include "vtkExecutive.h"
#include "vtkMPIController.h"
#include "vtkMultiBlockDataSet.h"

#include <gtest/gtest.h>

#include <functional>
#include <utility>

using namespace Pieces;

namespace
{

vtkSmartPointer<vtkFVMHeatFilter> MakeHeat(vtkDataObject* input)
{
  auto heat = vtkSmartPointer<vtkFVMHeatFilter>::New();
  heat->SetInputData(input);
  SetInputArray(heat, 0, "f");
  return heat;
}

/// The largest difference from the result of a single process, at points of equal coordinates, over
/// all processes.
double LargestDifference(vtkFVMHeatFilter* heat, vtkPolyData* whole)
{
  auto alone = MakeHeat(whole);
  alone->SetNumberOfTimeSteps(heat->GetNumberOfTimeSteps());
  alone->SetController(nullptr);
  alone->Update();
  double largest = 0.0;
  vtkPolyData* const mine = heat->GetOutput();
  for (vtkIdType i = 0; i < mine->GetNumberOfPoints(); ++i)
  {
    const vtkIdType same = whole->FindPoint(mine->GetPoint(i));
    largest = std::max(
      largest, std::abs(Result(heat)->GetComponent(i, 0) - Result(alone)->GetComponent(same, 0)));
  }
  return OfAll(largest, vtkCommunicator::MAX_OP);
}

} // namespace

TEST(Pieces, GiveTheResultOfTheWholeSurface)
{
  const int n = 24;
  auto heat = MakeHeat(Mine(n));
  heat->Update();
  EXPECT_LT(LargestDifference(heat, Strip(0, n, n)), 1e-12);
  EXPECT_EQ(History(heat)->GetNumberOfRows(), Rank() == 0 ? 11 : 0);
  const double mean = heat->GetMeanEdgeLength();
  EXPECT_EQ(OfAll(mean, vtkCommunicator::MAX_OP), mean);
}

TEST(Pieces, HaveTheRangeOfTheWholeSurface)
{
  // A patch of 0.7 % of the area, which is more of the piece that has it.
  const int n = 24;
  const auto addOutliers = [n](vtkPolyData* piece)
  {
    vtkDataArray* const f = piece->GetPointData()->GetArray("f");
    for (vtkIdType i = 0; i < piece->GetNumberOfPoints(); ++i)
    {
      const double* const x = piece->GetPoint(i);
      if (x[0] < 1.5 / n && x[1] < 2.5 / n)
      {
        f->SetComponent(i, 0, 100.0 - i % 3);
      }
    }
  };
  const auto whole = Strip(0, n, n);
  addOutliers(whole);
  auto alone = MakeHeat(whole);
  alone->SetController(nullptr);
  alone->Update();
  EXPECT_LT(alone->GetValueRange(), 10.0);
  const auto mine = Mine(n);
  addOutliers(mine);
  auto heat = MakeHeat(mine);
  heat->SetSolverToConjugateGradient(); // not gathered
  heat->Update();
  EXPECT_DOUBLE_EQ(heat->GetValueRange(), alone->GetValueRange());
}

TEST(Pieces, MatchWithinTheToleranceOnly)
{
  const int n = 24;
  const auto whole = Strip(0, n, n);
  const double shift = 1e-8 * Rank();
  auto heat = MakeHeat(Mine(n, shift));
  heat->Update();
  EXPECT_LT(LargestDifference(heat, whole), 1e-5);
  heat->SetSeamTolerance(0.0);
  heat->Update();
  const double walls = LargestDifference(heat, whole);
  EXPECT_EQ(walls > 1e-3, Count() > 1) << walls;
}

TEST(Pieces, AreMatchedByGlobalIdsIfTheyHaveThem)
{
  // Coincident points with different ids are different points.
  const int n = 24;
  auto mine = Mine(n);
  vtkNew<vtkIdTypeArray> ids;
  ids->SetName("ids");
  for (vtkIdType i = 0; i < mine->GetNumberOfPoints(); ++i)
  {
    ids->InsertNextValue(10000 * Rank() + i);
  }
  mine->GetPointData()->SetGlobalIds(ids);
  auto heat = MakeHeat(mine);
  heat->Update();
  const double walls = LargestDifference(heat, Strip(0, n, n));
  EXPECT_EQ(walls > 1e-3, Count() > 1) << walls;
}

TEST(Pieces, AreMatchedByGlobalIdsThatNoDoubleHolds)
{
  // Above 2^53 doubles are further apart than neighbouring ids.
  const int n = 24;
  for (const vtkIdType first : { (vtkIdType(1) << 53) + 1, vtkIdType(1) << 62 })
  {
    auto mine = Mine(n);
    vtkNew<vtkIdTypeArray> ids;
    ids->SetName("ids");
    for (vtkIdType i = 0; i < mine->GetNumberOfPoints(); ++i)
    {
      const double* const x = mine->GetPoint(i);
      ids->InsertNextValue(first + std::lround(x[0] * n) * (n + 1) + std::lround(x[1] * n));
    }
    mine->GetPointData()->SetGlobalIds(ids);
    for (const int solver :
      { vtkFVMHeatFilter::SOLVER_DIRECT, vtkFVMHeatFilter::SOLVER_CONJUGATE_GRADIENT })
    {
      auto heat = MakeHeat(mine);
      heat->SetSolver(solver);
      heat->SetTolerance(1e-12);
      heat->Update();
      EXPECT_LT(LargestDifference(heat, Strip(0, n, n)), 1e-9) << first << ' ' << solver;
    }
  }
}

TEST(Pieces, GiveTheSameBitsForAnyPartition)
{
  // Strips, and all in one process. A power of two, so that coordinates have the same bits too.
  const int n = 32;
  auto strips = MakeHeat(Mine(n));
  strips->SetSolverToDirect();
  strips->Update();
  for (int owner = 1; owner < Count(); ++owner)
  {
    const auto whole = Strip(0, n, n);
    vtkNew<vtkPolyData> none;
    auto heat = MakeHeat(Rank() == owner ? whole.Get() : none.Get());
    heat->SetSolverToDirect();
    heat->Update();
    vtkPolyData* const mine = strips->GetOutput();
    for (vtkIdType i = 0; Rank() == owner && i < mine->GetNumberOfPoints(); ++i)
    {
      ASSERT_EQ(Result(strips)->GetComponent(i, 0),
        Result(heat)->GetComponent(whole->FindPoint(mine->GetPoint(i)), 0));
    }
  }
}

TEST(Pieces, OfClosedSurfacesThatTouchStayApart)
{
  // A sphere in each process, all touching at (1, 0, 0), which no piece has on its edge.
  auto sphere = Sphere(3);
  if (Rank() % 2 == 1)
  {
    for (vtkIdType i = 0; i < sphere->GetNumberOfPoints(); ++i)
    {
      double x[3];
      sphere->GetPoint(i, x);
      x[0] = 2.0 - x[0];
      sphere->GetPoints()->SetPoint(i, x);
    }
  }
  if (Rank() > 1)
  {
    sphere->Initialize();
  }
  AddPointArray(sphere, "f", 1, [&](vtkIdType, int) { return static_cast<double>(Rank()); });
  auto heat = MakeHeat(sphere);
  heat->Update();
  for (vtkIdType i = 0; i < sphere->GetNumberOfPoints(); ++i)
  {
    ASSERT_NEAR(Result(heat)->GetComponent(i, 0), Rank(), 1e-12);
  }
}

TEST(Pieces, SheetsThatTouchWithinAPieceStayApart)
{
  // Two coincident sheets, divided into the same pieces.
  const int n = 24;
  auto lower = Mine(n);
  vtkNew<vtkPolyData> both;
  vtkNew<vtkPoints> points;
  points->SetDataTypeToDouble();
  vtkNew<vtkCellArray> triangles;
  const vtkIdType count = lower->GetNumberOfPoints();
  for (const int sheet : { 0, 1 })
  {
    for (vtkIdType i = 0; i < count; ++i)
    {
      points->InsertNextPoint(lower->GetPoint(i));
    }
    vtkNew<vtkIdList> corners;
    for (vtkIdType c = 0; c < lower->GetNumberOfCells(); ++c)
    {
      lower->GetCellPoints(c, corners);
      triangles->InsertNextCell({ corners->GetId(0) + sheet * count,
        corners->GetId(1) + sheet * count, corners->GetId(2) + sheet * count });
    }
  }
  both->SetPoints(points);
  both->SetPolys(triangles);
  AddPointArray(
    both, "f", 1, [&](vtkIdType i, int) { return i < count ? Data(points->GetPoint(i)) : 5.0; });
  auto heat = MakeHeat(both);
  heat->SetUnitsToAbsolute();
  heat->SetTimeStep(1e-3);
  heat->Update();
  auto alone = MakeHeat(Strip(0, n, n));
  alone->SetController(nullptr);
  alone->SetUnitsToAbsolute();
  alone->SetTimeStep(1e-3);
  alone->Update();
  for (vtkIdType i = 0; i < count; ++i)
  {
    const vtkIdType same = alone->GetOutput()->FindPoint(points->GetPoint(i));
    ASSERT_NEAR(Result(heat)->GetComponent(i, 0), Result(alone)->GetComponent(same, 0), 1e-12);
    ASSERT_NEAR(Result(heat)->GetComponent(i + count, 0), 5.0, 1e-12);
  }
}

TEST(Pieces, OfBlocksAreSeparateSurfaces)
{
  // Block 0 is divided into pieces, block 1 is in the last process only, block 2 is in none.
  const int n = 24;
  vtkNew<vtkMultiBlockDataSet> blocks;
  blocks->SetNumberOfBlocks(3);
  blocks->SetBlock(0, Mine(n));
  const auto other = Strip(0, 10, 10);
  if (Rank() == Count() - 1)
  {
    blocks->SetBlock(1, other);
  }
  auto heat = MakeHeat(blocks);
  heat->Update();
  vtkNew<vtkMultiBlockDataSet> whole;
  whole->SetBlock(0, Strip(0, n, n));
  whole->SetBlock(1, other);
  auto alone = MakeHeat(whole);
  alone->SetController(nullptr);
  alone->Update();
  for (const unsigned int b : { 0u, 1u })
  {
    auto* found = vtkPolyData::SafeDownCast(
      vtkMultiBlockDataSet::SafeDownCast(heat->GetOutputDataObject(0))->GetBlock(b));
    auto* expected = vtkPolyData::SafeDownCast(
      vtkMultiBlockDataSet::SafeDownCast(alone->GetOutputDataObject(0))->GetBlock(b));
    for (vtkIdType i = 0; found && i < found->GetNumberOfPoints(); ++i)
    {
      ASSERT_NEAR(found->GetPointData()->GetArray("fDiffused")->GetComponent(i, 0),
        expected->GetPointData()
          ->GetArray("fDiffused")
          ->GetComponent(expected->FindPoint(found->GetPoint(i)), 0),
        1e-12);
    }
  }
}

TEST(Pieces, WithoutAControllerAreSeparateSurfaces)
{
  const auto mine = Mine(24);
  auto heat = MakeHeat(mine);
  heat->SetController(nullptr);
  heat->Update();
  const std::vector<double> areas = ControlAreas(mine);
  EXPECT_NEAR(Total(areas, Result(heat)), Total(areas, mine->GetPointData()->GetArray("f")), 1e-12);
  EXPECT_EQ(History(heat)->GetNumberOfRows(), 11);
}

TEST(Pieces, OfNoiseWithoutASignalThatWasSmoothedGiveTheWarningOfTheWholeSurfaceOnce)
{
  const int n = 32;
  const auto makeHeat = [&](vtkPolyData* surface)
  {
    AddPointArray(surface, "f", 1,
      [&](vtkIdType i, int) { return SmoothedNoise(surface->GetPoint(i), 3.0 / n); });
    auto heat = MakeHeat(surface);
    heat->AutomaticFidelityOn();
    heat->SetModeToSteadyState();
    return heat;
  };
  auto pieces = makeHeat(Mine(n));
  Messages ofPieces(pieces);
  pieces->Update();
  auto whole = makeHeat(Strip(0, n, n));
  whole->SetController(nullptr);
  Messages ofWhole(whole);
  whole->Update();
  ASSERT_EQ(ofWhole.Warnings.size(), 1u);
  ASSERT_EQ(ofPieces.Warnings.size(), Rank() == 0 ? 1u : 0u);
  const auto words = [](const std::string& text)
  {
    const std::size_t begin = text.find("NoiseLevel: the data show no white noise");
    return begin == std::string::npos ? std::string() : text.substr(begin);
  };
  EXPECT_NE(words(ofWhole.Warnings[0]), "") << ofWhole.Warnings[0];
  if (Rank() == 0)
  {
    EXPECT_EQ(words(ofPieces.Warnings[0]), words(ofWhole.Warnings[0]));
  }
}

TEST(Pieces, WithoutTheArrayAreOneError)
{
  auto mine = Mine(24);
  if (Rank() == Count() - 1)
  {
    mine->GetPointData()->RemoveArray("f");
  }
  auto heat = MakeHeat(mine);
  Messages messages(heat);
  heat->Update();
  EXPECT_EQ(messages.Errors.size(), Rank() == 0 ? 1u : 0u);
  EXPECT_EQ(Result(heat), nullptr);
}

TEST(Pieces, WithDifferentArraysAreOneErrorOfAllProcesses)
{
  using Change = std::function<void(vtkPolyData*)>;
  const auto value = [](vtkIdType i, int k) { return 1.0 + Rough(i, k); };
  const std::vector<std::pair<const char*, Change>> changes = {
    { "3 components", [&](vtkPolyData* piece) { AddPointArray(piece, "f", 3, value); } },
    { "unsigned char",
      [&](vtkPolyData* piece) { AddPointArray(piece, "f", 1, value, VTK_UNSIGNED_CHAR); } },
    { "on cells",
      [&](vtkPolyData* piece)
      {
        piece->GetPointData()->RemoveArray("f");
        piece->GetCellData()->SetScalars(
          MakeArray(VTK_DOUBLE, "f", piece->GetNumberOfCells(), 1, value));
      } },
    { "\"g\"",
      [&](vtkPolyData* piece)
      {
        AddPointArray(piece, "g", 1, value);
        piece->GetPointData()->SetActiveScalars("g");
      } },
  };
  for (const auto& [words, change] : changes)
  {
    for (const bool gathered : { false, true })
    {
      const auto mine = Mine(24);
      mine->GetPointData()->SetActiveScalars("f");
      if (Rank() == Count() - 1)
      {
        change(mine);
      }
      vtkNew<vtkFVMHeatFilter> heat; // of the active scalars
      heat->SetInputData(mine);
      gathered ? heat->SetSolverToDirect() : heat->SetSolverToConjugateGradient();
      Messages messages(heat);
      const int succeeded = heat->GetExecutive()->Update();
      if (Count() == 1)
      {
        EXPECT_EQ(succeeded, 1);
        continue;
      }
      EXPECT_EQ(succeeded, 0) << words << gathered;
      EXPECT_EQ(Result(heat), nullptr) << words << gathered;
      ASSERT_EQ(messages.Errors.size(), Rank() == 0 ? 1u : 0u) << words << gathered;
      if (Rank() == 0)
      {
        const std::string& error = messages.Errors[0];
        EXPECT_NE(error.find("the pieces of the input have different arrays, \"f\" (double, 1 "
                             "component, on points) and "),
          std::string::npos)
          << error;
        EXPECT_NE(error.find(words), std::string::npos) << error;
      }
    }
  }
}

TEST(Pieces, OfPointsWithDifferentValuesAreOneErrorOfAllProcesses)
{
  const auto makePoints = [](int components, const char* name)
  {
    auto points = vtkSmartPointer<vtkPolyData>::New();
    points->DeepCopy(Mine(3));
    points->SetPolys(nullptr);
    points->GetPointData()->Initialize();
    AddPointArray(points, name, components, [](vtkIdType i, int k) { return Rough(i, k); });
    return points;
  };
  for (const auto& [components, name] :
    { std::pair<int, const char*>(3, "t"), std::pair<int, const char*>(1, "absent elsewhere") })
  {
    const bool isOther = Count() > 1 && Rank() == Count() - 1;
    vtkNew<vtkSurfaceInterpolationFilter> spline;
    spline->SetInputData(Mine(24));
    spline->SetInputData(1, isOther ? makePoints(components, name) : makePoints(1, "t"));
    spline->SetPointValueArray("t");
    Messages messages(spline);
    const int succeeded = spline->GetExecutive()->Update();
    EXPECT_EQ(succeeded, Count() > 1 ? 0 : 1) << name;
    EXPECT_EQ(messages.Errors.size(), Count() > 1 && Rank() == 0 ? 1u : 0u) << name;
  }
}

TEST(Pieces, HaveTheMeasuredValuesOfTheWholeSurfaceWhereTheyAreRefined)
{
  const int n = 32;
  for (const bool onCells : { false, true })
  {
    const auto makeFilter = [&](vtkPolyData* surface)
    {
      const auto value = [](const double* x)
      { return std::sin(x[0]) + 0.2 * std::sin(1e4 * x[0] + 2e4 * x[1]); }; // as good as random
      AddPointArray(surface, "f", 1, [&](vtkIdType i, int) { return value(surface->GetPoint(i)); });
      surface->GetCellData()->AddArray(MakeArray(VTK_DOUBLE, "f", surface->GetNumberOfCells(), 1,
        [&](vtkIdType i, int) { return value(surface->GetCell(i)->GetBounds()); }));
      auto filter = vtkSmartPointer<vtkSurfaceInterpolationFilter>::New();
      filter->SetInputData(surface);
      filter->SetRefineTo(0.5 / n);
      SetInputArray(filter, 0, "f", onCells);
      return filter;
    };
    auto pieces = makeFilter(Mine(n));
    pieces->Update();
    const auto surface = Strip(0, n, n);
    auto whole = makeFilter(surface);
    whole->SetController(nullptr);
    whole->Update();
    EXPECT_GT(whole->GetOutput()->GetNumberOfCells(), 3 * surface->GetNumberOfCells());
    EXPECT_EQ(whole->GetNumberOfValues(),
      onCells ? surface->GetNumberOfCells() : surface->GetNumberOfPoints());
    EXPECT_EQ(pieces->GetNumberOfValues(), whole->GetNumberOfValues());
    // The random vectors of cross-validation depend on the order of the values.
    EXPECT_NEAR(pieces->GetEffectiveSmoothing(), whole->GetEffectiveSmoothing(),
      0.03 * whole->GetEffectiveSmoothing());
  }
}

TEST(Pieces, AreRefinedAlikeForTheFeatureSizeOfATexture)
{
  const auto makeTexture = [](vtkPolyData* input)
  {
    auto texture = vtkSmartPointer<vtkTuringTextureFilter>::New();
    texture->SetInputData(input);
    texture->SetFeatureSize(0.4);
    texture->SetNumberOfTimeSteps(2);
    return texture;
  };
  const int n = 8; // 0.4 is three edges
  auto pieces = makeTexture(Mine(n));
  auto alone = makeTexture(Strip(0, n, n));
  alone->SetController(nullptr);
  Messages ofPieces(pieces);
  Messages ofAlone(alone);
  pieces->Update();
  alone->Update();
  ASSERT_EQ(ofAlone.Warnings.size(), 1u);
  EXPECT_EQ(ofPieces.Warnings.size(), Rank() == 0 ? 1u : 0u);
  vtkPolyData* const mine = pieces->GetOutput();
  vtkPolyData* const whole = alone->GetOutput();
  EXPECT_GT(whole->GetNumberOfCells(), 2 * 32 * 32 / 2);
  EXPECT_EQ(OfAll(static_cast<double>(mine->GetNumberOfCells()), vtkCommunicator::SUM_OP),
    static_cast<double>(whole->GetNumberOfCells()));
  vtkDataArray* const u1 = mine->GetPointData()->GetArray("u1");
  ASSERT_NE(u1, nullptr);
  double largest = 0.0;
  for (vtkIdType i = 0; i < mine->GetNumberOfPoints(); ++i)
  {
    const vtkIdType same = whole->FindPoint(mine->GetPoint(i));
    largest = std::max(largest,
      std::abs(
        u1->GetComponent(i, 0) - whole->GetPointData()->GetArray("u1")->GetComponent(same, 0)));
  }
  EXPECT_LT(largest, 1e-9);
}

int main(int argc, char** argv)
{
  vtkNew<vtkMPIController> controller;
  controller->Initialize(&argc, &argv);
  vtkMultiProcessController::SetGlobalController(controller);
  testing::InitGoogleTest(&argc, argv);
  const int failed = RUN_ALL_TESTS();
  vtkMultiProcessController::SetGlobalController(nullptr);
  controller->Finalize();
  return failed;
}
