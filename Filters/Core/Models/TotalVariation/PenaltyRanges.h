// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Core/Foundation/Parallel.h"
#include "Core/Foundation/Types.h"
#include "Core/Models/EdgeFunctions.h"
#include "Core/Operators/GradientMap.h"
#include "Core/Surface/TriangleMesh.h"

namespace SurfaceDiffusion
{

// The first penalties of VariationMinimizer, and the ranges of values that they are derived from.

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

/// The first penalties on S grad u - p per triangle, times its area. ranges: of the values on it.
/// unknowns: number of vertices of the surface.
Vector PenaltiesOfTriangles(const TriangleMesh& mesh, const GradientMaps& gradients,
  const EdgeFunction& function, const Vector& ranges, double unknowns, const ParallelFor& parallel);

/// The largest |S grad phi|^2 of the basis functions.
double SquaredSteepest(const GradientMap& map);

} // namespace SurfaceDiffusion
