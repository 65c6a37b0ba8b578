// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "vtkSurfaceDiffusionNamespace.h"

#include "vtkSmartPointer.h"

VTK_ABI_NAMESPACE_BEGIN
class vtkDataArray;
class vtkPolyData;
VTK_ABI_NAMESPACE_END

namespace SurfaceDiffusion
{

/// One unit normal per point, the normalised sum of the normals of its polygons; zero if there is
/// none. The polygons are summed in their order: vtkPolyDataNormals sums in the order of threads,
/// so that its last bits differ from run to run.
vtkSmartPointer<vtkDataArray> ComputePointNormals(vtkPolyData* surface);

/// `after` is a copy of `before` with moved points. Compute the normals again that it has of the
/// input, on points and on cells: those that are active there and those with the name "Normals".
/// Tangents are dropped.
void UpdateNormals(vtkPolyData* before, vtkPolyData* after);

/// Drop them all.
void DropNormals(vtkPolyData* before, vtkPolyData* after);

} // namespace SurfaceDiffusion
