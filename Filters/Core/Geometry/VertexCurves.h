// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Core/Surface/TriangleMesh.h"

#include <vector>

namespace SurfaceDiffusion
{

/// The vertices around a vertex, each once.
void ListNeighbours(const TriangleMesh& mesh, Index i, std::vector<Index>& neighbours);

/// Curves of vertices that run along the edges of a mesh.
class VertexCurves
{
public:
  /// The vertices with values from threshold on, thinned to curves: those of the smallest values
  /// are removed first, and only if the topology of the rest does not change (homotopic thinning;
  /// L. Lam, S.-W. Lee, C. Suen, IEEE PAMI 14, 1992). Ends are kept from the value `core` on.
  VertexCurves(const TriangleMesh& mesh, const Vector& values, double threshold, double core);

  /// The vertices of the curves, ascending.
  const std::vector<Index>& Vertices() const { return this->Members; }

  /// Remove curves and side branches shorter than `shortest`, the shortest first. points: those
  /// that lengths are measured between, one per entry of Vertices().
  void RemoveShort(const Points& points, double shortest);

  /// All curves between ends and junctions, and closed ones, which repeat their first vertex: as
  /// numbers of entries of Vertices().
  std::vector<std::vector<Index>> FindPaths() const;

private:
  void Connect(const TriangleMesh& mesh, const Vector& values);
  std::vector<Index> Follow(Index i, Index j) const;
  void Cut(const std::vector<Index>& path);
  void Disconnect(Index i, Index j);
  Index Degree(Index i) const { return static_cast<Index>(this->Neighbours[i].size()); }

  std::vector<Index> Members;
  std::vector<std::vector<Index>> Neighbours; ///< per entry of Members
};

} // namespace SurfaceDiffusion
