// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Run/Surface.h"

#include <cstdint>
#include <functional>

namespace SurfaceDiffusion
{

/// The unit vectors of a line field on the cells that the triangles of a surface were cut from;
/// zero for cells without direction. A cell of several triangles takes the main axis of the sum of
/// area d dᵀ, in which the sign of d does not matter.
///
/// directions: per triangle of surface.InputMesh(). cellOf: the cell of a triangle of the surface's
/// input; the triangles of a cell follow one another.
Points DirectionsOfCells(const Surface& surface, const TangentVectors& directions,
  std::int64_t numberOfCells, const std::function<std::int64_t(Index)>& cellOf,
  const ParallelFor& parallel);

} // namespace SurfaceDiffusion
