// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
//
// Points with vtkDataSetAttributes::HIDDENPOINT take no part: results are those of the surface with
// the cells around them hidden, and they keep their value.

#include "FilterTest.h"

#include "vtkCellData.h"
#include "vtkFVMHeatFilter.h"
#include "vtkHarmonicMapFilter.h"
#include "vtkIdList.h"
#include "vtkIntrinsicTVFilter.h"
#include "vtkMultiBlockDataSet.h"
#include "vtkPartitionedDataSet.h"
#include "vtkSurfaceCurvatureFilter.h"
#include "vtkSurfaceDistanceFilter.h"
#include "vtkSurfaceInterpolationFilter.h"
#include "vtkSurfaceSegmentationFilter.h"
#include "vtkUnsignedCharArray.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>

using namespace FilterTest;

namespace
{

constexpr double Wild = 1e6;

bool IsHidden(vtkIdType i)
{
  return i == 8 || i % 37 == 5;
}

vtkSmartPointer<vtkUnsignedCharArray> MakeFlags(vtkIdType count)
{
  auto flags = vtkSmartPointer<vtkUnsignedCharArray>::New();
  flags->SetName(vtkDataSetAttributes::GhostArrayName());
  flags->SetNumberOfTuples(count);
  flags->FillValue(0);
  return flags;
}

void HidePoints(vtkPolyData* surface)
{
  const auto flags = MakeFlags(surface->GetNumberOfPoints());
  for (vtkIdType i = 0; i < surface->GetNumberOfPoints(); ++i)
  {
    flags->SetValue(i, IsHidden(i) ? vtkDataSetAttributes::HIDDENPOINT : 0);
  }
  surface->GetPointData()->AddArray(flags);
}

void HideCellsAround(vtkPolyData* surface)
{
  const auto flags = MakeFlags(surface->GetNumberOfCells());
  vtkNew<vtkIdList> points;
  for (vtkIdType c = 0; c < surface->GetNumberOfCells(); ++c)
  {
    surface->GetCellPoints(c, points);
    for (vtkIdType k = 0; k < points->GetNumberOfIds(); ++k)
    {
      if (IsHidden(points->GetId(k)))
      {
        flags->SetValue(c, vtkDataSetAttributes::HIDDENCELL);
      }
    }
  }
  surface->GetCellData()->AddArray(flags);
}

/// With wild values at hidden points, on points and on cells.
vtkSmartPointer<vtkPolyData> MakeSurface(bool hidesPoints, double wild = Wild)
{
  const auto surface = Sphere(3);
  AddPointArray(
    surface, "f", 1, [wild](vtkIdType i, int k) { return IsHidden(i) ? wild : Rough(i, k); });
  surface->GetPointData()->SetActiveScalars("f");
  surface->GetCellData()->AddArray(
    MakeArray(VTK_DOUBLE, "c", surface->GetNumberOfCells(), 1, Rough));
  hidesPoints ? HidePoints(surface) : HideCellsAround(surface);
  return surface;
}

void ExpectSame(const std::function<vtkSmartPointer<vtkPolyDataAlgorithm>()>& make,
  const char* result, bool onCells = false)
{
  vtkSmartPointer<vtkDataArray> results[2];
  for (const bool hidesPoints : { false, true })
  {
    const auto filter = make();
    Messages messages(filter);
    filter->SetInputData(MakeSurface(hidesPoints));
    filter->Update();
    ASSERT_TRUE(messages.Errors.empty()) << messages.Errors[0];
    vtkPolyData* const output = filter->GetOutput();
    results[hidesPoints] =
      onCells ? output->GetCellData()->GetArray(result) : output->GetPointData()->GetArray(result);
    ASSERT_NE(results[hidesPoints], nullptr) << result;
  }
  EXPECT_TRUE(Identical(results[0], results[1])) << result;
}

} // namespace

TEST(HiddenPoints, TakeNoPartAndKeepTheirValue)
{
  for (const double wild : { Wild, vtkMath::Nan() })
  {
    const auto surface = MakeSurface(true, wild);
    vtkNew<vtkFVMHeatFilter> filter;
    filter->SetInputData(surface);
    filter->Update();
    vtkDataArray* const result = Result(filter);
    ASSERT_NE(result, nullptr);
    for (vtkIdType i = 0; i < surface->GetNumberOfPoints(); ++i)
    {
      const double u = result->GetComponent(i, 0);
      if (IsHidden(i))
      {
        EXPECT_TRUE(u == wild || (std::isnan(u) && std::isnan(wild))) << i;
      }
      else
      {
        EXPECT_LE(std::abs(u), 1.0 + 1e-6) << i;
      }
    }
    EXPECT_LE(filter->GetValueRange(), 2.0);
  }
}

TEST(HiddenPoints, AreAsIfTheirCellsWereHidden)
{
  ExpectSame([] { return vtkSmartPointer<vtkFVMHeatFilter>::New(); }, "fDiffused");
  ExpectSame([] { return vtkSmartPointer<vtkIntrinsicTVFilter>::New(); }, "fTV");
  ExpectSame([] { return vtkSmartPointer<vtkHarmonicMapFilter>::New(); }, "NormalsHarmonic");
  ExpectSame([] { return vtkSmartPointer<vtkSurfaceSegmentationFilter>::New(); }, "RegionId");
  ExpectSame(
    []
    {
      auto filter = vtkSmartPointer<vtkFVMHeatFilter>::New();
      SetInputArray(filter, 0, "c", true);
      return filter;
    },
    "cDiffused", true);
}

TEST(HiddenPoints, HideWholePolygons)
{
  const auto grid = Grid(5, 5);
  vtkNew<vtkCellArray> quads;
  for (vtkIdType y = 0; y < 4; ++y)
  {
    for (vtkIdType x = 0; x < 4; ++x)
    {
      quads->InsertNextCell({ 5 * y + x, 5 * y + x + 1, 5 * y + x + 6, 5 * y + x + 5 });
    }
  }
  grid->SetPolys(quads);
  grid->GetCellData()->SetScalars(MakeArray(VTK_DOUBLE, "c", 16, 1, Rough));
  HidePoints(grid);
  vtkNew<vtkFVMHeatFilter> filter;
  filter->SetInputData(grid);
  SetInputArray(filter, 0, "c", true);
  filter->Update();
  vtkDataArray* const after = filter->GetOutput()->GetCellData()->GetArray("cDiffused");
  ASSERT_NE(after, nullptr);
  vtkNew<vtkIdList> points;
  int changed = 0;
  for (vtkIdType c = 0; c < 16; ++c)
  {
    grid->GetCellPoints(c, points);
    bool hidden = false;
    for (vtkIdType k = 0; k < 4; ++k)
    {
      hidden = hidden || IsHidden(points->GetId(k));
    }
    const bool same = after->GetComponent(c, 0) == Rough(c, 0);
    EXPECT_TRUE(same || !hidden) << c;
    changed += same ? 0 : 1;
  }
  EXPECT_GT(changed, 4);
}

TEST(HiddenPoints, OfOneBlockAreHiddenThere)
{
  vtkSmartPointer<vtkDataArray> results[2][2];
  for (const bool hidesPoints : { false, true })
  {
    vtkNew<vtkMultiBlockDataSet> blocks;
    const auto open = Sphere(2);
    AddRough(open);
    blocks->SetBlock(0, open);
    blocks->SetBlock(1, MakeSurface(hidesPoints));
    vtkNew<vtkFVMHeatFilter> filter;
    filter->SetInputData(blocks);
    filter->Update();
    auto* const output = vtkMultiBlockDataSet::SafeDownCast(filter->GetOutputDataObject(0));
    for (unsigned int b = 0; b < 2; ++b)
    {
      results[hidesPoints][b] =
        vtkPolyData::SafeDownCast(output->GetBlock(b))->GetPointData()->GetArray("fDiffused");
    }
  }
  EXPECT_TRUE(Identical(results[0][0], results[1][0]));
  EXPECT_TRUE(Identical(results[0][1], results[1][1]));
}

TEST(HiddenPoints, OfPiecesAreAsIfTheirCellsWereHidden)
{
  for (const char* data : { "f", "c" })
  {
    vtkSmartPointer<vtkDataArray> results[2][2];
    for (const bool hidesPoints : { false, true })
    {
      vtkNew<vtkPartitionedDataSet> pieces;
      for (unsigned int p = 0; p < 2; ++p)
      {
        const auto half = Grid(9, 9);
        for (vtkIdType i = 0; i < half->GetNumberOfPoints(); ++i)
        {
          double x[3];
          half->GetPoint(i, x);
          half->GetPoints()->SetPoint(i, x[0] + 8.0 * p, x[1], x[2]);
        }
        AddPointArray(
          half, "f", 1, [](vtkIdType i, int k) { return IsHidden(i) ? Wild : Rough(i, k); });
        half->GetCellData()->AddArray(
          MakeArray(VTK_DOUBLE, "c", half->GetNumberOfCells(), 1, Rough));
        hidesPoints ? HidePoints(half) : HideCellsAround(half);
        pieces->SetPartition(p, half);
      }
      vtkNew<vtkFVMHeatFilter> filter;
      filter->SetInputData(pieces);
      const bool onCells = *data == 'c';
      SetInputArray(filter, 0, data, onCells);
      filter->Update();
      auto* const output = vtkPartitionedDataSet::SafeDownCast(filter->GetOutputDataObject(0));
      for (unsigned int p = 0; p < 2; ++p)
      {
        vtkPolyData* const piece = vtkPolyData::SafeDownCast(output->GetPartition(p));
        results[hidesPoints][p] = onCells ? piece->GetCellData()->GetArray("cDiffused")
                                          : piece->GetPointData()->GetArray("fDiffused");
        ASSERT_NE(results[hidesPoints][p], nullptr);
      }
    }
    EXPECT_TRUE(Identical(results[0][0], results[1][0])) << data;
    EXPECT_TRUE(Identical(results[0][1], results[1][1])) << data;
  }
}

TEST(HiddenPoints, OfTheSecondInputAreNoSources)
{
  // Points 1 and 4 are hidden; 2 to 4 are a line, 5 and 6 another one.
  vtkNew<vtkPolyData> sources;
  vtkNew<vtkPoints> points;
  points->SetDataTypeToDouble();
  for (int i = 0; i < 7; ++i)
  {
    points->InsertNextPoint(i == 1 ? vtkMath::Nan() : i, i > 4 ? 8.0 : 0.0, 0.0);
  }
  vtkNew<vtkCellArray> lines;
  lines->InsertNextCell({ 2, 3, 4 });
  lines->InsertNextCell({ 5, 6 });
  sources->SetPoints(points);
  sources->SetLines(lines);
  const auto flags = MakeFlags(7);
  flags->SetValue(1, vtkDataSetAttributes::HIDDENPOINT);
  flags->SetValue(4, vtkDataSetAttributes::HIDDENPOINT);
  sources->GetPointData()->AddArray(flags);
  vtkNew<vtkSurfaceDistanceFilter> filter;
  filter->SetInputData(Grid(9, 9));
  filter->SetInputData(1, sources);
  filter->SetMethodToEikonal();
  Messages messages(filter);
  const auto expect = [&](bool hasLine)
  {
    filter->Update();
    ASSERT_TRUE(messages.Errors.empty()) << messages.Errors[0];
    EXPECT_EQ(filter->GetNumberOfSources(), hasLine ? 2 : 1);
    EXPECT_NEAR(Result(filter, "Distance")->GetComponent(4, 0), 4.0, 1e-12);
    EXPECT_NEAR(
      Result(filter, "Distance")->GetComponent(80, 0), hasLine ? 2.0 : std::hypot(8.0, 8.0), 1e-6);
    EXPECT_EQ(Result(filter, "NearestSource")->GetComponent(80, 0), hasLine ? 5.0 : 0.0);
  };
  expect(true);
  const auto ofCells = MakeFlags(2);
  ofCells->SetValue(1, vtkDataSetAttributes::HIDDENCELL);
  sources->GetCellData()->AddArray(ofCells);
  filter->Modified();
  expect(false);
  flags->FillValue(vtkDataSetAttributes::HIDDENPOINT);
  filter->Modified();
  filter->Update();
  ASSERT_EQ(messages.Errors.size(), 1u);
  EXPECT_NE(messages.Errors[0].find("the sources, has 7 hidden points; allowed: 1 or more points"),
    std::string::npos)
    << messages.Errors[0];
}

TEST(HiddenPoints, OfTheSecondInputHaveNoValue)
{
  const auto makeSamples = [](bool all)
  {
    auto samples = vtkSmartPointer<vtkPolyData>::New();
    vtkNew<vtkPoints> points;
    points->SetDataTypeToDouble();
    for (int i = 0; i < 40; ++i)
    {
      const double angle = 2.4 * i;
      const double z = -0.9 + 0.045 * i;
      const double r = std::sqrt(1.0 - z * z);
      if (all || !IsHidden(i))
      {
        points->InsertNextPoint(
          i == 5 ? vtkMath::Nan() : r * std::cos(angle), r * std::sin(angle), z);
      }
    }
    samples->SetPoints(points);
    AddPointArray(samples, "t", 1,
      [&](vtkIdType i, int) { return all && IsHidden(i) ? Wild : points->GetPoint(i)[2]; });
    AddPointArray(
      samples, "w", 1, [&](vtkIdType i, int) { return all && IsHidden(i) ? -1.0 : 1.0; });
    samples->GetPointData()->SetActiveScalars("t");
    if (all)
    {
      HidePoints(samples);
    }
    return samples;
  };
  vtkSmartPointer<vtkDataArray> results[2];
  for (const bool all : { false, true })
  {
    vtkNew<vtkSurfaceInterpolationFilter> filter;
    filter->SetInputData(Sphere(3));
    const auto samples = makeSamples(all);
    filter->SetInputData(1, samples);
    filter->SetPointWeightArray("w");
    Messages messages(filter);
    filter->Update();
    ASSERT_TRUE(messages.Errors.empty()) << messages.Errors[0];
    EXPECT_EQ(filter->GetNumberOfValues(), 38);
    results[all] = Result(filter, "tInterpolated");
    if (all)
    {
      vtkUnsignedCharArray::SafeDownCast(
        samples->GetPointData()->GetArray(vtkDataSetAttributes::GhostArrayName()))
        ->FillValue(vtkDataSetAttributes::HIDDENPOINT);
      filter->Modified();
      filter->Update();
      ASSERT_EQ(messages.Errors.size(), 1u);
      EXPECT_NE(messages.Errors[0].find("the points with values, has 40 hidden points; allowed: "),
        std::string::npos)
        << messages.Errors[0];
    }
  }
  ASSERT_TRUE(results[0] && results[1]);
  EXPECT_TRUE(Identical(results[0], results[1]));
}

TEST(HiddenPoints, AndCellsAreAWarningIfNothingElseIsLeft)
{
  const char* const text = "all polygons are hidden or ghost cells: nothing is computed";
  for (const bool hidesPoints : { false, true })
  {
    const auto surface = Grid(5, 5);
    AddPointArray(surface, "f", 1, Rough);
    surface->GetPointData()->SetActiveScalars("f");
    const auto flags =
      MakeFlags(hidesPoints ? surface->GetNumberOfPoints() : surface->GetNumberOfCells());
    flags->FillValue(
      hidesPoints ? +vtkDataSetAttributes::HIDDENPOINT : +vtkDataSetAttributes::HIDDENCELL);
    surface->GetAttributes(hidesPoints ? vtkDataObject::POINT : vtkDataObject::CELL)
      ->AddArray(flags);
    vtkNew<vtkMultiBlockDataSet> blocks;
    blocks->SetBlock(0, MakeSurface(true));
    blocks->SetBlock(1, surface);
    vtkNew<vtkFVMHeatFilter> heat;
    vtkNew<vtkSurfaceCurvatureFilter> curvature;
    for (vtkPolyDataAlgorithm* const filter :
      std::initializer_list<vtkPolyDataAlgorithm*>{ heat, curvature })
    {
      Messages messages(filter);
      filter->SetInputData(surface);
      filter->Update();
      filter->Modified();
      filter->Update();
      EXPECT_TRUE(messages.Errors.empty()) << messages.Errors[0];
      ASSERT_EQ(messages.Warnings.size(), 1u);
      EXPECT_NE(messages.Warnings[0].find(text), std::string::npos) << messages.Warnings[0];
      EXPECT_EQ(messages.Warnings[0].find("block"), std::string::npos) << messages.Warnings[0];
      filter->SetInputData(blocks);
      filter->Update();
      ASSERT_EQ(messages.Warnings.size(), 2u);
      EXPECT_NE(messages.Warnings[1].find(std::string("block 1: ") + text), std::string::npos)
        << messages.Warnings[1];
    }
  }
}
