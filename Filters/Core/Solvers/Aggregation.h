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
/// An off-diagonal entry is strong if -a_ij > strength sqrt(a_ii a_jj), and joins the vertices i
/// and j as neighbours. In the order of the numbering, a vertex and its neighbours form an
/// aggregate if none of them is in one yet. Every vertex that is left joins the aggregate of the
/// neighbour with the strongest entry. Vertices without neighbours are left out.
///
/// The prolongation is (I - 8/9 D^-1 A') T. T is the `kernel`, a vector that the matrix nearly maps
/// to zero, cut into one column of unit norm per aggregate. A' is the strong part of A with the
/// other entries lumped to its diagonal D. So the coarse space contains the kernel.
///
/// kernel: on entry the fine level's, on return the coarse level's, all positive.
SparseMatrix SmoothedAggregation(
  const SparseMatrix& matrix, double strength, Vector& kernel, const ParallelFor& parallel);

/// R A P, symmetric to the rounding error. restriction: R; prolongation: P, its transpose.
SparseMatrix GalerkinProduct(const SparseMatrix& matrix, const SparseMatrix& restriction,
  const SparseMatrix& prolongation, const ParallelFor& parallel);

} // namespace SurfaceDiffusion
