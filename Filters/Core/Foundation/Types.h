// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <Eigen/SparseCore>

namespace SurfaceDiffusion
{

/// 32 bits: sparse matrices with 64-bit indices would double the memory traffic of indices.
using Index = int;

using Vector = Eigen::VectorXd;

/// n x k point data, one row per vertex. The k components of a vertex are adjacent in memory, so
/// that one pass over a matrix serves all of them.
using Values = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

/// n x 3 coordinates.
using Points = Eigen::Matrix<double, Eigen::Dynamic, 3, Eigen::RowMajor>;

/// m x 3 vertex numbers.
using Triangles = Eigen::Matrix<Index, Eigen::Dynamic, 3, Eigen::RowMajor>;

/// m x 3, one weight per corner of each triangle: entry (t, a) is the weight of the edge opposite
/// corner a, like the cotangent of the angle there.
using CornerWeights = Eigen::Matrix<double, Eigen::Dynamic, 3, Eigen::RowMajor>;

/// m x 2, one tangent vector per triangle, in the triangle's own axes (see TriangleMesh).
using TangentVectors = Eigen::Matrix<double, Eigen::Dynamic, 2, Eigen::RowMajor>;

/// All matrices are symmetric with both halves stored, so that rows and columns are
/// interchangeable.
using SparseMatrix = Eigen::SparseMatrix<double, Eigen::ColMajor, Index>;

/// One flag per vertex.
using Flags = Eigen::Array<bool, Eigen::Dynamic, 1>;

} // namespace SurfaceDiffusion
