// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "BandedImage.h"
#include "FilterTest.h"

#include "vtkMumfordShahFilter.h"

#include <gtest/gtest.h>

using namespace BandedImage;
using namespace FilterTest;

namespace
{

/// Three heights on the sphere, and a slope.
double Patches(const double* p)
{
  const bool disk = std::hypot(p[0] - 0.4, p[1] - 0.3) < 0.35;
  return (p[0] + 0.4 * p[1] > -0.2 ? 1.0 : 0.0) + (disk ? 1.0 : 0.0) + 0.5 * p[1];
}

} // namespace

TEST(MumfordShahImages, NoiseIsRemovedBetweenEdges)
{
  auto sphere = Sphere(6);
  Noise noise;
  AddPointArray(sphere, "f", 1,
    [&](vtkIdType i, int k) { return Patches(sphere->GetPoint(i)) + 0.15 * noise(i, k); });
  vtkNew<vtkMumfordShahFilter> filter;
  filter->SetInputData(sphere);
  SetInputArray(filter, 0, "f");
  filter->AutomaticThresholdOff();
  filter->SetEdgeThreshold(0.15);
  EXPECT_LE(Error(filter, -0.6, 2.4, "MumfordShah"), ImageTest::Tolerance);
  filter->SetSmoothingLength(7.0);
  EXPECT_GT(Error(filter, -0.6, 2.4, "MumfordShah", "MumfordShahTwin"), ImageTest::Tolerance);
}

TEST(MumfordShahImages, EdgesRunBetweenThePatches)
{
  auto sphere = Sphere(6);
  Noise noise;
  AddPointArray(sphere, "f", 1,
    [&](vtkIdType i, int k) { return Patches(sphere->GetPoint(i)) + 0.15 * noise(i, k); });
  vtkNew<vtkMumfordShahFilter> filter;
  filter->SetInputData(sphere);
  SetInputArray(filter, 0, "f");
  filter->AutomaticThresholdOff();
  filter->SetEdgeThreshold(0.15);
  const auto error = [&](const std::string& output)
  {
    filter->Update();
    filter->GetOutput()->GetPointData()->SetActiveScalars("Edges");
    return Error(filter, 0.0, 1.0, "MumfordShahEdges", output);
  };
  EXPECT_LE(error(""), ImageTest::Tolerance);
  filter->SetEdgeThreshold(0.2);
  EXPECT_GT(error("MumfordShahEdgesTwin"), ImageTest::Tolerance);
}
