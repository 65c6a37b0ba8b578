// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "FilterTest.h"

#include "vtkCellData.h"
#include "vtkDataSetAttributes.h"
#include "vtkFVMHeatFilter.h"
#include "vtkPartitionedDataSet.h"
#include "vtkUnsignedCharArray.h"

#include <gtest/gtest.h>

using namespace FilterTest;

namespace
{

/// Two adjacent grids that meet at x = 5, each with its own points there: an unmerged seam.
vtkSmartPointer<vtkPolyData> TwoSheets()
{
  auto sheets = Grid(6, 6);
  auto right = Grid(6, 6);
  vtkNew<vtkPoints> points;
  points->DeepCopy(sheets->GetPoints());
  for (vtkIdType i = 0; i < 36; ++i)
  {
    const double* p = right->GetPoint(i);
    points->InsertNextPoint(p[0] + 5.0, p[1], p[2]);
  }
  sheets->GetPolys()->Append(right->GetPolys(), 36);
  sheets->SetPoints(points);
  return sheets;
}

/// f as a function of the place of a grid point, independent of its number.
double Place(const double* p)
{
  return std::sin(2.0 * p[0]) + std::cos(3.0 * p[1]) + 0.1 * p[0];
}

void AddPlaceData(vtkPolyData* surface)
{
  AddPointArray(surface, "f", 1, [&](vtkIdType i, int) { return Place(surface->GetPoint(i)); });
  surface->GetPointData()->SetActiveScalars("f");
}

void AddGhosts(vtkPolyData* surface, const std::vector<vtkIdType>& cells, unsigned char kind)
{
  vtkNew<vtkUnsignedCharArray> ghosts;
  ghosts->SetName(vtkDataSetAttributes::GhostArrayName());
  ghosts->SetNumberOfTuples(surface->GetNumberOfCells());
  ghosts->FillValue(0);
  for (const vtkIdType cell : cells)
  {
    ghosts->SetValue(cell, kind);
  }
  surface->GetCellData()->AddArray(ghosts);
}

} // namespace

TEST(Surfaces, DefectsAreHandledAndReportedInOneWarningWithCounts)
{
  auto surface = TwoSheets(); // 6 + 6 points on the seam
  vtkPoints* points = surface->GetPoints();
  for (int i = 0; i < 3; ++i)
  {
    points->InsertNextPoint(20.0 + i, 0.0, 0.0); // isolated
  }
  const vtkIdType top = points->InsertNextPoint(1.5, 1.0, 2.0);
  vtkCellArray* cells = surface->GetPolys();
  cells->InsertNextCell({ vtkIdType(7), vtkIdType(8), top }); // a third triangle at an edge
  cells->InsertNextCell({ vtkIdType(0), vtkIdType(1), vtkIdType(2) }); // collinear
  cells->InsertNextCell({ vtkIdType(3), vtkIdType(3), vtkIdType(9) }); // one point twice
  AddPointArray(surface, "f", 2, Rough);
  const std::vector<double> areas = ControlAreas(surface);
  vtkDataArray* f = surface->GetPointData()->GetArray("f");
  for (const int solver : { vtkFVMHeatFilter::SOLVER_DIRECT,
         vtkFVMHeatFilter::SOLVER_CONJUGATE_GRADIENT, vtkFVMHeatFilter::SOLVER_MULTIGRID })
  {
    auto filter = MakeHeatFilter(surface);
    SetInputArray(filter, 0, "f");
    filter->SetSolver(solver);
    Messages messages(filter);
    filter->Update();
    EXPECT_TRUE(messages.Errors.empty());
    ASSERT_EQ(messages.Warnings.size(), 1u);
    const std::string& text = messages.Warnings[0];
    for (const char* words : { "2 triangles of zero area", "1 edges have three or more triangles",
           "12 boundary points coincide" })
    {
      EXPECT_NE(text.find(words), std::string::npos) << words << " is not in: " << text;
    }
    EXPECT_EQ(text.find("no triangle uses"), std::string::npos) << text;
    EXPECT_EQ(filter->GetNumberOfUnusedPoints(), 3);
    ASSERT_TRUE(AllFinite(Result(filter)));
    for (int k = 0; k < 2; ++k)
    {
      EXPECT_NEAR(
        Total(areas, Result(filter), k), Total(areas, f, k), 1e-12 * TotalMagnitude(areas, f, k));
    }
    for (vtkIdType i = 72; i < 75; ++i)
    {
      EXPECT_EQ(Result(filter)->GetComponent(i, 0), f->GetComponent(i, 0));
    }
    EXPECT_NE(Result(filter)->GetComponent(top, 0), f->GetComponent(top, 0));
    filter->SetTimeStep(2.0);
    filter->Update();
    EXPECT_EQ(messages.Warnings.size(), 1u); // the surface is the same
  }
}

TEST(Surfaces, PointsThatNoTriangleUsesAreCountedWithoutAWarning)
{
  auto sphere = Sphere(2);
  const vtkIdType strays = 4;
  for (vtkIdType i = 0; i < strays; ++i)
  {
    sphere->GetPoints()->InsertNextPoint(5.0, static_cast<double>(i), 0.0);
  }
  AddRough(sphere);
  AddPointArray(sphere, "mask", 1,
    [&](vtkIdType i, int) { return i == 0 || i + 1 == sphere->GetNumberOfPoints() ? 1.0 : 0.0; });
  auto filter = MakeHeatFilter(sphere);
  Messages messages(filter);
  filter->Update();
  EXPECT_EQ(filter->GetNumberOfUnusedPoints(), strays);
  SetInputArray(filter, 1, "mask");
  filter->SetMaskModeToExclude();
  filter->Update();
  EXPECT_EQ(filter->GetNumberOfUnusedPoints(), strays - 1); // one of them is excluded
  EXPECT_TRUE(messages.Warnings.empty() && messages.Errors.empty());
}

TEST(Surfaces, OfZeroAreaKeepTheirValues)
{
  auto surface = Grid(3, 3);
  for (vtkIdType i = 0; i < 9; ++i)
  {
    surface->GetPoints()->SetPoint(i, 1.0, 2.0, 3.0);
  }
  vtkDataArray* f = AddRough(surface);
  for (const int mode : { vtkFVMHeatFilter::MODE_TIME_STEPS, vtkFVMHeatFilter::MODE_STEADY_STATE })
  {
    auto filter = MakeHeatFilter(surface);
    filter->SetMode(mode);
    Messages messages(filter);
    filter->Update();
    EXPECT_TRUE(messages.Errors.empty());
    EXPECT_EQ(messages.Warnings.size(), 1u);
    EXPECT_TRUE(Identical(Result(filter), f));
  }
}

TEST(Surfaces, FullyExcludedKeepTheInputAndFullyMissingAreAnError)
{
  auto surface = Grid(5, 5);
  vtkDataArray* f = AddRough(surface);
  AddPointArray(surface, "all", 1, [](vtkIdType, int) { return 1.0; });
  AddPointArray(surface, "nan", 1, [](vtkIdType, int) { return std::nan(""); });
  auto filter = MakeHeatFilter(surface);
  SetInputArray(filter, 1, "all");
  filter->SetMaskModeToExclude();
  {
    const Messages messages(filter);
    filter->Update();
    EXPECT_TRUE(Identical(Result(filter), f));
    EXPECT_TRUE(messages.Errors.empty());
  }
  filter->SetMaskModeToInpaint();
  filter->SetFidelityWeight(1.0);
  for (int fill = 0; fill < 3; ++fill)
  {
    for (const char* name : { "f", "nan" })
    {
      SetInputArray(filter, 0, name);
      filter->SetResultArrayName("u");
      filter->SetInitialFill(fill);
      const Messages messages(filter);
      filter->Update();
      ASSERT_EQ(messages.Errors.size(), 1u);
      EXPECT_NE(messages.Errors[0].find("has no known value"), std::string::npos);
      EXPECT_EQ(Result(filter, "u"), nullptr) << name << fill;
    }
  }
}

TEST(Surfaces, MergedPointsAreOne)
{
  auto sheets = TwoSheets();
  AddPlaceData(sheets);
  auto whole = Grid(11, 6);
  AddPlaceData(whole);
  auto reference = MakeHeatFilter(whole);
  reference->SetUnitsToAbsolute();
  reference->Update();
  auto filter = MakeHeatFilter(sheets);
  filter->SetUnitsToAbsolute();
  filter->MergeCoincidentPointsOn();
  Messages messages(filter);
  filter->Update();
  EXPECT_TRUE(messages.Warnings.empty());
  const auto compare = [&](double allowed)
  {
    for (vtkIdType i = 0; i < 72; ++i)
    {
      const int x = static_cast<int>(i % 6 + (i < 36 ? 0 : 5));
      const int y = static_cast<int>(i % 36 / 6);
      EXPECT_NEAR(Result(filter)->GetComponent(i, 0),
        Result(reference)->GetComponent(x + 11 * y, 0), allowed);
    }
  };
  compare(1e-12);

  // A seam with a small gap needs a tolerance.
  for (vtkIdType i = 36; i < 72; ++i)
  {
    double p[3];
    sheets->GetPoint(i, p);
    sheets->GetPoints()->SetPoint(i, p[0] + 1e-5, p[1], p[2]);
  }
  sheets->GetPoints()->Modified();
  filter->Update();
  EXPECT_GT(
    std::abs(Result(filter)->GetComponent(5, 0) - Result(filter)->GetComponent(36, 0)), 1e-4);
  filter->SetMergeTolerance(1e-4);
  filter->Update();
  EXPECT_EQ(Result(filter)->GetComponent(5, 0), Result(filter)->GetComponent(36, 0));
  compare(1e-3);
}

TEST(Surfaces, WhoseSeamsCoincideUpToRoundOffAreReportedWithTheToleranceThatJoinsThem)
{
  constexpr int n = 24;
  auto torus = Grid(n + 1, n + 1);
  const double full = 8.0 * std::atan(1.0);
  for (vtkIdType i = 0; i < torus->GetNumberOfPoints(); ++i)
  {
    double p[3];
    torus->GetPoint(i, p);
    const double u = full * p[0] / n;
    const double v = full * p[1] / n;
    const double radius = 3.0 + std::cos(v);
    torus->GetPoints()->SetPoint(i, radius * std::cos(u), radius * std::sin(u), std::sin(v));
  }
  AddPlaceData(torus);
  auto filter = MakeHeatFilter(torus);
  Messages messages(filter);
  filter->Update();
  ASSERT_EQ(messages.Warnings.size(), 1u);
  const std::string& text = messages.Warnings[0];
  EXPECT_NE(text.find("96 boundary points coincide with others"), std::string::npos) << text;
  const std::string words = "set MergeCoincidentPoints, and MergeTolerance to ";
  const std::size_t place = text.find(words);
  ASSERT_NE(place, std::string::npos) << text;
  const double tolerance = std::stod(text.substr(place + words.size()));
  EXPECT_LT(tolerance, 1e-13);
  const auto largestJump = [&]
  {
    double jump = 0.0;
    for (vtkIdType j = 0; j <= n; ++j)
    {
      jump = std::max(jump,
        std::abs(Result(filter)->GetComponent(j * (n + 1), 0) -
          Result(filter)->GetComponent(j * (n + 1) + n, 0)));
    }
    return jump;
  };
  EXPECT_GT(largestJump(), 1e-4);
  messages.Warnings.clear();
  filter->MergeCoincidentPointsOn();
  filter->Update();
  ASSERT_EQ(messages.Warnings.size(), 1u);
  EXPECT_NE(messages.Warnings[0].find("(to join them, set MergeTolerance to "), std::string::npos)
    << messages.Warnings[0];
  messages.Warnings.clear();
  filter->SetMergeTolerance(tolerance);
  filter->Update();
  EXPECT_TRUE(messages.Warnings.empty()) << messages.Warnings[0];
  EXPECT_EQ(largestJump(), 0.0);
}

TEST(Surfaces, MergedPointsWithDifferentDataTakeTheirMeanAndKeepTheSum)
{
  auto sheets = TwoSheets();
  AddPointArray(sheets, "f", 1, [](vtkIdType i, int) { return i < 36 ? 1.0 : 3.0; });
  auto filter = MakeHeatFilter(sheets);
  SetInputArray(filter, 0, "f");
  filter->MergeCoincidentPointsOn();
  filter->GenerateTimeStepsOn();
  UpdateAt(filter, 0.0);
  EXPECT_EQ(Result(filter)->GetComponent(5, 0), 2.0);
  EXPECT_EQ(Result(filter)->GetComponent(36, 0), 2.0);
  EXPECT_EQ(Result(filter)->GetComponent(4, 0), 1.0);
  UpdateAt(filter, 10.0);
  EXPECT_NEAR(HistoryAt(filter, 10, "Total_0"), 100.0, 1e-10); // 25 x 1 + 25 x 3
}

TEST(Surfaces, PartitionsOfStripsAreOneSurface)
{
  const auto part = [](int first)
  {
    auto strips = Grid(4, 5);
    vtkNew<vtkCellArray> cells;
    for (vtkIdType j = 0; j < 4; ++j)
    {
      cells->InsertNextCell(8);
      for (vtkIdType i = 0; i < 4; ++i) // the diagonals of Grid()
      {
        cells->InsertCellPoint(i + 4 * (j + 1));
        cells->InsertCellPoint(i + 4 * j);
      }
    }
    for (vtkIdType i = 0; i < 20; ++i)
    {
      double x[3];
      strips->GetPoint(i, x);
      strips->GetPoints()->SetPoint(i, x[0] + first, x[1], x[2]);
    }
    strips->SetPolys(nullptr);
    strips->SetStrips(cells);
    AddPlaceData(strips);
    return strips;
  };
  vtkNew<vtkPartitionedDataSet> partitions;
  partitions->SetPartition(0, part(0));
  partitions->SetPartition(1, part(3));
  vtkNew<vtkFVMHeatFilter> filter;
  filter->SetInputDataObject(partitions);
  filter->Update();
  const auto whole = Grid(7, 5);
  AddPlaceData(whole);
  const auto reference = MakeHeatFilter(whole);
  reference->Update();
  auto* output = vtkPartitionedDataSet::SafeDownCast(filter->GetOutputDataObject(0));
  for (int p = 0; p < 2; ++p)
  {
    vtkDataArray* u = output->GetPartition(p)->GetPointData()->GetArray("fDiffused");
    for (vtkIdType i = 0; i < 20; ++i)
    {
      const vtkIdType there = i % 4 + 3 * p + 7 * (i / 4);
      EXPECT_NEAR(u->GetComponent(i, 0), Result(reference)->GetComponent(there, 0), 1e-9);
    }
  }
}

TEST(Surfaces, MasksOfPiecesMayHaveAnyTypes)
{
  const auto resultOf = [](int mask, int secondMask, int fixed, int secondFixed)
  {
    vtkNew<vtkPartitionedDataSet> partitions;
    for (const int p : { 0, 1 })
    {
      auto part = Grid(4, 5);
      for (vtkIdType i = 0; i < 20; ++i)
      {
        double x[3];
        part->GetPoint(i, x);
        part->GetPoints()->SetPoint(i, x[0] + 3 * p, x[1], x[2]);
      }
      AddPlaceData(part);
      const auto add = [&](const char* name, int type, vtkIdType marked)
      {
        const auto flags = vtkSmartPointer<vtkDataArray>::Take(vtkDataArray::CreateDataArray(type));
        flags->SetName(name);
        flags->SetNumberOfTuples(20);
        flags->Fill(0.0);
        flags->SetComponent(marked, 0, type == VTK_INT ? 256.0 : 1.0);
        part->GetPointData()->AddArray(flags);
      };
      add("mask", p == 0 ? mask : secondMask, 5);
      add("fixed", p == 0 ? fixed : secondFixed, 10);
      partitions->SetPartition(static_cast<unsigned int>(p), part);
    }
    vtkNew<vtkFVMHeatFilter> filter;
    filter->SetInputDataObject(partitions);
    SetInputArray(filter, 1, "mask");
    SetInputArray(filter, 3, "fixed");
    Messages messages(filter);
    filter->Update();
    EXPECT_TRUE(messages.Errors.empty()) << messages.Errors.front();
    std::vector<double> values;
    auto* const output = vtkPartitionedDataSet::SafeDownCast(filter->GetOutputDataObject(0));
    for (unsigned int p = 0; p < 2; ++p)
    {
      vtkDataArray* const u = output->GetPartition(p)->GetPointData()->GetArray("fDiffused");
      for (vtkIdType i = 0; u && i < 20; ++i)
      {
        values.push_back(u->GetComponent(i, 0));
      }
    }
    return values;
  };
  const std::vector<double> ofOneType = resultOf(VTK_INT, VTK_INT, VTK_INT, VTK_INT);
  EXPECT_EQ(ofOneType.size(), 40u);
  EXPECT_EQ(resultOf(VTK_UNSIGNED_CHAR, VTK_INT, VTK_FLOAT, VTK_ID_TYPE), ofOneType);
  EXPECT_EQ(resultOf(VTK_INT, VTK_DOUBLE, VTK_INT, VTK_UNSIGNED_CHAR), ofOneType);
}

TEST(Surfaces, CollinearPolygonsAreIgnoredTriangleByTriangle)
{
  auto surface = Grid(5, 5);
  surface->GetPolys()->InsertNextCell({ 0, 1, 2, 3, 4 });
  AddPlaceData(surface);
  auto filter = MakeHeatFilter(surface);
  Messages messages(filter);
  filter->Update();
  EXPECT_TRUE(messages.Errors.empty());
  ASSERT_EQ(messages.Warnings.size(), 1u);
  EXPECT_NE(messages.Warnings[0].find("3 triangles of zero area were left out"), std::string::npos)
    << messages.Warnings[0];
}

TEST(Surfaces, QuadsPolygonsAndStripsAreTriangulatedInternallyOnly)
{
  const int n = 6;
  auto triangles = Grid(n, n);
  AddPlaceData(triangles);
  auto reference = MakeHeatFilter(triangles);
  reference->SetUnitsToAbsolute();
  reference->Update();
  // In unit squares both diagonals give the same result, since the cotan weight of a diagonal is 0.
  for (const char* kind : { "quads", "strips", "hexagons" })
  {
    vtkNew<vtkPolyData> surface;
    surface->SetPoints(triangles->GetPoints());
    vtkNew<vtkCellArray> cells;
    for (int j = 0; j + 1 < n; ++j)
    {
      if (std::string(kind) == "strips")
      {
        cells->InsertNextCell(2 * n);
        for (int i = 0; i < n; ++i)
        {
          cells->InsertCellPoint(i + n * (j + 1));
          cells->InsertCellPoint(i + n * j);
        }
        continue;
      }
      const bool hexagons = std::string(kind) == "hexagons"; // each is two squares
      for (vtkIdType i = 0; i + 1 < n; ++i)
      {
        const vtkIdType a = i + n * j;
        if (hexagons && i % 2 == 0 && i + 2 < n)
        {
          cells->InsertNextCell({ a, a + 1, a + 2, a + n + 2, a + n + 1, a + n });
          ++i;
        }
        else
        {
          cells->InsertNextCell({ a, a + 1, a + n + 1, a + n });
        }
      }
    }
    if (std::string(kind) == "strips")
    {
      surface->SetStrips(cells);
    }
    else
    {
      surface->SetPolys(cells);
    }
    AddPlaceData(surface);
    auto filter = MakeHeatFilter(surface);
    filter->SetUnitsToAbsolute();
    Messages messages(filter);
    filter->Update();
    EXPECT_TRUE(messages.Warnings.empty()) << kind;
    EXPECT_EQ(
      filter->GetOutput()->GetPolys()->GetNumberOfCells(), surface->GetPolys()->GetNumberOfCells());
    EXPECT_EQ(filter->GetOutput()->GetNumberOfStrips(), surface->GetNumberOfStrips());
    EXPECT_NEAR(HistoryAt(filter, 10, "Total_0"), HistoryAt(filter, 0, "Total_0"), 1e-12);
    if (std::string(kind) != "hexagons") // ear clipping may give obtuse triangles
    {
      EXPECT_NEAR(HistoryAt(filter, 10, "Energy"), HistoryAt(reference, 10, "Energy"), 0.02)
        << kind;
    }
    EXPECT_TRUE(AllFinite(Result(filter)));
    EXPECT_NE(Result(filter)->GetComponent(14, 0), Place(surface->GetPoint(14)));
  }
}

TEST(Surfaces, VertsAndLinesPassThroughAndCellDataStayWithTheirCells)
{
  auto plane = Grid(6, 6);
  auto mixed = Grid(6, 6);
  vtkNew<vtkCellArray> verts;
  verts->InsertNextCell({ vtkIdType(3) });
  vtkNew<vtkCellArray> lines;
  lines->InsertNextCell({ vtkIdType(0), vtkIdType(35) });
  mixed->SetVerts(verts);
  mixed->SetLines(lines);
  // Cell arrays contain the verts and lines first.
  const auto direction = [](int offset)
  { return [offset](vtkIdType c, int k) { return c < offset ? 0.0 : Rough(c - offset, k); }; };
  plane->GetCellData()->AddArray(MakeArray(VTK_DOUBLE, "e1", 50, 3, direction(0)));
  mixed->GetCellData()->AddArray(MakeArray(VTK_DOUBLE, "e1", 52, 3, direction(2)));
  vtkSmartPointer<vtkDataArray> results[2];
  int r = 0;
  for (vtkPolyData* surface : { plane.Get(), mixed.Get() })
  {
    AddRough(surface);
    auto filter = MakeHeatFilter(surface);
    SetInputArray(filter, 2, "e1", true);
    filter->SetAlongDiffusivity(5.0);
    filter->Update();
    results[r++] = Result(filter);
    EXPECT_EQ(filter->GetOutput()->GetNumberOfVerts(), surface->GetNumberOfVerts());
    EXPECT_EQ(filter->GetOutput()->GetNumberOfLines(), surface->GetNumberOfLines());
    EXPECT_EQ(
      filter->GetOutput()->GetCellData()->GetArray("e1"), surface->GetCellData()->GetArray("e1"));
  }
  EXPECT_TRUE(Identical(results[0], results[1]));
}

TEST(Surfaces, GhostAndHiddenCellsAreIgnored)
{
  for (const unsigned char kind :
    { vtkDataSetAttributes::DUPLICATECELL, vtkDataSetAttributes::HIDDENCELL })
  {
    auto plane = Grid(6, 6);
    vtkDataArray* f = AddRough(plane);
    std::vector<vtkIdType> rightColumn;
    for (vtkIdType row = 0; row < 5; ++row)
    {
      rightColumn.insert(rightColumn.end(), { 10 * row + 8, 10 * row + 9 });
    }
    AddGhosts(plane, rightColumn, kind);
    auto rest = Grid(5, 6);
    AddPointArray(
      rest, "f", 1, [&](vtkIdType i, int) { return f->GetComponent(i % 5 + 6 * (i / 5), 0); });
    rest->GetPointData()->SetActiveScalars("f");
    auto filter = MakeHeatFilter(plane);
    auto reference = MakeHeatFilter(rest);
    for (vtkFVMHeatFilter* each : { filter.Get(), reference.Get() })
    {
      each->SetUnitsToAbsolute();
      each->Update();
    }
    for (vtkIdType i = 0; i < 36; ++i)
    {
      EXPECT_NEAR(Result(filter)->GetComponent(i, 0),
        i % 6 == 5 ? f->GetComponent(i, 0)
                   : Result(reference)->GetComponent(i % 6 + 5 * (i / 6), 0),
        1e-12);
    }
  }
}
