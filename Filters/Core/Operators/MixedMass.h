// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Core/Operators/Assembler.h"

namespace SurfaceDiffusion
{

/// The mixed mass matrix B = (M + C)/2, the mean of the lumped one M = diag(A_i) and the consistent
/// one C of linear elements, a sixth and a twelfth of the area of each triangle. On an even lattice
/// of edges h a wave of the wave number k has the eigenvalue k^2 (1 - k^2 h^2/16) of M^-1 K and k^2
/// (1 + k^2 h^2/16) of C^-1 K: that of B^-1 K is of fourth order. The sums of the rows are those of
/// M, and
///
///     B = M - K_w,   (K_w u)_i = sum over the triangles T at vertex i and their corners j of
///                                |T|/24 (u_i - u_j),
///
/// so that B has the pattern of the stiffness matrix, and is assembled as one. Where A_i are not
/// thirds of triangles, as of intrinsic triangulations and given areas, each triangle counts by the
/// smallest ratio of A_i to these thirds at its corners: 5/8 M <= B <= M on any surface.

/// The coefficients c = -w of which Assembler makes B - M.
CornerWeights MixedMassWeights(const TriangleMesh& mesh, const ParallelFor& parallel = SerialFor());

/// B - M of these, of the pattern of `assembler`.
SparseMatrix MixedMinusLumped(const Assembler& assembler, const CornerWeights& weights,
  const ParallelFor& parallel = SerialFor());

} // namespace SurfaceDiffusion
