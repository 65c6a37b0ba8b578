// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Core/Geodesics/SourcePiece.h"

#include <memory>
#include <vector>

namespace SurfaceDiffusion
{

/// GeodesicDistance from pieces of sources, on any surface. Where triangles are few, their edges are
/// bisected first, which does not change the surface: fronts that meet behind a vertex, and an intrinsic
/// Delaunay triangulation whose triangles have a vertex at two corners, would make distances far too
/// short. A component whose longest edge is above a sixth of the root of its area is cut until no edge
/// is above a 39th, or less where speeds differ between directions. Surfaces without such components
/// stay as they are. Fronts are early by about 1 % of the largest time at most then, where directed speeds
/// differ by a factor of up to 2.
class EikonalDistance
{
public:
  /// mesh: the triangles of the surface, with vertices at `positions`, in units of the mesh. delaunay:
  /// their intrinsic Delaunay triangulation, with BoundaryEdges::Keep. shapes: of mesh; empty: its own.
  /// Triangles of different speeds do not become others. Throws Aborted.
  EikonalDistance(std::shared_ptr<const TriangleMesh> mesh,
    std::shared_ptr<const TriangleMesh> delaunay, const Points& positions, FrontShapes shapes,
    const ParallelFor& parallel, const ProgressMonitor& progress);

  /// The time at each vertex of the mesh, and the piece that it comes from, the first of several, as if
  /// the fronts of each label were alone. Fronts of one label, such as those of a line, are one source.
  /// starts: the times at the pieces; empty: 0. Throws Aborted.
  GeodesicDistance::Arrival Find(const std::vector<SourcePiece>& sources,
    const std::vector<double>& starts, const ProgressMonitor& progress) const;

  /// The times up to the cutoff from one vertex, as (vertex, time). memory: NumberOfVertices().
  /// Throws Aborted.
  std::vector<std::pair<Index, double>> FindNear(Index vertex, double cutoff,
    GeodesicDistance::Memory& memory, const ProgressMonitor& progress = ProgressMonitor()) const;

  /// Of the refined surface.
  Index NumberOfVertices() const { return this->Fine->NumberOfVertices(); }

private:
  /// A triangle of the refined surface.
  struct Part
  {
    Index Triangle;
    /// A column for each corner: its barycentric coordinates in the triangle that it was cut from.
    Eigen::Matrix3d Corners;
  };

  bool Refine(
    const Points& positions, const ParallelFor& parallel, const ProgressMonitor& progress);
  void CutShapes();
  void AppendParts(const SourcePiece& piece, std::vector<SourcePiece>& pieces) const;

  std::shared_ptr<const TriangleMesh> Mesh;
  std::shared_ptr<const TriangleMesh> Fine; ///< Mesh, unless it is refined
  FrontShapes Shapes; ///< of Fine
  std::vector<Index> FineVertices; ///< per vertex of Mesh; empty: the same
  std::vector<std::vector<Part>> Parts; ///< per triangle of Mesh; empty: itself
  std::unique_ptr<const GeodesicDistance> Fronts;
};

} // namespace SurfaceDiffusion
