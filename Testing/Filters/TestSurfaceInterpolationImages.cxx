// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "BandedImage.h"
#include "FilterTest.h"

#include "vtkSurfaceInterpolationFilter.h"

#include <gtest/gtest.h>

#include <cmath>

using namespace FilterTest;

TEST(InterpolationImages, ValuesAtFewPointsAreContinuedSmoothly)
{
  auto sphere = Sphere(5);
  AddPointArray(sphere, "f", 1,
    [&](vtkIdType i, int)
    { return i % 64 == 0 ? BandedImage::Signal(sphere->GetPoint(i)) : std::nan(""); });
  vtkNew<vtkSurfaceInterpolationFilter> filter;
  filter->SetInputData(sphere);
  SetInputArray(filter, 0, "f");
  filter->ExactOn();
  EXPECT_LE(BandedImage::Error(filter, -3.0, 3.0, "Interpolated"), ImageTest::Tolerance);
  filter->SetCorrelationLength(0.2); // returns to the mean between the values
  EXPECT_GT(BandedImage::Error(filter, -3.0, 3.0, "Interpolated", "InterpolatedTwin"),
    ImageTest::Tolerance);
}
