// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Core/Solvers/LinearSolver.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace SurfaceDiffusion
{

/// Forecasts the number of iterations of a solve after 32, 64, 128, ... iterations, by the mean rate
/// of convergence since the forecast before. The rate of conjugate gradients is uneven: they stall
/// where few small eigenvalues are left, and speed up when they have found these.
class ConvergenceForecast
{
public:
  static constexpr int First = 32; ///< iterations

  /// residual: SolveReport::Residual of the start.
  ConvergenceForecast(double residual, const IterationLimits& limits)
    : Limits(limits)
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
    const double gain = std::log(this->LastResidual / residual);
    const double forecast = gain > 0.0 ? iterations + left / gain * (iterations - this->Last)
                                       : std::numeric_limits<double>::infinity();
    this->Most = std::max(this->Most, forecast);
    this->Last = iterations;
    this->LastResidual = residual;
    this->Next = 2 * iterations;
    return this->IsHopeless();
  }

  /// Whether to stop early.
  bool IsHopeless() const
  {
    return this->Limits.StopsEarly && this->Most > this->Limits.MaximumNumberOfIterations;
  }

  /// Of all forecasts.
  double Largest() const { return this->Most; }

private:
  IterationLimits Limits;
  double LastResidual;
  double Most = 0.0;
  int Before = 0;
  int Last = 0;
  int Next = First;
};

} // namespace SurfaceDiffusion
