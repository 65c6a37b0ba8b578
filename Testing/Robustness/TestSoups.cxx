// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
//
// Surfaces as STL files have them: every triangle has points of its own.

#include "AllFilters.h"

#include <string>

using namespace FilterTest;

namespace
{

vtkSmartPointer<vtkPolyData> Soup()
{
  const auto sphere = Sphere(2);
  AddRough(sphere);
  AddArraysOfAllFilters(sphere);
  auto soup = vtkSmartPointer<vtkPolyData>::New();
  vtkNew<vtkPoints> points;
  points->SetDataTypeToDouble();
  vtkNew<vtkCellArray> triangles;
  vtkPointData* const from = sphere->GetPointData();
  vtkPointData* const to = soup->GetPointData();
  to->CopyAllocate(from);
  for (vtkIdType t = 0; t < sphere->GetNumberOfCells(); ++t)
  {
    vtkNew<vtkIdList> corners;
    sphere->GetCellPoints(t, corners);
    triangles->InsertNextCell(3);
    for (int k = 0; k < 3; ++k)
    {
      const vtkIdType corner = corners->GetId(k);
      const vtkIdType copy = points->InsertNextPoint(sphere->GetPoint(corner));
      triangles->InsertCellPoint(copy);
      to->CopyData(from, corner, copy);
    }
  }
  soup->SetPoints(points);
  soup->SetPolys(triangles);
  soup->GetCellData()->ShallowCopy(sphere->GetCellData());
  return soup;
}

class SoupsFor : public testing::TestWithParam<FilterKind>
{
};

} // namespace

TEST_P(SoupsFor, AreReportedUnlessPointsAreMerged)
{
  const auto filter = this->GetParam().Make();
  auto* const surfaceFilter = vtkSurfaceFilter::SafeDownCast(filter);
  filter->SetInputData(Soup());
  Messages messages(filter);
  const auto isReported = [&]
  {
    messages.Warnings.clear();
    filter->Update();
    bool found = false;
    for (const std::string& warning : messages.Warnings)
    {
      found = found || warning.find("boundary points coincide with others") != std::string::npos ||
        warning.find("open edges") != std::string::npos; // of relief
    }
    return found;
  };
  surfaceFilter->MergeCoincidentPointsOff();
  EXPECT_TRUE(isReported());
  surfaceFilter->MergeCoincidentPointsOn();
  EXPECT_FALSE(isReported());
  EXPECT_TRUE(messages.Errors.empty());
}

INSTANTIATE_TEST_SUITE_P(EveryKind, SoupsFor, testing::ValuesIn(AllFilters()), KindName);
