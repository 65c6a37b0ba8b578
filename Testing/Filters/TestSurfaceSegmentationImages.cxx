// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "BandedImage.h"
#include "FilterTest.h"

#include "vtkSurfaceSegmentationFilter.h"

#include <gtest/gtest.h>

using namespace FilterTest;

TEST(SegmentationImages, RegionsAreFoundUnderNoise)
{
  auto sphere = Sphere(5);
  BandedImage::Noise noise;
  AddPointArray(sphere, "f", 1,
    [&](vtkIdType i, int k)
    { return std::round(BandedImage::Signal(sphere->GetPoint(i))) + noise(i, k); });
  vtkNew<vtkSurfaceSegmentationFilter> filter;
  filter->SetInputData(sphere);
  SetInputArray(filter, 0, "f");
  filter->SetNumberOfRegions(3);
  filter->AutomaticMeansOff();
  for (int k = 0; k < 3; ++k)
  {
    filter->SetMean(k + 1, 0, 1.5 * k - 1.5);
  }
  filter->AutomaticFidelityOff();
  filter->SetFidelityWeight(30.0);
  filter->SetStopTolerance(1e-6); // the picture does not depend on how the minimum is found
  EXPECT_LE(BandedImage::Error(filter, 1.0, 3.0, "Regions"), ImageTest::Tolerance);
  filter->SetFidelityWeight(20.0);
  EXPECT_GT(BandedImage::Error(filter, 1.0, 3.0, "Regions", "RegionsTwin"), ImageTest::Tolerance);
}
