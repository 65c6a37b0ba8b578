// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
//
// Cell arrays as data of all filters that take data.

#include "FilterTest.h"

#include "vtkFVMHeatFilter.h"
#include "vtkHarmonicMapFilter.h"
#include "vtkTuringTextureFilter.h"

#include "vtkCellArray.h"
#include "vtkCellData.h"
#include "vtkMultiBlockDataSet.h"

#include <gtest/gtest.h>

#include <cmath>

using namespace FilterTest;

namespace
{

template <typename Value>
vtkDataArray* AddCellArray(
  vtkPolyData* surface, const char* name, int components, Value&& value, int type = VTK_DOUBLE)
{
  const auto array = MakeArray(type, name, surface->GetNumberOfCells(), components, value);
  surface->GetCellData()->AddArray(array);
  return array;
}

/// A grid of quads, with a vertex cell and a line in front, and a strip behind.
vtkSmartPointer<vtkPolyData> QuadGrid(int nx, int ny)
{
  auto grid = Grid(nx, ny);
  vtkNew<vtkCellArray> quads, vertices, lines, strips;
  for (int j = 0; j + 2 < ny; ++j)
  {
    for (int i = 0; i + 1 < nx; ++i)
    {
      const vtkIdType a = i + nx * j;
      quads->InsertNextCell({ a, a + 1, a + nx + 1, a + nx });
    }
  }
  const vtkIdType last = nx * (ny - 2);
  strips->InsertNextCell(2 * nx);
  for (int i = 0; i < nx; ++i)
  {
    strips->InsertCellPoint(last + i);
    strips->InsertCellPoint(last + nx + i);
  }
  vertices->InsertNextCell({ 3 });
  lines->InsertNextCell({ 4, 5 });
  grid->SetPolys(quads);
  grid->SetVerts(vertices);
  grid->SetLines(lines);
  grid->SetStrips(strips);
  return grid;
}

template <typename Filter>
vtkSmartPointer<Filter> MakeFilter(vtkPolyData* surface, const char* array)
{
  auto filter = vtkSmartPointer<Filter>::New();
  filter->SetInputData(surface);
  SetInputArray(filter, 0, array, true);
  return filter;
}

vtkDataArray* CellResult(vtkPolyDataAlgorithm* filter, const char* name)
{
  return filter->GetOutput()->GetCellData()->GetArray(name);
}

double Area(vtkPolyData* surface, vtkIdType cell)
{
  vtkNew<vtkIdList> corners;
  surface->GetCellPoints(cell, corners);
  double area = 0.0;
  for (vtkIdType i = 0; i + 2 < corners->GetNumberOfIds(); ++i)
  {
    double p[3][3];
    surface->GetPoint(corners->GetId(0), p[0]);
    surface->GetPoint(corners->GetId(i + 1), p[1]);
    surface->GetPoint(corners->GetId(i + 2), p[2]);
    area += vtkTriangle::TriangleArea(p[0], p[1], p[2]);
  }
  return area;
}

} // namespace

TEST(CellDataFilters, TheResultIsOnCellsWithNameTypeAndRole)
{
  auto sphere = Sphere(3);
  AddCellArray(sphere, "c", 2, Rough, VTK_FLOAT)->SetComponentName(1, "second");
  auto heat = MakeFilter<vtkFVMHeatFilter>(sphere, "c");
  heat->Update();
  vtkDataArray* const result = CellResult(heat, "cDiffused");
  ASSERT_NE(result, nullptr);
  EXPECT_EQ(result->GetDataType(), VTK_FLOAT);
  EXPECT_EQ(result->GetNumberOfTuples(), sphere->GetNumberOfCells());
  EXPECT_STREQ(result->GetComponentName(1), "second");
  EXPECT_EQ(heat->GetOutput()->GetCellData()->GetScalars(), result);
  EXPECT_EQ(heat->GetOutput()->GetPointData()->GetNumberOfArrays(), 0);
  EXPECT_EQ(CellResult(heat, "c"), sphere->GetCellData()->GetArray("c"));

  heat->ResultOnCellsOff();
  const auto steps = heat->GetNumberOfStepsComputed();
  heat->Update();
  EXPECT_EQ(heat->GetNumberOfStepsComputed(), steps);
  EXPECT_EQ(CellResult(heat, "cDiffused"), nullptr);
  ASSERT_NE(Result(heat, "cDiffused"), nullptr);
  EXPECT_EQ(heat->GetOutput()->GetPointData()->GetScalars(), Result(heat, "cDiffused"));

  heat->ResultOnCellsOn();
  heat->SetOutputPrecisionToDouble();
  heat->SetResultArrayName("c"); // replaces the data
  Messages messages(heat);
  heat->Update();
  EXPECT_TRUE(messages.Warnings.empty());
  EXPECT_EQ(CellResult(heat, "c")->GetDataType(), VTK_DOUBLE);
  EXPECT_EQ(heat->GetOutput()->GetCellData()->GetNumberOfArrays(), 1);
}

TEST(CellDataFilters, TotalsOfQuadsAndStripsAreKeptAndOtherCellsKeepTheirValue)
{
  auto grid = QuadGrid(9, 7);
  vtkDataArray* const f = AddCellArray(grid, "c", 1, Rough);
  auto heat = MakeFilter<vtkFVMHeatFilter>(grid, "c");
  for (const bool detail : { true, false })
  {
    heat->SetKeepCellDetail(detail);
    heat->Update();
    vtkDataArray* const result = CellResult(heat, "cDiffused");
    double before = 0.0, after = 0.0, size = 0.0;
    for (vtkIdType c = 2; c < grid->GetNumberOfCells() - 1; ++c)
    {
      before += Area(grid, c) * f->GetComponent(c, 0);
      after += Area(grid, c) * result->GetComponent(c, 0);
      size += Area(grid, c) * std::abs(f->GetComponent(c, 0));
      EXPECT_NE(f->GetComponent(c, 0), result->GetComponent(c, 0));
    }
    const vtkIdType strip = grid->GetNumberOfCells() - 1;
    before += 8.0 * f->GetComponent(strip, 0);
    after += 8.0 * result->GetComponent(strip, 0);
    EXPECT_NEAR(before, after, 1e-12 * size);
    EXPECT_NEAR(HistoryAt(heat, 0, "Total_0"), before, 1e-12 * size);
    EXPECT_EQ(f->GetComponent(0, 0), result->GetComponent(0, 0));
    EXPECT_EQ(f->GetComponent(1, 0), result->GetComponent(1, 0));
  }
}

TEST(CellDataFilters, TheirDetailComesAndGoesWithItsProperties)
{
  auto sphere = Sphere(3);
  AddCellArray(sphere, "c", 2, Rough);
  auto heat = MakeFilter<vtkFVMHeatFilter>(sphere, "c");
  heat->Update();
  const auto kept = Copy(CellResult(heat, "cDiffused"));
  const auto steps = heat->GetNumberOfStepsComputed();
  heat->KeepCellDetailOff();
  heat->Update();
  EXPECT_GT(LargestDifference(CellResult(heat, "cDiffused"), kept), 1e-6);
  heat->ResultOnCellsOff();
  heat->Update();
  heat->ResultOnCellsOn();
  heat->KeepCellDetailOn();
  heat->Update();
  EXPECT_TRUE(Identical(CellResult(heat, "cDiffused"), kept));
  EXPECT_EQ(heat->GetNumberOfStepsComputed(), steps);

  for (const bool onCells : { false, true })
  {
    auto late = MakeFilter<vtkFVMHeatFilter>(sphere, "c");
    late->SetResultOnCells(onCells);
    late->SetKeepCellDetail(!onCells);
    late->Update();
    late->ResultOnCellsOn();
    late->KeepCellDetailOn();
    late->Update();
    EXPECT_TRUE(Identical(CellResult(late, "cDiffused"), kept));
  }
}

TEST(CellDataFilters, HarmonicMapsOfCellNormalsAreUnitVectorsWithTheRoleOfNormals)
{
  auto sphere = Sphere(3);
  vtkDataArray* const normals = AddCellArray(sphere, "CellNormals", 3,
    [&](vtkIdType c, int k)
    {
      vtkNew<vtkIdList> corners;
      sphere->GetCellPoints(c, corners);
      double p[3][3], n[3];
      for (int a = 0; a < 3; ++a)
      {
        sphere->GetPoint(corners->GetId(a), p[a]);
      }
      vtkTriangle::ComputeNormal(p[0], p[1], p[2], n);
      return n[k];
    });
  sphere->GetCellData()->SetNormals(normals);
  vtkNew<vtkHarmonicMapFilter> map;
  map->SetInputData(sphere);
  map->SetInputArrayToProcess(0, 0, 0, vtkDataObject::FIELD_ASSOCIATION_CELLS, "CellNormals");
  map->Update();
  vtkDataArray* const result = CellResult(map, "CellNormalsHarmonic");
  ASSERT_NE(result, nullptr);
  EXPECT_EQ(map->GetOutput()->GetCellData()->GetNormals(), result);
  for (vtkIdType c = 0; c < result->GetNumberOfTuples(); ++c)
  {
    EXPECT_NEAR(vtkMath::Norm(result->GetTuple3(c)), 1.0, 1e-12);
  }
  map->MoveVerticesOn();
  Messages messages(map);
  map->Update();
  EXPECT_TRUE(messages.Errors.empty());
  EXPECT_NE(map->GetOutput()->GetPoints(), sphere->GetPoints());
}

TEST(CellDataFilters, TexturesStartFromCells)
{
  auto sphere = Sphere(3);
  AddCellArray(sphere, "start", 2, [](vtkIdType c, int k) { return 4.0 + k + 0.1 * Rough(c, k); });
  auto texture = MakeFilter<vtkTuringTextureFilter>(sphere, "start");
  texture->SetNumberOfTimeSteps(0);
  Messages messages(texture);
  texture->Update();
  EXPECT_TRUE(messages.Errors.empty());
  ASSERT_NE(Result(texture, "u2"), nullptr);
  EXPECT_NEAR(Result(texture, "u2")->GetComponent(0, 0), 5.0, 0.1);
}

TEST(CellDataFilters, BlocksOfPointAndCellDataShareTheirUnits)
{
  auto first = Sphere(2);
  auto second = Sphere(2);
  AddCellArray(first, "f", 1, Rough);
  AddPointArray(second, "f", 1, [](vtkIdType i, int k) { return 3.0 * Rough(i, k); });
  vtkNew<vtkMultiBlockDataSet> blocks;
  blocks->SetBlock(0, first);
  blocks->SetBlock(1, second);
  vtkNew<vtkFVMHeatFilter> heat;
  heat->SetInputData(blocks);
  heat->SetInputArrayToProcess(0, 0, 0, vtkDataObject::FIELD_ASSOCIATION_POINTS_THEN_CELLS, "f");
  Messages messages(heat);
  heat->Update();
  EXPECT_TRUE(messages.Errors.empty());
  auto* const output = vtkMultiBlockDataSet::SafeDownCast(heat->GetOutputDataObject(0));
  EXPECT_NE(
    vtkPolyData::SafeDownCast(output->GetBlock(0))->GetCellData()->GetArray("fDiffused"), nullptr);
  EXPECT_NE(
    vtkPolyData::SafeDownCast(output->GetBlock(1))->GetPointData()->GetArray("fDiffused"), nullptr);
  EXPECT_GT(heat->GetValueRange(), 5.0);
}

TEST(CellDataFilters, AssociationsAreNotConfusedIfOneArrayHasBoth)
{
  // As many points as cells.
  auto surface = vtkSmartPointer<vtkPolyData>::New();
  vtkNew<vtkPoints> points;
  for (const auto& x :
    { std::array<double, 3>{ 1, 1, 1 }, { 1, -1, -1 }, { -1, 1, -1 }, { -1, -1, 1 } })
  {
    points->InsertNextPoint(x.data());
  }
  vtkNew<vtkCellArray> triangles;
  for (const auto& t :
    { std::array<vtkIdType, 3>{ 0, 1, 2 }, { 0, 3, 1 }, { 0, 2, 3 }, { 1, 3, 2 } })
  {
    triangles->InsertNextCell(3, t.data());
  }
  surface->SetPoints(points);
  surface->SetPolys(triangles);
  vtkDataArray* const f = AddPointArray(surface, "f", 1, Rough);
  surface->GetCellData()->AddArray(f);
  vtkNew<vtkFVMHeatFilter> heat;
  heat->SetInputData(surface);
  SetInputArray(heat, 0, "f");
  heat->Update();
  ASSERT_NE(Result(heat), nullptr);
  const auto onPoints = Copy(Result(heat));
  SetInputArray(heat, 0, "f", true);
  heat->Update();
  ASSERT_NE(CellResult(heat, "fDiffused"), nullptr);
  EXPECT_FALSE(Identical(CellResult(heat, "fDiffused"), onPoints));
  EXPECT_EQ(Result(heat), nullptr);
}
