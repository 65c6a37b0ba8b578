// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Core/Surface/TriangleMesh.h"

#include <memory>
#include <vector>

namespace SurfaceDiffusion
{

/// Turns coefficients per triangle into the matrices of (8), (11) and (14): what is left of the
/// integrals of an equation over the control cells (5). The pattern and the map
/// from triangles to its slots are made once; filling in values is then one pass over the
/// triangles, gathered row by row: no two threads write one entry, the order of every sum is fixed,
/// and the matrix is symmetric to the last bit.
class Assembler
{
public:
  explicit Assembler(std::shared_ptr<const TriangleMesh> mesh,
    const ParallelFor& parallel = SerialFor(),
    const ProgressMonitor& progress = ProgressMonitor());

  const TriangleMesh& Mesh() const { return *this->Surface; }
  std::shared_ptr<const TriangleMesh> SharedMesh() const { return this->Surface; }

  /// A matrix of the pattern, all zero: a vertex and its neighbours, sorted.
  const SparseMatrix& Pattern() const { return this->Empty; }

  /// matrix = diag(d) + scale K, with (K u)_i = -sum over triangles and j of c_ij u_j (6), rows
  /// summing to zero: (7) and (9), (12) summed over the triangles of D_1(i). `matrix` is a copy of
  /// Pattern(); weights, one per triangle, multiply the coefficients (g of (9)); none means 1.
  /// signs, +1 or -1, multiply those off the diagonal, for fields whose neighbours are compared up
  /// to the sign: the rows of K then give sum of c_ij (u_i - sign_ij u_j).
  void Fill(SparseMatrix& matrix, const Eigen::Ref<const Vector>& diagonal, double scale,
    const CornerWeights& coefficients, const double* weights = nullptr,
    const ParallelFor& parallel = SerialFor(), const CornerWeights* signs = nullptr) const;

  /// Make `fixed` vertices known: their rows keep only the diagonal and their columns are taken
  /// out. load is what this adds to the right-hand side: -sum over fixed j of a_ij values_j in free
  /// rows, and in fixed rows a_ii values_i, which stands alone there. The matrix stays symmetric
  /// positive definite. load: n x k.
  void Constrain(SparseMatrix& matrix, const Flags& fixed, const Values& values, Values& load,
    const ParallelFor& parallel = SerialFor()) const;

private:
  std::shared_ptr<const TriangleMesh> Surface;
  SparseMatrix Empty;
  struct Slots
  {
    Index Next, Last; ///< where a corner's row keeps the triangle's next and last vertex
  };
  std::vector<Slots> SlotMap; ///< in the order of TriangleMesh::VertexCorners()
  std::vector<Index> DiagonalSlot; ///< per row
};

/// y = matrix x for all columns of x at once. y must not be x.
void Multiply(const SparseMatrix& matrix, const Values& x, Values& y,
  const ParallelFor& parallel = SerialFor());

} // namespace SurfaceDiffusion
