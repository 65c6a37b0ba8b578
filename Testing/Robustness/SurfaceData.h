// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "AllFilters.h"
#include "CoarseSurfaces.h"

/// Surfaces of the tests of the core as input of filters.
namespace FilterTest
{

inline vtkSmartPointer<vtkPolyData> MakePolyData(
  const SurfaceDiffusion::Testing::NamedSurface& named)
{
  vtkNew<vtkPoints> points;
  points->SetDataType(named.InSinglePrecision ? VTK_FLOAT : VTK_DOUBLE);
  for (const auto& v : named.Shape.Vertices.rowwise())
  {
    points->InsertNextPoint(v.data());
  }
  vtkNew<vtkCellArray> cells;
  for (const auto& f : named.Shape.Faces.rowwise())
  {
    cells->InsertNextCell({ f[0], f[1], f[2] });
  }
  auto surface = vtkSmartPointer<vtkPolyData>::New();
  surface->SetPoints(points);
  surface->SetPolys(cells);
  return surface;
}

/// Adds the rough positive data "f" in [1, 3), and what AllFilters() take.
inline void AddDataOfAllFilters(vtkPolyData* surface)
{
  AddPointArray(surface, "f", 1, [](vtkIdType i, int k) { return 2.0 + Rough(i, k); });
  surface->GetPointData()->SetActiveScalars("f");
  AddArraysOfAllFilters(surface);
}

/// Relief that is larger than a surface is an error: heights for a sphere of radius 1 become smaller.
inline void FitHeights(vtkPolyDataAlgorithm* filter, vtkPolyData* surface)
{
  if (auto* const relief = vtkSurfaceReliefFilter::SafeDownCast(filter))
  {
    const double scale = std::min(1.0, surface->GetLength() / 3.5);
    relief->SetHeight(scale * relief->GetHeight());
    relief->SetBase(scale * relief->GetBase());
    relief->SetFlank(scale * relief->GetFlank());
  }
}

} // namespace FilterTest
