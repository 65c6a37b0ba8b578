// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Conversion/TriangleCells.h"
#include "Run/Fingerprint.h"
#include "Run/Surface.h"
#include "vtkSurfaceDiffusionNamespace.h"

#include "vtkType.h"

VTK_ABI_NAMESPACE_BEGIN
class vtkDataArray;
class vtkPolyData;
VTK_ABI_NAMESPACE_END

namespace SurfaceDiffusion
{

/// Throws std::runtime_error unless the array has one tuple for each of `count`.
void RequireTuples(vtkDataArray* array, vtkIdType count, const char* what);

/// The hash of everything that ReadSurface() reads.
Fingerprint FingerprintSurface(
  vtkPolyData* input, vtkDataArray* excluded = nullptr, bool excludedCells = false);

/// The triangles of the polygons and strips of `input`. Ghost and hidden cells are ignored,
/// and cells with a hidden point.
/// excluded: per point, nonzero for points whose triangles are ignored, or, with excludedCells, per
/// cell, nonzero for those that are ignored; may be null. cells: the input's cell of each triangle.
///
/// Throws std::runtime_error if there are more points, cells or triangles than 32-bit numbers
/// count, and if a cell refers to a point that does not exist.
SurfaceArrays ReadSurface(
  vtkPolyData* input, vtkDataArray* excluded, bool excludedCells, TriangleCells& cells);

} // namespace SurfaceDiffusion
