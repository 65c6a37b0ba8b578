// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Solvers/LinearSolver.h"

#include <algorithm>
#include <cmath>
#include <sstream>
#include <string>

namespace SurfaceDiffusion
{

namespace
{

std::string DescribeFailure(const SolveReport& report)
{
  std::ostringstream text;
  text << "the linear solver stopped after " << report.Iterations
       << " iterations at a relative residual of " << report.Residual;
  return text.str();
}

} // namespace

NotConverged::NotConverged(const SolveReport& report)
  : std::runtime_error(DescribeFailure(report))
{
}

void RequireAnswer(const SolveReport& report, const IterationLimits& limits)
{
  const double largest = AnswerFactor * std::max(limits.Tolerance, limits.AskedTolerance);
  // Negated: a residual that is not a number is no answer.
  if (!report.Converged && !report.IsFinal && !(report.Residual <= largest))
  {
    throw NotConverged(report);
  }
}

double ScaleOf(const Values& a, const Values& b, Eigen::Index column, const ParallelFor& parallel,
  const Reduction& overProcesses)
{
  double largest = Max(parallel, static_cast<Index>(a.rows()),
    [&](Index i) { return std::max(std::abs(a(i, column)), std::abs(b(i, column))); });
  overProcesses.Max(&largest, 1);
  return largest > 0.0 && std::isfinite(largest) ? std::exp2(std::ilogb(largest)) : 1.0;
}

} // namespace SurfaceDiffusion
