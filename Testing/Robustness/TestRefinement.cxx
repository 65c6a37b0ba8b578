// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
//
// RefineTo of every kind of run, its limit, and the surfaces in pieces that it keeps together.

#include "Twins.h"

#include "vtkPartitionedDataSet.h"

using namespace FilterTest;

namespace
{

constexpr double Length = 0.25; // of a sphere of 80 triangles

/// A coarse sphere with the arrays of all filters, and the same with bisected edges.
struct Spheres
{
  vtkSmartPointer<vtkPolyData> Coarse = Sphere(1);
  vtkNew<vtkPolyData> Fine;

  Spheres()
  {
    AddRough(this->Coarse);
    AddArraysOfAllFilters(this->Coarse);
    AddPointArray(this->Coarse, "none", 1, [](vtkIdType, int) { return 0.0; });
    vtkNew<vtkSurfaceReliefFilter> relief;
    relief->SetInputData(this->Coarse);
    SetInputArray(relief, 0, "none");
    relief->SetRefineTo(Length);
    relief->Update();
    this->Fine->ShallowCopy(relief->GetOutput());
    this->Fine->GetPointData()->RemoveArray("ReliefHeight");
    this->Fine->GetPointData()->SetActiveScalars("f");
  }
};

class RefinementOf : public testing::TestWithParam<FilterKind>
{
};

/// The part of a box in which z is below or above a plane, refined so far that parts differ.
vtkSmartPointer<vtkPolyData> BoxPart(bool upper)
{
  const double low = upper ? 1.0 : 0.0;
  const double high = upper ? 4.0 : 1.0;
  auto part = vtkSmartPointer<vtkPolyData>::New();
  vtkNew<vtkPoints> points;
  points->SetDataTypeToDouble();
  for (int i = 0; i < 8; ++i)
  {
    points->InsertNextPoint(3.0 * (i & 1), 2.0 * (i >> 1 & 1), i < 4 ? low : high);
  }
  vtkNew<vtkCellArray> squares;
  const vtkIdType sides[5][4] = { { 0, 1, 5, 4 }, { 1, 3, 7, 5 }, { 3, 2, 6, 7 }, { 2, 0, 4, 6 },
    { 0, 2, 3, 1 } };
  for (const auto& side : sides)
  {
    squares->InsertNextCell(4, side);
  }
  if (upper) // the top in place of the bottom
  {
    const vtkIdType top[4] = { 4, 5, 7, 6 };
    squares->ReplaceCellAtId(4, 4, top);
  }
  part->SetPoints(points);
  part->SetPolys(squares);
  AddPointArray(part, "Texture", 1, [](vtkIdType, int) { return 1.0; });
  return part;
}

} // namespace

TEST_P(RefinementOf, GivesWhatTheFilterGivesOnTheRefinedSurface)
{
  static const Spheres spheres;
  const auto refining = this->GetParam().Make();
  const auto given = this->GetParam().Make();
  vtkSurfaceFilter::SafeDownCast(refining)->SetRefineTo(Length);
  refining->SetInputData(spheres.Coarse);
  given->SetInputData(spheres.Fine);
  Messages messages(refining);
  Messages ofGiven(given);
  refining->Update();
  given->Update();
  EXPECT_EQ(Sentences(messages), std::vector<std::string>());
  EXPECT_EQ(messages.Warnings.size(), ofGiven.Warnings.size());
  EXPECT_GT(refining->GetOutput()->GetNumberOfCells(), 4 * spheres.Coarse->GetNumberOfCells());
  EXPECT_NE(refining->GetOutput()->GetCellData()->GetArray("vtkOriginalCellIds"), nullptr);
  EXPECT_NE(refining->GetOutput()->GetPointData()->GetArray(this->GetParam().Result) != nullptr,
    refining->GetOutput()->GetCellData()->GetArray(this->GetParam().Result) != nullptr);
  EXPECT_EQ(Difference(refining, given), "");
}

INSTANTIATE_TEST_SUITE_P(EveryKind, RefinementOf, testing::ValuesIn(AllFilters()), KindName);

TEST(Refinement, StopsAtTheLimitWithOneWarning)
{
  const auto sphere = Sphere(1);
  AddRough(sphere);
  vtkNew<vtkFVMHeatFilter> heat;
  heat->SetInputData(sphere);
  heat->SetRefineTo(0.01);
  heat->SetMaximumNumberOfTriangles(1000);
  Messages messages(heat);
  heat->Update();
  heat->SetTimeStep(2.0);
  heat->Update();
  EXPECT_LE(heat->GetOutput()->GetNumberOfCells(), 1000);
  EXPECT_GT(heat->GetOutput()->GetNumberOfCells(), 990);
  ASSERT_EQ(messages.Warnings.size(), 1u);
  EXPECT_NE(messages.Warnings[0].find("refinement stopped at edges of 0.2"), std::string::npos)
    << messages.Warnings[0];
  EXPECT_NE(messages.Warnings[0].find("longer than 0.01, because MaximumNumberOfTriangles is 1000"),
    std::string::npos);
  heat->SetMaximumNumberOfTriangles(2000);
  heat->Update();
  EXPECT_GT(heat->GetOutput()->GetNumberOfCells(), 1990);
  heat->SetMaximumNumberOfTriangles(0);
  heat->Update();
  ASSERT_EQ(messages.Errors.size(), 1u);
  EXPECT_NE(messages.Errors[0].find("MaximumNumberOfTriangles is 0; allowed: integers, 1 or more"),
    std::string::npos);
}

TEST(Refinement, KeepsPiecesTogetherAtAndBelowTheLimit)
{
  // One part has four times the area of the other: it alone reaches the limit.
  for (const int limit : { 4000000, 500 })
  {
    vtkNew<vtkPartitionedDataSet> pieces;
    pieces->SetPartition(0, BoxPart(false));
    pieces->SetPartition(1, BoxPart(true));
    vtkNew<vtkSurfaceReliefFilter> filter;
    filter->SetInputDataObject(pieces);
    filter->SetHeight(0.01);
    filter->SetRefineTo(0.1);
    filter->SetMaximumNumberOfTriangles(limit);
    Messages messages(filter);
    filter->Update();
    EXPECT_EQ(messages.Warnings.size(), limit == 500 ? 1u : 0u);
    EXPECT_EQ(filter->GetOpenEdges(), 0) << limit;
    EXPECT_NEAR(filter->GetVolumeChange(), 3.02 * 2.02 * 4.02 - 24.0, 1e-9) << limit;
  }
}
