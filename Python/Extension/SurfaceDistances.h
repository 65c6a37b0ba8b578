// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Core/Geodesics/GeodesicDistance.h"
#include "Core/Geodesics/HeatDistance.h"
#include "Core/Geodesics/SourcePiece.h"
#include "InputData.h"

#include <memory>
#include <optional>
#include <vector>

namespace SurfaceDiffusion
{

/// Distances or arrival times on a surface as arrays of Python, in coordinate units over those of speed.
///
/// Sources are rows of points or, with barycentric coordinates (k x 3), rows of triangles of the input
/// and places in them.
class SurfaceDistances
{
public:
  /// slowness: per face, above 0 or infinite; may be none. directions: per point or face, with
  /// factors of the speed along and across them; may be none. Without speeds and with factors 1, ways
  /// are those on the intrinsic Delaunay triangulation.
  SurfaceDistances(std::shared_ptr<const InputSurface> surface,
    const std::optional<FlagArray>& mask, bool maskOnFaces,
    const std::optional<FactorArray>& slowness, const std::optional<DoubleArray>& directions,
    bool directionsOnFaces, double along, double across, const nanobind::object& progress);

  const SurfaceDiagnostics& Diagnostics() const { return this->Built->Diagnostics(); }

  /// Whether a triangle that takes part uses the point, or that triangle of the input takes part.
  bool HasPoint(std::int64_t point) const
  {
    return this->Built->VertexOf(static_cast<Index>(point)) >= 0;
  }
  bool HasTriangle(std::int64_t row) const;

  /// The triangles (k) and barycentric coordinates (k x 3) of the nearest places of the surface to
  /// points (k x 3); -1 for those nearest to triangles that take no part. Then a sentence if half of
  /// the points are far away.
  nanobind::tuple Project(const DoubleArray& points, const nanobind::object& progress) const;

  /// The times (n) from sources with start times, and the row of the source that each point is
  /// reached from (n): infinite and -1 where none arrives. apart: fronts of different sources do not
  /// mix, so that the row is that of the smallest time of one source alone.
  nanobind::tuple FromAll(const LongArray& rows, const std::optional<DoubleArray>& barycentric,
    const FactorArray& starts, bool apart, const nanobind::object& progress) const;

  /// The distances (n) from sources by the heat method, without speeds. Its factors are kept.
  nanobind::object ByHeat(const LongArray& rows, const std::optional<DoubleArray>& barycentric,
    const nanobind::object& progress);

  /// data, indices and indptr of the times up to the cutoff from each of the points, one row each.
  nanobind::tuple FromEach(
    const LongArray& points, double cutoff, const nanobind::object& progress) const;

private:
  SourcePiece PieceOf(const LongArray& rows, const DoubleArray& barycentric, std::size_t k) const;

  std::shared_ptr<const InputSurface> Input;
  Located<std::optional<FlagArray>> Mask;
  std::unique_ptr<const Surface> Built;
  std::vector<Index> MeshTriangles; ///< per triangle of the input, that of InputMesh(); -1: none
  FrontShapes Shapes; ///< of InputMesh(); empty: its own
  std::unique_ptr<const GeodesicDistance> Fronts;
  std::unique_ptr<const HeatDistance> Heat;
};

} // namespace SurfaceDiffusion
