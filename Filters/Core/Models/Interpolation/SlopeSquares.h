// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Core/Solvers/SupernodalFactor.h"
#include "Core/Surface/TriangleMesh.h"

#include <vector>

namespace SurfaceDiffusion
{

/// The mean square of a component of the gradient around each vertex,
///   s_i(u) = sum_t |T_t| |grad u|^2 / (2 sum_t |T_t|)
/// over the triangles at vertex i, and its expectation for random functions.
class SlopeSquares
{
public:
  /// mesh: must outlive it.
  SlopeSquares(const TriangleMesh& mesh, const ParallelFor& parallel);

  /// sum_k factors_k s(u_k) over the columns of u.
  Vector Of(const Values& u, const Vector& factors) const;

  /// The entries of a covariance along the edges of the triangles that OfCovariance() takes.
  std::vector<InverseEntry> Edges() const;
  /// The expectation of s(u) of functions with mean 0 and this covariance.
  Vector OfCovariance(const Vector& diagonal, const std::vector<InverseEntry>& edges) const;

private:
  /// squareAlong(t, a): sum or expectation of squared differences along the edge opposite corner a.
  template <typename Along>
  Vector Around(const Along& squareAlong) const;

  const TriangleMesh& Mesh;
  const ParallelFor& Parallel;
  CornerWeights Coefficients;
};

} // namespace SurfaceDiffusion
