// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Core/Foundation/Parallel.h"
#include "Core/Foundation/Types.h"
#include "Core/Surface/TriangleMesh.h"

namespace SurfaceDiffusion
{

// The ranges of values that TotalVariationMinimizer derives its first penalties from.

/// The typical range of u on each triangle: that on the whole surface, except at outliers.
/// quadratic: the weights of the fidelity, of which one above 0 lets the penalty grow.
Vector RangesOfTriangles(const TriangleMesh& mesh, const Eigen::Ref<const Values>& u,
  const Values& quadratic, const ParallelFor& parallel);

/// Their means around each vertex.
Vector RangesOfVertices(
  const TriangleMesh& mesh, const Vector& ofTriangles, const ParallelFor& parallel);

/// The square of the width of each vertex' control cell, for the penalties there: its area, but on
/// needles that of a cell as wide as they are.
Vector SquaredWidths(const TriangleMesh& mesh, const ParallelFor& parallel);

} // namespace SurfaceDiffusion
