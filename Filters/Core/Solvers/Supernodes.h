// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Core/Foundation/Types.h"

#include <cstddef>
#include <vector>

namespace SurfaceDiffusion
{

/// The structure of the Cholesky factor L of a symmetric matrix in a given order: its columns are
/// grouped to supernodes, columns that follow each other and have the same rows below them. A child
/// with few columns joins its parent, with zeros in the factor, if these are few (C. Ashcraft,
/// R. Grimes, ACM Trans. Math. Softw. 15, 1989). All numbers of rows are places in the order.
struct Supernodes
{
  /// order: the place of every row, which is refined to a postorder of the elimination tree.
  Supernodes(const SparseMatrix& matrix, std::vector<Index> order);
  Supernodes() = default;

  Index Count() const { return static_cast<Index>(this->Parent.size()); }
  Index Pivots(Index s) const { return this->First[s + 1] - this->First[s]; }
  Index RowsBelow(Index s) const
  {
    return static_cast<Index>(this->RowsBegin[s + 1] - this->RowsBegin[s]);
  }
  const Index* Below(Index s) const { return this->Rows.data() + this->RowsBegin[s]; }

  std::vector<Index> Place; ///< per row of the matrix
  std::vector<Index> RowAt; ///< its inverse
  std::vector<Index> First; ///< the first column of every supernode, and the number of columns
  std::vector<std::size_t> RowsBegin;
  std::vector<Index> Rows; ///< below the pivots of each supernode, ascending
  std::vector<Index> Parent; ///< -1: a root. Parents come after their children.
  std::vector<Index> ChildrenBegin, Children;
  std::vector<Index> FirstDescendant; ///< supernodes from it to s are the subtree of s
  std::vector<double> Operations; ///< products of the factorisation, of each supernode
};

/// An order of the rows with a sparse factor: by approximate minimum degree, or by nested
/// dissection if it takes fewer operations. That is tried if the vertices of the mesh are regular
/// and minimum degree takes more operations than 20 n^1.5.
Supernodes OrderedSupernodes(const SparseMatrix& matrix, bool isRegular);

} // namespace SurfaceDiffusion
