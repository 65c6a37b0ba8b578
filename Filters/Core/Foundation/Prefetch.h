// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Core/Foundation/Types.h"

#include <cstddef>

namespace SurfaceDiffusion
{

/// Ask for the memory at `place`, which is read soon. Processors foresee where a loop over an array
/// reads next, but not where the numbers in the array point to.
inline void Prefetch(const void* place)
{
#if defined(__GNUC__) // and clang
  __builtin_prefetch(place);
#else
  static_cast<void>(place);
#endif
}

/// Products of a sparse matrix with x call this once per row of the matrix, with the end of the
/// row's entries, of which all rows have `size`. It asks for the row of x, or its first cache line,
/// that an entry needs some tens of rows later.
template <typename Number>
void PrefetchRow(const Number* x, const Index* inner, Index endOfRow, Index size, int columns)
{
  constexpr Index distance = 280; // entries
  const Index end = size - endOfRow > distance ? endOfRow + distance : size;
  if (end > 0)
  {
    Prefetch(x + static_cast<std::ptrdiff_t>(inner[end - 1]) * columns);
  }
}

} // namespace SurfaceDiffusion
