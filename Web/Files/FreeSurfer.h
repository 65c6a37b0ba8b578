// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Files/Content.h"

namespace SurfaceDiffusion::Files
{

/// Triangles of FreeSurfer: lh.white, lh.inflated, ...
SurfaceFile ReadFreeSurfer(Content content);
Bytes WriteFreeSurfer(const SurfaceFile& surface);

/// Values at points, as lh.thickness: the curv format, and volumes with a voxel per point.
SurfaceFile ReadCurv(Content content, const std::string& name);
SurfaceFile ReadMgh(Content content, const std::string& name);
bool IsMgh(Content content);

} // namespace SurfaceDiffusion::Files
