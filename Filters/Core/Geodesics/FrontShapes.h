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

/// Of the speeds along and across a direction: larger ratios, and 0 beside a speed, count as this one.
constexpr double LargestSpeedRatio = 1000.0;

/// The speeds of fronts are `along` and `across` times 1 / slowness, each per triangle, or one for all, 0 or
/// more; empty: 1. slowness: infinite for a barrier. directions: e1 of each triangle; no row, or zero:
/// fronts have the geometric mean of both speeds in all directions. Where both are 0, or one of them
/// without a direction, is a barrier; with a direction, the smaller one is no less than the larger one over
/// LargestSpeedRatio.
FrontShapes MakeFrontShapes(const TriangleMesh& mesh, const std::vector<double>& slowness,
  const Eigen::Ref<const TangentVectors>& directions, const std::vector<double>& along,
  const std::vector<double>& across);

} // namespace SurfaceDiffusion
