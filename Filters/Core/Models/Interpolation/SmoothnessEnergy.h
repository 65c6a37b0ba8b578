// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Core/Operators/Assembler.h"

namespace SurfaceDiffusion
{

/// The condition at the boundary of the surface that a smooth function fulfils by itself.
enum class RimCondition
{
  /// That of the Neumann problem: du/dn = 0 and d(Laplace u)/dn = 0. Functions become flat towards
  /// the boundary, across it.
  Natural,
  /// None: functions continue their slope. On flat surfaces linear functions have no energy.
  Free,
  /// Natural on closed connected surfaces, and where edges have so many triangles that Q has more than
  /// 400 entries per vertex with Free; Free on others.
  Automatic
};

/// The energy of fourth order of a function on a surface, 1/2 u^T Q u, in units of the mesh.
/// - Natural: 1/2 |kappa^2 u - div(D grad u)|^2 by linear elements with lumped masses,
///     Q = (kappa^2 M + K) M^-1 (kappa^2 M + K).
///   With kappa > 0 it is the precision of a Gaussian field whose correlation on the plane is
///   (kappa r) K_1(kappa r), of Matern's class with nu = 1, and its variance 1/(4 pi kappa^2)
///   (F. Lindgren, H. Rue, J. Lindstrom, J. R. Statist. Soc. B 73, 2011).
/// - Free: with D = 1, 1/2 int |Hessian u|^2 + curvature |grad u|^2 (O. Stein, A. Jacobson,
///   M. Wardetzky, E. Grinspun, ACM Trans. Graph. 39, 2020) by the gradients of linear elements in
///   Crouzeix-Raviart elements, and kappa^4 M + 2 kappa^2 K. Inside the surface it has the same
///   Euler equation as Natural.
class SmoothnessEnergy
{
public:
  /// coefficients: of K, as in CotanWeights.h; not used with Free. kappa: >= 0. Throws
  /// std::runtime_error if an edge has so many triangles that Free takes gigabytes.
  SmoothnessEnergy(const Assembler& assembler, const CornerWeights& coefficients, double kappa,
    RimCondition rim, const ParallelFor& parallel = SerialFor());

  bool IsFree() const { return this->Rim == RimCondition::Free; }

  /// Of Free: leave negative curvature out, without which no function has a negative energy.
  void DropNegativeCurvature();

  /// The size that entries of the diagonal of Q have where functions can bend, K_ii^2 / A_i.
  Vector Sizes() const;

  /// Add tension int |grad u|^2 to u^T Q u, in 1/length^2.
  void AddTension(double tension);

  double GetTension() const { return this->Tension; }

  /// Q. Its pattern contains that of the assembler. Natural: with further unknowns after those of the
  /// vertices where vertices have many triangles, see SparseSquare().
  const SparseMatrix& Matrix() const { return this->Q; }

  /// y = Q u, by differences of u: exact for constants where Q has a small round-off that the
  /// fourth order of the operator makes large.
  void Multiply(const Values& u, Values& y) const;

  /// y = K u, of the mesh alone with Free.
  void MultiplyStiffness(const Values& u, Values& y) const;

  /// u^T Q u of each column, without tension.
  Vector Squares(const Values& u) const;

private:
  void TakeHessian(bool withNegativeCurvature);

  const TriangleMesh& Mesh;
  const ParallelFor& Parallel;
  double Kappa;
  RimCondition Rim;
  double Tension = 0.0;
  SparseMatrix K, Q;
  SparseMatrix First; ///< of Free: kappa^4 M + 2 kappa^2 K
  SparseMatrix Gradient, Second; ///< of Free: u^T Gradient^T Second Gradient u
};

} // namespace SurfaceDiffusion
