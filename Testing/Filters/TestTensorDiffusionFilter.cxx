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

TEST(TensorDiffusionFilter, EachModelReducesNoiseAndItsEnergy)
{
  for (int model = 0; model < 3; ++model)
  {
    const auto sphere = StripedSphere(5, 0.3);
    const auto clean = StripedSphere(5, 0.0);
    if (model != Tensor::MODEL_COHERENCE_ENHANCING) // these keep edges
    {
      for (vtkPolyData* const surface : { sphere.Get(), clean.Get() })
      {
        vtkDataArray* const f = surface->GetPointData()->GetScalars();
        for (vtkIdType i = 0; i < f->GetNumberOfTuples(); ++i)
        {
          const double noise = surface == sphere ? 0.15 * Rough(i, 0) : 0.0;
          f->SetComponent(i, 0, (surface->GetPoint(i)[2] > 0.3 ? 1.0 : 0.0) + noise);
        }
      }
    }
    const auto filter = MakeFilter(sphere, model);
    Messages messages(filter);
    filter->Update();
    EXPECT_TRUE(messages.Errors.empty() && messages.Warnings.empty());
    vtkDataArray* const u = Result(filter, Results[model]);
    ASSERT_TRUE(u) << model;
    EXPECT_EQ(filter->GetOutput()->GetPointData()->GetScalars(), u);
    double before = 0.0;
    double after = 0.0;
    for (vtkIdType i = 0; i < u->GetNumberOfTuples(); ++i)
    {
      const double exact = clean->GetPointData()->GetScalars()->GetComponent(i, 0);
      before += std::pow(sphere->GetPointData()->GetScalars()->GetComponent(i, 0) - exact, 2);
      after += std::pow(u->GetComponent(i, 0) - exact, 2);
    }
    EXPECT_LT(after, 0.5 * before) << model;
    ASSERT_EQ(History(filter)->GetNumberOfRows(), 5);
    for (vtkIdType row = 1; row < 5; ++row)
    {
      EXPECT_LT(HistoryAt(filter, row, "Energy"), HistoryAt(filter, row - 1, "Energy"));
    }
  }
}

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
  filter->SetMaximumNumberOfIterations(300);
  Messages messages(filter);
  filter->Update();
  EXPECT_TRUE(messages.Errors.empty());
  ASSERT_EQ(messages.Warnings.size(), 1u);
  EXPECT_NE(messages.Warnings[0].find("missed its tolerance in filling in"), std::string::npos)
    << messages.Warnings[0];
}

TEST(TensorDiffusionFilter, NaturalUnitsAreThoseOfTheMeshAndTheData)
{
  const auto sphere = StripedSphere(4, 0.3, 2);
  for (int model = 0; model < 3; ++model)
  {
    const auto natural = MakeFilter(sphere, model);
    natural->SetFidelityWeight(0.2);
    natural->Update();
    const double h = natural->GetMeanEdgeLength();
    const double range = natural->GetValueRange();
    EXPECT_NEAR(natural->GetTimeUnit(), h * h, 1e-12 * h * h);
    const auto absolute = MakeFilter(sphere, model);
    absolute->SetUnitsToAbsolute();
    absolute->SetTimeStep(h * h);
    absolute->SetFidelityWeight(0.2 / (h * h));
    absolute->SetColorScale(10.0 * h / range);
    absolute->SetContrast(0.05 * range / h);
    absolute->SetNoiseScale(h);
    absolute->SetIntegrationScale(4.0 * h);
    absolute->Update();
    EXPECT_LT(
      LargestDifference(Result(natural, Results[model]), Result(absolute, Results[model])), 1e-9);
  }
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

TEST(TensorDiffusionFilter, PropertiesAreChecked)
{
  const auto sphere = StripedSphere(2, 0.1);
  const auto expect = [&](const char* name, void (*set)(Tensor*))
  {
    const auto wrong = MakeFilter(sphere);
    set(wrong);
    Messages messages(wrong);
    wrong->Update();
    ASSERT_EQ(messages.Errors.size(), 1u) << name;
    EXPECT_NE(messages.Errors[0].find(name), std::string::npos) << messages.Errors[0];
    EXPECT_FALSE(Result(wrong, "fBeltrami"));
  };
  expect("Model is 3", [](Tensor* f) { f->SetModel(3); });
  expect("ColorScale is 0", [](Tensor* f) { f->SetColorScale(0.0); });
  expect("Metric is -1", [](Tensor* f) { f->SetMetric(-1); });
  expect("NoiseScale is -1", [](Tensor* f) { f->SetNoiseScale(-1.0); });
  expect("IntegrationScale is nan", [](Tensor* f) { f->SetIntegrationScale(vtkMath::Nan()); });
  expect("Contrast is 0", [](Tensor* f) { f->SetContrast(0.0); });
  expect("Alpha is 0", [](Tensor* f) { f->SetAlpha(0.0); });
  expect("DiffusionAxes is 1",
    [](Tensor* f)
    {
      f->DiffusionAxesOn();
      f->IntrinsicDelaunayOn();
    });
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
