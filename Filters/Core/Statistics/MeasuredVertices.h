// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Core/Foundation/Types.h"
#include "Core/Operators/SparsePattern.h"

namespace SurfaceDiffusion
{

/// The vertices at which data were measured, where others have values between them: those at the
/// middles of edges that were bisected. Estimates of noise take no account of the others.
struct MeasuredVertices
{
  Flags IsBetween; ///< per vertex: its value was interpolated
  /// The measured vertices around each measured vertex; the rows of others are empty.
  SparsePattern Neighbours;
};

/// A vertex in between belongs to the measured vertex with the fewest edges to it, and among
/// several to the one with the smallest coordinates. Measured vertices are neighbours if an edge
/// joins them or vertices that belong to them. pattern: of the stiffness matrix. points: one row
/// per vertex.
MeasuredVertices FindMeasuredVertices(
  const SparsePattern& pattern, const Points& points, Flags isBetween);

} // namespace SurfaceDiffusion
