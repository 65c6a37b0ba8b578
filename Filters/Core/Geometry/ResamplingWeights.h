// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Core/Foundation/Parallel.h"
#include "Core/Foundation/ProgressMonitor.h"
#include "Core/Foundation/Types.h"

namespace SurfaceDiffusion
{

/// Weights by rows: row t has those of target vertex t, column s is source vertex s. Columns ascend in
/// each row, and no weight is 0.
using RowMatrix = Eigen::SparseMatrix<double, Eigen::RowMajor, Index>;

enum class ResamplingMethod
{
  /// The linear interpolation in the triangle of the source that a vertex of the target lies in.
  Barycentric,
  /// AdaptiveAreaWeights().
  AdaptiveBarycentricArea,
};

/// A sphere with the areas A of its vertices: any positive multiple of them gives the same weights.
struct AreaSphere
{
  Points Vertices; ///< at distance 1 from the origin; others are moved there
  Triangles Faces;
  Vector Areas; ///< 0 or more
};

/// F: row t has the barycentric coordinates of the point of the source's triangles that is nearest to
/// target vertex t. Both spheres have radius 1.
RowMatrix BarycentricWeights(const Points& target, const Points& source, const Triangles& faces,
  const ParallelFor& parallel, const ProgressMonitor& progress);

/// Weights that use each value of the source, however coarse the target is, and keep the integral:
///
///     W_ts = A_s B_ts A_t / sum over t' of B_t's A_t',    sum over t of W_ts = A_s,
///
/// where row t of B is that of F (forward) if G_ts is 0 wherever F_ts is 0, and that of G otherwise. G
/// is the transpose of `reverse`, the weights F of the source's vertices in the target's triangles,
/// without those of the area 0, which take no part. A target vertex of the area 0 has an empty row.
/// This is ADAP_BARY_AREA of Connectome Workbench (Marcus et al., Informatics and data mining tools
/// and strategies for the Human Connectome Project, Front. Neuroinform. 5, 2011).
RowMatrix AdaptiveAreaWeights(const RowMatrix& forward, const RowMatrix& reverse,
  const Vector& sourceAreas, const Vector& targetAreas);

/// The weights of the method, without the columns that are left out, divided by the sums of their
/// rows. A row without weight stays empty. isLeftOut: per source vertex; may be empty.
RowMatrix ResamplingWeights(ResamplingMethod method, AreaSphere source, AreaSphere target,
  const Flags& isLeftOut, const ParallelFor& parallel, const ProgressMonitor& progress);

} // namespace SurfaceDiffusion
