// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "FilterTest.h"
#include "ImageTest.h"

#include "vtkActor.h"
#include "vtkCamera.h"
#include "vtkCellCenters.h"
#include "vtkCellData.h"
#include "vtkGlyph3D.h"
#include "vtkLineSource.h"
#include "vtkLookupTable.h"
#include "vtkPolyDataMapper.h"
#include "vtkProperty.h"
#include "vtkRenderer.h"
#include "vtkSurfaceDirectionFieldFilter.h"
#include "vtkTuringTextureFilter.h"

#include <gtest/gtest.h>

using namespace FilterTest;

namespace
{

double ErrorOfPicture(vtkActor* actor, const std::string& baseline, const std::string& output)
{
  actor->GetProperty()->LightingOff();
  vtkNew<vtkRenderer> renderer;
  renderer->AddActor(actor);
  renderer->SetBackground(1.0, 1.0, 1.0);
  renderer->GetActiveCamera()->ParallelProjectionOn();
  renderer->ResetCamera();
  renderer->GetActiveCamera()->Zoom(1.4);
  vtkNew<vtkRenderWindow> window;
  ImageTest::Prepare(window);
  window->AddRenderer(renderer);
  return ImageTest::Error(window, baseline, output);
}

/// Error of the picture of Texture in four bands.
double Error(
  vtkTuringTextureFilter* filter, const std::string& baseline, const std::string& output = "")
{
  filter->Update();
  filter->GetOutput()->GetPointData()->SetActiveScalars("Texture");
  vtkNew<vtkLookupTable> bands;
  bands->SetNumberOfTableValues(4);
  bands->SetTableRange(0.0, 1.0);
  bands->SetHueRange(0.1, 0.08);
  bands->SetValueRange(1.0, 0.2);
  bands->Build();
  vtkNew<vtkPolyDataMapper> mapper;
  mapper->SetInputData(filter->GetOutput());
  mapper->SetLookupTable(bands);
  mapper->UseLookupTableScalarRangeOn();
  mapper->InterpolateScalarsBeforeMappingOn();
  vtkNew<vtkActor> actor;
  actor->SetMapper(mapper);
  return ErrorOfPicture(actor, baseline, output);
}

/// A texture of wavelength 0.5 on the unit sphere, until it is stationary.
vtkSmartPointer<vtkTuringTextureFilter> MakeTexture(double ratio)
{
  auto filter = vtkSmartPointer<vtkTuringTextureFilter>::New();
  filter->SetInputData(Sphere(5));
  filter->SetFeatureSize(0.5);
  filter->SetDiffusionRate1(2.6 * ratio);
  filter->SetTimeStep(0.125);
  filter->SetNumberOfTimeSteps(160);
  return filter;
}

void ExpectPictureOfItsOwn(vtkTuringTextureFilter* filter, const std::string& baseline)
{
  EXPECT_LE(Error(filter, baseline), ImageTest::Tolerance);
  filter->SetFeatureSize(0.51);
  EXPECT_GT(Error(filter, baseline, baseline + "Twin"), ImageTest::Tolerance);
}

} // namespace

TEST(TuringTextureImages, ARateRatioOfFiveMakesSpots)
{
  const auto filter = MakeTexture(5.0);
  filter->SetNumberOfTimeSteps(320); // spots grow slowly
  ExpectPictureOfItsOwn(filter, "TuringSpots");
}

TEST(TuringTextureImages, ARateRatioOfSixteenMakesALabyrinth)
{
  ExpectPictureOfItsOwn(MakeTexture(16.0), "TuringLabyrinth");
}

TEST(TuringTextureImages, ARateRatioOfThirtyMakesANet)
{
  ExpectPictureOfItsOwn(MakeTexture(30.0), "TuringNet");
}

TEST(TuringTextureImages, AFasterActivatorAlongADirectionMakesStripes)
{
  auto sphere = Sphere(5);
  AddPointArray(sphere, "e1", 3,
    [&](vtkIdType i, int k)
    {
      const double* p = sphere->GetPoint(i); // spirals around the axis of view
      return k == 0 ? -p[1] + 0.5 * p[0] : k == 1 ? p[0] + 0.5 * p[1] : 0.0;
    });
  const auto filter = MakeTexture(8.0);
  filter->SetInputData(sphere);
  SetInputArray(filter, 2, "e1");
  filter->SetDiffusionRate2(5.2);
  filter->SetDiffusionRateAcross2(2.6);
  filter->SetFeatureSize(0.6); // along e1, along which no waves grow
  EXPECT_LE(Error(filter, "TuringStripes"), ImageTest::Tolerance);
  filter->SetDiffusionRate2(4.8);
  EXPECT_GT(Error(filter, "TuringStripes", "TuringStripesTwin"), ImageTest::Tolerance);
}

TEST(TuringTextureImages, ColorOutputShowsTheTexture)
{
  const auto filter = MakeTexture(8.0);
  filter->ColorOutputOn();
  const auto draw = [&](const std::string& output)
  {
    filter->Update();
    vtkNew<vtkPolyDataMapper> mapper;
    mapper->SetInputData(filter->GetOutput());
    vtkNew<vtkActor> actor;
    actor->SetMapper(mapper);
    return ErrorOfPicture(actor, "TuringColors", output);
  };
  EXPECT_LE(draw(""), ImageTest::Tolerance);
  filter->SetHighColor(0.93, 0.70, 0.58);
  EXPECT_GT(draw("TuringColorsTwin"), ImageTest::Tolerance);
}

TEST(DirectionFieldImages, SmoothLinesCoverASphere)
{
  // An egg. Without symmetry the smoothest field is unique.
  auto egg = Sphere(4);
  for (vtkIdType i = 0; i < egg->GetNumberOfPoints(); ++i)
  {
    double p[3];
    egg->GetPoint(i, p);
    egg->GetPoints()->SetPoint(i, p[0] * (1.2 + 0.2 * p[1]), p[1] * 0.9, p[2] * (1.0 + 0.1 * p[0]));
  }
  vtkNew<vtkSurfaceDirectionFieldFilter> filter;
  filter->SetInputData(egg);
  filter->SetMethodToSmooth();
  const auto draw = [&](const std::string& output)
  {
    vtkNew<vtkCellCenters> centers;
    centers->SetInputConnection(filter->GetOutputPort());
    vtkNew<vtkLineSource> line;
    line->SetPoint1(-0.5, 0.0, 0.0);
    line->SetPoint2(0.5, 0.0, 0.0);
    vtkNew<vtkGlyph3D> lines;
    lines->SetInputConnection(centers->GetOutputPort());
    lines->SetSourceConnection(line->GetOutputPort());
    lines->SetInputArrayToProcess(1, 0, 0, vtkDataObject::FIELD_ASSOCIATION_POINTS, "Direction");
    lines->SetScaleModeToDataScalingOff();
    lines->SetScaleFactor(0.07);
    vtkNew<vtkPolyDataMapper> mapper;
    mapper->SetInputConnection(lines->GetOutputPort());
    mapper->ScalarVisibilityOff();
    vtkNew<vtkActor> actor;
    actor->SetMapper(mapper);
    actor->GetProperty()->SetColor(0.0, 0.0, 0.0);
    actor->GetProperty()->SetLineWidth(1.5);
    return ErrorOfPicture(actor, "DirectionSmooth", output);
  };
  EXPECT_LE(draw(""), ImageTest::Tolerance);
  filter->SetAngle(3.0);
  EXPECT_GT(draw("DirectionSmoothTwin"), ImageTest::Tolerance);
}
