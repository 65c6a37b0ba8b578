// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Core/Surface/TriangleMesh.h"

#include <cmath>
#include <vector>

namespace SurfaceDiffusion
{

/// How fronts measure each triangle of a mesh: a vector v in the plane of the triangle has the length
/// sqrt(v^T D^-1 v), the time that a front takes along it, with D = s1^2 e1 e1^T + s2^2 e2 e2^T and the
/// speeds s1 along e1 and s2 across. A linear map of the triangle makes such lengths Euclidean; these
/// are the shapes of the images. Empty: the shapes of the mesh. The two triangles beside an edge may
/// give it different lengths.
using FrontShapes = std::vector<TriangleMesh::Shape>;

/// Whether no front crosses the triangle.
inline bool IsBarrier(const FrontShapes& shapes, Index t)
{
  return !shapes.empty() && std::isinf(shapes[static_cast<std::size_t>(t)].Length);
}

/// The speeds of fronts are `along` and `across` times 1 / slowness. slowness: per triangle, 0 or more,
/// and infinite for a barrier; empty: 1. directions: e1 of each triangle; no row, or zero: fronts have
/// the geometric mean of both speeds in all directions. along, across: above 0.
FrontShapes MakeFrontShapes(const TriangleMesh& mesh, const std::vector<double>& slowness,
  const Eigen::Ref<const TangentVectors>& directions, double along, double across);

} // namespace SurfaceDiffusion
