// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "FilterTest.h"
#include "ImageTest.h"

#include "vtkActor.h"
#include "vtkCamera.h"
#include "vtkHarmonicMapFilter.h"
#include "vtkLookupTable.h"
#include "vtkPolyDataMapper.h"
#include "vtkProperty.h"
#include "vtkRenderer.h"

#include <gtest/gtest.h>

#include <random>

using namespace FilterTest;

namespace
{

/// White noise, uniform in [-1, 1).
class Noise
{
public:
  double operator()() { return static_cast<double>(this->Random()) / 0x80000000u - 1.0; }

private:
  std::mt19937 Random;
};

/// Error of the picture of the filter's output, seen from a corner, in twelve bands of
/// value(u, point) over [-1, 1].
template <typename Value>
double Error(vtkHarmonicMapFilter* filter, const char* array, const Value& value,
  const std::string& baseline, const std::string& output = "")
{
  filter->Update();
  vtkNew<vtkPolyData> drawn;
  drawn->ShallowCopy(filter->GetOutput());
  vtkDataArray* u = Result(filter, array);
  AddPointArray(
    drawn, "drawn", 1, [&](vtkIdType i, int) { return value(u->GetTuple(i), drawn->GetPoint(i)); });
  drawn->GetPointData()->SetActiveScalars("drawn");
  vtkNew<vtkLookupTable> bands;
  bands->SetNumberOfTableValues(12);
  bands->SetTableRange(-1.0, 1.0);
  bands->SetHueRange(0.67, 0.0);
  bands->Build();
  vtkNew<vtkPolyDataMapper> mapper;
  mapper->SetInputData(drawn);
  mapper->SetLookupTable(bands);
  mapper->UseLookupTableScalarRangeOn();
  mapper->InterpolateScalarsBeforeMappingOn();
  vtkNew<vtkActor> actor;
  actor->SetMapper(mapper);
  actor->GetProperty()->LightingOff();
  vtkNew<vtkRenderer> renderer;
  renderer->AddActor(actor);
  renderer->SetBackground(1.0, 1.0, 1.0);
  vtkCamera* camera = renderer->GetActiveCamera();
  camera->ParallelProjectionOn();
  camera->SetPosition(0.8, 0.6, 1.0);
  renderer->ResetCamera();
  camera->Zoom(1.1);
  vtkNew<vtkRenderWindow> window;
  ImageTest::Prepare(window);
  window->AddRenderer(renderer);
  return ImageTest::Error(window, baseline, output);
}

double Oblique(const double* u, const double*)
{
  return 0.8 * u[0] - 0.6 * u[1] + 0.3 * u[2];
}

/// The cube of side 2: a sphere projected onto it, with points moved by up to `shake`.
vtkSmartPointer<vtkPolyData> Cube(double shake)
{
  auto cube = Sphere(5);
  Noise noise;
  for (vtkIdType i = 0; i < cube->GetNumberOfPoints(); ++i)
  {
    double p[3];
    cube->GetPoint(i, p);
    const double size = std::max({ std::abs(p[0]), std::abs(p[1]), std::abs(p[2]) });
    for (double& x : p)
    {
      x = x / size + shake * noise();
    }
    cube->GetPoints()->SetPoint(i, p);
  }
  return cube;
}

/// The cube with the normals of its faces plus noise.
vtkSmartPointer<vtkPolyData> CubeWithNoisyNormals()
{
  auto cube = Cube(0.0);
  Noise noise;
  AddPointArray(cube, "n", 3,
    [&](vtkIdType i, int k)
    {
      const double* p = cube->GetPoint(i);
      return (std::abs(p[k]) > 1.0 - 1e-9 ? p[k] : 0.0) + 0.5 * noise();
    });
  cube->GetPointData()->SetActiveNormals("n");
  return cube;
}

} // namespace

TEST(HarmonicMapImages, CreasesArePreservedForExponentOne)
{
  vtkNew<vtkHarmonicMapFilter> filter;
  filter->SetInputData(CubeWithNoisyNormals());
  filter->SetTimeStep(0.06);
  filter->SetNumberOfTimeSteps(10);
  EXPECT_LE(Error(filter, "nHarmonic", Oblique, "HarmonicCreases"), ImageTest::Tolerance);
  filter->SetExponent(1.1);
  EXPECT_GT(Error(filter, "nHarmonic", Oblique, "HarmonicCreases", "HarmonicCreasesTwin"),
    ImageTest::Tolerance);
}

TEST(HarmonicMapImages, CreasesAreRoundedForExponentTwo)
{
  vtkNew<vtkHarmonicMapFilter> filter;
  filter->SetInputData(CubeWithNoisyNormals());
  filter->SetTimeStep(0.2);
  filter->SetNumberOfTimeSteps(10);
  filter->SetExponent(2.0);
  EXPECT_LE(Error(filter, "nHarmonic", Oblique, "HarmonicRounded"), ImageTest::Tolerance);
  filter->SetNumberOfTimeSteps(9);
  EXPECT_GT(Error(filter, "nHarmonic", Oblique, "HarmonicRounded", "HarmonicRoundedTwin"),
    ImageTest::Tolerance);
}

TEST(HarmonicMapImages, LinesAreSmoothedIndependentlyOfTheirSign)
{
  auto sphere = Sphere(5);
  Noise noise;
  AddPointArray(sphere, "lines", 2,
    [&](vtkIdType i, int k)
    {
      const double* p = sphere->GetPoint(i);
      const double angle = 1.5 * std::atan2(p[1], p[0]) + p[2]; // not a vector field
      return (k == 0 ? std::cos(angle) : std::sin(angle)) + 0.7 * noise();
    });
  vtkNew<vtkHarmonicMapFilter> filter;
  filter->SetInputData(sphere);
  SetInputArray(filter, 0, "lines");
  filter->SetTimeStep(0.5);
  filter->SetNumberOfTimeSteps(10);
  filter->SetExponent(2.0);
  filter->LineFieldOn();
  const auto twice = [](const double* u, const double*) { return 2.0 * u[0] * u[1]; };
  EXPECT_LE(Error(filter, "linesHarmonic", twice, "HarmonicLines"), ImageTest::Tolerance);
  filter->LineFieldOff();
  EXPECT_GT(Error(filter, "linesHarmonic", twice, "HarmonicLines", "HarmonicLinesTwin"),
    ImageTest::Tolerance);
}

TEST(HarmonicMapImages, MovedVerticesDenoiseACube)
{
  vtkNew<vtkHarmonicMapFilter> filter;
  filter->SetInputData(Cube(0.02));
  filter->SetTimeStep(0.02);
  filter->SetNumberOfTimeSteps(10);
  filter->MoveVerticesOn();
  const auto outwards = [](const double*, const double* p) {
    return 40.0 * (std::max({ std::abs(p[0]), std::abs(p[1]), std::abs(p[2]) }) - 1.0);
  };
  EXPECT_LE(Error(filter, "NormalsHarmonic", outwards, "HarmonicMoved"), ImageTest::Tolerance);
  filter->SetNumberOfTimeSteps(8);
  EXPECT_GT(Error(filter, "NormalsHarmonic", outwards, "HarmonicMoved", "HarmonicMovedTwin"),
    ImageTest::Tolerance);
}
