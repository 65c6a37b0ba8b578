// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Core/Models/Interpolation/ScatteredValues.h"
#include "Core/Models/Interpolation/SmoothnessEnergy.h"
#include "Core/Solvers/SupernodalFactor.h"

namespace SurfaceDiffusion
{

/// The smooth function with given values at points,
///   min  1/2 sum_i w_i (u(p_i) - d_i)^2 + mu/2 u^T Q u
/// with the energy Q of SmoothnessEnergy, whose linear system is
///   H u = B^T W d,  H = B^T W B + mu Q,
/// where the rows of B have the barycentric coordinates of the points. Vertices may be held at
/// values. The factor of H gives a first answer; the rest of the error, which the condition number
/// of a fourth-order operator makes large, leaves by repeated solves for the residual.
class SmoothFit
{
public:
  /// energy, data: must outlive it. regular: whether the mesh is regular; see OrderedSupernodes().
  SmoothFit(const SmoothnessEnergy& energy, const ScatteredValues& data, bool regular,
    const ParallelFor& parallel);

  /// Take mu > 0, and hold the vertices of `held`. exact: the values at points inside triangles
  /// hold, too, by multipliers; their weights do not count.
  /// Returns the numbers of rows that neither values nor the energy determine.
  PivotCounts Prepare(double mu, const Flags& held, bool exact, const ProgressMonitor& progress);

  /// Take mu for mu_0, which the fit is prepared with, and keep the factor of mu_0: with the
  /// eigenvalues s and eigenvectors V of S = W^(1/2) B H_0^-1 B^T W^(1/2) and r = mu / mu_0,
  ///   H^-1 = (H_0^-1 - H_0^-1 B^T W^(1/2) V diag((1 - r) / (s + r (1 - s))) V^T W^(1/2) B H_0^-1) / r
  /// by Woodbury's formula. Not for exact values, nor before InverseDiagonal().
  void Rescale(double mu, const Eigen::MatrixXd& vectors, const Vector& shares);

  /// Take mu_0 again.
  void Restore();

  /// given: values d at the points of the data, d x k. u: on entry the values of the held vertices
  /// and a start elsewhere, n x k. Returns the multipliers of exact values, d x k.
  Values Solve(const Values& given, Values& u);

  /// Whether the factor of another mu gave Solve() a solution with the round-off of its own: the last
  /// steps were below 1e-12 of it.
  bool IsResolved() const { return this->Vectors.size() == 0 || this->LastStep < 1e-12; }

  /// x becomes H^-1 x, with zeros at held vertices. Not refined.
  void ApplyInverse(Values& x) const;

  /// B H^-1 B^T v, d x k: H^-1 at the points of the data. Not refined.
  Values InverseAtPoints(const Values& v) const;

  /// B u, d x k.
  Values AtPoints(const Values& u) const;
  /// B^T v.
  Values ToVertices(const Values& v) const;

  /// The diagonal of H^-1, of the mu of Prepare().
  /// others: entries along edges of the mesh.
  Vector InverseDiagonal(
    const ProgressMonitor& progress, std::vector<InverseEntry>* others = nullptr) const
  {
    return this->Factor.InverseDiagonal(this->Parallel, progress, others).head(this->Held.size());
  }

  /// Of each value b H^-1 b^T with its row b of B, likewise.
  Vector VarianceAtPoints(const ProgressMonitor& progress) const;

  /// log(det(H)), of the mu of Prepare(), and the rows of H, with the further unknowns of the energy.
  double LogDeterminant() const;
  Index NumberOfRows() const { return static_cast<Index>(this->H.rows()); }

  /// mu Q u - B^T W (d - B u) - B^T forces: the derivative of the energy.
  void Derivative(
    const Values& given, const Values& u, const Values& forces, Values& derivative) const;

  double GetSmoothing() const { return this->Mu; }

private:
  void ReleaseHeld(Values& x) const;
  void SolveSystem(Values& x, const std::vector<char>& needed) const;
  void Refine(const Values& given, const Values& forces, Values& u);
  Vector FindForces(const Vector& misfit) const;

  const SmoothnessEnergy& Energy;
  const ScatteredValues& Data;
  const bool IsRegular;
  const ParallelFor& Parallel;
  SupernodalFactor Factor;
  std::vector<char> NeededAtPoints; ///< of the factor
  SparseMatrix H;
  Vector Weights; ///< of the data in H
  Flags Held;
  double Mu = 0.0;
  bool IsExact = false;
  double FactorMu = 0.0;
  Eigen::MatrixXd Vectors; ///< of S; empty if the factor is that of mu
  Vector Scales; ///< of the vectors
  double LastStep = 0.0; ///< of Solve(), relative to the solution: the largest of its columns
};

} // namespace SurfaceDiffusion
