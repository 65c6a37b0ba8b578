// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Core/Foundation/Parallel.h"
#include "Core/Foundation/Types.h"

namespace SurfaceDiffusion
{

/// Smoothed aggregation (P. Vanek, J. Mandel, M. Brezina, Computing 56, 1996): the
/// restriction to the coarse level of a symmetric matrix, coarse x fine. Its transpose, the
/// prolongation, spans the coarse space.
///
/// Off-diagonal entries are strong where -a_ij > strength sqrt(a_ii a_jj). Vertices joined by
/// strong entries form aggregates, in the order of the numbering: a vertex with its neighbours
/// where none is taken, then what is left joins the neighbour it is joined to most strongly. On
/// each the `kernel` is kept, a vector that the matrix nearly maps to zero: (I - 8/9 D^-1 A') T,
/// where T is the kernel cut into aggregates of unit norm and A' with its diagonal D the strong
/// part of A, the rest lumped to its diagonal. Rows without strong entries are left out.
///
/// kernel: on entry the fine level's, on return the coarse level's, all positive.
SparseMatrix SmoothedAggregation(
  const SparseMatrix& matrix, double strength, Vector& kernel, const ParallelFor& parallel);

/// R A P, symmetric to the rounding error. restriction: R; prolongation: P, its transpose.
SparseMatrix GalerkinProduct(const SparseMatrix& matrix, const SparseMatrix& restriction,
  const SparseMatrix& prolongation, const ParallelFor& parallel);

} // namespace SurfaceDiffusion
