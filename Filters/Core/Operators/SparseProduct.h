// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Core/Foundation/Types.h"

namespace SurfaceDiffusion
{

/// Rows [begin, end) of y = matrix x, for K columns of x, or any number of them if K is 0. With the
/// number known to the compiler the sums stay in registers, so that the speed is that of memory.
/// Instantiated for the numbers of ForColumns() in a file of its own, lest the loops around it take
/// its registers.
template <int K>
void MultiplyRows(const SparseMatrix& matrix, const Values& x, Values& y, Index begin, Index end);

} // namespace SurfaceDiffusion
