// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Distributed/Processes.h"
#include "Distributed/SurfacePieces.h"

#include "vtkType.h"

#include <cstdint>
#include <vector>

namespace SurfaceDiffusion
{

/// Which points of different pieces are one point of the surface.
///
/// With global point ids in all pieces, points of one id are one. Without, points at one place are,
/// where at least one of them lies on the edge of its piece (an edge of one triangle) or belongs to
/// ghost cells alone: first those with equal coordinates, then, of the rest, those within the
/// tolerance. Points of one piece are never joined: where a piece has several at one place (two
/// sheets that touch, split normals), the k-th goes with the k-th of the others.
struct PointIdentity
{
  /// Per point the number of the point it stands for, its owner's: itself, unless another piece
  /// comes first. Numbers run from FirstLabel through the points of this piece, and through all
  /// pieces of all processes.
  std::vector<vtkIdType> Labels;
  vtkIdType FirstLabel = 0;
  /// Per point a number that does not depend on the partition, for random numbers: the global id,
  /// or a hash of the coordinates.
  std::vector<std::int64_t> Ids;
};

/// The identity of the points of each of this process's pieces. Collective. tolerance: in
/// coordinate units; negative: 1e-6 of the diagonal of the surface's bounding box.
std::vector<PointIdentity> FindIdentity(
  const Processes& processes, const std::vector<SurfacePiece>& pieces, double tolerance);

} // namespace SurfaceDiffusion
