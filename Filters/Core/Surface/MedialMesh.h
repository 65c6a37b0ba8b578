// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Core/Surface/TriangleMesh.h"

#include <array>
#include <memory>
#include <vector>

namespace SurfaceDiffusion
{

/// The triangles' medial triangles, whose corners are the midpoints of the edges: a mesh with one
/// vertex per edge, where neighbours touch at corners.
///
/// The Crouzeix-Raviart discretisation is the ordinary one on this mesh. Its functions are linear
/// on each triangle, continuous at the midpoints of edges only, and its unknowns are the values
/// there: just the continuous functions on the medial triangles. These have a quarter of the area
/// and the shape of their triangles, so that every integral is a quarter of the one on the surface
/// while equations and time scales are the same, and no model needs to know. (M. Crouzeix, P.-A.
/// Raviart, RAIRO 7, 1973; total variation: A. Chambolle, T. Pock, J. Math. Imaging Vis. 62, 2020.)
class MedialMesh
{
public:
  explicit MedialMesh(const TriangleMesh& mesh);

  /// Triangle t lies in triangle t of the surface, corner a on the edge opposite corner a, and the
  /// two have the same axes up to sign: direction fields carry over as they are.
  std::shared_ptr<const TriangleMesh> Edges() const { return this->Medial; }

  /// The two vertices of the edge that vertex e of the medial mesh stands for. Edges between the
  /// same two, which intrinsic triangulations can have, are one.
  const std::vector<std::array<Index, 2>>& Ends() const { return this->EdgeEnds; }

private:
  std::shared_ptr<const TriangleMesh> Medial;
  std::vector<std::array<Index, 2>> EdgeEnds;
};

} // namespace SurfaceDiffusion
