// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Core/Foundation/ProgressMonitor.h"
#include "Core/Operators/Assembler.h"

namespace SurfaceDiffusion
{

/// Pairs of K x = lambda M x.
struct Eigenmodes
{
  Vector Eigenvalues; ///< ascending
  Values Modes; ///< n x count, one per column: x_k^T M x_l = 1 if k = l, and 0 otherwise
};

/// The `count` smallest eigenvalues of the operator -div(D grad) on a surface, K x = lambda M x,
/// and their modes, in units of the mesh: eigenvalues in 1 / LengthUnit()^2 of the coordinates.
/// coefficients: of D, positive semidefinite, as those of CotanWeights.h.
///
/// Block Lanczos with full orthogonalisation (G. Golub, R. Underwood, Mathematical Software III,
/// 1977) of A^4 with A = (M^-1/2 K M^-1/2 + sigma)^-1, on one factorisation: powers of A need more
/// solves, which are cheap, and shorter bases, whose orthogonalisation is not. The connected
/// components have separate modes, which are zero elsewhere: eigenvalues that several parts have in
/// common are found as often as they occur. Of each component the first mode is constant, and its
/// eigenvalue exactly 0. An eigenvalue that one component has more than 16 times, as the 0 of a
/// part with D = 0, is looked for in a new random block until none is found any more.
///
/// The entry of each mode with the largest magnitude is positive; of several that agree to 1e-6 the
/// one of the first point. The start is random with a fixed seed per point: no bit depends on the
/// number of threads. count: at most the number of vertices. Throws Aborted, and std::runtime_error
/// if K is indefinite or the iteration does not converge.
Eigenmodes FindEigenmodes(const Assembler& assembler, const CornerWeights& coefficients,
  Index count, const ParallelFor& parallel = SerialFor(),
  const ProgressMonitor& progress = ProgressMonitor());

} // namespace SurfaceDiffusion
