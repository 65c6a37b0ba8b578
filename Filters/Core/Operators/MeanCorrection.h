// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Core/Foundation/Parallel.h"
#include "Core/Surface/PointData.h"
#include "Core/Surface/TriangleMesh.h"

#include <vector>

namespace SurfaceDiffusion
{

/// Sum over the surface of A_i u_i for column k.
double Total(const TriangleMesh& mesh, const Values& u, Eigen::Index k,
  const ParallelFor& parallel = SerialFor());

/// Keeps sum A u to round-off, whatever tolerance the solver has: what a solve leaves over on a
/// connected component is spread over it evenly. Acts on the components that conserve the sum: no
/// fixed vertex, and no fidelity or one to the start itself (nothing missing, start = f).
class TotalCorrection
{
public:
  TotalCorrection() = default;
  TotalCorrection(const TriangleMesh& mesh, const PointData& data, bool hasFidelity,
    const ParallelFor& parallel = SerialFor());

  void Restore(const TriangleMesh& mesh, Values& u, const ParallelFor& parallel);

private:
  void Total(const TriangleMesh& mesh, const Values& u, const ParallelFor& parallel);

  std::vector<Index> Components; ///< those that conserve
  std::vector<double> Areas;
  Values Totals; ///< sum A u, component x column
  Values Targets; ///< sum A u at the start, component x column
};

/// Makes solutions of (diag(w) + K) x = b satisfy the sum of the equations over each connected
/// component without fixed vertices: sum w x = sum b, whatever K is, since its columns sum to zero.
/// Where w is small against K (long steps, weak fidelity) the matrix tells the mean of x from
/// nothing but the last digits of its diagonal; this sum tells it exactly.
class MeanCorrection
{
public:
  MeanCorrection() = default;
  MeanCorrection(const TriangleMesh& mesh, Vector weights, const Flags& fixed,
    const ParallelFor& parallel = SerialFor());

  void Restore(const TriangleMesh& mesh, const Values& b, Values& x, const ParallelFor& parallel);

private:
  std::vector<Index> Components; ///< those with no fixed vertex
  std::vector<double> Sums; ///< of their weights
  Vector Weights; ///< w
  Values Left; ///< sum b - sum w x, component x column
};

} // namespace SurfaceDiffusion
