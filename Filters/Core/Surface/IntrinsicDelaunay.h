// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Core/Surface/TriangleMesh.h"

#include <memory>

namespace SurfaceDiffusion
{

/// A Delaunay triangulation of the same surface: no vertex moves, only edges are flipped, along
/// geodesics (A. Bobenko, B. Springborn, Discrete Comput. Geom. 38, 2007). All (7) then are
/// nonnegative, so that linear diffusion by backward Euler keeps the bounds of the data at any time
/// step on any surface.
///
/// Surfaces that are not closed, oriented manifolds are covered twice first: every triangle has a
/// front and a back, joined at boundary edges and around edges with more than two triangles
/// (N. Sharp, K. Crane, "A Laplacian for Nonmanifold Triangle Meshes", SGP 2020), each side with
/// half the area. Nothing flows over a boundary then either, by symmetry, and boundary edges flip
/// like others, so no vertex has to be added. Edges of nearly flat triangles are made longer by one
/// length first, at most 1e-6 of the mean edge, so that every triangle is proper in floating point
/// (mollification, ibid.).
///
/// The result has the vertices of `mesh`, in its order, the edge length of natural units and the
/// findings; its triangles are not those of the input: InputTriangle() is empty.
///
/// frames: a direction per triangle of `mesh` (see Frames.h), replaced by one per new triangle: the
/// main axis of the area-weighted average of those it was flipped from. Null where there are none.
std::shared_ptr<TriangleMesh> IntrinsicDelaunay(const TriangleMesh& mesh, TangentVectors* frames,
  const ParallelFor& parallel = SerialFor(), const ProgressMonitor& progress = ProgressMonitor());

} // namespace SurfaceDiffusion
