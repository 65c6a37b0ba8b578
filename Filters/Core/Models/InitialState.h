// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Core/Models/Model.h"
#include "Core/Operators/Assembler.h"
#include "Core/Surface/TriangleMesh.h"

#include <cstdint>
#include <memory>
#include <vector>

namespace SurfaceDiffusion
{

/// The initial values of the missing points of (18), (19).
enum class InitialFill
{
  Input, ///< the damaged values f themselves; the mean instead of NaN
  Mean, ///< the area-weighted mean of the known values of the connected component
  Noise, ///< the paper's f_rd: uniform between the smallest and largest known value
  Harmonic ///< the harmonic function of the known values; see FillHarmonically()
};

/// Fill data.Start at the missing vertices, and NaN in Given; Start = Given elsewhere. A component
/// without known values takes the mean of all components; with no known value at all it is 0.
/// Harmonic starts from Mean, and FillHarmonically() completes it. ids: one per vertex, for the
/// random numbers of Noise.
void FillMissing(const TriangleMesh& mesh, PointData& data, InitialFill fill, std::int64_t seed,
  const std::vector<std::int64_t>& ids);

/// Replace data.Start at the missing vertices by the harmonic function of the values at the others:
/// K u = 0 there with the stiffness matrix K of the cotan weights. Components without known values
/// keep the mean of their Start. Returns the report of the solve.
StepReport FillHarmonically(const std::shared_ptr<const Assembler>& assembler, PointData& data,
  const std::shared_ptr<LinearSolver>& solver, const ParallelFor& parallel,
  const ProgressMonitor& progress = ProgressMonitor());

/// For steady states: a connected component with neither a Dirichlet condition nor fidelity tends
/// to the mean of its Start. Its Start becomes the mean, and its vertices fixed.
void FixFreeComponents(const TriangleMesh& mesh, PointData& data, double fidelity);

} // namespace SurfaceDiffusion
