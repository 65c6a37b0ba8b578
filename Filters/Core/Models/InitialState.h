// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Core/Models/Model.h"
#include "Core/Surface/TriangleMesh.h"

#include <cstdint>
#include <vector>

namespace SurfaceDiffusion
{

/// What the missing points of (18), (19) start from.
enum class InitialFill
{
  Input, ///< the damaged values f themselves; the mean where they are NaN
  Mean, ///< the area-weighted mean of the known values of the connected component
  Noise ///< the paper's f_rd: uniform between the smallest and largest known value
};

/// Fill data.Start, and Given where it is NaN, from Given at the missing vertices; Start = Given
/// elsewhere. A component without known values takes the mean of all components; with no known
/// value at all it is 0. ids: one per vertex, for the random numbers.
void FillMissing(const TriangleMesh& mesh, PointData& data, InitialFill fill, std::int64_t seed,
  const std::vector<std::int64_t>& ids);

/// For steady states: connected components that nothing holds, neither a fixed vertex nor fidelity
/// at a known one, end at the mean of their Start; there Start becomes it, and fixed.
void FixFreeComponents(const TriangleMesh& mesh, PointData& data, double fidelity);

} // namespace SurfaceDiffusion
