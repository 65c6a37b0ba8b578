// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Files/Content.h"

namespace SurfaceDiffusion::Files
{

/// A line of numbers, after lines that may name the columns.
bool IsTable(const Content& content);
/// Numbers in lines, between commas, semicolons or white space. Columns named x, y and z are points.
SurfaceFile ReadTable(Content content, const std::string& name);
/// The points and all their arrays.
Bytes WriteTable(const SurfaceFile& surface);

} // namespace SurfaceDiffusion::Files
