// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Core/Foundation/Types.h"

#include <cstddef>
#include <vector>

namespace SurfaceDiffusion
{

/// A place in a list that may have more entries than an Index counts.
using Offset = std::ptrdiff_t;

/// Replaces counts by offsets: entry i becomes the sum of the entries before it.
template <typename Integer>
void CountsToOffsets(std::vector<Integer>& counts)
{
  Integer sum = 0;
  for (Integer& entry : counts)
  {
    const Integer next = sum + entry;
    entry = sum;
    sum = next;
  }
}

} // namespace SurfaceDiffusion
