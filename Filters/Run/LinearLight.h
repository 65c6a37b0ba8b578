// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Core/Foundation/Parallel.h"
#include "Core/Foundation/Types.h"

namespace SurfaceDiffusion
{

/// The transfer function of sRGB (IEC 61966-2-1:1999) for values from 0 to 255: an encoded value v
/// has the linear light 255 L(v/255) with
///   L(s) = s/12.92 for s <= 0.04045, ((s + 0.055)/1.055)^2.4 above.
void DecodeColors(Values& colors, const ParallelFor& parallel);

/// Its inverse. Linear light below 0 becomes 0, and above 255 it becomes 255.
void EncodeColors(Values& colors, const ParallelFor& parallel);

} // namespace SurfaceDiffusion
