// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Core/Geometry/FaceGraph.h"

namespace SurfaceDiffusion
{

/// The kind of surface that the normals are filtered for.
enum class SurfaceKind
{
  Sharp, ///< smooth faces that meet in sharp edges, as CAD models
  Smooth ///< organic shapes, scans
};

struct NormalFilterSettings
{
  SurfaceKind Kind = SurfaceKind::Sharp; ///< of the guide
  double Range = 0.35; ///< differences of unit normals that count as one surface
  double Width = 1.0; ///< of the spatial weight, in mean distances between neighbouring triangles
  double Fidelity = 0.1; ///< weight of the normals that are filtered
  int Sweeps = 3;
};

/// The guide of a filter of normals: one unit vector per triangle that is less noisy than the
/// normals but not blurred over sharp edges.
///
/// For sharp surfaces it is that of guided normal filtering (W. Zhang, B. Deng, J. Zhang, S.
/// Bouaziz, L. Liu, Guided Mesh Normal Filtering, Computer Graphics Forum 34(7), 2015): of the
/// patches that contain the triangle, each a triangle with those that share a vertex with it, the
/// one with the most consistent normals is chosen, and the guide is its area-weighted mean normal.
/// For smooth surfaces it is the mean normal over the patch of the triangle itself with narrow
/// spatial weights.
Points MakeGuide(const FaceGraph& graph, const FaceGeometry& geometry,
  const NormalFilterSettings& settings, const ParallelFor& parallel);

/// The weights w_fg of FilterNormals(), in the order of graph.Ring.Entries.
Vector NeighbourWeights(const FaceGraph& graph, const FaceGeometry& geometry, const Points& guide,
  const NormalFilterSettings& settings, const ParallelFor& parallel);

/// Filters the normals n0 of the triangles: the robust regularisation of unit normals over the
/// triangles that share a vertex,
///
///   E(n) = sum_{f,g} a_f a_g w_fg rho(|n_f - n_g|) + mu sum_f a_f^2 |n_f - n0_f|^2,   |n_f| = 1,
///
/// with the areas a, the weights w_fg = exp(-|c_f - c_g|^2 / (2 s^2) - |m_f - m_g|^2 / (2 r^2)) of
/// the centroids c and the guide m, and the saturating penalty rho(d) = 1 - exp(-d^2 / (2 r^2))
/// (static/dynamic filtering: J. Zhang, B. Deng, Y. Hong, Y. Peng, W. Qin, L. Liu, TVCG 25(4),
/// 2019). Each sweep majorises the penalty and sets each normal to the direction of the weighted
/// sum of its neighbours.
Points FilterNormals(const FaceGraph& graph, const FaceGeometry& geometry, const Points& guide,
  const NormalFilterSettings& settings, const ParallelFor& parallel);

} // namespace SurfaceDiffusion
