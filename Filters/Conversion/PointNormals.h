// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "vtkSmartPointer.h"

class vtkDataArray;
class vtkPolyData;

namespace SurfaceDiffusion
{

/// One unit normal per point, the normalised sum of the normals of its polygons; zero if there is
/// none. The polygons are summed in their order: vtkPolyDataNormals sums in the order of threads,
/// so that its last bits differ from run to run.
vtkSmartPointer<vtkDataArray> ComputePointNormals(vtkPolyData* surface);

} // namespace SurfaceDiffusion
