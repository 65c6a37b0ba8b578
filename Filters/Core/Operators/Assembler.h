// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Core/Operators/SparsePattern.h"
#include "Core/Surface/TriangleMesh.h"

#include <cstdint>
#include <memory>
#include <vector>

namespace SurfaceDiffusion
{

/// Assembles the matrices of a diffusion equation on a triangulated surface, diag(d) + s K: a
/// multiple of the lumped mass matrix M = diag(A_i), whose entries are the areas of the control
/// cells, and the stiffness matrix K. With cotan weights K is the cotan Laplacian, and -M^-1 K the
/// discrete Laplace-Beltrami operator. This is the finite-volume discretisation (5) of the paper,
/// (8), (11) and (14), and the same as that by linear finite elements.
///
/// The lengths of the rows and the map from triangles to the entries of the matrix are made once.
/// Assembling is then one pass over the triangles, gathered row by row: no two threads write one
/// entry, the order of every sum is fixed, and the matrix is symmetric to the last bit.
class Assembler
{
public:
  explicit Assembler(std::shared_ptr<const TriangleMesh> mesh,
    const ParallelFor& parallel = SerialFor(), const ProgressMonitor& progress = ProgressMonitor());

  const TriangleMesh& Mesh() const { return *this->SurfaceMesh; }
  std::shared_ptr<const TriangleMesh> SharedMesh() const { return this->SurfaceMesh; }

  /// In each row, a vertex and its neighbours. Every call computes the pattern, because storing it
  /// would duplicate the column indices of the matrices, 28 bytes per vertex.
  SparsePattern Pattern(const ParallelFor& parallel = SerialFor()) const;
  /// Give `matrix` the pattern and leave its values to be filled in.
  void TakePattern(SparseMatrix& matrix, const ParallelFor& parallel) const;

  /// matrix = diag(d) + scale K with the stiffness matrix K,
  ///   (K u)_i = sum over the triangles at vertex i and their corners j of c_ij (u_i - u_j),
  /// (6), (7), (9), (12). coefficients: c as in CotanWeights.h. `matrix` has the Pattern().
  /// weights, one per triangle, multiply the coefficients (g of (9)); none means 1. signs, +1 or
  /// -1, are for fields whose neighbours are compared up to the sign: the rows of K then give the
  /// sum of c_ij (u_i - sign_ij u_j).
  void Fill(SparseMatrix& matrix, const Eigen::Ref<const Vector>& diagonal, double scale,
    const CornerWeights& coefficients, const double* weights = nullptr,
    const ParallelFor& parallel = SerialFor(), const CornerWeights* signs = nullptr) const;

  /// Replace the diagonal of a matrix of the pattern.
  void SetDiagonal(
    SparseMatrix& matrix, const Vector& diagonal, const ParallelFor& parallel = SerialFor()) const;

  /// Impose Dirichlet conditions u = values at `fixed` vertices: their rows keep only the diagonal
  /// and their columns are eliminated, so that the matrix stays symmetric positive definite. load,
  /// n x k, is the term of the right-hand side: the sum over fixed j of -a_ij values_j in free
  /// rows, and a_ii values_i in fixed rows, whose right-hand side it replaces.
  void Constrain(SparseMatrix& matrix, const Flags& fixed, const Values& values, Values& load,
    const ParallelFor& parallel = SerialFor()) const;

private:
  void ListColumns(Index* inner, const ParallelFor& parallel) const;
  bool IsMapped(Index row) const
  {
    return this->RowsBegin[row + 1] - this->RowsBegin[row] <= LongestMappedRow;
  }
  Index DiagonalSlot(Index row, const Index* inner) const;

  std::shared_ptr<const TriangleMesh> SurfaceMesh;
  std::vector<Index> RowsBegin; ///< the first entry of each row, and their end
  /// The entries of the triangle's next and last vertex in a corner's row, counted from the start
  /// of the row. Those of rows that are too long for that are searched.
  struct Slots
  {
    std::uint8_t Next, Last;
  };
  static constexpr Index LongestMappedRow = 256;
  Buffer<Slots> SlotMap; ///< in the order of TriangleMesh::VertexCorners()
  Buffer<std::uint8_t> DiagonalSlots; ///< per row, likewise
};

/// y = matrix x for all columns of x at once. y must not be x.
void Multiply(const SparseMatrix& matrix, const Values& x, Values& y,
  const ParallelFor& parallel = SerialFor());

} // namespace SurfaceDiffusion
