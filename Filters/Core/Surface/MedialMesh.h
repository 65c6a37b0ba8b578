// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Core/Surface/TriangleMesh.h"

#include <array>
#include <memory>
#include <vector>

namespace SurfaceDiffusion
{

/// The medial triangles of a surface, whose corners are the midpoints of the edges: a mesh with one
/// vertex per edge, whose triangles touch at corners.
///
/// The Crouzeix-Raviart finite element method is the usual linear one on this mesh. Its functions
/// are linear on each triangle and continuous at the midpoints of edges only; its unknowns are the
/// values there. These are exactly the continuous functions on the medial triangles. A medial
/// triangle is similar to its triangle and has a quarter of the area, so that every integral is a
/// quarter of the one on the surface, equations and time scales are the same, and models run on it
/// unchanged. (M. Crouzeix, P.-A. Raviart, RAIRO 7, 1973; total variation: A. Chambolle, T. Pock,
/// J. Math. Imaging Vis. 62, 2020.)
class MedialMesh
{
public:
  /// splitsJunctions: whether each triangle of an edge of three or more has a vertex of its own there.
  explicit MedialMesh(const TriangleMesh& mesh, bool splitsJunctions = false);

  /// Triangle t lies in triangle t of the surface, its corner a on the edge opposite corner a. The
  /// two have the same axes up to sign, so that tangent vectors are the same on both.
  std::shared_ptr<const TriangleMesh> Edges() const { return this->Medial; }

  /// The two vertices of the edge whose midpoint is vertex e of the medial mesh. Intrinsic
  /// triangulations can have several edges between the same two vertices.
  const std::vector<std::array<Index, 2>>& Ends() const { return this->EdgeEnds; }

private:
  std::shared_ptr<const TriangleMesh> Medial;
  std::vector<std::array<Index, 2>> EdgeEnds;
};

} // namespace SurfaceDiffusion
