// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Core/Foundation/IndexLists.h"
#include "Core/Foundation/ProgressMonitor.h"
#include "Core/Surface/TriangleMesh.h"

#include <utility>
#include <vector>

namespace SurfaceDiffusion
{

/// Edges by their two vertices, the smaller first, ascending.
using VertexPairs = std::vector<std::pair<Index, Index>>;

/// The triangles of a mesh as the nodes of a graph.
struct FaceGraph
{
  /// Throws Aborted.
  explicit FaceGraph(const TriangleMesh& mesh, const ParallelFor& parallel = SerialFor(),
    const ProgressMonitor& progress = ProgressMonitor());

  /// Triangles on two sides of these edges are no longer neighbours, nor are those at a vertex of
  /// them that share no other edge.
  void Separate(const VertexPairs& edges, const ParallelFor& parallel);

  Index NumberOfFaces() const { return this->Mesh.NumberOfTriangles(); }

  const TriangleMesh& Mesh;
  /// Per triangle: the others that share a vertex with it, ascending. Around vertices with many
  /// triangles, some of them: see VertexFans.
  IndexLists Ring;
  IndexLists Across; ///< per triangle: those of its ring that share an edge with it, ascending
};

/// Unit normals, areas and centroids of the triangles. The normal of a triangle of zero area is 0.
struct FaceGeometry
{
  SurfaceDiffusion::Points Normals;
  Vector Areas;
  SurfaceDiffusion::Points Centroids;
  /// The mean distance to the centroids of the neighbours across edges, estimated as 1/1.5 of that
  /// to the triangles that share a vertex; 0 without any. Filters of normals have this width.
  Vector Widths;

  /// points: per vertex of the mesh. The widths stay.
  void Measure(const TriangleMesh& mesh, const Points& points, const ParallelFor& parallel);
  /// At the points of the last Measure().
  void MeasureWidths(const FaceGraph& graph, const ParallelFor& parallel);
};

/// 1 - x / 8, and 0 from x = 8 on.
template <typename Number>
Number Fade(Number x)
{
  const Number y = Number(1) - Number(0.125) * x;
  return y > Number(0) ? y : Number(0);
}

template <typename Number>
Number EighthPower(Number y)
{
  const Number square = y * y;
  return (square * square) * (square * square);
}

/// exp(-x) for x >= 0 within 0.04, and 0 from x = 8 on: a weight that needs no library function, so
/// that its bits are the same on all platforms.
inline double FallOff(double x)
{
  return EighthPower(Fade(x));
}

} // namespace SurfaceDiffusion
