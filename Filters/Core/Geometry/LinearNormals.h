// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Core/Geometry/FaceNormalFilter.h"

namespace SurfaceDiffusion
{

/// The normals of the triangles as the guide of FitLinearNormals(), without the outliers among
/// them: the normal of a triangle that few of its neighbours support, by area, is replaced by that
/// of the neighbour across an edge with the most support. The support of f is the mean of
/// exp(-|n_f - n_g|^2 / (2 r^2)) over the triangles g that share a vertex with it, r the Range of
/// the settings. Such are slivers and folded triangles, whose normals noise turns most. (Vector
/// median filters remove outliers in the same manner: H. Yagou, Y. Ohtake, A. Belyaev, Mesh
/// Smoothing via Mean and Median Filtering Applied to Face Normals, GMP 2002.)
Points ReplaceUnsupportedNormals(const FaceGraph& graph, const FaceGeometry& geometry,
  const NormalFilterSettings& settings, const ParallelFor& parallel);

/// Second-order filter of the normals: for each triangle f, the normals n_g of the triangles that
/// share a vertex with it are fitted by a linear function of the centroids c_g in the plane
/// orthogonal to the guide m_f,
///
///   min over n, G of  sum_g a_g w_fg |n + G P_f (c_g - c_f) - n_g|^2
///     + e tr(sum_g a_g w_fg P_f (c_g - c_f) (c_g - c_f)^T P_f^T) |G|^2,
///
/// with the areas a, the weights w of FilterNormals(), those of f itself included, and e = 0.05.
/// The result is the direction of n. A mean of normals is right where normals are constant, and in
/// the interior of curved regions. At their edges it is one-sided and flattens them, which a linear
/// function does not: it plays the part of the second order in the total generalized variation of
/// normals (Z. Liu, Y. Li, W. Wang, L. Liu, R. Chen, Mesh Total Generalized Variation for
/// Denoising, TVCG 28(12), 2022), as a local regression (W. Cleveland, Robust Locally Weighted
/// Regression, JASA 74, 1979).
Points FitLinearNormals(const FaceGraph& graph, const FaceGeometry& geometry, const Points& guide,
  const NormalFilterSettings& settings, const ParallelFor& parallel);

} // namespace SurfaceDiffusion
