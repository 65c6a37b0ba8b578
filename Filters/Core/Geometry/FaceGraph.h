// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Core/Foundation/Offsets.h"
#include "Core/Surface/TriangleMesh.h"

#include <vector>

namespace SurfaceDiffusion
{

/// Lists of numbers, one list per row.
struct IndexLists
{
  std::vector<Offset> Begin; ///< list i is Entries[Begin[i]] .. Entries[Begin[i + 1]]
  std::vector<Index> Entries;
};

/// The triangles of a mesh as the nodes of a graph.
struct FaceGraph
{
  explicit FaceGraph(const TriangleMesh& mesh, const ParallelFor& parallel = SerialFor());

  Index NumberOfFaces() const { return static_cast<Index>(this->Ring.Begin.size()) - 1; }

  const TriangleMesh& Mesh;
  /// Per triangle: the others that share a vertex with it, ascending. Around vertices with many
  /// triangles, some of them: see VertexFans.
  IndexLists Ring;
  IndexLists Across; ///< per triangle: those of its ring that share an edge with it, ascending
  /// Per triangle: the places in Across.Entries of the pairs of triangles of its patch, itself and
  /// its ring, that share an edge; each pair once.
  IndexLists Inside;
};

/// Unit normals, areas and centroids of the triangles. The normal of a triangle of zero area is 0.
struct FaceGeometry
{
  SurfaceDiffusion::Points Normals;
  Vector Areas;
  SurfaceDiffusion::Points Centroids;

  /// points: per vertex of the mesh.
  void Measure(const TriangleMesh& mesh, const Points& points, const ParallelFor& parallel);
};

/// exp(-x) for x >= 0 within 0.04, and 0 from x = 8 on: a weight that needs no library function, so
/// that its bits are the same on all platforms.
inline double FallOff(double x)
{
  const double y = x < 8.0 ? 1.0 - 0.125 * x : 0.0;
  const double square = y * y;
  return (square * square) * (square * square);
}

} // namespace SurfaceDiffusion
