// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "BandedImage.h"
#include "FilterTest.h"

#include "vtkCellData.h"
#include "vtkSurfaceDistanceFilter.h"

#include <gtest/gtest.h>

#include <cmath>

using namespace FilterTest;

namespace
{

/// A sphere with hills, and points and a line beside it.
struct Scene
{
  vtkSmartPointer<vtkPolyData> Surface = Sphere(6);
  vtkNew<vtkPolyData> Sources;

  Scene()
  {
    vtkPoints* const points = this->Surface->GetPoints();
    for (vtkIdType i = 0; i < points->GetNumberOfPoints(); ++i)
    {
      double x[3];
      points->GetPoint(i, x);
      const double height = 1.0 + 0.12 * std::sin(7.0 * x[0]) * std::sin(6.0 * x[1]);
      vtkMath::MultiplyScalar(x, height);
      points->SetPoint(i, x);
    }
    vtkNew<vtkPoints> places;
    places->InsertNextPoint(0.4, 0.5, 0.9);
    places->InsertNextPoint(-0.8, -0.2, 0.6);
    places->InsertNextPoint(-0.2, -0.7, 0.7);
    places->InsertNextPoint(0.4, -0.8, 0.5);
    vtkNew<vtkCellArray> line;
    line->InsertNextCell({ 1, 2, 3 });
    this->Sources->SetPoints(places);
    this->Sources->SetLines(line);
  }
};

} // namespace

TEST(DistanceImages, FromAPointAndALineAreEven)
{
  const Scene scene;
  vtkNew<vtkSurfaceDistanceFilter> filter;
  filter->SetInputData(scene.Surface);
  filter->SetInputData(1, scene.Sources);
  filter->SetMethodToEikonal();
  EXPECT_LE(BandedImage::Error(filter, 0.0, 1.2, "DistanceFronts"), ImageTest::Tolerance);
  // Both methods have the same bands up to their width, but not the pixels.
  scene.Sources->GetPoints()->SetPoint(0, 0.42, 0.5, 0.9);
  scene.Sources->Modified();
  EXPECT_GT(BandedImage::Error(filter, 0.0, 1.2, "DistanceFronts", "DistanceFrontsTwin"),
    ImageTest::Tolerance);
}

TEST(DistanceImages, ByHeatAreSmoothWhereFrontsMeet)
{
  const Scene scene;
  vtkNew<vtkSurfaceDistanceFilter> filter;
  filter->SetInputData(scene.Surface);
  filter->SetInputData(1, scene.Sources);
  filter->SetMethodToHeat();
  EXPECT_LE(BandedImage::Error(filter, 0.0, 1.2, "DistanceHeat"), ImageTest::Tolerance);
  filter->SetMethodToEikonal(); // whose fronts have kinks
  EXPECT_GT(
    BandedImage::Error(filter, 0.0, 1.2, "DistanceHeat", "DistanceHeatTwin"), ImageTest::Tolerance);
}

TEST(DistanceImages, ArrivalTimesAreDenserWhereTheSpeedIsLower)
{
  const Scene scene;
  scene.Surface->GetCellData()->AddArray(
    MakeArray(VTK_DOUBLE, "v", scene.Surface->GetNumberOfCells(), 1,
      [&](vtkIdType c, int)
      {
        double bounds[6];
        scene.Surface->GetCellBounds(c, bounds);
        return bounds[0] < 0.1 ? 1.0 : 0.4;
      }));
  vtkNew<vtkSurfaceDistanceFilter> filter;
  filter->SetInputData(scene.Surface);
  filter->SetInputData(1, scene.Sources);
  filter->SetMethodToEikonal();
  SetInputArray(filter, 8, "v", true);
  EXPECT_LE(BandedImage::Error(filter, 0.0, 1.8, "ArrivalTimes"), ImageTest::Tolerance);
  SetInputArray(filter, 8, "");
  EXPECT_GT(
    BandedImage::Error(filter, 0.0, 1.8, "ArrivalTimes", "ArrivalTimesTwin"), ImageTest::Tolerance);
}
