// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "FilterTest.h"

#include "vtkAppendPolyData.h"
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

std::string ErrorOf(Filter* filter)
{
  const Messages messages(filter);
  filter->Update();
  return messages.Errors.empty() ? "" : messages.Errors[0];
}

std::string WarningOf(Filter* filter)
{
  const Messages messages(filter);
  filter->Update();
  return messages.Warnings.empty() ? "" : messages.Warnings[0];
}

} // namespace

TEST(InterpolationFilter, HasTheKnownValuesOfTheData)
{
  auto sphere = SparseSphere(5);
  auto filter = MakeFilter(sphere);
  filter->ExactOn();
  filter->Update();
  vtkDataArray* const u = Result(filter, "fInterpolated");
  ASSERT_NE(u, nullptr);
  EXPECT_EQ(filter->GetOutput()->GetPointData()->GetScalars(), u);
  EXPECT_EQ(Result(filter, "fError"), nullptr);
  for (vtkIdType i = 0; i < u->GetNumberOfTuples(); i += 9)
  {
    EXPECT_NEAR(u->GetComponent(i, 0), Field(sphere->GetPoint(i)), 1e-12);
  }
  EXPECT_LT(LargestError(filter, "fInterpolated"), 0.03);
  EXPECT_EQ(filter->GetNumberOfValues(), (u->GetNumberOfTuples() + 8) / 9);
  EXPECT_EQ(filter->GetEffectiveSmoothing(), 0.0);
}

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

TEST(InterpolationFilter, CountsFarPoints)
{
  auto filter = MakeFilter(Sphere(3), Probes(30, 1.5));
  filter->SetMaximumDistance(0.1);
  EXPECT_NE(ErrorOf(filter).find("outside of the surface: farther than MaximumDistance 0.1"),
    std::string::npos);
  EXPECT_EQ(Result(filter, "tInterpolated"), nullptr);
  auto both = Probes(30, 1.0);
  both->GetPoints()->SetPoint(4, 8.0, 0.0, 0.0);
  filter->SetInputData(1, both);
  EXPECT_NE(WarningOf(filter).find("1 value is farther from the surface than MaximumDistance 0.1"),
    std::string::npos);
  EXPECT_EQ(filter->GetNumberOfFarValues(), 1);
  EXPECT_EQ(filter->GetNumberOfValues(), 29);
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

TEST(InterpolationFilter, SaysWhatItDoesWithOddValues)
{
  auto sphere = Sphere(3);
  auto probes = Probes(20, 1.0);
  vtkDataArray* const t = probes->GetPointData()->GetArray("t");
  vtkDataArray* const w = probes->GetPointData()->GetArray("w");
  auto filter = MakeFilter(sphere, probes);
  const auto update = [&]
  {
    t->Modified();
    w->Modified();
    probes->Modified();
    return WarningOf(filter);
  };
  const auto has = [](const std::string& text, const char* part)
  { return text.find(part) != std::string::npos; };
  filter->ExactOn();
  EXPECT_EQ(update(), "");

  const auto values = Copy(t);
  t->Fill(4.5);
  EXPECT_TRUE(has(update(), "all known values are equal, and so is the result"));
  EXPECT_NEAR(Result(filter, "tInterpolated")->GetComponent(11, 0), 4.5, 1e-12);

  // Two values at a point of the surface
  t->DeepCopy(values);
  probes->GetPoints()->SetPoint(4, sphere->GetPoint(7));
  probes->GetPoints()->SetPoint(5, sphere->GetPoint(7));
  w->Fill(1.0);
  w->SetComponent(5, 0, 3.0);
  t->SetComponent(4, 0, 3.0);
  t->SetComponent(5, 0, 5.0);
  filter->SetPointWeightArray("w");
  EXPECT_TRUE(has(update(), "1 place has different values: their weighted mean counts"));
  EXPECT_NEAR(Result(filter, "tInterpolated")->GetComponent(7, 0), 4.5, 1e-12);

  w->SetComponent(3, 0, -1.0);
  filter->Modified();
  EXPECT_TRUE(
    has(ErrorOf(filter), "is -1 at point 3 of the values; allowed: finite numbers, 0 or"));
  w->SetComponent(3, 0, 1.0);
  t->SetComponent(2, 0, std::numeric_limits<double>::infinity());
  filter->Modified();
  EXPECT_TRUE(has(ErrorOf(filter), "a value is infinite at point 2 of the values; allowed"));

  // The smoothing of two values cannot be found.
  t->Fill(NaN);
  t->SetComponent(4, 0, 3.0);
  t->SetComponent(9, 0, 5.0);
  filter->ExactOff();
  EXPECT_TRUE(has(update(), "fewer than 3 places have a value, too few for AutomaticSmoothing"));
  EXPECT_NEAR(Result(filter, "tInterpolated")->GetComponent(7, 0), 3.0, 1e-12);
}

TEST(InterpolationFilter, IsNaNWhereNothingIsKnown)
{
  // A second sphere without values
  vtkNew<vtkAppendPolyData> both;
  auto far = Sphere(2);
  for (vtkIdType i = 0; i < far->GetNumberOfPoints(); ++i)
  {
    const double* const x = far->GetPoint(i);
    far->GetPoints()->SetPoint(i, 5.0 + x[0], x[1], x[2]);
  }
  both->AddInputData(Sphere(3));
  both->AddInputData(far);
  both->Update();
  auto filter = MakeFilter(both->GetOutput(), Probes(20, 1.0));
  filter->ExactOn();
  filter->ComputeErrorOn();
  EXPECT_NE(WarningOf(filter).find("1 connected component has no known value"), std::string::npos);
  for (const char* const name : { "tInterpolated", "tError" })
  {
    for (vtkIdType i = 0; i < filter->GetOutput()->GetNumberOfPoints(); ++i)
    {
      EXPECT_EQ(std::isnan(Result(filter, name)->GetComponent(i, 0)),
        filter->GetOutput()->GetPoint(i)[0] > 3.0);
    }
  }

  // A mask around half of the values
  auto sphere = Sphere(3);
  AddPointArray(
    sphere, "south", 1, [&](vtkIdType i, int) { return sphere->GetPoint(i)[2] < 0.0 ? 1.0 : 0.0; });
  filter->SetInputDataObject(sphere);
  SetInputArray(filter, 1, "south");
  filter->SetMaskModeToExclude();
  EXPECT_NE(WarningOf(filter).find("10 values are where MaskArray excludes the surface"),
    std::string::npos);
  EXPECT_EQ(filter->GetNumberOfValues(), 10);
  for (vtkIdType i = 0; i < sphere->GetNumberOfPoints(); ++i)
  {
    EXPECT_EQ(std::isnan(Result(filter, "tInterpolated")->GetComponent(i, 0)),
      sphere->GetPoint(i)[2] < 0.0);
  }
}

TEST(InterpolationFilter, KeepsTheRangeOfTheValues)
{
  auto probes = Probes(30, 1.0);
  vtkDataArray* const t = probes->GetPointData()->GetArray("t");
  for (vtkIdType i = 0; i < 30; ++i)
  {
    t->SetComponent(i, 0, i < 15 ? 0.0 : 1.0);
  }
  auto filter = MakeFilter(Sphere(4), probes);
  filter->Update();
  EXPECT_GT(Result(filter, "tInterpolated")->GetRange()[1], 1.01);
  EXPECT_LT(Result(filter, "tInterpolated")->GetRange()[0], -0.01);
  filter->KeepRangeOn();
  EXPECT_EQ(WarningOf(filter), "");
  EXPECT_EQ(Result(filter, "tInterpolated")->GetRange()[0], 0.0);
  EXPECT_EQ(Result(filter, "tInterpolated")->GetRange()[1], 1.0);
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

TEST(InterpolationFilter, ContinuesSlopesUnlessTheBoundaryIsNatural)
{
  auto plane = Grid(21, 21);
  const auto ramp = [&](vtkIdType i)
  { return plane->GetPoint(i)[0] - 2.0 * plane->GetPoint(i)[1]; };
  AddPointArray(plane, "f", 1, [&](vtkIdType i, int) { return i % 45 == 22 ? ramp(i) : NaN; });
  plane->GetPointData()->SetActiveScalars("f");
  auto filter = MakeFilter(plane);
  filter->ExactOn();
  const auto largest = [&]
  {
    filter->Update();
    double found = 0.0;
    for (vtkIdType i = 0; i < plane->GetNumberOfPoints(); ++i)
    {
      found =
        std::max(found, std::abs(Result(filter, "fInterpolated")->GetComponent(i, 0) - ramp(i)));
    }
    return found;
  };
  EXPECT_STREQ(filter->GetBoundaryAsString(), "Automatic");
  EXPECT_LT(largest(), 1e-9 * plane->GetLength());
  filter->SetBoundaryToNatural();
  EXPECT_GT(largest(), 1e-2);
}
