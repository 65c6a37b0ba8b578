// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Core/Foundation/ProgressMonitor.h"
#include "Core/Surface/TriangleMesh.h"

namespace SurfaceDiffusion
{

struct NormalFitSettings
{
  double Fidelity = 0.05; ///< weight of the given points along the normal
  double TangentialFidelity = 0.5; ///< the same across the normal; not below Fidelity
  /// Displacements along the normal up to this length count as Gaussian noise, larger ones as
  /// outliers, whose weight falls with the displacement (Huber). In the unit of the points.
  double OutlierDistance = 0.0; ///< 0: no outliers
  Vector FidelityFactors; ///< of Fidelity, per vertex; no entries: 1
  int MaximumNumberOfIterations = 30;
};

/// Move the vertices of a surface so that its triangles become orthogonal to given normals, near
/// the given points x0. x minimises
///
///   sum_f 1/3 sum_{edges (i, j) of f} (n_f . (x_i - x_j))^2
///     + sum_i l_i (N_i . (x_i - x0_i))^2 + t_i |P_i (x_i - x0_i)|^2,
///
/// with the vertex normals N, the tangential projections P = I - N N^T, and the weights l and t of
/// the settings. Every edge counts alike, since noise of vertices does not depend on the size of
/// triangles. The minimum is approached by conjugate gradients with a block Jacobi preconditioner,
/// each of whose iterations lowers the energy. `points` is the start, and the result.
///
/// fixed: per vertex, nonzero for vertices that stay; may be empty. Throws Aborted.
void FitToNormals(const TriangleMesh& mesh, const Points& given, const Points& normals,
  const std::vector<char>& fixed, const NormalFitSettings& settings, Points& points,
  const ParallelFor& parallel = SerialFor(), const ProgressMonitor& progress = ProgressMonitor());

} // namespace SurfaceDiffusion
