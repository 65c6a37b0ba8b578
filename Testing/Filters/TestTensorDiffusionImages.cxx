// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "BandedImage.h"
#include "FilterTest.h"

#include "vtkTensorDiffusionFilter.h"

#include <gtest/gtest.h>

using namespace BandedImage;
using namespace FilterTest;

namespace
{

/// Stripes of 11 edges on the sphere, with gaps.
double Stripes(const double* p)
{
  const bool gap = std::hypot(p[0] - 0.5, p[2]) < 0.1 || std::hypot(p[0] + 0.1, p[2] - 0.5) < 0.1;
  return gap ? 0.0 : std::sin(20.0 * (0.8 * p[0] + 0.6 * p[2]));
}

vtkSmartPointer<vtkPolyData> MakeSurface(double (*signal)(const double*), double amount)
{
  auto sphere = Sphere(6);
  Noise noise;
  AddPointArray(sphere, "f", 1,
    [&](vtkIdType i, int k) { return signal(sphere->GetPoint(i)) + amount * noise(i, k); });
  return sphere;
}

double Patches(const double* p)
{
  return (p[0] + 0.4 * p[1] > -0.2 ? 1.0 : 0.0) +
    (std::hypot(p[0] - 0.4, p[1] - 0.3) < 0.35 ? 1.0 : 0.0);
}

} // namespace

TEST(TensorDiffusionImages, BeltramiRemovesNoiseAndKeepsEdges)
{
  vtkNew<vtkTensorDiffusionFilter> filter;
  filter->SetInputData(MakeSurface(Patches, 0.15));
  SetInputArray(filter, 0, "f");
  filter->SetNumberOfTimeSteps(10);
  EXPECT_LE(Error(filter, -0.2, 2.2, "Beltrami"), ImageTest::Tolerance);
  filter->SetNumberOfTimeSteps(5);
  EXPECT_GT(Error(filter, -0.2, 2.2, "Beltrami", "BeltramiTwin"), ImageTest::Tolerance);
}

TEST(TensorDiffusionImages, CoherenceClosesGapsOfStripes)
{
  vtkNew<vtkTensorDiffusionFilter> filter;
  filter->SetInputData(MakeSurface(Stripes, 0.4));
  SetInputArray(filter, 0, "f");
  filter->SetModelToCoherenceEnhancing();
  filter->SetNumberOfTimeSteps(15);
  filter->SetTimeStep(2.0);
  EXPECT_LE(Error(filter, -1.2, 1.2, "Coherent"), ImageTest::Tolerance);
  filter->SetIntegrationScale(2.0);
  EXPECT_GT(Error(filter, -1.2, 1.2, "Coherent", "CoherentTwin"), ImageTest::Tolerance);
}
