// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Core/Geodesics/GeodesicDistance.h"
#include "Core/Geodesics/HeatDistance.h"

#include <array>
#include <vector>

namespace SurfaceDiffusion
{

/// A place within a triangle.
struct MeshPlace
{
  Index Triangle;
  std::array<double, 3> At; ///< barycentric coordinates
};

/// A straight piece of a source within a triangle: a part of a line, or a point.
struct SourcePiece
{
  Index Triangle = 0;
  /// The barycentric coordinates of its ends, which are equal for a point.
  std::array<double, 3> From = { 0.0, 0.0, 0.0 }, To = { 0.0, 0.0, 0.0 };
  /// The numbers of the points of the source that the ends are; -1: they are none.
  Index FromPoint = -1, ToPoint = -1;
  Index Label = 0;
};

/// Append the fronts of a piece: the vertices of its triangle, at their straight distances from it in
/// the triangle as fronts measure it. Where that is the shape of the mesh (`shapes` is empty), also the
/// vertices that a straight way reaches over up to three more triangles, laid out side by side: on an
/// intrinsic Delaunay triangulation of the same surface the piece may lie in a triangle with any of
/// these vertices. Vertices that are nearest to
/// a point of the source have its number, others numbers from nextPoint on, which becomes one more
/// for each.
void AppendFronts(const TriangleMesh& mesh, const FrontShapes& shapes, const SourcePiece& piece,
  Index& nextPoint, std::vector<FrontSource>& fronts);

/// The same for heat, at the vertices of the triangle. Their shares are the barycentric coordinates
/// of the place of the piece that is nearest to them.
void AppendHeat(
  const TriangleMesh& mesh, const SourcePiece& piece, std::vector<HeatSource>& sources);

} // namespace SurfaceDiffusion
