// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Files/Content.h"

namespace SurfaceDiffusion::Files
{

/// Triangles of FreeSurfer: lh.white, lh.inflated, ...
SurfaceFile ReadFreeSurfer(Content content);
Bytes WriteFreeSurfer(const SurfaceFile& surface);

/// The texts of FreeSurfer: surfaces (.asc), and the points of a label, for which an array with 1 is made
/// that is 0 elsewhere.
SurfaceFile ReadFreeSurferText(Content content, const std::string& name);
/// The numbers of the regions of an annotation in the order of its table of colours; NaN outside of them.
SurfaceFile ReadAnnotation(Content content, const std::string& name);

/// Values at points, as lh.thickness: the curv format, and volumes with a voxel per point.
SurfaceFile ReadCurv(Content content, const std::string& name);
SurfaceFile ReadMgh(Content content, const std::string& name);
bool IsMgh(Content content);

} // namespace SurfaceDiffusion::Files
