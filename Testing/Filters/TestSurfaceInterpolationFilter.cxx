// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "FilterTest.h"

#include "vtkCellArray.h"
#include "vtkMultiBlockDataSet.h"
#include "vtkPoints.h"
#include "vtkSurfaceInterpolationFilter.h"
#include "vtkTable.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>
#include <vector>

using namespace FilterTest;

namespace
{

using Filter = vtkSurfaceInterpolationFilter;

constexpr double NaN = std::numeric_limits<double>::quiet_NaN();

double Field(const double* x)
{
  return 3.0 + x[2] * x[2] + 0.5 * x[0];
}

/// A sphere with the field at every ninth point.
vtkSmartPointer<vtkPolyData> SparseSphere(int levels)
{
  auto sphere = Sphere(levels);
  AddPointArray(sphere, "f", 1,
    [&](vtkIdType i, int) { return i % 9 == 0 ? Field(sphere->GetPoint(i)) : NaN; });
  sphere->GetPointData()->SetActiveScalars("f");
  return sphere;
}

/// Points around the sphere, `scale` from its centre, with the field at the sphere.
vtkSmartPointer<vtkPolyData> Probes(int count, double scale)
{
  auto probes = vtkSmartPointer<vtkPolyData>::New();
  vtkNew<vtkPoints> points;
  points->SetDataTypeToDouble();
  for (int i = 0; i < count; ++i)
  {
    const double z = -0.98 + 1.96 * i / (count - 1.0);
    const double r = std::sqrt(1.0 - z * z);
    points->InsertNextPoint(
      scale * r * std::cos(2.4 * i), scale * r * std::sin(2.4 * i), scale * z);
  }
  probes->SetPoints(points);
  AddPointArray(probes, "t", 1,
    [&](vtkIdType i, int)
    {
      double x[3];
      points->GetPoint(i, x);
      for (double& coordinate : x)
      {
        coordinate /= scale;
      }
      return Field(x);
    });
  AddPointArray(probes, "w", 1, [](vtkIdType i, int) { return i % 2 == 0 ? 1.0 : 0.0; });
  probes->GetPointData()->SetActiveScalars("t");
  return probes;
}

/// Triangles with points of their own, whose array "point" has the points of the surface.
vtkSmartPointer<vtkPolyData> TriangleSoup(vtkPolyData* surface)
{
  auto soup = vtkSmartPointer<vtkPolyData>::New();
  vtkNew<vtkPoints> points;
  points->SetDataTypeToDouble();
  vtkNew<vtkCellArray> triangles;
  std::vector<vtkIdType> of;
  for (vtkIdType t = 0; t < surface->GetNumberOfCells(); ++t)
  {
    triangles->InsertNextCell(3);
    for (int a = 0; a < 3; ++a)
    {
      of.push_back(surface->GetCell(t)->GetPointId(a));
      triangles->InsertCellPoint(points->InsertNextPoint(surface->GetPoint(of.back())));
    }
  }
  soup->SetPoints(points);
  soup->SetPolys(triangles);
  AddPointArray(soup, "point", 1, [&](vtkIdType i, int) { return static_cast<double>(of[i]); });
  vtkDataArray* const values = surface->GetPointData()->GetScalars();
  AddPointArray(
    soup, values->GetName(), 1, [&](vtkIdType i, int) { return values->GetComponent(of[i], 0); });
  soup->GetPointData()->SetActiveScalars(values->GetName());
  return soup;
}

vtkSmartPointer<Filter> MakeFilter(vtkDataObject* surface, vtkDataObject* points = nullptr)
{
  auto filter = vtkSmartPointer<Filter>::New();
  filter->SetInputDataObject(surface);
  if (points)
  {
    filter->SetInputData(1, points);
  }
  return filter;
}

double TableAt(Filter* filter, const char* column)
{
  return vtkTable::SafeDownCast(filter->GetOutputDataObject(1))
    ->GetValueByName(0, column)
    .ToDouble();
}

double LargestError(Filter* filter, const char* name)
{
  vtkDataArray* const u = Result(filter, name);
  double largest = 0.0;
  for (vtkIdType i = 0; u && i < u->GetNumberOfTuples(); ++i)
  {
    largest =
      std::max(largest, std::abs(u->GetComponent(i, 0) - Field(filter->GetOutput()->GetPoint(i))));
  }
  return u ? largest : NaN;
}

} // namespace

/// As files of triangles without neighbours store them.
TEST(InterpolationFilter, EqualValuesOfMergedPointsCountOnce)
{
  auto sphere = SparseSphere(3);
  auto filter = MakeFilter(sphere);
  filter->ComputeErrorOn();
  filter->SetNoiseLevel(0.1);
  filter->Update();
  auto soup = TriangleSoup(sphere);
  auto merging = MakeFilter(soup);
  merging->ComputeErrorOn();
  merging->SetNoiseLevel(0.1);
  merging->MergeCoincidentPointsOn();
  merging->Update();
  EXPECT_EQ(filter->GetNumberOfValues(), merging->GetNumberOfValues());
  for (const char* const name : { "fInterpolated", "fError" })
  {
    vtkDataArray* const whole = Result(filter, name);
    vtkDataArray* const apart = Result(merging, name);
    ASSERT_TRUE(whole && apart);
    for (vtkIdType i = 0; i < apart->GetNumberOfTuples(); ++i)
    {
      const auto point =
        static_cast<vtkIdType>(soup->GetPointData()->GetArray("point")->GetComponent(i, 0));
      EXPECT_NEAR(apart->GetComponent(i, 0), whole->GetComponent(point, 0), 1e-6);
    }
  }
  // Other values at the same place are other measurements.
  vtkDataArray* const values = soup->GetPointData()->GetArray("f");
  for (vtkIdType i = 0; i < values->GetNumberOfTuples(); ++i)
  {
    values->SetComponent(i, 0, values->GetComponent(i, 0) + 1e-3 * static_cast<double>(i));
  }
  values->Modified();
  merging->Update();
  EXPECT_GT(merging->GetNumberOfValues(), 3 * filter->GetNumberOfValues());
}

TEST(InterpolationFilter, TakesValuesOfPointsBesideTheSurface)
{
  auto probes = Probes(80, 1.1);
  auto filter = MakeFilter(Sphere(4), probes);
  filter->ExactOn();
  filter->ComputeErrorOn();
  filter->Update();
  EXPECT_LT(LargestError(filter, "tInterpolated"), 0.1);
  vtkDataArray* const error = Result(filter, "tError");
  ASSERT_NE(error, nullptr);
  EXPECT_GT(error->GetRange()[1], 0.0);
  EXPECT_EQ(TableAt(filter, "DegreesOfFreedom"), 80.0);
  EXPECT_LT(TableAt(filter, "Misfit"), 1e-9);

  filter->SetResultArrayName("u");
  filter->Update();
  EXPECT_NE(Result(filter, "u"), nullptr);
  EXPECT_NE(Result(filter, "uError"), nullptr);

  filter->SetPointWeightArray("w");
  filter->Update();
  EXPECT_EQ(filter->GetNumberOfValues(), 40);

  probes->GetPointData()->GetArray("w")->Fill(1.0);
  probes->GetPointData()->GetArray("t")->SetComponent(3, 0, NaN);
  probes->GetPointData()->GetArray("t")->Modified();
  probes->Modified();
  filter->Update();
  EXPECT_EQ(filter->GetNumberOfValues(), 79);
}

TEST(InterpolationFilter, ReadsValuesThatWereEditedInPlace)
{
  auto probes = Probes(30, 1.0);
  auto filter = MakeFilter(Sphere(3), probes);
  filter->Update();
  const auto before = Copy(Result(filter, "tInterpolated"));
  probes->GetPointData()->GetArray("t")->SetComponent(7, 0, 9.0);
  filter->Modified();
  filter->Update();
  EXPECT_FALSE(Identical(Result(filter, "tInterpolated"), before));
}

TEST(InterpolationFilter, ReportsBadPointsWithValues)
{
  vtkNew<vtkTable> table;
  auto filter = MakeFilter(Sphere(2), table);
  EXPECT_NE(ErrorOf(filter).find("the points with values are a vtkTable; allowed: a vtkPointSet"),
    std::string::npos);
  auto probes = Probes(5, 1.0);
  filter->SetInputData(1, probes);
  filter->SetPointValueArray("none");
  EXPECT_NE(ErrorOf(filter).find("PointValueArray \"none\" is not among the point arrays"),
    std::string::npos);
  filter->SetPointValueArray("t");
  EXPECT_EQ(ErrorOf(filter), "");
  probes->GetPointData()->GetArray("t")->Fill(NaN);
  probes->Modified();
  EXPECT_NE(ErrorOf(filter).find("no value is known"), std::string::npos);
  vtkNew<vtkPolyData> empty;
  filter->SetInputData(1, empty);
  EXPECT_NE(
    ErrorOf(filter).find("the second input, the points with values, has 0 points; allowed: 1"),
    std::string::npos);
  filter->SetInputData(1, nullptr);
  filter->RemoveAllInputConnections(1);
  EXPECT_NE(ErrorOf(filter).find("InputArray"), std::string::npos); // the sphere has no data
}

TEST(InterpolationFilter, GivesEachBlockTheValues)
{
  vtkNew<vtkMultiBlockDataSet> blocks;
  blocks->SetBlock(0, Sphere(2));
  blocks->SetBlock(1, Sphere(3));
  auto filter = MakeFilter(blocks, Probes(40, 1.0));
  filter->Update();
  auto* const output = vtkMultiBlockDataSet::SafeDownCast(filter->GetOutputDataObject(0));
  for (unsigned int b = 0; b < 2; ++b)
  {
    auto alone = MakeFilter(blocks->GetBlock(b), Probes(40, 1.0));
    alone->Update();
    auto* const block = vtkPolyData::SafeDownCast(output->GetBlock(b));
    vtkDataArray* const found = block->GetPointData()->GetArray("tInterpolated");
    ASSERT_NE(found, nullptr);
    EXPECT_LT(LargestDifference(found, Result(alone, "tInterpolated")), 1e-9);
  }
}
