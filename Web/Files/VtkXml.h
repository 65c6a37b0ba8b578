// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Files/Content.h"

namespace SurfaceDiffusion::Files
{

/// VTK's files of XML, polydata and grids of polygons: text, base 64, appended raw or in base 64, each
/// compressed by zlib or not.
SurfaceFile ReadVtkXml(Content content);
/// isGrid: as vtu in place of vtp.
Bytes WriteVtkXml(const SurfaceFile& surface, bool isGrid);

} // namespace SurfaceDiffusion::Files
