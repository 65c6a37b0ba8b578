// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
//
// Edges without a length, as at the seams and poles of parametric surfaces.

#include "AllFilters.h"

#include <cmath>
#include <set>
#include <string>
#include <vector>

using namespace FilterTest;

namespace
{

constexpr vtkIdType Split = 11; ///< the point that is split
constexpr double Gap = 3e-16;

vtkSmartPointer<vtkPolyData> WholeSphere()
{
  const auto sphere = Sphere(2);
  AddRough(sphere);
  AddArraysOfAllFilters(sphere);
  // Given normals: computed ones are those of each point's own triangles.
  sphere->GetPointData()->SetNormals(AddPointArray(
    sphere, "Normals", 3, [&](vtkIdType i, int k) { return sphere->GetPoint(i)[k]; }));
  return sphere;
}

/// Part of the triangles of a point get a copy of it beside it, and two triangles of the width of the
/// gap lie between them and the others.
vtkSmartPointer<vtkPolyData> SplitSphere()
{
  const auto sphere = WholeSphere();
  auto split = vtkSmartPointer<vtkPolyData>::New();
  split->DeepCopy(sphere);
  double place[3];
  sphere->GetPoint(Split, place);
  const vtkIdType copy =
    split->GetPoints()->InsertNextPoint(place[0] + Gap, place[1] - Gap, place[2]);
  split->GetPointData()->CopyAllocate(sphere->GetPointData());
  for (vtkIdType i = 0; i < sphere->GetNumberOfPoints(); ++i)
  {
    split->GetPointData()->CopyData(sphere->GetPointData(), i, i);
  }
  split->GetPointData()->CopyData(sphere->GetPointData(), Split, copy);
  // The neighbours of the point, in order: corner k and k + 1 are of one triangle.
  std::vector<vtkIdType> ring = { -1 };
  std::vector<vtkIdType> triangleOf;
  sphere->BuildLinks();
  while (ring.size() == 1 || ring.front() != ring.back())
  {
    vtkNew<vtkIdList> triangles;
    sphere->GetPointCells(Split, triangles);
    for (const vtkIdType t : *triangles)
    {
      vtkNew<vtkIdList> corners;
      sphere->GetCellPoints(t, corners);
      const vtkIdType at = corners->IsId(Split);
      const vtkIdType next = corners->GetId((at + 1) % 3);
      const vtkIdType last = corners->GetId((at + 2) % 3);
      if (ring.front() < 0)
      {
        ring.front() = next;
      }
      if (ring.back() == next)
      {
        ring.push_back(last);
        triangleOf.push_back(t);
        break;
      }
    }
  }
  vtkNew<vtkCellArray> cells;
  const std::set<vtkIdType> moved(triangleOf.begin(), triangleOf.begin() + 2);
  for (vtkIdType t = 0; t < sphere->GetNumberOfCells(); ++t)
  {
    vtkNew<vtkIdList> corners;
    sphere->GetCellPoints(t, corners);
    if (moved.count(t) > 0)
    {
      corners->SetId(corners->IsId(Split), copy);
    }
    cells->InsertNextCell(corners);
  }
  const vtkIdType slivers[2][3] = { { Split, copy, ring[0] }, { copy, Split, ring[2] } };
  split->GetCellData()->CopyAllocate(sphere->GetCellData());
  for (vtkIdType t = 0; t < sphere->GetNumberOfCells(); ++t)
  {
    split->GetCellData()->CopyData(sphere->GetCellData(), t, t);
  }
  for (const auto& sliver : slivers)
  {
    split->GetCellData()->CopyData(
      sphere->GetCellData(), triangleOf[0], cells->InsertNextCell(3, sliver));
  }
  split->SetPolys(cells);
  return split;
}

/// The largest difference of the first rows of arrays of one name, relative to the range.
double DifferenceOfFirstRows(vtkDataArray* whole, vtkDataArray* split)
{
  double difference = 0.0;
  double size = 0.0;
  for (vtkIdType i = 0; i < whole->GetNumberOfTuples(); ++i)
  {
    for (int k = 0; k < whole->GetNumberOfComponents(); ++k)
    {
      const double a = whole->GetComponent(i, k);
      const double b = split->GetComponent(i, k);
      if (std::isnan(a) != std::isnan(b))
      {
        return 1.0;
      }
      size = std::isnan(a) ? size : std::max(size, std::abs(a));
      difference = std::isnan(a) ? difference : std::max(difference, std::abs(a - b));
    }
  }
  return difference / (size > 0.0 ? size : 1.0);
}

class ShortEdgesFor : public testing::TestWithParam<FilterKind>
{
};

} // namespace

TEST_P(ShortEdgesFor, ArePointsOfTheSurface)
{
  const FilterKind& kind = this->GetParam();
  const auto ofWhole = kind.Make();
  const auto ofSplit = kind.Make();
  ofWhole->SetInputData(WholeSphere());
  ofSplit->SetInputData(SplitSphere());
  ofWhole->Update();
  const Messages messages(ofSplit);
  ofSplit->Update();
  for (const std::string& warning : messages.Warnings)
  {
    EXPECT_EQ(warning.find("zero area"), std::string::npos) << warning;
  }
  vtkPolyData* const whole = ofWhole->GetOutput();
  vtkPolyData* const split = ofSplit->GetOutput();
  EXPECT_LT(
    DifferenceOfFirstRows(whole->GetPoints()->GetData(), split->GetPoints()->GetData()), 1e-12);
  for (const auto attribute : { vtkDataObject::POINT, vtkDataObject::CELL })
  {
    vtkDataSetAttributes* const expected = whole->GetAttributes(attribute);
    vtkDataSetAttributes* const found = split->GetAttributes(attribute);
    for (int a = 0; a < expected->GetNumberOfArrays(); ++a)
    {
      vtkDataArray* const array = expected->GetArray(a);
      if (std::string("Normals") == array->GetName())
      {
        continue; // of moved points: those of each point's own triangles
      }
      ASSERT_TRUE(found->GetArray(array->GetName())) << array->GetName();
      EXPECT_LT(DifferenceOfFirstRows(array, found->GetArray(array->GetName())), 1e-9)
        << array->GetName();
    }
  }
  if (vtkDataArray* const result = split->GetPointData()->GetArray(kind.Result.c_str()))
  {
    const vtkIdType copy = result->GetNumberOfTuples() - 1;
    for (int k = 0; k < result->GetNumberOfComponents(); ++k)
    {
      EXPECT_EQ(result->GetComponent(copy, k), result->GetComponent(Split, k));
    }
  }
}

INSTANTIATE_TEST_SUITE_P(EveryKind, ShortEdgesFor, testing::ValuesIn(AllFilters()), KindName);
