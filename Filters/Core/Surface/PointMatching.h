// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace SurfaceDiffusion
{

/// A point of a piece of a surface that may be a point of other pieces too.
struct InterfacePoint
{
  int Piece; ///< its number in the list of all pieces
  int Surface;
  std::int64_t Label;
  bool IsOpen; ///< on the edge of its piece, or used by no cell of its own
  bool IsCopy; ///< used by no cell of its own, or flagged as a duplicate
  std::int64_t GlobalId; ///< 0 if points are matched by their coordinates
  std::array<double, 3> Coordinates; ///< zeros if points are matched by their ids
};

/// Which of the points are one point of the surface: for each the index of the point that owns it,
/// itself if no other matches. points: ordered by label.
///
/// Points of several pieces of one surface are one if they have the same global id or, without
/// ids, if one of them is open: first those with equal coordinates, then, of the others, those for
/// which the first point within the tolerance, in the order of labels, is the same. Points of one
/// piece are never merged: if a piece has several coincident points (two sheets that touch, split
/// normals), its k-th is identified with the k-th of the other pieces. The first point that is no
/// copy owns the others.
///
/// What a point matches depends only on points within ReachOfMatching tolerances: those with which
/// it may share the first point within the tolerance are two tolerances away, and their first
/// points one more. Processes that know these points therefore agree.
constexpr double ReachOfMatching = 3.0;
std::vector<std::size_t> MatchPoints(
  std::vector<InterfacePoint> points, bool byId, double tolerance);

} // namespace SurfaceDiffusion
