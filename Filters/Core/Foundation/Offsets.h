// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Core/Foundation/Types.h"

#include <vector>

namespace SurfaceDiffusion
{

/// Replaces counts by offsets: entry i becomes the sum of the entries before it.
inline void CountsToOffsets(std::vector<Index>& counts)
{
  Index sum = 0;
  for (Index& entry : counts)
  {
    const Index next = sum + entry;
    entry = sum;
    sum = next;
  }
}

} // namespace SurfaceDiffusion
