// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Core/Surface/TriangleMesh.h"

namespace SurfaceDiffusion
{

/// The Hessian energy of a function u of linear elements,
///   int |Hessian u|^2 + kappa |grad u|^2 = u^T G^T E G u
/// with the Gaussian curvature kappa (O. Stein, A. Jacobson, M. Wardetzky, E. Grinspun, A Smoothness
/// Energy without Boundary Distortion for Curved Surfaces, ACM Trans. Graph. 39, 2020). G takes the
/// gradients to Crouzeix-Raviart elements, which have a tangent vector at the middle of each edge:
/// the mean over the triangles of the edge, in the axes along and across it. E is the vector
/// Dirichlet energy of these elements, and the angle defects of inner vertices in the corners of
/// their triangles.
///
/// Where three or more triangles meet in an edge, the slopes across it, each into its own triangle,
/// are those nearest to the gradients, with the areas as weights, whose sum is 0: for two triangles
/// that is the mean.
struct HessianEnergy
{
  /// withNegativeCurvature: as in the equation. On coarse meshes of surfaces with saddles, as in
  /// handles, E may then be indefinite; without negative angle defects it is not.
  explicit HessianEnergy(const TriangleMesh& mesh, bool withNegativeCurvature = true);

  /// If edges of many triangles let G^T E G have more entries than 400 per vertex, of which an even mesh
  /// has 49, and `more`, the number of triangles of the edge with the most, otherwise 0.
  static Index TooManyTriangles(const TriangleMesh& mesh, double more);

  SparseMatrix Gradient; ///< G, 2 per edge and 1 per triangle of an edge of three or more x n
  SparseMatrix Energy; ///< E
};

} // namespace SurfaceDiffusion
