// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Core/Models/InitialState.h"
#include "Core/Models/Model.h"
#include "Core/Surface/TriangleMesh.h"

#include <cmath>
#include <cstdint>
#include <vector>

namespace SurfaceDiffusion
{

/// Maps into the unit sphere S^(m-1): one unit vector of m >= 2 components per vertex, a row of a
/// Values. Line fields are such maps with u and -u taken as the same.

/// Normalise a row of any size, without overflow; false (and unchanged) if it is zero or not
/// finite: no direction.
template <typename Row>
bool Normalize(Row&& row)
{
  const double size = row.cwiseAbs().maxCoeff();
  if (!(size > 0.0) || !std::isfinite(size) || row.hasNaN())
  {
    return false;
  }
  row /= size; // no overflow or underflow in the squares
  row /= row.norm();
  return true;
}

/// Make the data of a harmonic map from vectors of any length: Given is normalised where it is
/// known; vectors without a direction (zero or NaN) become missing, and Start is filled there:
/// - Mean: the normalised mean of the known vectors of the connected component (of lines: the main
///   axis of the sum of u u^T). If no direction prevails (the mean is shorter than 1/2, as of
///   the normals of a closed surface) the rim of the hole spreads inwards instead;
/// - Input: the vectors themselves, as Mean if they have no direction;
/// - Noise: random directions, each component uniform between the smallest and largest known value.
/// A component without any known vector takes e_1. ids: one per vertex, for the random numbers.
/// Over several processes no line may be missing.
void FillMissingUnitVectors(const TriangleMesh& mesh, PointData& data, bool lineField,
  InitialFill fill, std::int64_t seed, const std::vector<std::int64_t>& ids);

/// Of vectors the parts orthogonal to the normals, each of n x 3: 0 where there is none but round-off.
void ProjectIntoPlanes(const Values& normals, Values& vectors);

/// Give every vertex that is not known the direction of the sum of the vectors of its neighbours,
/// ring by ring from the known ones on; e_1 if nothing is known or neighbours cancel exactly. All
/// become known. (The sum of lines depends on its order: only the serial reduction takes them.)
void SpreadUnitVectors(const TriangleMesh& mesh, Values& u, Flags& known, bool lineField);

/// Normalise data.Start at the missing vertices; vectors without a direction are replaced by those
/// of `instead`.
void NormalizeFilled(PointData& data, const Values& instead);

/// Bring data.Start at the missing vertices into the planes orthogonal to the normals, where a vector
/// along the normal becomes any.
void NormalizeFilledInPlanes(const Values& normals, PointData& data);

} // namespace SurfaceDiffusion
