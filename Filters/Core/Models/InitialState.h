// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Core/Models/Model.h"
#include "Core/Surface/TriangleMesh.h"

#include <cstdint>
#include <vector>

namespace SurfaceDiffusion
{

/// The initial values of the missing points of (18), (19).
enum class InitialFill
{
  Input, ///< the damaged values f themselves; the mean instead of NaN
  Mean, ///< the area-weighted mean of the known values of the connected component
  Noise ///< the paper's f_rd: uniform between the smallest and largest known value
};

/// Fill data.Start at the missing vertices, and NaN in Given; Start = Given elsewhere. A component
/// without known values takes the mean of all components; with no known value at all it is 0. ids:
/// one per vertex, for the random numbers.
void FillMissing(const TriangleMesh& mesh, PointData& data, InitialFill fill, std::int64_t seed,
  const std::vector<std::int64_t>& ids);

/// For steady states: a connected component with neither a Dirichlet condition nor fidelity tends
/// to the mean of its Start. Its Start becomes the mean, and its vertices fixed.
void FixFreeComponents(const TriangleMesh& mesh, PointData& data, double fidelity);

} // namespace SurfaceDiffusion
