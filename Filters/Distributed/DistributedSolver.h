// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Core/Solvers/LinearSolver.h"
#include "Distributed/PiecePartition.h"

#include <memory>

namespace SurfaceDiffusion
{

/// Whether this library was built with an engine for systems that are spread over processes.
bool HasDistributedSolver(const Processes& processes);

/// Conjugate gradients of hypre on matrices, right-hand sides and solutions as in Reduction,
/// preconditioned with the diagonal or with BoomerAMG (multigrid). Null without an engine.
std::unique_ptr<LinearSolver> MakeDistributedSolver(
  std::shared_ptr<const PiecePartition> partition, bool multigrid);

} // namespace SurfaceDiffusion
