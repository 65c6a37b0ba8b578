// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Files/Content.h"

namespace SurfaceDiffusion::Files
{

/// Binary files have the number of their triangles in the header.
bool IsBinaryStl(const Content& content);
SurfaceFile ReadStl(Content content);
Bytes WriteStl(const SurfaceFile& surface);

} // namespace SurfaceDiffusion::Files
