// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Files/Content.h"

namespace SurfaceDiffusion::Files
{

/// Binary files have the number of their triangles in the header.
bool IsBinaryStl(const Content& content);
SurfaceFile ReadStl(Content content);
/// Programs round the corners of neighbours apart: along open edges of triangles, corners that are nearly
/// at one place become one point, which the warnings say.
void JoinSeams(SurfaceFile& file);
Bytes WriteStl(const SurfaceFile& surface);

} // namespace SurfaceDiffusion::Files
