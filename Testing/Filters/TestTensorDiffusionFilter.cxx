// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "FilterTest.h"

#include "vtkCellData.h"
#include "vtkMath.h"
#include "vtkTensorDiffusionFilter.h"

#include <gtest/gtest.h>

using namespace FilterTest;

namespace
{

using Tensor = vtkTensorDiffusionFilter;

constexpr const char* Results[] = { "fBeltrami", "fCoherent", "fEdgeEnhanced" };

/// The unit sphere with three stripes around z in "f", and rough noise.
vtkSmartPointer<vtkPolyData> StripedSphere(
  int levels, double noise, int components = 1, double scale = 1.0)
{
  auto sphere = Sphere(levels);
  AddPointArray(sphere, "f", components,
    [&](vtkIdType i, int k)
    {
      const double z = sphere->GetPoint(i)[2];
      return scale * (std::sin(9.0 * z + k) + noise * Rough(i, k));
    });
  sphere->GetPointData()->SetActiveScalars("f");
  return sphere;
}

vtkSmartPointer<Tensor> MakeFilter(vtkDataObject* data, int model = Tensor::MODEL_BELTRAMI)
{
  auto filter = vtkSmartPointer<Tensor>::New();
  filter->SetModel(model);
  filter->SetNumberOfTimeSteps(4);
  filter->SetInputDataObject(data);
  return filter;
}

} // namespace

TEST(TensorDiffusionFilter, ToleranceOfStepsDoesNotFillHoles)
{
  const auto sphere = StripedSphere(6, 0.3);
  vtkDataArray* const f = sphere->GetPointData()->GetScalars();
  for (vtkIdType i = 0; i < f->GetNumberOfTuples(); ++i)
  {
    if (sphere->GetPoint(i)[2] < 0.8)
    {
      f->SetComponent(i, 0, vtkMath::Nan());
    }
  }
  const auto exact = MakeFilter(sphere);
  exact->SetNumberOfTimeSteps(0);
  exact->SetSolverToDirect();
  exact->Update();
  const auto filter = MakeFilter(sphere);
  filter->SetNumberOfTimeSteps(0);
  filter->SetSolverToConjugateGradient();
  filter->SetTolerance(0.1);
  filter->Update();
  EXPECT_LT(LargestDifference(Result(filter, Results[0]), Result(exact, Results[0])), 1e-7);
}

TEST(TensorDiffusionFilter, AxesRunAlongTheStripesAndNeedNoNewSteps)
{
  const auto sphere = StripedSphere(5, 0.1);
  for (int model = 0; model < 3; ++model)
  {
    const auto filter = MakeFilter(sphere, model);
    filter->Update();
    EXPECT_FALSE(filter->GetOutput()->GetCellData()->GetArray("DiffusionAxes"));
    filter->SetContrast(0.01); // below it, edge-enhancing diffusion is isotropic
    filter->Update();
    const vtkIdType steps = filter->GetNumberOfStepsComputed();
    filter->DiffusionAxesOn();
    filter->Update();
    EXPECT_EQ(filter->GetNumberOfStepsComputed(), steps);
    vtkDataArray* const axes = filter->GetOutput()->GetCellData()->GetArray("DiffusionAxes");
    ASSERT_TRUE(axes);
    ASSERT_EQ(axes->GetNumberOfTuples(), sphere->GetNumberOfCells());
    double sum = 0.0;
    int found = 0;
    for (vtkIdType c = 0; c < axes->GetNumberOfTuples(); ++c)
    {
      double axis[3];
      axes->GetTuple(c, axis);
      const double length = vtkMath::Norm(axis);
      ASSERT_TRUE(length == 0.0 || std::abs(length - 1.0) < 1e-9) << length;
      found += length > 0.0;
      sum += std::abs(axis[2]); // stripes are circles of equal z
    }
    EXPECT_GT(found, 0.9 * axes->GetNumberOfTuples()); // flat parts have no axis
    EXPECT_LT(sum / found, 0.25) << model;
  }
}

TEST(TensorDiffusionFilter, DirectionsWeighTheTensor)
{
  auto sphere = StripedSphere(4, 0.3);
  AddPointArray(sphere, "e1", 3, [](vtkIdType, int k) { return k == 2 ? 1.0 : 0.0; });
  for (int model = 0; model < 3; ++model)
  {
    const auto plain = MakeFilter(sphere, model);
    plain->Update();
    const auto along = MakeFilter(sphere, model);
    SetInputArray(along, 2, "e1");
    along->SetAcrossDiffusivity(0.0);
    along->Update();
    EXPECT_GT(
      LargestDifference(Result(plain, Results[model]), Result(along, Results[model])), 0.01);
    const auto none = MakeFilter(sphere, model); // nothing flows: equal, and no direction
    none->SetAlongDiffusivity(0.0);
    none->SetAcrossDiffusivity(0.0);
    none->Update();
    EXPECT_TRUE(Identical(Result(none, Results[model]), sphere->GetPointData()->GetScalars()));
  }
}

TEST(TensorDiffusionFilter, ScalesThatContradictEachOtherGiveAWarning)
{
  const auto filter = MakeFilter(StripedSphere(3, 0.1), Tensor::MODEL_COHERENCE_ENHANCING);
  filter->SetIntegrationScale(0.5);
  Messages messages(filter);
  filter->Update();
  ASSERT_EQ(messages.Warnings.size(), 1u);
  EXPECT_NE(
    messages.Warnings[0].find("IntegrationScale is 0.5, below NoiseScale"), std::string::npos);
  filter->SetModelToEdgeEnhancing();
  filter->Update();
  EXPECT_EQ(messages.Warnings.size(), 1u);
}
