// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Core/Models/Fields/FunctionDiagonal.h"
#include "Core/Models/ImplicitSystem.h"

#include <memory>
#include <vector>

namespace SurfaceDiffusion
{

/// A power of the resolvent of B = s L + e, with the Laplace-Beltrami operator L = M^-1 K and numbers
/// e of 0 to 99 at the vertices,
///   (1 + B)^-beta u,  beta in (0.5, 2.5],
/// where (1 + B)^-1 = (M (1 + e) + s K)^-1 M. With m the largest integer below beta it is
///   (1 + B)^-m (c + sum_j c_j (q_j + B)^-1),
/// whose poles q are between 1 and 1e6 (D. Bolin, K. Kirchner, J. Comput. Graph. Stat. 29, 2020, have a
/// rational function, too). White noise W gets the covariance of (1 + B)^-beta W within 0.5 %.
class ResolventPower
{
public:
  /// coefficients: of K, see CotanWeights.h. step: s > 0, in the units of the mesh. extra: e; no row: 0.
  ResolventPower(std::shared_ptr<const Assembler> assembler, const CornerWeights& coefficients,
    double step, const Vector& extra, double beta, const ParallelFor& parallel = SerialFor());

  /// u becomes (1 + B)^-beta u. No bit of a column depends on the others. Throws NotConverged and
  /// Aborted.
  void Apply(Values& u, const ProgressMonitor& progress = ProgressMonitor());

  /// The largest relative residual of solves above their tolerance; 0 if there was none.
  double MissedResidual() const { return this->Report.MissedResidual; }
  void ForgetResiduals() { this->Report = StepReport(); }

private:
  void ApplyToPanel(Values& u, const ProgressMonitor& progress);
  /// The first solve with a matrix decides the method of all (FallBackSolver), so that it is one of noise
  /// that is always the same.
  void Prepare(std::size_t pole, const ProgressMonitor& progress);
  /// x = (q + B)^-1 b with the pole of this number.
  void Solve(std::size_t pole, const Values& b, Values& x, const ProgressMonitor& progress);

  std::shared_ptr<const Assembler> Assembly;
  int Power; ///< m
  PoleSum Sum;
  std::vector<ImplicitSystem> Systems; ///< of each pole, of which the first one is 1
  std::vector<bool> ArePrepared;
  StepReport Report;
};

/// (1 + x)^-beta less its integer power m < beta, as poles from 1 on and a constant. extra: the largest e, up
/// to 99.
PoleSum PolesOfPower(double beta, double extra);
/// (1 + x)^-(2 beta), without a constant.
PoleSum PolesOfSquaredPower(double beta, double extra);

} // namespace SurfaceDiffusion
