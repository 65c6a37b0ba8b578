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
/// The same for every column.
void Total(const TriangleMesh& mesh, const Values& u, std::vector<double>& totals,
  const ParallelFor& parallel = SerialFor());
/// means[k] = the mean over the surface of column k, or 0 if it is not finite.
void FindMeans(const TriangleMesh& mesh, const Values& u, Eigen::RowVectorXd& means,
  const ParallelFor& parallel = SerialFor());

/// Conserves the total sum A u to round-off, independently of the tolerance of the solver: the
/// error that a solve makes on a connected component is spread over it evenly. Acts on the
/// components that conserve the total: no fixed vertex, and no fidelity or one to the start itself
/// (nothing missing, start = f).
class TotalCorrection
{
public:
  TotalCorrection() = default;
  TotalCorrection(const TriangleMesh& mesh, const PointData& data, bool hasFidelity,
    const ParallelFor& parallel = SerialFor());

  /// u: all columns of the start, or a part of them from `first` on.
  void Restore(
    const TriangleMesh& mesh, Values& u, const ParallelFor& parallel, Eigen::Index first = 0);
  /// The numbers that Restore() adds, component of the mesh x column of u.
  void FindShifts(const TriangleMesh& mesh, const Values& u, const ParallelFor& parallel,
    Eigen::Index first, Values& shifts);

private:
  void SumComponents(const TriangleMesh& mesh, const Values& u, const ParallelFor& parallel);
  void FindErrors(
    const TriangleMesh& mesh, const Values& u, const ParallelFor& parallel, Eigen::Index first);

  std::vector<Index> Components; ///< those that conserve
  std::vector<double> Areas;
  Values Totals; ///< sum A u, component x column of u
  Values Targets; ///< sum A u at the start, component x column
};

/// Corrects the mean of a solution of (diag(w) + K) x = b, K a stiffness matrix: makes it satisfy
/// the sum of the equations over each connected component without fixed vertices, sum w x = sum b,
/// in which K vanishes since its columns sum to zero. If w is small against K (long steps, weak
/// fidelity), the mean of x depends on the last digits of the diagonal of the matrix only; this sum
/// determines it exactly.
class MeanCorrection
{
public:
  MeanCorrection() = default;
  MeanCorrection(const TriangleMesh& mesh, Vector weights, const Flags& fixed,
    const ParallelFor& parallel = SerialFor());

  void Restore(const TriangleMesh& mesh, const Values& b, Values& x, const ParallelFor& parallel);
  /// The numbers that Restore() adds, component of the mesh x column of x.
  void FindShifts(const TriangleMesh& mesh, const Values& b, const Values& x,
    const ParallelFor& parallel, Values& shifts);

private:
  void FindMeans(
    const TriangleMesh& mesh, const Values& b, const Values& x, const ParallelFor& parallel);

  std::vector<Index> Components; ///< those with no fixed vertex
  std::vector<double> Sums; ///< of their weights
  Vector Weights; ///< w
  Values Residuals; ///< (sum b - sum w x) / sum w, component x column
};

} // namespace SurfaceDiffusion
