// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Files/Content.h"

namespace SurfaceDiffusion::Files
{

/// VTK's legacy files of polydata and of grids of polygons, text and binary, versions 1.0 to 5.1.
SurfaceFile ReadVtkLegacy(Content content);
Bytes WriteVtkLegacy(const SurfaceFile& surface);

} // namespace SurfaceDiffusion::Files
