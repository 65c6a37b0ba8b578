// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Core/Foundation/ProgressMonitor.h"
#include "Core/Foundation/Types.h"

#include <array>
#include <vector>

namespace SurfaceDiffusion
{

/// A surface whose long edges were bisected, and where its parts come from.
struct RefinedSurface
{
  Points Vertices; ///< first the given ones, then one per bisection
  Triangles Faces;
  /// The given triangle that each triangle lies in.
  std::vector<Index> InputTriangle;
  /// Vertex n + k, with n given vertices, is the middle of two vertices of lower numbers.
  std::vector<std::array<Index, 2>> Parents;
  /// Of the edges; 0 if there is no triangle. Above the given length if the limit of triangles was
  /// reached.
  double LongestEdge = 0.0;
  bool LimitReached = false;
};

/// Bisect edges longer than `length` until none is left, or until one more bisection would make
/// more than `maximumTriangles` triangles. The shape of the surface does not change: vertices stay,
/// and new ones are on edges.
///
/// The longest edge of the surface is always bisected next, in all its triangles at once, however
/// many they are. So it is the longest edge of each of them, no vertex ever lies within an edge of
/// another triangle, and the smallest angle of a triangle is at least half of that of the triangle
/// that it was cut from (I. G. Rosenberg, F. Stenger, A lower bound on the angles of triangles
/// constructed by bisecting the longest side, Mathematics of Computation 29(130), 1975). Edges of
/// equal length are taken by the places of their middles and ends, so that the numbering of
/// vertices and triangles does not matter unless vertices coincide.
///
/// points: finite coordinates. Triangles that have a vertex twice are left out. Throws Aborted.
RefinedSurface RefineEdges(const Points& points, const Triangles& triangles, double length,
  Index maximumTriangles, const ProgressMonitor& progress = ProgressMonitor());

/// What values of points mean where a point is added between two.
enum class PointRole
{
  Data, ///< the mean of both; of integers the rounded mean, and of labels, which are single, the smaller
  Mask, ///< what is between a masked point (not 0) and another one is masked
  Weight, ///< what is beside a point of weight 0 has weight 0
  Mark ///< the smaller of two marks, and none (0) beside a point without one
};

/// The value at the middle of two points. isSingle: there is one value for each point.
double ValueBetween(PointRole role, bool areIntegers, bool isSingle, double a, double b);

/// Rows at the vertices of a refined surface, from those at the given vertices: the mean of both
/// parents.
Values InterpolateAtVertices(const RefinedSurface& refined, const Eigen::Ref<const Values>& input);

} // namespace SurfaceDiffusion
