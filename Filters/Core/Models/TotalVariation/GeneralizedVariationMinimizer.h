// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Core/Models/TotalVariation/GeneralizedGradient.h"
#include "Core/Models/TotalVariation/VariationMinimizer.h"
#include "Core/Models/TotalVariation/VertexTerms.h"
#include "Core/Operators/Assembler.h"
#include "Core/Solvers/QuadraticDescent.h"

#include <memory>
#include <vector>

namespace SurfaceDiffusion
{

struct PenaltyPace;

/// Finds the minimum over u and w of
///   E(u, w) = sum_T |T| |grad u - w_T| + alpha sum_e |e| |w_left - P w_right|
///             + sum_i A_i (mu_i/2 |u_i - g_i|^2 + nu_i |u_i - f_i|)
/// with some u_i fixed: total generalised variation of second order (K. Bredies, K. Kunisch, T.
/// Pock, SIAM J. Imaging Sci. 3, 2010), with a tangent vector w on each triangle T and its jumps
/// over the edges e (GeneralizedGradient). Norms are over all columns. Where u is affine, on a part
/// of the surface that can be laid in the plane, w = grad u and the first two terms vanish; for a
/// large alpha, w is parallel there, and E is total variation but for an affine function.
///
/// The method is ADMM as in TotalVariationMinimizer, on both norms, with the quadratic problem for
/// (u, w) together. Its multipliers q of the edges, of at most alpha |e|, determine those of the
/// triangles, y = div q, which must have at most the length 1. Where they have more, projected
/// gradient steps change q (A. Beck, M. Teboulle, SIAM J. Imaging Sci. 2, 2009), and what is left is
/// taken out by a factor. So the duality gap bounds E - min E, as there.
class GeneralizedVariationMinimizer : public VariationMinimizer
{
public:
  /// length: alpha. The other arguments are those of TotalVariationMinimizer.
  GeneralizedVariationMinimizer(std::shared_ptr<const Assembler> assembler, double length,
    const Values& quadratic, Vector absolute, Flags fixed, const Eigen::Ref<const Values>& typical,
    const Settings& settings, const ParallelFor& parallel = SerialFor());

  Report Minimize(const Values& g, const Values& f, Values& u,
    const ProgressMonitor& progress = ProgressMonitor(), bool keepMultipliers = false) override;

  /// w in place of multipliers: GradientEnergy() depends on it.
  std::size_t NumberOfMultipliers(Eigen::Index columns) const override
  {
    return static_cast<std::size_t>(2 * columns * this->Operator.NumberOfTriangles());
  }
  void SaveMultipliers(double* numbers, Eigen::Index columns) const override;
  void RestoreMultipliers(const double* numbers, Eigen::Index columns) override;

  /// The first two terms, at the w of the last Minimize(), or w = 0 before it.
  double GradientEnergy(const Values& u) const override;
  Eigen::Vector2d FreeGradient(Index t, Eigen::Index k) const override
  {
    return this->X.size() > 0 ? this->Operator.VectorOf(t, this->X, k) : Eigen::Vector2d::Zero();
  }

private:
  void SetPenalties(const Vector& ranges);
  void Start(const Values& u);
  void AdaptPenalty(const Report& report, PenaltyPace& pace);
  void SetGrowth(double growth);
  void SetMatrix();
  void SetResidual();
  bool IsFixed(Index row) const;
  void SetLoad(const Values& u);
  template <int K>
  void UpdateGroups();
  template <int K>
  void UpdateResidual();
  template <int K>
  Eigen::Vector2d SideOf(Index group, int k) const;
  double GroupEnergy(const Values& x) const;
  template <int K>
  double DualEnergy(const Values& u);
  template <int K>
  void RepairMultipliers();
  template <int K>
  void StepTowardsFeasible(double momentum);
  template <int K>
  double MeasureExcess(const Values& q, bool keepsWhole);
  void MeasureGap(const Values& u, double negligible, Report& report);

  std::shared_ptr<const Assembler> Assembly;
  const ParallelFor& Parallel;
  GeneralizedGradient Operator;
  std::unique_ptr<VertexTerms> Vertices;
  Vector Bounds; ///< of the multipliers, per group: |T| or alpha |e|
  Vector Penalty; ///< per group, times its measure, at the start
  double Growth = 1.0; ///< of all penalties
  double GrowthRate = 0.0; ///< per iteration
  Vector VertexDiagonal; ///< what the terms at the vertices add to the diagonal
  SparseMatrix Matrix; ///< of the quadratic problem for (u, w)
  std::vector<double> Entries; ///< of the matrix without these terms, at the first penalties
  Values ColumnShifts;
  Values Load; ///< of fixed vertices, at the first penalties
  QuadraticDescent Descent;
  bool IsSingle = false; ///< whether it iterates in single precision
  Values X, RightHandSide;
  Values Initial; ///< u on entry
  Values Split, Multipliers; ///< two rows per group; multipliers are scaled by the penalty
  Values Q, Extrapolated; ///< feasible multipliers of edges, and the point to step from
  Values Excess; ///< two rows per triangle
  Values Gathered;
  double BestDual = 0.0; ///< the largest lower bound of E so far
  double LastEnergy = 0.0; ///< of the last check
};

} // namespace SurfaceDiffusion
