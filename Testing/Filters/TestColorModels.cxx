// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "IntrinsicTVTest.h"

#include <gtest/gtest.h>

#include <algorithm>

// ColorModel of vtkIntrinsicTVFilter. The models themselves are tested in Core.
using namespace IntrinsicTVTest;

namespace
{

constexpr int Colored[] = { Filter::COLOR_MODEL_OPPONENT,
  Filter::COLOR_MODEL_CHROMATICITY_BRIGHTNESS };

/// A colour on each side of the edge of a cap, and noise.
double Color(const double* p, vtkIdType i, int k)
{
  const double inside[] = { 0.8, 0.3, 0.1 };
  const double outside[] = { 0.2, 0.5, 0.7 };
  return (Cap(p) > 0.5 ? inside : outside)[k] + 0.1 * Rough(i, k);
}

void AddColors(vtkPolyData* sphere, double factor = 1.0)
{
  AddPointArray(
    sphere, "f", 3, [&](vtkIdType i, int k) { return factor * Color(sphere->GetPoint(i), i, k); });
  sphere->GetPointData()->SetActiveScalars("f");
}

/// The same from 0 to 255, with alpha.
void AddBytes(vtkPolyData* sphere, int components = 3)
{
  AddPointArray(
    sphere, "f", components,
    [&](vtkIdType i, int k)
    {
      const double value = k == 3 ? i % 256 : 255.0 * Color(sphere->GetPoint(i), i, k);
      return std::clamp(std::round(value), 0.0, 255.0);
    },
    VTK_UNSIGNED_CHAR);
  sphere->GetPointData()->SetActiveScalars("f");
}

double Decoded(double byte)
{
  const double s = byte / 255.0;
  return 255.0 * (s <= 0.04045 ? s / 12.92 : std::pow((s + 0.055) / 1.055, 2.4));
}

double Encoded(double light)
{
  const double s = std::clamp(light / 255.0, 0.0, 1.0);
  return 255.0 * (s <= 0.0031308 ? 12.92 * s : 1.055 * std::pow(s, 1.0 / 2.4) - 0.055);
}

} // namespace

TEST(ColorModels, HeldColoursInpaintTheOthers)
{
  auto sphere = Sphere(4);
  // The chromaticity is the same everywhere, so that brightness alone has to be continued.
  const double color[] = { 0.6, 0.3, 0.2 };
  AddPointArray(
    sphere, "f", 3, [&](vtkIdType i, int k) { return i % 9 == 0 ? std::nan("") : color[k]; });
  sphere->GetPointData()->SetActiveScalars("f");
  for (const int model : Colored)
  {
    auto filter = MakeFilter(sphere);
    filter->SetColorModel(model);
    filter->SetModeToSteadyState();
    filter->SetInitialFillToNoise();
    filter->SetStopTolerance(1e-6);
    filter->HoldKnownValuesOn();
    filter->Update();
    const auto expected = MakeArray(
      VTK_DOUBLE, "e", sphere->GetNumberOfPoints(), 3, [&](vtkIdType, int k) { return color[k]; });
    EXPECT_LT(LargestDifference(Result(filter), expected), 1e-2) << model;
  }
}

TEST(ColorModels, AutomaticFidelityHasNearlyTheSmallestError)
{
  auto sphere = Sphere(4);
  AddColors(sphere);
  const auto clean = MakeArray(VTK_DOUBLE, "e", sphere->GetNumberOfPoints(), 3,
    [&](vtkIdType i, int k) { return Color(sphere->GetPoint(i), i, k) - 0.1 * Rough(i, k); });
  for (const int model : Colored)
  {
    auto filter = MakeFilter(sphere);
    filter->SetColorModel(model);
    filter->SetModeToSteadyState();
    const auto update = [&]
    {
      filter->Update();
      double sum = 0.0;
      for (vtkIdType i = 0; i < sphere->GetNumberOfPoints(); ++i)
      {
        for (int k = 0; k < 3; ++k)
        {
          sum += std::pow(Result(filter)->GetComponent(i, k) - clean->GetComponent(i, k), 2);
        }
      }
      return std::sqrt(sum / (3.0 * static_cast<double>(sphere->GetNumberOfPoints())));
    };
    filter->AutomaticFidelityOn();
    Messages messages(filter);
    const double error = update();
    EXPECT_TRUE(messages.Warnings.empty());
    const double found = filter->GetEffectiveFidelityWeight();
    filter->AutomaticFidelityOff();
    double best = error;
    for (const double factor : { 0.125, 0.25, 0.5, 2.0, 4.0, 8.0 })
    {
      filter->SetFidelityWeight(factor * found);
      best = std::min(best, update());
    }
    EXPECT_LT(error, 1.5 * best) << model;
  }
}

TEST(ColorModels, LinearLightDecodesAndEncodesBytesOnly)
{
  auto bytes = Sphere(3);
  AddBytes(bytes);
  auto light = Sphere(3);
  vtkDataArray* f = bytes->GetPointData()->GetArray("f");
  AddPointArray(light, "f", 3, [&](vtkIdType i, int k) { return Decoded(f->GetComponent(i, k)); });
  light->GetPointData()->SetActiveScalars("f");
  for (const int model : Colored)
  {
    auto decoding = MakeFilter(bytes);
    decoding->SetOutputPrecisionToDouble();
    auto plain = MakeFilter(light);
    for (Filter* filter : { decoding.Get(), plain.Get() })
    {
      filter->SetColorModel(model);
      filter->LinearLightOn();
      filter->SetTolerance(1e-12);
      filter->Update();
    }
    const auto expected = MakeArray(VTK_DOUBLE, "e", bytes->GetNumberOfPoints(), 3,
      [&](vtkIdType i, int k) { return Encoded(Result(plain)->GetComponent(i, k)); });
    EXPECT_LT(LargestDifference(Result(decoding), expected), 1e-9) << model;
    EXPECT_NEAR(decoding->GetValueRange(), plain->GetValueRange(), 1e-9);
    plain->LinearLightOff(); // no bytes: no effect
    const auto before = Copy(Result(plain));
    plain->Update();
    EXPECT_TRUE(Identical(Result(plain), before));
    decoding->LinearLightOff();
    decoding->Update();
    EXPECT_GT(LargestDifference(Result(decoding), expected), 1.0) << model;
  }
}

TEST(ColorModels, LinearLightLeavesRGBAsItIs)
{
  auto sphere = Sphere(3);
  AddBytes(sphere);
  auto filter = MakeFilter(sphere);
  filter->LinearLightOn();
  filter->Update();
  const auto on = Copy(Result(filter));
  filter->LinearLightOff();
  filter->Update();
  EXPECT_TRUE(Identical(Result(filter), on));
}

TEST(ColorModels, ColoursOutsideTheRangeOfBytesAreClamped)
{
  // A weak fidelity of colour takes saturated colours next to white out of the cube.
  auto sphere = Sphere(3);
  AddPointArray(
    sphere, "f", 3,
    [&](vtkIdType i, int k) { return Cap(sphere->GetPoint(i)) > 0.5 || k == 0 ? 255.0 : 0.0; },
    VTK_UNSIGNED_CHAR);
  sphere->GetPointData()->SetActiveScalars("f");
  auto filter = MakeFilter(sphere);
  filter->SetColorModelToOpponent();
  filter->SetChannelCouplingToPerChannel();
  filter->SetChromaWeight(0.01);
  filter->LinearLightOn();
  filter->SetOutputPrecisionToDouble();
  filter->Update();
  double low = 255.0;
  double high = 0.0;
  for (vtkIdType i = 0; i < sphere->GetNumberOfPoints(); ++i)
  {
    for (int k = 0; k < 3; ++k)
    {
      low = std::min(low, Result(filter)->GetComponent(i, k));
      high = std::max(high, Result(filter)->GetComponent(i, k));
    }
  }
  EXPECT_GE(low, 0.0);
  EXPECT_DOUBLE_EQ(high, 255.0);
}
