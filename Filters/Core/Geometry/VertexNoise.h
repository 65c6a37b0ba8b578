// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Core/Surface/TriangleMesh.h"

#include <vector>

namespace SurfaceDiffusion
{

/// The upper median, 0 without values; reorders them.
double MedianOf(std::vector<double>& values);

/// The standard deviation of a normal distribution of mean 0 whose absolute values have this
/// median.
double MedianDeviation(std::vector<double>& absoluteValues);

/// An estimate of the noise of the vertices of a surface: the standard deviation of their
/// displacement along the normal, in the unit of the points.
///
/// A quadric z = a + b s + c t + d s^2 + e s t + f t^2 is fitted to the neighbours of each vertex
/// and their neighbours, without the vertex itself. The distance of the vertex from it has the
/// variance sigma^2 (1 + l), where l is the leverage of the fit. sigma is the median of the
/// absolute standardised distances over 0.6745, so that edges and corners of the surface, and
/// impulsive noise at less than half of the vertices, hardly matter. Vertices with fewer than nine
/// such neighbours, or with l > 2, are left out. Returns 0 if none is left.
///
/// points: per vertex of the mesh.
double EstimateVertexNoise(
  const TriangleMesh& mesh, const Points& points, const ParallelFor& parallel = SerialFor());

} // namespace SurfaceDiffusion
