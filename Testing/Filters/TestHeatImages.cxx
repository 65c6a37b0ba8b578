// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "BandedImage.h"
#include "FilterTest.h"

#include "vtkFVMHeatFilter.h"

#include <gtest/gtest.h>

using namespace BandedImage;
using namespace FilterTest;

TEST(HeatImages, NoiseIsSmoothed)
{
  auto sphere = Sphere(5);
  AddPointArray(sphere, "f", 1, Noise());
  vtkNew<vtkFVMHeatFilter> filter;
  filter->SetInputData(sphere);
  SetInputArray(filter, 0, "f");
  filter->SetTimeStep(2.0);
  filter->SetNumberOfTimeSteps(10);
  EXPECT_LE(Error(filter, -0.1, 0.1, "HeatSmoothed"), ImageTest::Tolerance);
  filter->SetNumberOfTimeSteps(9);
  EXPECT_GT(Error(filter, -0.1, 0.1, "HeatSmoothed", "HeatSmoothedTwin"), ImageTest::Tolerance);
}

TEST(HeatImages, NoiseIsRemovedFromASignal)
{
  auto sphere = Sphere(5);
  Noise noise;
  AddPointArray(
    sphere, "f", 1, [&](vtkIdType i, int k) { return Signal(sphere->GetPoint(i)) + noise(i, k); });
  vtkNew<vtkFVMHeatFilter> filter;
  filter->SetInputData(sphere);
  SetInputArray(filter, 0, "f");
  filter->SetModeToSteadyState();
  filter->SetFidelityWeight(0.1);
  EXPECT_LE(Error(filter, -2.5, 2.5, "HeatDenoised"), ImageTest::Tolerance);
  filter->SetFidelityWeight(0.12);
  EXPECT_GT(Error(filter, -2.5, 2.5, "HeatDenoised", "HeatDenoisedTwin"), ImageTest::Tolerance);
}

TEST(HeatImages, ABlurredSignalGetsItsHeightBack)
{
  auto sphere = Sphere(5);
  AddPointArray(sphere, "clean", 1, [&](vtkIdType i, int) { return Signal(sphere->GetPoint(i)); });
  const auto blurred = Blurred(sphere, "clean", 0.25);
  vtkNew<vtkFVMHeatFilter> filter;
  filter->SetInputData(blurred);
  SetInputArray(filter, 0, "f");
  filter->SetModeToSteadyState();
  filter->SetFidelityWeight(100.0);
  filter->SetBlurFWHM(0.25);
  EXPECT_LE(Error(filter, -2.5, 2.5, "HeatDeblurred"), ImageTest::Tolerance);
  filter->SetBlurFWHM(0.25 / 1.2);
  EXPECT_GT(Error(filter, -2.5, 2.5, "HeatDeblurred", "HeatDeblurredTwin"), ImageTest::Tolerance);
}

TEST(HeatImages, AHoleIsFilled)
{
  auto sphere = Sphere(5);
  AddPointArray(sphere, "f", 1, [&](vtkIdType i, int) { return Signal(sphere->GetPoint(i)); });
  AddPointArray(sphere, "mask", 1,
    [&](vtkIdType i, int)
    {
      const double* p = sphere->GetPoint(i); // a round hole towards the camera
      return p[2] > 0.0 && std::hypot(p[0], p[1]) < 0.6;
    });
  vtkNew<vtkFVMHeatFilter> filter;
  filter->SetInputData(sphere);
  SetInputArray(filter, 0, "f");
  SetInputArray(filter, 1, "mask");
  filter->SetFidelityWeight(5.0);
  filter->SetTimeStep(4.0);
  filter->SetInitialFillToMean(); // the harmonic start is nearly the result
  EXPECT_LE(Error(filter, -2.5, 2.5, "HeatInpainted"), ImageTest::Tolerance);
  filter->SetNumberOfTimeSteps(9);
  EXPECT_GT(Error(filter, -2.5, 2.5, "HeatInpainted", "HeatInpaintedTwin"), ImageTest::Tolerance);
}

TEST(HeatImages, NoiseIsSmoothedAlongADirection)
{
  auto sphere = Sphere(5);
  AddPointArray(sphere, "f", 1, Noise());
  AddPointArray(sphere, "e1", 3,
    [&](vtkIdType i, int k)
    {
      const double* p = sphere->GetPoint(i); // spirals around the axis of view
      return k == 0 ? -p[1] + 0.5 * p[0] : k == 1 ? p[0] + 0.5 * p[1] : 0.0;
    });
  vtkNew<vtkFVMHeatFilter> filter;
  filter->SetInputData(sphere);
  SetInputArray(filter, 0, "f");
  SetInputArray(filter, 2, "e1");
  filter->SetTimeStep(4.0);
  filter->SetAcrossDiffusivity(0.02);
  EXPECT_LE(Error(filter, -0.1, 0.1, "HeatAnisotropic"), ImageTest::Tolerance);
  filter->SetNumberOfTimeSteps(9);
  EXPECT_GT(
    Error(filter, -0.1, 0.1, "HeatAnisotropic", "HeatAnisotropicTwin"), ImageTest::Tolerance);
}
