// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "FilterTest.h"

#include "vtkCellData.h"
#include "vtkSurfaceReliefFilter.h"

#include <gtest/gtest.h>

#include <functional>

using namespace FilterTest;

namespace
{

/// A closed box of n^2 squares per side, from 0 to `size`. soup: each square has points of its own.
/// inwards: every second square faces inwards.
vtkSmartPointer<vtkPolyData> Box(double size, int n, bool soup = false, bool inwards = false)
{
  vtkNew<vtkPoints> points;
  points->SetDataTypeToDouble();
  vtkNew<vtkCellArray> squares;
  std::map<std::array<int, 3>, vtkIdType> found;
  int count = 0;
  const auto add = [&](const std::array<std::array<int, 3>, 4>& corners)
  {
    vtkNew<vtkIdList> ids;
    for (const std::array<int, 3>& c : corners)
    {
      if (soup || found.count(c) == 0)
      {
        found[c] = points->InsertNextPoint(size * c[0] / n, size * c[1] / n, size * c[2] / n);
      }
      ids->InsertNextId(found[c]);
    }
    if (inwards && ++count % 2 == 0)
    {
      const vtkIdType second = ids->GetId(1);
      ids->SetId(1, ids->GetId(3));
      ids->SetId(3, second);
    }
    squares->InsertNextCell(ids);
  };
  for (int i = 0; i < n; ++i)
  {
    for (int j = 0; j < n; ++j)
    {
      for (int axis = 0; axis < 3; ++axis)
      {
        for (const int side : { 0, n })
        {
          std::array<std::array<int, 3>, 4> corners{};
          const std::array<std::array<int, 2>, 4> square{ { { i, j }, { i + 1, j },
            { i + 1, j + 1 }, { i, j + 1 } } };
          for (std::size_t c = 0; c < 4; ++c)
          {
            const auto& [u, v] = square[side == 0 ? 3 - c : c];
            corners[c][axis] = side;
            corners[c][(axis + 1) % 3] = u;
            corners[c][(axis + 2) % 3] = v;
          }
          add(corners);
        }
      }
    }
  }
  auto box = vtkSmartPointer<vtkPolyData>::New();
  box->SetPoints(points);
  box->SetPolys(squares);
  AddPointArray(box, "Texture", 1, [](vtkIdType, int) { return 1.0; });
  return box;
}

void SetTexture(vtkPolyData* box, const std::function<double(const double*)>& value)
{
  for (vtkIdType i = 0; i < box->GetNumberOfPoints(); ++i)
  {
    double p[3];
    box->GetPoint(i, p);
    box->GetPointData()->GetArray("Texture")->SetComponent(i, 0, value(p));
  }
}

/// The volume that the polygons enclose, by fans.
double Volume(vtkPolyData* surface)
{
  double sum = 0.0;
  for (vtkIdType c = 0; c < surface->GetNumberOfCells(); ++c)
  {
    vtkNew<vtkIdList> ids;
    surface->GetCellPoints(c, ids);
    double a[3], b[3], d[3], normal[3];
    surface->GetPoint(ids->GetId(0), a);
    for (vtkIdType k = 1; k + 1 < ids->GetNumberOfIds(); ++k)
    {
      surface->GetPoint(ids->GetId(k), b);
      surface->GetPoint(ids->GetId(k + 1), d);
      vtkMath::Cross(b, d, normal);
      sum += vtkMath::Dot(a, normal) / 6.0;
    }
  }
  return sum;
}

double Height(vtkPolyDataAlgorithm* filter, vtkIdType point)
{
  return filter->GetOutput()->GetPointData()->GetArray("ReliefHeight")->GetComponent(point, 0);
}

} // namespace

TEST(SurfaceReliefFilter, OfConstantHeightMakesALargerBoxWhateverTheOrientation)
{
  for (const bool inwards : { false, true })
  {
    const auto box = Box(10.0, 8, false, inwards);
    vtkNew<vtkSurfaceReliefFilter> filter;
    filter->SetInputData(box);
    filter->SetHeight(0.5);
    Messages messages(filter);
    filter->Update();
    EXPECT_TRUE(messages.Warnings.empty() && messages.Errors.empty());
    EXPECT_NEAR(Volume(filter->GetOutput()), 1331.0, 1e-9);
    EXPECT_NEAR(filter->GetVolumeChange(), 331.0, 1e-9);
    EXPECT_NEAR(filter->GetSmallestWall(), 11.0, 1e-12);
    EXPECT_EQ(filter->GetOpenEdges(), 0);
    EXPECT_EQ(filter->GetNonManifoldEdges(), 0);
    EXPECT_EQ(filter->GetCrossingTriangles(), 0);
    EXPECT_EQ(filter->GetLoweredPoints(), 0);
    EXPECT_EQ(filter->GetOutput()->GetNumberOfCells(), box->GetNumberOfCells());
  }
}

TEST(SurfaceReliefFilter, MovesCopiesOfAPointAlikeSoThatSoupsStayClosed)
{
  const auto box = Box(10.0, 6, true);
  vtkNew<vtkSurfaceReliefFilter> filter;
  filter->SetInputData(box);
  filter->SetHeight(0.5);
  Messages messages(filter);
  filter->Update();
  ASSERT_EQ(messages.Warnings.size(), 1u); // every edge is open
  EXPECT_NE(messages.Warnings[0].find("open edges"), std::string::npos);
  filter->MergeCoincidentPointsOn();
  filter->Update();
  EXPECT_EQ(messages.Warnings.size(), 1u);
  EXPECT_EQ(filter->GetOpenEdges(), 0);
  EXPECT_NEAR(Volume(filter->GetOutput()), 1331.0, 1e-9);
  std::map<std::array<double, 3>, std::array<double, 3>> moved;
  for (vtkIdType i = 0; i < box->GetNumberOfPoints(); ++i)
  {
    std::array<double, 3> from{}, to{};
    box->GetPoint(i, from.data());
    filter->GetOutput()->GetPoint(i, to.data());
    EXPECT_EQ(moved.insert({ from, to }).first->second, to) << i;
  }
}

TEST(SurfaceReliefFilter, LeavesMaskedPointsFacesAndOverhangs)
{
  const auto box = Box(10.0, 10);
  AddPointArray(box, "half", 1, [&](vtkIdType i, int) { return box->GetPoint(i)[0] < 4.9; });
  box->GetCellData()->AddArray(MakeArray(VTK_INT, "top", box->GetNumberOfCells(), 1,
    [&](vtkIdType c, int)
    {
      double bounds[6];
      box->GetCellBounds(c, bounds);
      return bounds[4] == 10.0;
    }));
  const auto check = [&](vtkSurfaceReliefFilter* filter, const std::function<bool(double*)>& still)
  {
    filter->SetInputData(box);
    filter->SetHeight(0.5);
    filter->Update();
    for (vtkIdType i = 0; i < box->GetNumberOfPoints(); ++i)
    {
      double p[3];
      box->GetPoint(i, p);
      EXPECT_EQ(Height(filter, i), still(p) ? 0.0 : 0.5) << i;
    }
  };
  vtkNew<vtkSurfaceReliefFilter> ofPoints, ofCells, overhang, sideways;
  ofPoints->SetInputArrayToProcess(1, 0, 0, 0, "half");
  check(ofPoints, [](double* p) { return p[0] < 4.9; });
  ofCells->SetInputArrayToProcess(1, 0, 0, 1, "top");
  check(ofCells, [](double* p) { return p[2] == 10.0; });
  overhang->SetOverhang(45.0);
  check(overhang, [](double* p) { return p[2] == 0.0; });
  sideways->SetOverhang(45.0);
  sideways->SetUpDirection(-3.0, 0.0, 0.0);
  check(sideways, [](double* p) { return p[0] == 10.0; });
}

TEST(SurfaceReliefFilter, RefinesLargeFacesWithTheirData)
{
  const auto box = Box(10.0, 1);
  SetTexture(box, [](const double* p) { return 0.1 * p[2]; });
  box->GetCellData()->AddArray(MakeArray(VTK_DOUBLE, "area", box->GetNumberOfCells(), 1,
    [](vtkIdType c, int) { return 1.5 * static_cast<double>(c); }));
  AddPointArray(
    box, "label", 1, [](vtkIdType i, int) { return i; }, VTK_INT);
  vtkNew<vtkSurfaceReliefFilter> filter;
  filter->SetInputData(box);
  filter->SetHeight(0.0);
  filter->SetRefineTo(0.8);
  Messages messages(filter);
  filter->Update();
  EXPECT_TRUE(messages.Warnings.empty() && messages.Errors.empty());
  vtkPolyData* const output = filter->GetOutput();
  EXPECT_GT(output->GetNumberOfCells(), 6 * 2 * 12 * 12);
  EXPECT_EQ(filter->GetOpenEdges(), 0);
  EXPECT_NEAR(Volume(output), 1000.0, 1e-9);
  for (vtkIdType i = 0; i < output->GetNumberOfPoints(); ++i)
  {
    EXPECT_NEAR(output->GetPointData()->GetArray("Texture")->GetComponent(i, 0),
      0.1 * output->GetPoint(i)[2], 1e-14);
    const double label = output->GetPointData()->GetArray("label")->GetComponent(i, 0);
    EXPECT_EQ(label, std::floor(label));
    EXPECT_TRUE(i >= box->GetNumberOfPoints() || label == static_cast<double>(i));
  }
  vtkDataArray* const ids = output->GetCellData()->GetArray("vtkOriginalCellIds");
  ASSERT_NE(ids, nullptr);
  double areas[6] = {};
  for (vtkIdType c = 0; c < output->GetNumberOfCells(); ++c)
  {
    const auto cell = static_cast<vtkIdType>(ids->GetComponent(c, 0));
    EXPECT_EQ(output->GetCellData()->GetArray("area")->GetComponent(c, 0), 1.5 * cell);
    double p[3][3];
    vtkNew<vtkIdList> corners;
    output->GetCellPoints(c, corners);
    for (vtkIdType k = 0; k < 3; ++k)
    {
      output->GetPoint(corners->GetId(k), p[k]);
      EXPECT_LE(
        vtkMath::Distance2BetweenPoints(p[k], output->GetPoint(corners->GetId((k + 1) % 3))), 0.64);
    }
    areas[cell] += vtkTriangle::TriangleArea(p[0], p[1], p[2]);
  }
  for (const double area : areas)
  {
    EXPECT_NEAR(area, 100.0, 1e-9);
  }

  filter->SetRefineTo(20.0); // no edge is longer
  filter->Update();
  EXPECT_EQ(filter->GetOutput()->GetNumberOfCells(), 6);
  EXPECT_EQ(filter->GetOutput()->GetCellData()->GetArray("vtkOriginalCellIds"), nullptr);
  filter->SetRefineTo(0.8);
  filter->SetHeight(vtkMath::Nan());
  filter->Update();
  EXPECT_EQ(filter->GetOutput()->GetPoints(), box->GetPoints());
  filter->SetHeight(0.1);
  filter->SetRefineTo(0.8);
  filter->Update();
  filter->SetRefineTo(0.0);
  filter->SetHeight(vtkMath::Nan());
  const auto other = Box(5.0, 2);
  filter->SetInputData(other);
  filter->Update(); // nothing of the former update comes back
  EXPECT_EQ(filter->GetOutput()->GetPoints(), other->GetPoints());
  filter->SetInputData(box);
  filter->SetHeight(0.1);
  filter->SetRefineTo(-1.0);
  filter->Update();
  EXPECT_NE(messages.Errors.back().find("RefineTo is -1; allowed: finite numbers, 0 or more"),
    std::string::npos);
}

TEST(SurfaceReliefFilter, HasNoHeightAtPointsThatStay)
{
  for (const double unused : { 1.0, 1e9, vtkMath::Nan() })
  {
    const auto box = Box(10.0, 4);
    const vtkIdType last = box->GetPoints()->InsertNextPoint(5.0, 5.0, 20.0);
    AddPointArray(box, "Texture", 1, [&](vtkIdType i, int) { return i == last ? unused : 1.0; });
    vtkNew<vtkSurfaceReliefFilter> filter;
    filter->SetInputData(box);
    filter->SetHeight(0.25);
    filter->SetBase(0.125);
    Messages messages(filter);
    filter->Update();
    EXPECT_TRUE(messages.Errors.empty()) << messages.Errors[0];
    ASSERT_NE(Result(filter, "ReliefHeight"), nullptr);
    EXPECT_EQ(Result(filter, "ReliefHeight")->GetComponent(last, 0), 0.0);
    EXPECT_EQ(filter->GetOutput()->GetPoint(last)[2], 20.0);
    EXPECT_EQ(filter->GetLoweredPoints(), 0);
    EXPECT_NEAR(Result(filter, "ReliefHeight")->GetComponent(0, 0), 0.375, 1e-12);
  }
}
