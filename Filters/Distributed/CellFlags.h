// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "vtkSurfaceDiffusionNamespace.h"

#include <vector>

VTK_ABI_NAMESPACE_BEGIN
class vtkDataSet;
class vtkPolyData;
VTK_ABI_NAMESPACE_END

namespace SurfaceDiffusion
{

/// The ghost flags of each cell (vtkDataSetAttributes::CellGhostTypes), where a cell that uses a
/// hidden point is hidden, too. Empty if no cell has a flag. Arrays of flags that have not one
/// tuple per point or cell are ignored.
std::vector<unsigned char> FindCellFlags(vtkPolyData* surface);

/// Per point, nonzero for hidden points. Empty if there are none.
std::vector<char> FindHiddenPoints(vtkDataSet* data);

} // namespace SurfaceDiffusion
