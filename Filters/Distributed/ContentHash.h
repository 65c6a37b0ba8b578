// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Run/Fingerprint.h"
#include "vtkSurfaceDiffusionNamespace.h"

VTK_ABI_NAMESPACE_BEGIN
class vtkCellArray;
class vtkDataArray;
VTK_ABI_NAMESPACE_END

namespace SurfaceDiffusion
{

/// Hash the contents of an array: type, shape and values. A null array has a hash, too.
void AddArray(
  Fingerprint& fingerprint, vtkDataArray* array, const ParallelFor& parallel = SerialFor());

/// The same for cells.
void AddCells(
  Fingerprint& fingerprint, vtkCellArray* cells, const ParallelFor& parallel = SerialFor());

} // namespace SurfaceDiffusion
