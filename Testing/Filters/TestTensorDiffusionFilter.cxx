// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "FilterTest.h"

#include "vtkCellData.h"
#include "vtkIntrinsicTVFilter.h"
#include "vtkMultiBlockDataSet.h"
#include "vtkTensorDiffusionFilter.h"

#include <gtest/gtest.h>

#include <sstream>

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

TEST(TensorDiffusionFilter, HasTheDocumentedDefaults)
{
  vtkNew<Tensor> filter;
  EXPECT_EQ(filter->GetModel(), Tensor::MODEL_BELTRAMI);
  EXPECT_STREQ(filter->GetModelAsString(), "Beltrami");
  EXPECT_EQ(filter->GetColorScale(), 10.0);
  EXPECT_STREQ(filter->GetMetricAsString(), "Induced");
  EXPECT_EQ(filter->GetNoiseScale(), 1.0);
  EXPECT_EQ(filter->GetIntegrationScale(), 4.0);
  EXPECT_EQ(filter->GetContrast(), 0.05);
  EXPECT_EQ(filter->GetAlpha(), 1e-3);
  EXPECT_FALSE(filter->GetDiffusionAxes());
  EXPECT_EQ(filter->GetTolerance(), 1e-3);
  EXPECT_EQ(filter->GetInitialFill(), Tensor::INITIAL_FILL_HARMONIC);
}

TEST(TensorDiffusionFilter, PrintSelfNamesEveryProperty)
{
  vtkNew<Tensor> filter;
  std::ostringstream text;
  filter->Print(text);
  for (const char* property : { "Model", "ColorScale", "Metric", "NoiseScale", "IntegrationScale",
         "Contrast", "Alpha", "DiffusionAxes" })
  {
    EXPECT_NE(text.str().find(std::string(property) + ": "), std::string::npos) << property;
  }
}

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

TEST(TensorDiffusionFilter, FixedMetricHasTheSteadyStateOfCharbonnier)
{
  const auto sphere = StripedSphere(3, 0.3);
  vtkNew<vtkIntrinsicTVFilter> tv;
  tv->SetEdgeFunctionToCharbonnier();
  tv->SetEdgeThreshold(0.1);
  tv->SetInputData(sphere);
  const auto filter = MakeFilter(sphere);
  for (vtkSurfaceDataDiffusionAlgorithm* either :
    { static_cast<vtkSurfaceDataDiffusionAlgorithm*>(tv),
      static_cast<vtkSurfaceDataDiffusionAlgorithm*>(filter) })
  {
    either->SetFidelityWeight(0.05);
    either->SetTimeStep(1e3);
    either->SetNumberOfTimeSteps(200);
    either->Update();
  }
  EXPECT_LT(LargestDifference(Result(tv, "fTV"), Result(filter, "fBeltrami")), 1e-6);
  EXPECT_NEAR(HistoryAt(tv, 200, "Energy") / HistoryAt(filter, 200, "Energy"), 1.0, 1e-9);
}

TEST(TensorDiffusionFilter, NaturalUnitsAreThoseOfTheMeshAndTheData)
{
  const auto sphere = StripedSphere(4, 0.3, 2);
  const auto scaled = StripedSphere(4, 0.3, 2, 64.0);
  for (vtkIdType i = 0; i < scaled->GetNumberOfPoints(); ++i)
  {
    double p[3];
    sphere->GetPoint(i, p);
    vtkMath::MultiplyScalar(p, 16.0);
    scaled->GetPoints()->SetPoint(i, p);
  }
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
    const auto other = MakeFilter(scaled, model);
    other->SetFidelityWeight(0.2);
    other->Update();
    for (vtkIdType i = 0; i < sphere->GetNumberOfPoints(); ++i)
    {
      ASSERT_EQ(Result(other, Results[model])->GetComponent(i, 1),
        64.0 * Result(natural, Results[model])->GetComponent(i, 1));
    }
    const double unit = model == 0 ? 64.0 * 64.0 : 64.0 * 64.0 * 16.0 * 16.0;
    EXPECT_EQ(HistoryAt(other, 4, "Energy"), unit * HistoryAt(natural, 4, "Energy"));
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

TEST(TensorDiffusionFilter, ColorsShareTheirTensorAndKeepTheirTypeAndAlpha)
{
  auto sphere = Sphere(4);
  AddPointArray(
    sphere, "rgba", 4,
    [&](vtkIdType i, int k)
    { return k == 3 ? i % 256 : 128.0 + 90.0 * std::sin(7.0 * sphere->GetPoint(i)[k]); },
    VTK_UNSIGNED_CHAR);
  sphere->GetPointData()->SetActiveScalars("rgba");
  const auto filter = MakeFilter(sphere);
  filter->Update();
  vtkDataArray* const u = Result(filter, "rgbaBeltrami");
  ASSERT_TRUE(u);
  EXPECT_EQ(u->GetDataType(), VTK_UNSIGNED_CHAR);
  for (vtkIdType i = 0; i < u->GetNumberOfTuples(); ++i)
  {
    ASSERT_EQ(u->GetComponent(i, 3), i % 256);
  }
}

TEST(TensorDiffusionFilter, FixedMetricConservesTheTotal)
{
  const auto sphere = StripedSphere(4, 0.3);
  const auto filter = MakeFilter(sphere);
  filter->SetTimeStep(1e4);
  const auto change = [&]
  {
    filter->Update();
    const auto areas = ControlAreas(sphere);
    vtkDataArray* const f = sphere->GetPointData()->GetScalars();
    return std::abs(Total(areas, Result(filter, "fBeltrami")) - Total(areas, f)) /
      TotalMagnitude(areas, f);
  };
  EXPECT_GT(change(), 1e-9);
  filter->SetMetricToFixed();
  EXPECT_LT(change(), 1e-12);
}

TEST(TensorDiffusionFilter, MaskedPointsAreFilledOrKeptOut)
{
  auto sphere = StripedSphere(5, 0.0);
  AddPointArray(sphere, "mask", 1,
    [&](vtkIdType i, int)
    { return std::hypot(sphere->GetPoint(i)[1], sphere->GetPoint(i)[2]) < 0.2; });
  vtkDataArray* const f = sphere->GetPointData()->GetScalars();
  for (vtkIdType i = 0; i < sphere->GetNumberOfPoints(); ++i)
  {
    if (sphere->GetPointData()->GetArray("mask")->GetComponent(i, 0) != 0.0)
    {
      f->SetComponent(i, 0, 100.0);
    }
  }
  for (int model = 0; model < 3; ++model)
  {
    const auto filter = MakeFilter(sphere, model);
    SetInputArray(filter, 1, "mask");
    filter->Update();
    EXPECT_LT(Result(filter, Results[model])->GetRange()[1], 1.1);
    filter->SetMaskModeToExclude();
    filter->Update();
    EXPECT_EQ(Result(filter, Results[model])->GetRange()[1], 100.0);
    filter->SetMaskModeToInpaint();
    filter->HoldKnownValuesOn();
    filter->Update();
    for (vtkIdType i = 0; i < sphere->GetNumberOfPoints(); ++i)
    {
      if (f->GetComponent(i, 0) != 100.0)
      {
        ASSERT_EQ(Result(filter, Results[model])->GetComponent(i, 0), f->GetComponent(i, 0));
      }
    }
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
  expect("TimeIntegrator is 1", [](Tensor* f) { f->SetTimeIntegratorToSecondOrder(); });
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

TEST(TensorDiffusionFilter, EveryTimeCanBeRequestedInAnyOrder)
{
  for (int model = 0; model < 3; ++model)
  {
    const auto filter = MakeFilter(StripedSphere(4, 0.3), model);
    filter->GenerateTimeStepsOn();
    filter->DiffusionAxesOn();
    filter->UpdateTimeStep(4.0);
    const auto last = Copy(Result(filter, Results[model]));
    const auto axes = Copy(filter->GetOutput()->GetCellData()->GetArray("DiffusionAxes"));
    filter->UpdateTimeStep(2.0);
    const auto fresh = MakeFilter(filter->GetInput(), model);
    fresh->SetNumberOfTimeSteps(2);
    fresh->Update();
    EXPECT_TRUE(Identical(Result(fresh, Results[model]), Result(filter, Results[model])));
    filter->UpdateTimeStep(4.0);
    EXPECT_TRUE(Identical(last, Result(filter, Results[model])));
    EXPECT_TRUE(Identical(axes, filter->GetOutput()->GetCellData()->GetArray("DiffusionAxes")));
  }
}

TEST(TensorDiffusionFilter, AnAbortLeavesTheInput)
{
  for (int model = 0; model < 3; ++model)
  {
    const auto filter = MakeFilter(StripedSphere(5, 0.3), model);
    filter->SetNumberOfTimeSteps(1000);
    const unsigned long tag = Listen(filter,
      [&](double amount)
      {
        if (amount > 0.01)
        {
          filter->SetAbortExecute(1);
        }
      });
    filter->Update();
    EXPECT_FALSE(Result(filter, Results[model]));
    EXPECT_LT(filter->GetNumberOfStepsComputed(), 100);
    filter->RemoveObserver(tag);
  }
}

TEST(TensorDiffusionFilter, BlocksShareUnits)
{
  vtkNew<vtkMultiBlockDataSet> blocks;
  blocks->SetBlock(0, StripedSphere(4, 0.1));
  blocks->SetBlock(1, StripedSphere(4, 0.1, 1, 3.0));
  const auto filter = MakeFilter(blocks);
  filter->Update();
  EXPECT_NEAR(filter->GetValueRange(),
    blocks->GetBlock(1)->GetAttributes(0)->GetScalars()->GetRange()[1] -
      blocks->GetBlock(1)->GetAttributes(0)->GetScalars()->GetRange()[0],
    1e-12);
}
