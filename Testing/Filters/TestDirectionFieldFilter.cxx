// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "FilterTest.h"

#include "vtkAppendPolyData.h"
#include "vtkCellData.h"
#include "vtkCylinderSource.h"
#include "vtkStripper.h"
#include "vtkSurfaceDirectionFieldFilter.h"

#include <gtest/gtest.h>

using namespace FilterTest;

namespace
{

/// Open cylinder about the z axis, 0 <= z <= 2.
vtkSmartPointer<vtkPolyData> Cylinder(int around = 32, int along = 16)
{
  vtkNew<vtkPoints> points;
  points->SetDataTypeToDouble();
  vtkNew<vtkCellArray> triangles;
  for (int j = 0; j <= along; ++j)
  {
    for (int i = 0; i < around; ++i)
    {
      const double angle = 2.0 * vtkMath::Pi() * i / around;
      points->InsertNextPoint(0.5 * std::cos(angle), 0.5 * std::sin(angle), 2.0 * j / along);
      if (j < along)
      {
        const vtkIdType a = j * around + i;
        const vtkIdType b = j * around + (i + 1) % around;
        triangles->InsertNextCell({ a, b, b + around });
        triangles->InsertNextCell({ a, b + around, a + around });
      }
    }
  }
  auto cylinder = vtkSmartPointer<vtkPolyData>::New();
  cylinder->SetPoints(points);
  cylinder->SetPolys(triangles);
  return cylinder;
}

vtkDataArray* Direction(vtkPolyDataAlgorithm* filter)
{
  return filter->GetOutput()->GetCellData()->GetArray("Direction");
}

/// Smallest |d . axis| and largest deviation of |d| from one.
void ExpectAlong(vtkDataArray* directions, const double axis[3], double tolerance)
{
  ASSERT_NE(directions, nullptr);
  for (vtkIdType c = 0; c < directions->GetNumberOfTuples(); ++c)
  {
    double d[3];
    directions->GetTuple(c, d);
    EXPECT_NEAR(vtkMath::Norm(d), 1.0, 1e-9);
    EXPECT_NEAR(std::abs(vtkMath::Dot(d, axis)), 1.0, tolerance);
  }
}

std::string ErrorOf(vtkSurfaceDirectionFieldFilter* filter)
{
  Messages messages(filter);
  filter->Update();
  EXPECT_EQ(messages.Errors.size(), 1u);
  EXPECT_EQ(Direction(filter), nullptr);
  return messages.Errors.empty() ? std::string() : messages.Errors.front();
}

std::string WarningOf(vtkSurfaceDirectionFieldFilter* filter)
{
  const Messages messages(filter);
  filter->Update();
  EXPECT_TRUE(messages.Errors.empty());
  return messages.Warnings.empty() ? std::string() : messages.Warnings.front();
}

const double X[3] = { 1.0, 0.0, 0.0 };
const double Z[3] = { 0.0, 0.0, 1.0 };

} // namespace

TEST(DirectionFieldFilter, EveryMethodFindsTheAxisOfACylinder)
{
  auto cylinder = Cylinder();
  AddPointArray(cylinder, "hint", 3, [](vtkIdType i, int k) { return i == 40 && k == 2; });
  for (int method = 0; method < 4; ++method)
  {
    vtkNew<vtkSurfaceDirectionFieldFilter> filter;
    filter->SetInputData(cylinder);
    filter->SetMethod(method);
    SetInputArray(filter, 2, "hint");
    filter->Update();
    SCOPED_TRACE(filter->GetMethodAsString());
    ExpectAlong(Direction(filter), Z, 1e-3);
    EXPECT_EQ(filter->GetOutput()->GetCellData()->GetVectors(), Direction(filter));
    EXPECT_EQ(filter->GetOutput()->GetNumberOfCells(), cylinder->GetNumberOfCells());
    EXPECT_TRUE(filter->GetOutput()->GetPointData()->HasArray("hint"));
  }
}

TEST(DirectionFieldFilter, MaximumIsPerpendicularAndAngleTurns)
{
  auto cylinder = Cylinder();
  vtkNew<vtkSurfaceDirectionFieldFilter> filter;
  filter->SetInputData(cylinder);
  filter->SetPrincipalDirectionToMaximum();
  filter->Update();
  for (vtkIdType c = 0; c < cylinder->GetNumberOfCells(); ++c)
  {
    EXPECT_NEAR(Direction(filter)->GetComponent(c, 2), 0.0, 1e-2);
  }
  filter->SetAngle(90.0);
  filter->Update();
  ExpectAlong(Direction(filter), Z, 1e-3);
  filter->SetAngle(60.0); // from the circle: a right-handed screw at 60 degrees
  filter->Update();
  for (vtkIdType c = 0; c < cylinder->GetNumberOfCells(); ++c)
  {
    double d[3];
    Direction(filter)->GetTuple(c, d);
    EXPECT_NEAR(std::abs(d[2]), std::sqrt(0.75), 1e-2);
    double p[3];
    cylinder->GetPoint(cylinder->GetCell(c)->GetPointId(0), p);
    const double around = (p[0] * d[1] - p[1] * d[0]) / 0.5;
    EXPECT_GT(around * d[2], 0.3);
  }
}

TEST(DirectionFieldFilter, HintsOnCellsSpreadOverTheSurface)
{
  auto grid = Grid(12, 9);
  const auto hints = MakeArray(VTK_FLOAT, "hints", grid->GetNumberOfCells(), 3,
    [](vtkIdType c, int k) { return c == 3 ? (k == 0 ? -5.0 : 0.0) : std::nan(""); });
  grid->GetCellData()->AddArray(hints);
  vtkNew<vtkSurfaceDirectionFieldFilter> filter;
  filter->SetInputData(grid);
  filter->SetMethodToHints();
  EXPECT_NE(ErrorOf(filter).find("DirectionArray is not set"), std::string::npos);
  filter->SetResultArrayName("");
  EXPECT_NE(ErrorOf(filter).find("ResultArrayName is empty"), std::string::npos);
  filter->SetResultArrayName("Direction");
  SetInputArray(filter, 2, "hints", true);
  EXPECT_EQ(WarningOf(filter), "");
  ExpectAlong(Direction(filter), X, 1e-9);
}

TEST(DirectionFieldFilter, SaysWhereNoHintReaches)
{
  const auto other = Grid(5, 4);
  for (vtkIdType i = 0; i < other->GetNumberOfPoints(); ++i)
  {
    const double* const x = other->GetPoint(i);
    other->GetPoints()->SetPoint(i, 100.0 + x[0], x[1], x[2]);
  }
  other->GetCellData()->AddArray(MakeArray(VTK_DOUBLE, "hints", other->GetNumberOfCells(), 3,
    [](vtkIdType, int) { return std::nan(""); }));
  vtkNew<vtkSurfaceDirectionFieldFilter> filter;
  filter->SetInputData(other);
  filter->SetMethodToHints();
  SetInputArray(filter, 2, "hints", true);
  EXPECT_NE(WarningOf(filter).find(
              "no direction of DirectionArray reaches 24 triangles, where the field is 0"),
    std::string::npos);

  const auto grid = Grid(12, 9);
  grid->GetCellData()->AddArray(MakeArray(VTK_DOUBLE, "hints", grid->GetNumberOfCells(), 3,
    [](vtkIdType c, int k) { return c == 3 && k == 0 ? 1.0 : 0.0; }));
  vtkNew<vtkAppendPolyData> both;
  both->AddInputData(grid);
  both->AddInputData(other);
  filter->SetInputConnection(both->GetOutputPort());
  EXPECT_NE(WarningOf(filter).find("reaches 24 triangles, where"), std::string::npos);
  for (vtkIdType c = 0; c < Direction(filter)->GetNumberOfTuples(); ++c)
  {
    EXPECT_NEAR(std::abs(Direction(filter)->GetComponent(c, 0)),
      c < grid->GetNumberOfCells() ? 1.0 : 0.0, 1e-9);
  }
}

TEST(DirectionFieldFilter, HintsDoNotPassThroughAPoint)
{
  const auto bowTie = vtkSmartPointer<vtkPolyData>::New();
  vtkNew<vtkPoints> points;
  for (const double x : { -1.0, 1.0 })
  {
    points->InsertNextPoint(x, -1.0, 0.0);
    points->InsertNextPoint(x, 1.0, 0.0);
  }
  points->InsertNextPoint(0.0, 0.0, 0.0);
  vtkNew<vtkCellArray> triangles;
  triangles->InsertNextCell({ 0, 4, 1 });
  triangles->InsertNextCell({ 2, 3, 4 });
  bowTie->SetPoints(points);
  bowTie->SetPolys(triangles);
  bowTie->GetCellData()->AddArray(MakeArray(
    VTK_DOUBLE, "hints", 2, 3, [](vtkIdType c, int k) { return c == 0 && k == 0 ? 1.0 : 0.0; }));
  vtkNew<vtkSurfaceDirectionFieldFilter> filter;
  filter->SetInputData(bowTie);
  filter->SetMethodToHints();
  SetInputArray(filter, 2, "hints", true);
  EXPECT_NE(WarningOf(filter).find("reaches 1 triangle, where the field is 0"), std::string::npos);
}

TEST(DirectionFieldFilter, PolygonsAndStripsGetOneDirectionEach)
{
  vtkNew<vtkCylinderSource> source; // quads, about the y axis, with caps of one polygon each
  source->SetResolution(40);
  vtkNew<vtkSurfaceDirectionFieldFilter> filter;
  filter->SetInputConnection(source->GetOutputPort());
  filter->SetSmoothingLength(0.0);
  filter->MergeCoincidentPointsOff();
  filter->Update();
  const vtkIdType sides = 40;
  ASSERT_EQ(Direction(filter)->GetNumberOfTuples(), sides + 2);
  for (vtkIdType c = 0; c < sides; ++c)
  {
    EXPECT_NEAR(std::abs(Direction(filter)->GetComponent(c, 1)), 1.0, 1e-3);
  }
  for (vtkIdType c = sides; c < sides + 2; ++c) // flat caps have no direction
  {
    for (int k = 0; k < 3; ++k)
    {
      EXPECT_EQ(Direction(filter)->GetComponent(c, k), 0.0);
    }
  }
  vtkNew<vtkStripper> stripper;
  stripper->SetInputData(Cylinder());
  vtkNew<vtkSurfaceDirectionFieldFilter> ofStrips;
  ofStrips->SetInputConnection(stripper->GetOutputPort());
  ofStrips->Update();
  ASSERT_LT(Direction(ofStrips)->GetNumberOfTuples(), 200);
  EXPECT_TRUE(AllFinite(Direction(ofStrips)));
}
