// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Core/Models/Fidelity.h"
#include "Core/Models/ImplicitSystem.h"

#include <memory>

namespace SurfaceDiffusion
{

/// The blur of an instrument as N steps of backward Euler for the heat equation,
///   H = ((M + tau/N K)^-1 M)^N,
/// with the lumped mass matrix M and the stiffness matrix K of the cotan weights. H is self-adjoint
/// and positive definite in the inner product u . M v, keeps constants and the sum of A_i u_i, and
/// has the norm 1. Without obtuse triangles it is positive: it keeps the bounds of u.
class HeatBlur
{
public:
  /// width: full width at half maximum, in the units of the mesh. steps: N, 2 or more.
  HeatBlur(std::shared_ptr<const Assembler> assembler, double width, int steps,
    std::shared_ptr<LinearSolver> solver, const ParallelFor& parallel = SerialFor());

  /// tau, at which the point spread function of H on the plane has the full width at half maximum
  /// `width`. That function is a multiple of x^(N-1) K_(N-1)(x) at the distance x sqrt(tau/N), with
  /// the modified Bessel function K (Matern kernel); tau tends to that of the Gaussian,
  /// width^2/(16 ln 2), as N grows, and is 1.64 times as large at N = 4.
  static double TimeOfWidth(double width, int steps);

  /// Factorise the matrix, or prepare the solver in another way. The first Apply() does it
  /// otherwise.
  void Prepare(const ProgressMonitor& progress = ProgressMonitor());

  /// The numbers N and tau/N.
  int NumberOfSteps() const { return this->Steps; }
  double StepTime() const { return this->Time; }

  /// u becomes (M + tau/N K)^-1 M u, which is one of the steps.
  void Step(Values& u, StepReport& report, const ProgressMonitor& progress = ProgressMonitor());

  /// u becomes H u. The solves are added to the report.
  void Apply(Values& u, StepReport& report, const ProgressMonitor& progress = ProgressMonitor());

  /// v becomes H (lambda w chi v): the derivative of lambda/2 int w chi (H u - f)^2 in the inner
  /// product of M for v = H u - f.
  void ApplyToWeighted(const Fidelity& fidelity, Values& v, StepReport& report);

private:
  const TriangleMesh& Mesh;
  const ParallelFor& Parallel;
  int Steps;
  double Time;
  bool Prepared = false;
  ImplicitSystem System;
  Values RightHandSide;
  Eigen::RowVectorXd Mean; ///< of the values that are blurred
};

} // namespace SurfaceDiffusion
