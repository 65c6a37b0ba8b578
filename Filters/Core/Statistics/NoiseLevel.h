// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Core/Operators/Assembler.h"
#include "Core/Operators/Rings.h"
#include "Core/Surface/PointData.h"

#include <functional>
#include <vector>

namespace SurfaceDiffusion
{

/// An estimate of the standard deviation of the noise in data, without knowledge of the signal.
struct NoiseEstimate
{
  double BetweenNeighbours = 0.0; ///< from the neighbours of each vertex
  double Apart = 0.0; ///< from vertices farther apart, as far as correlation was found
  /// Whether it is 0 because no vertex has enough known ones around, not since there is no noise.
  bool IsUndetermined = false;

  /// White noise has the same deviation at all distances. The differences of correlated noise, of
  /// data that were interpolated or smoothed, are larger at larger distances.
  static constexpr double CorrelatedGrowth = 1.15;
  bool IsCorrelated() const { return this->Apart > CorrelatedGrowth * this->BetweenNeighbours; }
  double Level() const { return this->IsCorrelated() ? this->Apart : this->BetweenNeighbours; }
};

/// The known vertices where data have noise, if they have any. Noise differs from vertex to vertex,
/// so a vertex whose known neighbours all have its own value is in a constant part: a background or
/// a plateau of a mask. A vertex is varying if neither it nor a neighbour is in such a part.
/// Vertices at both sides of a jump between constant parts are not; if the varying vertices are
/// less than a third of those outside of constant parts, then there are jumps and spikes alone, and
/// none is varying.
Flags FindVaryingVertices(const Assembler& assembler, const PointData& data);

/// The same of the vertices of some connected components, one entry for each of them. pattern: that
/// of the assembler.
Flags FindVaryingVertices(const Assembler& assembler, const SparsePattern& pattern,
  const PointData& data, VertexRange range);

/// Estimates the noise from the residuals r_i of local linear fits: the difference of f_i and the
/// value at vertex i of the linear function, in the tangent plane, fitted to the known vertices at
/// a distance of 1 edge from i, and then of 2, 4 and 8 edges while the result grows by more than
/// 15 %, each time less than before: the noise is correlated. If it grows faster, or by more than
/// 30 % at the end, then the signal bends and the first result is taken. The deviation is 1.4826
/// times the median of |r_i|/sqrt(1 + |v|^2), where v are the weights of the fit: robust to edges
/// and exact on slopes (median absolute deviation; D. Donoho, IEEE Trans. Inf. Theory 41, 1995).
/// Only varying vertices count, 20,000 of them at most. Noise that was smoothed over more than
/// about an edge grows as fast as a signal, so that the result is too small: see
/// NeighbourVariation. Root mean square over the columns; 0 if no vertex has enough known ones
/// around. points: of the input, rows as in TriangleMesh::InputVertex.
NoiseEstimate EstimateNoise(
  const Assembler& assembler, const Eigen::Ref<const Points>& points, const PointData& data);

/// The coordinates of a row of values at vertex i that have noise, such as those of a vector in the
/// tangent plane; empty: all columns.
using NoisyCoordinates = std::function<Eigen::RowVectorXd(Index i, const Eigen::RowVectorXd& row)>;

/// The same from the vertices of some connected components. pattern: that of the assembler.
/// isOfFactorOne: the noise where the fidelity factor w is 1, if its variances are in proportion to
/// 1/w: r_i is over sqrt(1/w_i + sum_j v_j^2/w_j).
NoiseEstimate EstimateNoise(const Assembler& assembler, const SparsePattern& pattern,
  const Eigen::Ref<const Points>& points, const PointData& data, VertexRange range,
  bool isOfFactorOne = false, const NoisyCoordinates& coordinates = {});

/// What EstimateNoise() finds between neighbours, on average, in noise that is known everywhere and
/// has the same distribution but not the same correlation as white noise of deviation 1.
/// deviationOf(vertices, weights): the standard deviation of the sum of weights times values there.
/// 0 if no vertex has enough others around.
double ExpectedEstimate(const Assembler& assembler, const Eigen::Ref<const Points>& points,
  const PointData& data,
  const std::function<double(const std::vector<Index>&, const Vector&)>& deviationOf);

/// Root of the area-weighted mean of w (u - f)^2 over the columns and the known vertices of fidelity
/// factors w > 0: that of noise of the variances s^2/w is s.
double Discrepancy(const TriangleMesh& mesh, const PointData& data, const Values& u);
double Discrepancy(
  const TriangleMesh& mesh, const PointData& data, const Values& u, VertexRange range);

} // namespace SurfaceDiffusion
