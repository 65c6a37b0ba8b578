// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Core/Surface/IntrinsicTriangulation.h"

#include <memory>
#include <vector>

namespace SurfaceDiffusion
{

/// The intrinsic Delaunay triangulation of a surface: no vertex moves, only edges are flipped,
/// along geodesics (A. Bobenko, B. Springborn, Discrete Comput. Geom. 38, 2007). All cotan weights
/// (10) are then nonnegative, so that linear diffusion by backward Euler satisfies a maximum
/// principle: it keeps the bounds of the data at any time step on any surface. Boundaries, edges of
/// more than two triangles and nearly degenerate triangles: see IntrinsicTriangulation.
///
/// The flips are kept, so that fields on the surface can be carried over at any time.
class IntrinsicDelaunay
{
public:
  /// Throws Aborted.
  explicit IntrinsicDelaunay(std::shared_ptr<const TriangleMesh> mesh,
    const ParallelFor& parallel = SerialFor(), const ProgressMonitor& progress = ProgressMonitor(),
    BoundaryEdges boundary = BoundaryEdges::Flip);

  /// The number of edges that are not Delaunay: those of triangles too flat to be flipped, and
  /// those left when the flips were ended (50 checks per side of a triangle). The maximum principle
  /// does not hold there.
  Index NumberOfEdgesLeft() const { return this->EdgesLeft; }

  /// It has the vertices of the input mesh, in the same order, its control areas, its edge length
  /// of natural units and its diagnostics. Its triangles are not those of the input:
  /// InputTriangle() is empty.
  std::shared_ptr<const TriangleMesh> Mesh() const { return this->Triangulation; }

  /// Lines e1 per triangle of Mesh() (see TangentVectors.h) from lines per triangle of the input
  /// mesh: the main axis of the area-weighted mean of d d^T, which every flip takes over its two
  /// triangles.
  TangentVectors Transport(const Eigen::Ref<const TangentVectors>& lines) const;

  /// In the order in which the edges were flipped.
  const std::vector<IntrinsicTriangulation::EdgeFlip>& Flips() const { return this->EdgeFlips; }

private:
  void FlipEdges(IntrinsicTriangulation& triangulation, const ParallelFor& parallel,
    const ProgressMonitor& progress);

  std::shared_ptr<const TriangleMesh> Input, Triangulation;
  Index EdgesLeft = 0;
  std::vector<IntrinsicTriangulation::EdgeFlip> EdgeFlips;
};

} // namespace SurfaceDiffusion
