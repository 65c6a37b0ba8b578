// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Core/Surface/TriangleMesh.h"

#include <memory>
#include <vector>

namespace SurfaceDiffusion
{

/// The connected components of a mesh as meshes of their own, with the vertices, triangles and edges
/// in the same order, the same unit of length, and the areas of the control cells that the whole
/// has. Numbers of edges are those of the whole, lengths and counts of edges are not set.
class ComponentMeshes
{
public:
  /// mesh: must outlive it.
  explicit ComponentMeshes(const TriangleMesh& mesh);

  /// The numbers of the triangles of component c, ascending.
  std::vector<Index> TrianglesOf(Index c) const;

  std::shared_ptr<TriangleMesh> Make(Index c) const;

private:
  const TriangleMesh& Whole;
  std::vector<Index> Begin, Triangles; ///< those of c are entries Begin[c] .. Begin[c + 1]
};

} // namespace SurfaceDiffusion
