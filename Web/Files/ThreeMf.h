// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Files/Content.h"

namespace SurfaceDiffusion::Files
{

/// 3MF: a zip archive with the meshes of objects, which are placed to be printed.
SurfaceFile ReadThreeMf(Content content);
Bytes WriteThreeMf(const SurfaceFile& surface);

} // namespace SurfaceDiffusion::Files
