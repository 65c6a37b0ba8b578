// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Conversion/PolyDataSurface.h"

#include "vtkSmartPointer.h"

#include <string>

namespace SurfaceDiffusion
{

/// Conversions between arrays of directions in space and frames (see Core/Surface/TangentVectors.h)
/// of the triangles of surface.InputMesh.

/// From an array of three components on points or cells. Throws std::runtime_error, with the
/// property's name, on infinite values.
TangentVectors ReadFrames(
  const PolyDataSurface& surface, vtkDataArray* array, bool onCells, const ParallelFor& parallel);

/// An array for the cells of `input`, of unit vectors: of cells with several triangles the main
/// axis of their area-weighted sum of d d^T. Zero where there is no direction.
vtkSmartPointer<vtkDataArray> WriteFrames(const PolyDataSurface& surface, vtkPolyData* input,
  const TangentVectors& frames, const std::string& name, const ParallelFor& parallel);

} // namespace SurfaceDiffusion
