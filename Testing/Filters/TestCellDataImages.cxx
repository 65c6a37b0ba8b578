// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "BandedImage.h"
#include "FilterTest.h"

#include "vtkCellData.h"
#include "vtkFVMHeatFilter.h"

#include <gtest/gtest.h>

using namespace BandedImage;
using namespace FilterTest;

/// The triangles have one colour each.
TEST(CellDataImages, NoiseOfCellsIsSmoothed)
{
  auto sphere = Sphere(5);
  Noise noise;
  vtkNew<vtkIdList> corners;
  sphere->GetCellData()->AddArray(MakeArray(VTK_DOUBLE, "c", sphere->GetNumberOfCells(), 1,
    [&](vtkIdType c, int k)
    {
      double x[3];
      sphere->GetCellPoints(c, corners);
      sphere->GetPoint(corners->GetId(0), x);
      return Signal(x) + 1.5 * noise(c, k);
    }));
  vtkNew<vtkFVMHeatFilter> filter;
  filter->SetInputData(sphere);
  SetInputArray(filter, 0, "c", true);
  filter->SetFWHM(0.25);
  EXPECT_LE(Error(filter, -3.0, 3.0, "CellsSmoothed"), ImageTest::Tolerance);
  filter->SetFWHM(1.2 * 0.25);
  EXPECT_GT(Error(filter, -3.0, 3.0, "CellsSmoothed", "CellsSmoothedTwin"), ImageTest::Tolerance);
}
