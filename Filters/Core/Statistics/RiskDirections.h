// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Core/Operators/CellTransfer.h"
#include "Core/Operators/Rings.h"
#include "Core/Surface/PointData.h"
#include "Core/Surface/TriangleMesh.h"

#include <cstddef>
#include <vector>

namespace SurfaceDiffusion
{

/// How many random directions (M. Hutchinson, Commun. Stat. Simul. 19, 1990) a part of so many
/// vertices needs.
int NumberOfRiskDirections(Index numberOfVertices);

/// Set the rows of a range in the first `count` random directions p, of which there are more
/// afterwards if there were fewer. A row is 0 where a value is not known or does not change, and
/// interpolated at a vertex whose value was. Elsewhere it is +-1/sqrt(w_i), or
/// +-|f_i - the mean of the neighbours|/noise at an outlier, whose value is beyond those of all
/// neighbours by more than twice the noise, which differences across jumps of the signal are not.
/// The sign is a hash of the rank of the vertex by its values, and by its place among equal ones, in
/// its range: it depends neither on the numbering and the units, nor on other ranges. mesh: of the
/// data. points: of the input, rows as in TriangleMesh::InputVertex. pattern: of the stiffness matrix.
void SetRiskDirections(const TriangleMesh& mesh, const SparsePattern& pattern,
  const Eigen::Ref<const Points>& points, const PointData& data, VertexRange range, double noise,
  std::size_t count, std::vector<Values>& directions);

/// Set all directions as vertices have them of white noise on cells, the signs of which are a hash of
/// the rank of the cell in its part. givenCells: the cell that was measured, of each cell; empty if
/// all were. compared: the data with the vertices that count. gain: see NoiseGain().
void SetRiskDirectionsOfCells(const CellTransfer& cells, const std::vector<Index>& givenCells,
  const PointData& data, const PointData& compared, const std::vector<VertexRange>& parts,
  double gain, std::vector<Values>& directions);

} // namespace SurfaceDiffusion
