// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Distributed/Processes.h"
#include "Distributed/SurfacePieces.h"

#include "vtkType.h"

#include <array>
#include <cstdint>
#include <utility>
#include <vector>

namespace SurfaceDiffusion
{

/// Which points of different pieces are one point of the surface.
///
/// If all pieces have global point ids, points with one id are one point. Otherwise coincident
/// points are, if at least one of them lies on the edge of its piece (on an edge of one triangle)
/// or is used by ghost cells only: first those with equal coordinates, then, of the others, those
/// for which the first point within the tolerance, in the order of labels, is the same. Points of
/// one piece are never merged: if a piece has several coincident points (two sheets that touch,
/// split normals), its k-th is identified with the k-th of the other pieces.
///
/// vtkGenerateGlobalIds, which numbers coincident points of all processes, keeps none of these
/// rules: it merges coincident points of one piece (two sheets at one place become one) and inner
/// points of surfaces that only touch, and it replaces the ids that pieces have. It is also slower:
/// 17.7 s for 400,000 points in two processes, while the whole setup of a distributed run took
/// 3.1 s. Debian's VTK 9.1, which this library supports, does not have it.
struct PointIdentity
{
  /// Per point the label of the point that owns it: its own, unless another piece comes first.
  /// Labels run from FirstLabel through the points of this piece, and so through all pieces of all
  /// processes.
  std::vector<vtkIdType> Labels;
  vtkIdType FirstLabel = 0;
  bool IsById = false; ///< points were matched by their global ids
  std::vector<vtkIdType> Shared; ///< the points that are points of other pieces too, ascending
  std::vector<int> Neighbours; ///< the processes that may have such points, ascending

  /// Per point of the piece that owns itself a number that does not depend on the partition, which
  /// orders the points: the global id, or a hash of the coordinates; see IdsOfPlaces().
  std::vector<std::int64_t> MakeIds(vtkPolyData* piece) const;
};

/// The identity of the points of each of this process's pieces. Points are sent only to processes
/// with pieces nearby. Collective. tolerance: in coordinate units; negative: 1e-6 of the diagonal
/// of the surface's bounding box.
std::vector<PointIdentity> FindIdentity(
  const Processes& processes, const std::vector<SurfacePiece>& pieces, double tolerance);

} // namespace SurfaceDiffusion
