// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Core/Surface/TriangleMesh.h"

#include <vector>

namespace SurfaceDiffusion
{

/// The edges that count for the mean edge length h: those not longer than 30 times the median edge.
/// Longer ones are those of spikes, a few of which would make h a length that no other edge has.
struct EdgeLengths
{
  double Sum = 0.0;
  double Number = 0.0;
  double LeftOut = 0.0; ///< the number of longer edges
};

/// Of given lengths, of all processes together.
EdgeLengths MeasureEdgeLengths(
  const std::vector<double>& lengths, const Reduction& processes = Reduction::Serial());

/// Of the distinct edges of triangles.
EdgeLengths MeasureEdgeLengths(const Points& points, const Triangles& triangles);

/// Of the distinct edges of a mesh with as many edges as pairs of vertices, in its LengthUnit(). On
/// a piece of a surface each interface edge counts in the process that owns it.
EdgeLengths MeasureEdgeLengths(const TriangleMesh& mesh, const Reduction& processes);

/// LeftOut of a mesh that is whole. Takes a pass over the triangles of a mesh without long edges.
double CountLongEdges(const TriangleMesh& mesh, const ParallelFor& parallel = SerialFor());

} // namespace SurfaceDiffusion
