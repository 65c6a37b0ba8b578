// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "BandedImage.h"
#include "FilterTest.h"

#include "vtkIntrinsicTVFilter.h"

#include <gtest/gtest.h>

using namespace BandedImage;
using namespace FilterTest;

namespace
{

/// Steps of height 1 where the waves cross their means: edges of all directions.
double Patches(const double* p)
{
  return std::floor(Signal(p));
}

vtkSmartPointer<vtkIntrinsicTVFilter> MakeFilter(vtkPolyData* surface)
{
  auto filter = vtkSmartPointer<vtkIntrinsicTVFilter>::New();
  filter->SetInputData(surface);
  SetInputArray(filter, 0, "f");
  return filter;
}

} // namespace

TEST(IntrinsicTVImages, NoiseIsRemovedFromPatches)
{
  auto sphere = Sphere(5);
  Noise noise;
  AddPointArray(
    sphere, "f", 1, [&](vtkIdType i, int k) { return Patches(sphere->GetPoint(i)) + noise(i, k); });
  auto filter = MakeFilter(sphere);
  filter->SetModeToSteadyState();
  filter->SetStopTolerance(1e-6); // the picture does not depend on how the minimum is found
  filter->SetFidelityWeight(8.0);
  EXPECT_LE(Error(filter, -3.0, 2.5, "TVDenoised"), ImageTest::Tolerance);
  filter->SetFidelityWeight(1.2 * 8.0);
  EXPECT_GT(Error(filter, -3.0, 2.5, "TVDenoised", "TVDenoisedTwin"), ImageTest::Tolerance);
}

TEST(IntrinsicTVImages, EdgesAreContinuedThroughAHole)
{
  auto sphere = Sphere(5);
  AddPointArray(sphere, "f", 1, [&](vtkIdType i, int) { return Patches(sphere->GetPoint(i)); });
  AddPointArray(sphere, "mask", 1,
    [&](vtkIdType i, int)
    {
      const double* p = sphere->GetPoint(i); // a cross towards the camera
      return p[2] > 0.0 && std::abs(p[0] * p[1]) < 0.06;
    });
  auto filter = MakeFilter(sphere);
  SetInputArray(filter, 1, "mask");
  filter->SetFidelityWeight(20.0);
  EXPECT_LE(Error(filter, -3.0, 2.5, "TVInpainted"), ImageTest::Tolerance);
  filter->SetNumberOfTimeSteps(9);
  EXPECT_GT(Error(filter, -3.0, 2.5, "TVInpainted", "TVInpaintedTwin"), ImageTest::Tolerance);
}

TEST(IntrinsicTVImages, ImpulsesAreReplaced)
{
  auto sphere = Sphere(5);
  Noise noise;
  AddPointArray(sphere, "f", 1,
    [&](vtkIdType i, int k)
    {
      const double random = noise(i, k);
      return random > 0.9 ? 2.0 : random < -0.9 ? -3.0 : Patches(sphere->GetPoint(i));
    });
  auto filter = MakeFilter(sphere);
  filter->SetModeToSteadyState();
  filter->SetStopTolerance(1e-6); // the picture does not depend on how the minimum is found
  filter->SetFidelityNormToL1();
  filter->SetFidelityWeight(1.5);
  EXPECT_LE(Error(filter, -3.0, 2.5, "TVImpulses"), ImageTest::Tolerance);
  filter->SetFidelityWeight(1.2 * 1.5);
  EXPECT_GT(Error(filter, -3.0, 2.5, "TVImpulses", "TVImpulsesTwin"), ImageTest::Tolerance);
}

TEST(IntrinsicTVImages, BlurredPatchesGetTheirEdgesBack)
{
  auto sphere = Sphere(5);
  AddPointArray(sphere, "clean", 1, [&](vtkIdType i, int) { return Patches(sphere->GetPoint(i)); });
  const auto blurred = Blurred(sphere, "clean", 0.15);
  const auto filter = MakeFilter(blurred);
  filter->SetModeToSteadyState();
  filter->SetFidelityWeight(100.0);
  filter->SetBlurFWHM(0.15);
  EXPECT_LE(Error(filter, -3.0, 2.5, "TVDeblurred"), ImageTest::Tolerance);
  filter->SetBlurFWHM(0.15 / 1.2);
  EXPECT_GT(Error(filter, -3.0, 2.5, "TVDeblurred", "TVDeblurredTwin"), ImageTest::Tolerance);
}

TEST(IntrinsicTVImages, ChannelsAreDenoisedTogether)
{
  auto sphere = Sphere(5);
  Noise noise;
  AddPointArray(sphere, "f", 3,
    [&](vtkIdType i, int k)
    { return std::sin(1.3 * Patches(sphere->GetPoint(i)) + 2.0 * k) + noise(i, k); });
  auto filter = MakeFilter(sphere);
  filter->AutomaticFidelityOff(); // 3, which leaves clear bands
  EXPECT_LE(Error(filter, -1.0, 1.0, "TVColors"), ImageTest::Tolerance);
  filter->SetChannelCouplingToPerChannel();
  EXPECT_GT(Error(filter, -1.0, 1.0, "TVColors", "TVColorsTwin"), ImageTest::Tolerance);
}

namespace
{

/// Positive colours in patches, with noise.
vtkSmartPointer<vtkPolyData> NoisyColors()
{
  auto sphere = Sphere(5);
  Noise noise;
  AddPointArray(sphere, "f", 3,
    [&](vtkIdType i, int k)
    { return 1.5 + std::sin(1.3 * Patches(sphere->GetPoint(i)) + 2.0 * k) + noise(i, k); });
  return sphere;
}

} // namespace

TEST(IntrinsicTVImages, BrightnessAndChromaticityAreDenoised)
{
  const auto sphere = NoisyColors();
  auto filter = MakeFilter(sphere);
  filter->SetColorModelToChromaticityBrightness();
  filter->AutomaticFidelityOff();
  EXPECT_LE(Error(filter, 0.5, 2.5, "TVChromaticity"), ImageTest::Tolerance);
  filter->SetChromaticityWeight(1.5);
  EXPECT_GT(Error(filter, 0.5, 2.5, "TVChromaticity", "TVChromaticityTwin"), ImageTest::Tolerance);
}

TEST(IntrinsicTVImages, OpponentAxesHaveTheirOwnWeight)
{
  const auto sphere = NoisyColors();
  auto filter = MakeFilter(sphere);
  filter->SetColorModelToOpponent();
  filter->SetFidelityWeight(15.0);
  EXPECT_LE(Error(filter, 0.5, 2.5, "TVOpponent"), ImageTest::Tolerance);
  filter->SetChromaWeight(0.4);
  EXPECT_GT(Error(filter, 0.5, 2.5, "TVOpponent", "TVOpponentTwin"), ImageTest::Tolerance);
}
