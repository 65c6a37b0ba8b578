// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "ImageTest.h"

#include "vtkFVMHeatFilter.h"

#include "vtkActor.h"
#include "vtkCamera.h"
#include "vtkDataObject.h"
#include "vtkLookupTable.h"
#include "vtkPolyData.h"
#include "vtkPolyDataAlgorithm.h"
#include "vtkPolyDataMapper.h"
#include "vtkProperty.h"
#include "vtkRenderer.h"
#include "vtkSmartPointer.h"

#include <cmath>
#include <random>

/// Pictures of a filter's result on a sphere, and data on the sphere.
namespace BandedImage
{

/// Error of the picture of the first component of the filter's result, in twelve bands of color
/// over [low, high].
inline double Error(vtkPolyDataAlgorithm* filter, double low, double high,
  const std::string& baseline, const std::string& output = "")
{
  filter->Update();
  vtkNew<vtkLookupTable> bands;
  bands->SetNumberOfTableValues(12);
  bands->SetTableRange(low, high);
  bands->SetHueRange(0.67, 0.0);
  bands->Build();
  vtkNew<vtkPolyDataMapper> mapper;
  mapper->SetInputData(filter->GetOutput());
  mapper->SetLookupTable(bands);
  mapper->UseLookupTableScalarRangeOn();
  mapper->InterpolateScalarsBeforeMappingOn();
  vtkNew<vtkActor> actor;
  actor->SetMapper(mapper);
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

/// Two waves around the sphere and one along it.
inline double Signal(const double* p)
{
  return std::sin(5.0 * p[0] + 1.0) + std::cos(6.0 * p[1]) + std::sin(4.0 * p[2]);
}

/// Data that were blurred: the surface with the result "f" of linear diffusion of the width.
inline vtkSmartPointer<vtkPolyData> Blurred(vtkPolyData* surface, const char* name, double width)
{
  vtkNew<vtkFVMHeatFilter> blur;
  blur->SetInputData(surface);
  blur->SetInputArrayToProcess(0, 0, 0, vtkDataObject::FIELD_ASSOCIATION_POINTS, name);
  blur->SetFWHM(width);
  blur->SetResultArrayName("f");
  blur->Update();
  return blur->GetOutput();
}

/// White noise, uniform in [-1, 1).
class Noise
{
public:
  double operator()(vtkIdType, int)
  {
    return static_cast<double>(this->Random()) / 0x80000000u - 1.0;
  }

private:
  std::mt19937 Random;
};

} // namespace BandedImage
