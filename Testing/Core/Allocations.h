// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

namespace SurfaceDiffusion::Testing
{

/// Number of allocations by all threads since the start of the program, by operator new and by
/// Eigen; negative where they cannot be counted (see TestAllocation.cxx).
long NumberOfAllocations();

/// Let the allocation of this number from now on fail, from 1; 0: none.
void FailAllocation(long number);

} // namespace SurfaceDiffusion::Testing
