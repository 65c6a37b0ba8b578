// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Files/Content.h"

// OFF and OBJ, which are lines of text.
namespace SurfaceDiffusion::Files
{

bool IsOff(const Content& content);
SurfaceFile ReadOff(Content content);
Bytes WriteOff(const SurfaceFile& surface);

/// A line that begins with the key v and a number.
bool IsObj(const Content& content);
SurfaceFile ReadObj(Content content);
/// With the first array of colours, as numbers from 0 to 1 after the coordinates.
Bytes WriteObj(const SurfaceFile& surface);

/// The array of colours of the points, with three or four components from 0 to 255; null: none.
const FileArray* FindColors(const SurfaceFile& surface);

} // namespace SurfaceDiffusion::Files
