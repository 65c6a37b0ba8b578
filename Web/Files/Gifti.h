// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Files/Content.h"

namespace SurfaceDiffusion::Files
{

/// GIFTI: surfaces, and values at their points, in text, base 64 or compressed.
SurfaceFile ReadGifti(Content content, const std::string& name);
/// The surface, and each array of the points.
Bytes WriteGifti(const SurfaceFile& surface);

} // namespace SurfaceDiffusion::Files
