// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Core/Models/TotalVariation/GradientSplitting.h"
#include "Core/Models/TotalVariation/VariationMinimizer.h"
#include "Core/Models/TotalVariation/VertexTerms.h"
#include "Core/Operators/Assembler.h"
#include "Core/Solvers/QuadraticDescent.h"

#include <memory>
#include <vector>

namespace SurfaceDiffusion
{

/// Finds the minimum over u of
///   E(u) = int psi(|S grad u|) + sum_i A_i (mu_i/2 |u_i - g_i|^2 + nu_i |u_i - f_i|)
/// with some u_i fixed, for a convex psi: total variation psi(s) = s, exactly, without beta;
/// Charbonnier; or s^2/2. The terms at the vertices may be others (VertexTerms), for instance
/// costs with u_i in a convex set (SimplexSplitting).
///
/// The method is the alternating direction method of multipliers (ADMM; S. Boyd et al., Foundations
/// and Trends in Machine Learning 3, 2011; for total variation T. Goldstein, S. Osher, SIAM J.
/// Imaging Sci. 2, 2009) on p = S grad u and q = u - f, over-relaxed by 1.7; the quadratic problem
/// for u is not solved but improved by conjugate gradient iterations from the last u. With
/// mu > 0 the energy is strongly convex, and the penalty of the gradients grows linearly with the
/// iterations as long as the gap falls (accelerated ADMM; A. Chambolle, T. Pock, J. Math. Imaging
/// Vis. 40, 2011, algorithm 2; Y. Xu, SIAM J. Optim. 27, 2017). For total variation the penalty of
/// each triangle is then also adapted to p (GradientSplitting::Balance). The
/// multipliers are feasible for the dual problem at every iteration, so that the duality gap bounds
/// E(u) - min E from above: it is the stopping criterion. At vertices with mu_i = 0 the bound is
/// that over all u within Range of the data.
class TotalVariationMinimizer : public VariationMinimizer
{
public:
  /// quadratic, absolute: mu and nu >= 0 per vertex; in every connected component one of them must
  /// be positive somewhere, or a vertex fixed. Without nu, mu may have a column for each one of u.
  /// typical: values of the size of the data. They
  /// determine the penalty, and so the number of iterations; outliers act on it only around
  /// themselves.
  TotalVariationMinimizer(const std::shared_ptr<const Assembler>& assembler,
    std::shared_ptr<const GradientMaps> gradients, const Values& quadratic, Vector absolute,
    Flags fixed, const Eigen::Ref<const Values>& typical, const Settings& settings,
    const ParallelFor& parallel = SerialFor());

  /// The same with other terms at the vertices. ranges: typical ones of u on each triangle.
  TotalVariationMinimizer(std::shared_ptr<const Assembler> assembler,
    std::shared_ptr<const GradientMaps> gradients, std::unique_ptr<VertexTerms> terms,
    const Vector& ranges, const Settings& settings, const ParallelFor& parallel = SerialFor());

  Report Minimize(const Values& g, const Values& f, Values& u,
    const ProgressMonitor& progress = ProgressMonitor(), bool keepMultipliers = false) override;

  std::size_t NumberOfMultipliers(Eigen::Index columns) const override;
  void SaveMultipliers(double* numbers, Eigen::Index columns) const override;
  void RestoreMultipliers(const double* numbers, Eigen::Index columns) override;

  /// int psi(|S grad u|).
  double GradientEnergy(const Values& u) const override;

private:
  /// ranges: typical ones of the values on each triangle.
  TotalVariationMinimizer(const std::shared_ptr<const Assembler>& assembler,
    std::shared_ptr<const GradientMaps> gradients, Values quadratic, Vector absolute, Flags fixed,
    const Settings& settings, const Vector& ranges, const ParallelFor& parallel);

  void Start(const Values& u, bool keepMultipliers, bool isSingle);
  void SetPenalty(double growth, const Values& u);
  void AssembleMatrix(const Values& u);
  void SetResidual(const Values& u);
  void UpdateResidual();
  template <int K>
  void UpdateColumns();
  double Energy(const Values& u) const;
  double DualEnergy(const Values& u);
  void MeasureGap(const Values& u, double negligible, Report& report);

  std::shared_ptr<const Assembler> Assembly;
  const Reduction& OverProcesses;
  const ParallelFor& Parallel;
  double NumberOfVertices; ///< of the surface
  GradientSplitting Gradients;
  std::unique_ptr<VertexTerms> Vertices;
  CornerWeights Weights; ///< of the quadratic problem for u, at the first penalty
  Vector Diagonal; ///< likewise
  Values ColumnShifts; ///< more of it in each column, of an interface vertex in its owner only
  double GrowthRate; ///< of the penalty per iteration, in first penalties
  double LargestGrowth; ///< of the penalty, see PenaltyPace
  SparseMatrix Matrix; ///< of the quadratic problem for u
  QuadraticDescent Descent;
  Values RightHandSide, Load;
  Values Initial; ///< u on entry
  Values Gathered; ///< per vertex, what triangles give to the right-hand side or the dual function
};

} // namespace SurfaceDiffusion
