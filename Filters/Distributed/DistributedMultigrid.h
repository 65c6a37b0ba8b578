// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Core/Solvers/LinearSolver.h"
#include "Distributed/DomainDecomposition.h"

#include <memory>

namespace SurfaceDiffusion
{

/// Whether this library was built with hypre and the processes communicate by MPI.
bool HasDistributedMultigrid(const Processes& processes);

/// hypre's conjugate gradients, preconditioned with BoomerAMG. Matrices and right-hand sides are
/// accumulated, solutions consistent vectors (see Reduction). Null if this library was built without
/// hypre.
std::unique_ptr<LinearSolver> MakeDistributedMultigridSolver(
  std::shared_ptr<const DomainDecomposition> decomposition);

} // namespace SurfaceDiffusion
