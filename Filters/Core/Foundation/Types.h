// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <Eigen/SparseCore>

namespace SurfaceDiffusion
{

using Index = int; // 32-bit indices: half the memory traffic of every sparse product

using Vector = Eigen::VectorXd;

/// n x k point data, one row per vertex: the k components of a vertex lie side by side, so that
/// one pass over a matrix serves all of them.
using Values = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

/// n x 3 coordinates.
using Points = Eigen::Matrix<double, Eigen::Dynamic, 3, Eigen::RowMajor>;

/// m x 3 vertex numbers.
using Triangles = Eigen::Matrix<Index, Eigen::Dynamic, 3, Eigen::RowMajor>;

/// m x 3, one value per edge of each triangle; entry (t, a) belongs to the edge opposite corner a.
using CornerWeights = Eigen::Matrix<double, Eigen::Dynamic, 3, Eigen::RowMajor>;

/// m x 2, one plane vector per triangle, in the triangle's own axes (see TriangleMesh).
using TangentVectors = Eigen::Matrix<double, Eigen::Dynamic, 2, Eigen::RowMajor>;

/// All matrices here are symmetric and stored whole, so rows and columns are interchangeable.
using SparseMatrix = Eigen::SparseMatrix<double, Eigen::ColMajor, Index>;

/// One flag per vertex.
using Flags = Eigen::Array<bool, Eigen::Dynamic, 1>;

} // namespace SurfaceDiffusion
