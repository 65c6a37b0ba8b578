// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Core/Models/ImplicitSystem.h"
#include "Core/Operators/MeanCorrection.h"

#include <functional>
#include <memory>
#include <vector>

namespace SurfaceDiffusion
{

/// The coefficients of the Chebyshev series, on [0, 1], of the polynomial of this degree that has
/// the values of g at the extrema (1 + cos(pi j / degree)) / 2: it is within a small factor of the
/// best one. g(0) and g(1) hold exactly. degree: 1 or more.
std::vector<double> ChebyshevSeries(const std::function<double(double)>& g, int degree);
/// The sum of such a series at y in [0, 1].
double SumChebyshev(const std::vector<double>& series, double y);

/// A solver for the systems of a polynomial with this series: the same for any number of columns, of
/// which a panel is solved at once. largestStep: of s, in the units of the mesh.
std::unique_ptr<LinearSolver> MakeResolventSolver(const TriangleMesh& mesh, double largestStep,
  const std::vector<double>& series, const ParallelFor& parallel);

/// A function of the Laplace-Beltrami operator L = M^-1 K applied to data: p(Y) u with a polynomial
/// p and the resolvent
///   Y = (1 + s L)^-1 = (M + s K)^-1 M,
/// which is one step of backward Euler. For an eigenvalue lambda of L that of Y is
/// y = 1 / (1 + s lambda), in (0, 1], so that p stands for the function p(1 / (1 + s lambda)). All
/// solves share one matrix. Analytic functions need few of them: exp(-t L) to 2e-5 in 10 (rational
/// approximation with one pole, S. Norsett, SIAM J. Numer. Anal. 15, 1978; T. Goeckler, V. Grimm,
/// SIAM J. Numer. Anal. 51, 2013).
///
/// If p(1) = 1, constants stay, and so does the integral over each connected component.
class ResolventPolynomial
{
public:
  /// coefficients: of K, see CotanWeights.h. step: s > 0, in the units of the mesh. series: of p,
  /// of degree 1 or more.
  ResolventPolynomial(std::shared_ptr<const Assembler> assembler, const CornerWeights& coefficients,
    double step, std::vector<double> series, std::shared_ptr<LinearSolver> solver,
    const ParallelFor& parallel = SerialFor());

  /// u becomes p(Y) u. No bit of a column depends on the others. Throws NotConverged and Aborted.
  void Apply(Values& u, const ProgressMonitor& progress = ProgressMonitor());

  /// The largest relative residual of solves above their tolerance; 0 if there was none.
  double MissedResidual() const { return this->Report.MissedResidual; }
  void ForgetResiduals() { this->Report = StepReport(); }

private:
  void ApplyToPanel(Values& u, const ProgressMonitor& progress);
  void Solve(const Values& b, Values& x, const ProgressMonitor& progress);

  std::shared_ptr<const Assembler> Assembly;
  const ParallelFor& Parallel;
  std::vector<double> Series;
  ImplicitSystem System;
  MeanCorrection Balanced;
  StepReport Report;
  bool IsPrepared = false;
  Values RightHandSide;
};

} // namespace SurfaceDiffusion
