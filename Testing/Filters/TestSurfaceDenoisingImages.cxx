// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "FilterTest.h"
#include "ImageTest.h"

#include "vtkActor.h"
#include "vtkCamera.h"
#include "vtkCellArray.h"
#include "vtkLookupTable.h"
#include "vtkPolyDataMapper.h"
#include "vtkProperty.h"
#include "vtkRenderer.h"
#include "vtkSurfaceDenoisingFilter.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <map>
#include <random>

using namespace FilterTest;

namespace
{

constexpr double Shake = 0.02; // the largest displacement in each coordinate

/// Nearly Gaussian noise of standard deviation 1: the sum of twelve uniform numbers.
class Noise
{
public:
  double operator()()
  {
    double sum = -6.0;
    for (int k = 0; k < 12; ++k)
    {
      sum += static_cast<double>(this->Random()) / 0x100000000u;
    }
    return sum;
  }

private:
  std::mt19937 Random;
};

double LargestCoordinate(const double* p)
{
  return std::max({ std::abs(p[0]), std::abs(p[1]), std::abs(p[2]) });
}

/// The cube of side 2 with squares of two triangles, and noise of the points.
vtkSmartPointer<vtkPolyData> NoisyCube()
{
  constexpr int squares = 30; // per side
  Noise noise;
  vtkNew<vtkPoints> points;
  vtkNew<vtkCellArray> triangles;
  std::map<std::array<int, 3>, vtkIdType> known;
  const auto point = [&](const std::array<int, 3>& place)
  {
    const auto [found, isNew] = known.emplace(place, points->GetNumberOfPoints());
    if (isNew)
    {
      double p[3];
      for (int k = 0; k < 3; ++k)
      {
        p[k] = 2.0 * place[k] / squares - 1.0 + 0.5 * Shake * noise();
      }
      points->InsertNextPoint(p);
    }
    return found->second;
  };
  for (int side = 0; side < 6; ++side)
  {
    const auto corner = [&](int i, int j)
    {
      std::array<int, 3> place{};
      place[side % 3] = side < 3 ? 0 : squares;
      place[(side + 1) % 3] = side < 3 ? j : i;
      place[(side + 2) % 3] = side < 3 ? i : j;
      return point(place);
    };
    for (int i = 0; i < squares; ++i)
    {
      for (int j = 0; j < squares; ++j)
      {
        const vtkIdType corners[] = { corner(i, j), corner(i + 1, j), corner(i + 1, j + 1),
          corner(i, j + 1) };
        triangles->InsertNextCell({ corners[0], corners[1], corners[2] });
        triangles->InsertNextCell({ corners[0], corners[2], corners[3] });
      }
    }
  }
  auto cube = vtkSmartPointer<vtkPolyData>::New();
  cube->SetPoints(points);
  cube->SetPolys(triangles);
  return cube;
}

/// Error of the picture of the filter's output, seen from a corner. Twelve bands show how far
/// points are outside of the cube, from -Shake to Shake.
double Error(
  vtkSurfaceDenoisingFilter* filter, const std::string& baseline, const std::string& output = "")
{
  filter->Update();
  vtkNew<vtkPolyData> drawn;
  drawn->ShallowCopy(filter->GetOutput());
  AddPointArray(drawn, "outside", 1,
    [&](vtkIdType i, int) { return LargestCoordinate(drawn->GetPoint(i)) - 1.0; });
  drawn->GetPointData()->SetActiveScalars("outside");
  vtkNew<vtkLookupTable> bands;
  bands->SetNumberOfTableValues(12);
  bands->SetTableRange(-Shake, Shake);
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
  vtkCamera* const camera = renderer->GetActiveCamera();
  camera->ParallelProjectionOn();
  camera->SetPosition(0.8, 0.6, 1.0);
  renderer->ResetCamera();
  camera->Zoom(1.1);
  vtkNew<vtkRenderWindow> window;
  ImageTest::Prepare(window);
  window->AddRenderer(renderer);
  return ImageTest::Error(window, baseline, output);
}

} // namespace

TEST(SurfaceDenoisingImages, ACubeLosesItsNoiseAndKeepsItsEdges)
{
  vtkNew<vtkSurfaceDenoisingFilter> filter;
  filter->SetInputData(NoisyCube());
  EXPECT_LE(Error(filter, "MeshDenoised"), ImageTest::Tolerance);
  filter->SetNoiseLevel(0.9 * filter->GetEffectiveNoiseLevel());
  EXPECT_GT(Error(filter, "MeshDenoised", "MeshDenoisedTwin"), ImageTest::Tolerance);
}

TEST(SurfaceDenoisingImages, AnOrganicSurfaceKeepsMoreDetail)
{
  vtkNew<vtkSurfaceDenoisingFilter> filter;
  filter->SetInputData(NoisyCube());
  filter->SetSurfaceTypeToOrganic();
  EXPECT_LE(Error(filter, "MeshDenoisedOrganic"), ImageTest::Tolerance);
  filter->SetSurfaceTypeToCAD();
  EXPECT_GT(Error(filter, "MeshDenoisedOrganic", "MeshDenoisedOrganicTwin"), ImageTest::Tolerance);
}
