// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Core/Surface/TriangleMesh.h"

#include <array>
#include <vector>

namespace SurfaceDiffusion
{

/// A point of a surface: barycentric coordinates, which add up to 1, and the vertices they belong
/// to. Vertices with the coordinate 0 do not count.
struct SurfacePoint
{
  std::array<Index, 3> Vertices = { 0, 0, 0 };
  std::array<double, 3> Coordinates = { 1.0, 0.0, 0.0 };

  static SurfacePoint AtVertex(Index i) { return { { i, i, i }, { 1.0, 0.0, 0.0 } }; }
  /// The vertex that the point is at, or -1.
  Index Vertex() const;
};

/// Values d at points of a surface with weights w, all finite: d.row(i) at Places[i].
struct ScatteredValues
{
  std::vector<SurfacePoint> Places;
  Values Given; ///< d, one row per point
  Vector Weights; ///< w > 0, one per point

  Index Count() const { return static_cast<Index>(this->Places.size()); }

  /// u at the places, d x k, of a function with values at the vertices.
  Values AtPlaces(const Values& u) const;

  /// The values at vertices where `known` says so, with weights 1.
  static ScatteredValues AtVertices(const Values& f, const Flags& known);
};

/// The values with one row for all that have the same place: the weighted mean of their values with
/// the sum of their weights, which have the same fit. A place is the same if no barycentric
/// coordinate differs by more than the tolerance, that is within about 1e-4 of an edge: values so
/// near that differ make the system all but singular.
struct MergedValues
{
  static constexpr double Tolerance = 1e-4;

  explicit MergedValues(const ScatteredValues& given);

  ScatteredValues Rows;
  std::vector<Index> RowOf; ///< per given value
  Index Repeated = 0; ///< rows of the given values that joined another one
  Index Contradicting = 0; ///< places whose values differ
};

} // namespace SurfaceDiffusion
