// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Core/Geodesics/GeodesicDistance.h"
#include "Core/Geodesics/HeatDistance.h"
#include "InputData.h"

#include <memory>
#include <optional>

namespace SurfaceDiffusion
{

/// Distances or arrival times on a surface as arrays of Python, in coordinate units times slowness.
class SurfaceDistances
{
public:
  /// slowness: per face, above 0 or infinite; none: 1, and ways on the intrinsic Delaunay
  /// triangulation.
  SurfaceDistances(std::shared_ptr<const InputSurface> surface,
    const std::optional<FlagArray>& mask, bool maskOnFaces,
    const std::optional<FactorArray>& slowness, const nanobind::object& progress);

  /// Whether a triangle that is not masked uses the point.
  bool HasPoint(std::int64_t point) const
  {
    return this->Built->VertexOf(static_cast<Index>(point)) >= 0;
  }

  /// The times (n) from sources at points with start times, and the row of the source that each
  /// point is reached from (n): infinite and -1 where none arrives. apart: fronts of different sources
  /// do not mix, so that the row is that of the smallest time of one source alone.
  nanobind::tuple FromAll(const LongArray& points, const FactorArray& starts, bool apart,
    const nanobind::object& progress) const;

  /// The distances (n) from sources at points by the heat method, without speeds. Its factors are
  /// kept.
  nanobind::object ByHeat(const LongArray& points, double m, const nanobind::object& progress);

  /// data, indices and indptr of the times up to the cutoff from each of the points, one row each.
  nanobind::tuple FromEach(
    const LongArray& points, double cutoff, const nanobind::object& progress) const;

private:
  std::shared_ptr<const InputSurface> Input;
  std::unique_ptr<const Surface> Built;
  std::unique_ptr<const GeodesicDistance> Fronts;
  std::unique_ptr<const HeatDistance> Heat;
};

} // namespace SurfaceDiffusion
