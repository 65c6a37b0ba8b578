// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Core/Foundation/Parallel.h"
#include "Core/Foundation/Types.h"

#include <array>
#include <vector>

namespace SurfaceDiffusion
{

/// A curve between two regions.
struct RegionBoundary
{
  std::array<Index, 2> Regions; ///< labels 1 .. K, ascending
  std::vector<Index> Points; ///< rows of RegionBoundaries::Points; a closed curve ends as it starts
  double Length = 0.0;
};

/// The curves between the regions of a surface, in a position that does not depend on the numbering
/// of the triangles.
struct RegionBoundaries
{
  SurfaceDiffusion::Points Points;
  std::vector<RegionBoundary> Curves;
};

/// The curves on which the two largest of the u_k are equal: level lines of functions that are
/// linear on the triangles, which they cut. (For two regions with u_1 + u_2 = 1 it is the line u_1
/// = 1/2.) Where u is the relaxed solution of Segmentation, their length is that of the boundary up
/// to some percent, while the edges between vertices of different labels are too long by a tenth on
/// any mesh. In a triangle with three regions the curves meet at the point where the three u_k are
/// equal. With more, they meet at the mean of the places where they enter. Curves end at such
/// junctions, at the boundary of the surface, and at edges of three or more triangles.
///
/// points: coordinates; triangles: rows of points; u: a row per point, and one column per region.
RegionBoundaries FindRegionBoundaries(const Eigen::Ref<const Points>& points,
  const Eigen::Ref<const Triangles>& triangles, const Eigen::Ref<const Values>& u);

/// Per region the integral over the part of the surface where its u_k is the largest, of a weight
/// that is linear on triangles: with the weight 1 its area. Where several are the largest, the
/// first of them counts. weights: a row per point, or none for 1.
Vector RegionAreas(const Eigen::Ref<const Points>& points,
  const Eigen::Ref<const Triangles>& triangles, const Eigen::Ref<const Values>& u,
  const Eigen::Ref<const Vector>& weights, const ParallelFor& parallel = SerialFor());

/// Per region the number of its connected components: of points of its label that edges connect.
/// labels: 1 .. K per point, 0 at points of no triangle.
std::vector<Index> CountRegionComponents(
  const Eigen::Ref<const Triangles>& triangles, const std::vector<Index>& labels, Index regions);

} // namespace SurfaceDiffusion
