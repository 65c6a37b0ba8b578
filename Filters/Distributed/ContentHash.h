// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Run/Fingerprint.h"

class vtkCellArray;
class vtkDataArray;

namespace SurfaceDiffusion
{

/// Hash the contents of an array: type, shape and values. A null array has a hash, too.
void AddArray(
  Fingerprint& fingerprint, vtkDataArray* array, const ParallelFor& parallel = SerialFor());

/// The same for cells.
void AddCells(
  Fingerprint& fingerprint, vtkCellArray* cells, const ParallelFor& parallel = SerialFor());

} // namespace SurfaceDiffusion
