// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Core/Solvers/LinearSolver.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace SurfaceDiffusion
{

/// Forecasts the number of iterations of a solve after 32, 64, 128, ... iterations: the geometric
/// mean of those at the mean rate of convergence so far and since the last forecast. The rate of
/// conjugate gradients is uneven: they stall where few small eigenvalues are left, and speed up
/// when they have found these.
class ConvergenceForecast
{
public:
  static constexpr int First = 32; ///< iterations

  /// residual: SolveReport::Residual of the start.
  ConvergenceForecast(double residual, const IterationLimits& limits)
    : Limits(limits)
    , Start(residual)
    , LastResidual(residual)
  {
  }

  /// Later iterations are counted from here on, after `iterations` in all.
  void StartPass(int iterations) { this->Before = iterations; }

  /// Take the residual after a number of iterations of this pass. Returns whether to stop early.
  bool Update(int iterations, double residual)
  {
    iterations += this->Before;
    if (iterations < this->Next || residual <= this->Limits.Tolerance)
    {
      return false;
    }
    const double left = std::log(residual / this->Limits.Tolerance);
    const double whole = std::log(this->Start / residual);
    const double last = std::log(this->LastResidual / residual);
    const double forecast = whole > 0.0 && last > 0.0
      ? std::sqrt((iterations + left / whole * iterations) *
          (iterations + left / last * (iterations - this->Last)))
      : std::numeric_limits<double>::infinity();
    this->Most = std::max(this->Most, forecast);
    this->Last = iterations;
    this->LastResidual = residual;
    this->Next = 2 * iterations;
    this->Hopeless = this->Limits.StopsEarly && forecast > this->Limits.MaximumNumberOfIterations &&
      iterations >= LeastShare * this->Limits.MaximumNumberOfIterations;
    return this->Hopeless;
  }

  /// Whether to stop early.
  bool IsHopeless() const { return this->Hopeless; }

  /// Of all forecasts.
  double Largest() const { return this->Most; }

private:
  /// Of the iterations that are allowed. To stop before these are done would save little, and from
  /// a start near the solution the residual grows at first.
  static constexpr double LeastShare = 0.25;

  IterationLimits Limits;
  double Start, LastResidual;
  double Most = 0.0;
  bool Hopeless = false;
  int Before = 0;
  int Last = 0;
  int Next = First;
};

} // namespace SurfaceDiffusion
