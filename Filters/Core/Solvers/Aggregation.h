// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Core/Foundation/Buffer.h"
#include "Core/Foundation/Parallel.h"
#include "Core/Foundation/Reduction.h"
#include "Core/Foundation/Types.h"
#include "Core/Solvers/Aggregates.h"

#include <cstdint>
#include <memory>
#include <vector>

namespace SurfaceDiffusion
{

/// Smoothed aggregation (P. Vanek, J. Mandel, M. Brezina, Computing 56, 1996): the
/// restriction to the coarse level of a symmetric matrix, coarse x fine. Its transpose, the
/// prolongation, spans the coarse space.
///
/// An off-diagonal entry is strong if -a_ij > strength sqrt(a_ii a_jj), and joins the vertices i
/// and j as neighbours. In the order of the numbering, a vertex and its neighbours form an
/// aggregate if none of them is in one yet. This is done inside of chunks of 16384 vertices first,
/// on all threads, and then along their borders. Every vertex that is left joins the aggregate of
/// the neighbour with the strongest entry. Vertices without neighbours are left out.
///
/// The prolongation is (I - 8/9 D^-1 A') T. T is the `kernel`, a vector that the matrix nearly maps
/// to zero, cut into one column of unit norm per aggregate. A' is the strong part of A with the
/// other entries lumped to its diagonal D. So the coarse space contains the kernel.
///
/// Over processes the matrix is accumulated. The vertices of an aggregate are in the same
/// processes, and so are their rows of the prolongation: on interfaces it is T, which needs no rows
/// of other processes.
///
/// kernel, overProcesses: on entry the fine level's, on return the coarse level's; kernel:
/// consistent and positive.
SparseMatrix SmoothedAggregation(const SparseMatrix& matrix, double strength, Vector& kernel,
  std::shared_ptr<const Reduction>& overProcesses, const ParallelFor& parallel);
/// On one process.
SparseMatrix SmoothedAggregation(
  const SparseMatrix& matrix, double strength, Vector& kernel, const ParallelFor& parallel);

/// slots: where to store the slot of `matrix` that each slot of the result comes from, or null.
SparseMatrix Transposed(
  const SparseMatrix& matrix, const ParallelFor& parallel, Buffer<Index>* slots = nullptr);

/// R A P, symmetric to the rounding error. restriction: R; prolongation: P, its transpose.
SparseMatrix GalerkinProduct(const SparseMatrix& matrix, const SparseMatrix& restriction,
  const SparseMatrix& prolongation, const ParallelFor& parallel);

/// Both for one matrix after the other of the same pattern, with the aggregates and the strong
/// entries of the first: a fraction of the time.
class Coarsening
{
public:
  /// matrix: gives the aggregates. See SmoothedAggregation().
  Coarsening(const SparseMatrix& matrix, double strength, const ParallelFor& parallel);

  Index NumberOfAggregates() const { return this->Sets.Count; }

  /// Take the values of a matrix. kernel: see SmoothedAggregation().
  void SetMatrix(const SparseMatrix& matrix, Vector& kernel);

  const SparseMatrix& Restriction() const { return this->Restricting.Matrix; }
  const SparseMatrix& Prolongation() const { return this->Prolonging; }
  const SparseMatrix& Product() const { return this->Coarse.Matrix; }

private:
  struct Collected
  {
    SparseMatrix Matrix;
    std::vector<std::vector<std::uint16_t>> Places; ///< see SparseColumns.h

    template <typename Collect>
    void Set(Index rows, Index columns, const ParallelFor& parallel, const Collect& collect);
  };

  void Transpose();

  const ParallelFor& Parallel;
  Aggregates Sets;
  Collected Restricting, Half, Coarse;
  SparseMatrix Prolonging;
  Buffer<Index> Slots; ///< of the restriction, per slot of the prolongation
};

} // namespace SurfaceDiffusion
