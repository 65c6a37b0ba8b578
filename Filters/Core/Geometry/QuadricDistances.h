// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Core/Surface/TriangleMesh.h"

#include <vector>

namespace SurfaceDiffusion
{

/// The deviation of normally distributed numbers whose absolute values these are by their 0.95 quantile,
/// over that by their 0.3 quantile; infinite if the latter is 0. Reorders them.
double TailOfNormal(std::vector<double>& values);

/// How far a vertex is from the quadric z = a + b s + c t + d s^2 + e s t + f t^2 through its
/// neighbours, without the vertex itself.
struct QuadricDistance
{
  /// The distance over sqrt(1 + l), l the leverage of the fit; negative with fewer than nine
  /// neighbours, or l > 2.
  double Standardized = -1.0;
  double Radius = 0.0; ///< the deviation of the neighbours along their second axis
};

/// The standard deviation of normally distributed numbers whose absolute values these are: by their
/// 0.3 quantile, so that edges and outliers hardly matter, and by their 0.95 quantile.
struct Deviation
{
  double Sigma;
  double Tail;
  bool IsOfEnough; ///< 30 % of the vertices and more have a distance
};

/// Negative distances are left out.
Deviation DeviationOf(std::vector<double>& distances);

/// Every so many vertices are used to have about `enough` of them.
Index StrideFor(const TriangleMesh& mesh, Index enough);

/// The number of vertices that suffices where many rings of neighbours are measured around each.
constexpr Index EnoughWideNeighbourhoods = 1000;

/// Per number of rings of neighbours, ascending, of every vertex with the stride.
std::vector<std::vector<QuadricDistance>> MeasureDistances(const TriangleMesh& mesh,
  const Points& points, const std::vector<int>& rings, Index stride, const ParallelFor& parallel);

std::vector<double> Standardized(const std::vector<QuadricDistance>& distances);

/// sigma_r per number of rings r.
std::vector<Deviation> MeasureDeviations(const TriangleMesh& mesh, const Points& points,
  const std::vector<int>& rings, Index stride, const ParallelFor& parallel);

} // namespace SurfaceDiffusion
