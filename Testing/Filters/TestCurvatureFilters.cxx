// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "FilterTest.h"

#include "vtkCellData.h"
#include "vtkSurfaceCurvatureFilter.h"
#include "vtkSurfaceDerivativesFilter.h"
#include "vtkTriangle.h"

#include <gtest/gtest.h>

#include <cmath>

using namespace FilterTest;

namespace
{

/// A square of quadrilaterals with the side 10 in the plane z = 0, and the point array t = 2 x - y.
vtkSmartPointer<vtkPolyData> Plane()
{
  vtkNew<vtkPoints> points;
  points->SetDataTypeToDouble();
  vtkNew<vtkCellArray> cells;
  for (int j = 0; j <= 10; ++j)
  {
    for (int i = 0; i <= 10; ++i)
    {
      points->InsertNextPoint(i, j, 0.0);
      if (i < 10 && j < 10)
      {
        const vtkIdType a = 11 * j + i;
        cells->InsertNextCell({ a, a + 1, a + 12, a + 11 });
      }
    }
  }
  auto plane = vtkSmartPointer<vtkPolyData>::New();
  plane->SetPoints(points);
  plane->SetPolys(cells);
  AddPointArray(plane, "t", 1, [](vtkIdType i, int) { return 2.0 * (i % 11) - (i / 11); });
  return plane;
}

} // namespace

TEST(CurvatureFilter, OfASphereIsThatOfItsRadius)
{
  const auto sphere = Sphere(5);
  vtkNew<vtkSurfaceCurvatureFilter> filter;
  filter->SetInputData(sphere);
  for (const double fwhm : { 0.0, 0.2 })
  {
    filter->SetFWHM(fwhm);
    filter->Update();
    vtkPointData* const arrays = filter->GetOutput()->GetPointData();
    ASSERT_NE(arrays->GetArray("MeanCurvature"), nullptr);
    EXPECT_EQ(arrays->GetScalars(), arrays->GetArray("MeanCurvature"));
    double point[3];
    sphere->GetPoint(0, point);
    const double radius = vtkMath::Norm(point);
    // Positive with the normals outward, negative with the normals inward.
    double corners[3][3];
    vtkNew<vtkIdList> ids;
    sphere->GetCellPoints(0, ids);
    for (int a = 0; a < 3; ++a)
    {
      sphere->GetPoint(ids->GetId(a), corners[a]);
    }
    double normal[3];
    vtkTriangle::ComputeNormal(corners[0], corners[1], corners[2], normal);
    const double sign = vtkMath::Dot(normal, corners[0]) > 0.0 ? 1.0 : -1.0;
    for (vtkIdType i = 0; i < sphere->GetNumberOfPoints(); ++i)
    {
      EXPECT_NEAR(sign * radius * arrays->GetArray("MeanCurvature")->GetComponent(i, 0), 1.0, 0.03);
      EXPECT_NEAR(
        radius * radius * arrays->GetArray("GaussianCurvature")->GetComponent(i, 0), 1.0, 0.06);
      EXPECT_NEAR(
        sign * radius * arrays->GetArray("PrincipalCurvatures")->GetComponent(i, 1), 1.0, 0.06);
      EXPECT_GT(sign * arrays->GetArray("ShapeIndex")->GetComponent(i, 0), 0.95);
      EXPECT_NEAR(radius * arrays->GetArray("Curvedness")->GetComponent(i, 0), 1.0, 0.03);
    }
  }
  filter->SetResultArrayName("My");
  filter->Update();
  EXPECT_TRUE(filter->GetOutput()->GetPointData()->HasArray("MyShapeIndex"));
}

TEST(DerivativesFilter, AreExactOnAPlaneOfQuadrilaterals)
{
  vtkNew<vtkSurfaceDerivativesFilter> filter;
  filter->SetInputData(Plane());
  SetInputArray(filter, 0, "t");
  for (const bool onCells : { false, true })
  {
    filter->SetResultOnCells(onCells);
    filter->Update();
    vtkDataSetAttributes* const attributes = onCells
      ? static_cast<vtkDataSetAttributes*>(filter->GetOutput()->GetCellData())
      : filter->GetOutput()->GetPointData();
    vtkDataArray* const gradient = attributes->GetArray("tGradient");
    ASSERT_NE(gradient, nullptr);
    EXPECT_EQ(attributes->GetVectors(), gradient);
    ASSERT_EQ(gradient->GetNumberOfTuples(), onCells ? 100 : 121);
    for (vtkIdType i = 0; i < gradient->GetNumberOfTuples(); ++i)
    {
      EXPECT_NEAR(gradient->GetComponent(i, 0), 2.0, 1e-12);
      EXPECT_NEAR(gradient->GetComponent(i, 1), -1.0, 1e-12);
      EXPECT_EQ(gradient->GetComponent(i, 2), 0.0);
    }
  }
  filter->ResultOnCellsOff();
  filter->SetQuantityToConductionVelocity();
  filter->SetSmoothingFWHM(3.0);
  filter->Update();
  vtkPointData* const arrays = filter->GetOutput()->GetPointData();
  ASSERT_TRUE(arrays->HasArray("tConductionVelocity") && arrays->HasArray("tSpeed"));
  for (vtkIdType i = 0; i < 121; ++i)
  {
    EXPECT_NEAR(arrays->GetArray("tSpeed")->GetComponent(i, 0), 1.0 / std::sqrt(5.0), 1e-9);
    EXPECT_NEAR(arrays->GetArray("tConductionVelocity")->GetComponent(i, 0), 0.4, 1e-9);
  }
}

TEST(DerivativesFilter, HasTheBandOfTheSpeedWithErrorsOfSlopes)
{
  const auto plane = Plane();
  AddPointArray(plane, "e", 1, [](vtkIdType i, int) { return 0.01 * static_cast<double>(i); });
  plane->GetCellData()->AddArray(
    MakeArray(VTK_DOUBLE, "ofCells", 100, 1, [](vtkIdType, int) { return 0.1; }));
  vtkNew<vtkSurfaceDerivativesFilter> filter;
  filter->SetInputData(plane);
  filter->SetQuantityToConductionVelocity();
  SetInputArray(filter, 0, "t");
  filter->Update();
  EXPECT_EQ(Result(filter, "tSpeedLower"), nullptr);
  SetInputArray(filter, 10, "e");
  filter->Update();
  vtkDataArray* const lower = Result(filter, "tSpeedLower");
  vtkDataArray* const upper = Result(filter, "tSpeedUpper");
  ASSERT_TRUE(lower && upper);
  for (vtkIdType i = 0; i < 121; ++i)
  {
    const double half = 1.645 * 0.01 * static_cast<double>(i); // less than the slope, root 5
    EXPECT_NEAR(1.0 / lower->GetComponent(i, 0), std::sqrt(5.0) + half, 1e-3);
    EXPECT_NEAR(1.0 / upper->GetComponent(i, 0), std::sqrt(5.0) - half, 1e-3);
  }
  plane->GetPointData()->GetArray("e")->SetComponent(3, 0, 9.0); // as numpy does: not marked
  filter->Modified();
  filter->Update();
  EXPECT_EQ(Result(filter, "tSpeedUpper")->GetComponent(3, 0), vtkMath::Inf());
  SetInputArray(filter, 10, "ofCells", true);
  Messages messages(filter);
  filter->Update();
  ASSERT_EQ(messages.Errors.size(), 1u);
  EXPECT_NE(messages.Errors[0].find("SlopeErrorArray"), std::string::npos) << messages.Errors[0];
  SetInputArray(filter, 10, "absent");
  filter->Update();
  ASSERT_EQ(messages.Errors.size(), 2u);
  EXPECT_NE(messages.Errors[1].find("SlopeErrorArray \"absent\""), std::string::npos)
    << messages.Errors[1];
}

TEST(DerivativesFilter, NamesWhatIsNotAllowed)
{
  const auto plane = Plane();
  vtkNew<vtkSurfaceDerivativesFilter> filter;
  filter->SetInputData(plane);
  SetInputArray(filter, 0, "t");
  filter->SetQuantityToCurl();
  const auto errorOf = [&]
  {
    Messages messages(filter);
    filter->Update();
    EXPECT_EQ(messages.Errors.size(), 1u);
    return messages.Errors.empty() ? std::string() : messages.Errors.front();
  };
  EXPECT_NE(errorOf().find("has 1 components; allowed with Quantity Curl: 3"), std::string::npos)
    << errorOf();
  SetInputArray(filter, 0, "absent");
  EXPECT_NE(errorOf().find("absent"), std::string::npos);
  plane->GetPointData()->GetArray("t")->SetComponent(5, 0, vtkMath::Inf());
  SetInputArray(filter, 0, "t");
  filter->SetQuantityToGradient();
  EXPECT_NE(errorOf().find("is infinite at point 5"), std::string::npos) << errorOf();
}

TEST(DerivativesFilter, OfUnsignedCharsHaveAllComponents)
{
  const auto plane = Plane();
  for (const int components : { 1, 2, 3, 4 })
  {
    const auto value = [](vtkIdType i, int k) { return 100.0 + (k + 1.0) * (i % 11) - (i / 11); };
    plane->GetPointData()->AddArray(
      MakeArray(VTK_UNSIGNED_CHAR, "c", plane->GetNumberOfPoints(), components, value));
    plane->GetCellData()->AddArray(MakeArray(VTK_UNSIGNED_CHAR, "c", plane->GetNumberOfCells(),
      components, [](vtkIdType, int k) { return 10.0 * k; }));
    vtkNew<vtkSurfaceDerivativesFilter> filter;
    filter->SetInputData(plane);
    SetInputArray(filter, 0, "c");
    filter->Update();
    vtkDataArray* const gradient = Result(filter, "cGradient");
    ASSERT_NE(gradient, nullptr);
    ASSERT_EQ(gradient->GetNumberOfComponents(), 3 * components);
    for (int k = 0; k < components; ++k)
    {
      EXPECT_NEAR(gradient->GetComponent(60, 3 * k), k + 1.0, 1e-12);
      EXPECT_NEAR(gradient->GetComponent(60, 3 * k + 1), -1.0, 1e-12);
    }
    SetInputArray(filter, 0, "c", true);
    filter->SetQuantityToLaplacian();
    filter->Update();
    EXPECT_EQ(Result(filter, "cLaplacian")->GetNumberOfComponents(), components);
  }
}

TEST(DerivativesFilter, OfNoKnownValuesAreOneWarning)
{
  const auto plane = Plane();
  AddPointArray(plane, "t", 1, [](vtkIdType, int) { return vtkMath::Nan(); });
  plane->GetCellData()->AddArray(MakeArray(
    VTK_DOUBLE, "t", plane->GetNumberOfCells(), 1, [](vtkIdType, int) { return vtkMath::Nan(); }));
  for (const bool onCells : { false, true })
  {
    vtkNew<vtkSurfaceDerivativesFilter> filter;
    filter->SetInputData(plane);
    SetInputArray(filter, 0, "t", onCells);
    Messages messages(filter);
    filter->Update();
    EXPECT_TRUE(messages.Errors.empty());
    ASSERT_EQ(messages.Warnings.size(), 1u);
    EXPECT_NE(
      messages.Warnings[0].find("InputArray \"t\" is NaN in every triangle"), std::string::npos)
      << messages.Warnings[0];
    EXPECT_TRUE(std::isnan(Result(filter, "tGradient")->GetComponent(5, 0)));
  }
}
