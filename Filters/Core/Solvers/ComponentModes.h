// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Core/Foundation/ProgressMonitor.h"
#include "Core/Solvers/Eigenmodes.h"

#include <vector>

namespace SurfaceDiffusion
{

/// FindEigenmodes() of one connected component. stiffness: its K. areas: of its control cells. ids:
/// numbers of its points, for random numbers. Signs are not fixed.
Eigenmodes FindComponentModes(SparseMatrix stiffness, Vector areas, std::vector<Index> ids,
  Index count, const ParallelFor& parallel, const ProgressMonitor& progress);

} // namespace SurfaceDiffusion
