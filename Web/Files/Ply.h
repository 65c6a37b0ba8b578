// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Files/Content.h"

namespace SurfaceDiffusion::Files
{

/// Polygon files, text and binary, with any elements and properties.
SurfaceFile ReadPly(Content content);
/// Binary, with all arrays of the points; the first array of colours is its colours.
Bytes WritePly(const SurfaceFile& surface);

} // namespace SurfaceDiffusion::Files
