// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Core/Foundation/Types.h"

namespace SurfaceDiffusion
{

/// L M^-1 L for masses M, given by their diagonal, and L = s M + K, where rows of K have the sum 0. The
/// product is full around vertices of many triangles. For the row l of such a vertex, (l^T u)^2 / m is
/// therefore taken as the least value over z of
///   sum_k (l_k^T u + sum of the z_j of the children j of k - z_k)^2 / m_k,  sum_k m_k = m,
/// with a tree of nodes k, whose root has no z, and with parts l_k of l of few entries each. The z are
/// further unknowns, after the n of L: what is left when they are eliminated is L M^-1 L.
SparseMatrix SparseSquare(const SparseMatrix& l, const Vector& masses, double s);

} // namespace SurfaceDiffusion
