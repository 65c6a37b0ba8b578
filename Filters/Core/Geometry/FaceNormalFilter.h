// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Core/Geometry/FaceGraph.h"

#include <vector>

namespace SurfaceDiffusion
{

struct NormalFilterSettings
{
  double Range = 0.35; ///< differences of unit normals that count as one surface
  double Width = 1.0; ///< of the spatial weight, in mean distances between neighbouring triangles
};

/// The guide of a filter of normals: per triangle the mean normal of those that share a vertex with
/// it, with narrow spatial weights, which is less noisy than its own but hardly blurred over sharp
/// edges. All filters need the widths of the geometry.
Points MakeGuide(const FaceGraph& graph, const FaceGeometry& geometry,
  const NormalFilterSettings& settings, const ParallelFor& parallel);

/// The weights w_fg of FilterNormals().
class NeighbourWeights
{
public:
  NeighbourWeights(const FaceGraph& graph, const FaceGeometry& geometry, const Points& guide,
    const NormalFilterSettings& settings);

  /// Those of triangle f, in the order of its list in graph.Ring.
  void Find(Index f, std::vector<double>& weights) const;

private:
  const FaceGraph& Graph;
  const FaceGeometry& Geometry;
  const Points& Guide;
  const double DistanceFactor; ///< 1 / (2 Width^2)
  const double RangeFactor; ///< 1 / (2 Range^2)
};

/// Filters the normals n_f of the triangles: the joint bilateral filter over the triangles that
/// share a vertex (W. Zhang, B. Deng, J. Zhang, S. Bouaziz, L. Liu, Guided Mesh Normal Filtering,
/// Computer Graphics Forum 34(7), 2015). The result is the direction of
///
///   a_f n_f + sum_g a_g w_fg n_g,
///
/// with the areas a and the weights w_fg = exp(-|c_f - c_g|^2 / (2 s^2) - |m_f - m_g|^2 / (2 r^2))
/// of the centroids c and the guide m. s is the Width and r the Range of the settings.
Points FilterNormals(const FaceGraph& graph, const FaceGeometry& geometry, const Points& guide,
  const NormalFilterSettings& settings, const ParallelFor& parallel);

} // namespace SurfaceDiffusion
