// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Core/Solvers/ConjugateGradients.h"
#include "Core/Solvers/LinearSolver.h"
#include "Core/Solvers/SinglePrecisionSolver.h"

#include <vector>

namespace SurfaceDiffusion
{

/// Plans the passes of SinglePrecisionSolver, from one residual in double precision to the next.
class SinglePrecisionPasses
{
public:
  /// share: of the sums of the rows in the diagonal, without entries along lines. (1 + lambda dt) M
  /// + dt K has the row sums of its first term, so that this measures the condition: 7e-4 is the
  /// diffusion number 300. leastShare: the least over the rows of (a_ii - sum of the other |a_ij|)
  /// / a_ii, which no eigenvalue of D^-1 A is below (Gershgorin), or 0 if it is not known.
  void SetShares(double share, double leastShare)
  {
    this->Share = share;
    this->LeastShare = leastShare;
  }

  /// Whether rounding to single precision may cost less than its speed gains.
  bool MayHelp() const;

  void Start(int columns) { this->Columns.assign(columns, SinglePrecisionSolver::Column()); }

  /// Decide for each column by how much the next pass reduces its residual, whose squares, unit and
  /// reference are in `measured`. Returns the largest number of passes that are left, or 0.
  double Plan(const ConjugateGradientWork& measured, double tolerance, SolveReport& report);

  /// After a last pass of `iterations`: whether it has brought every column within the tolerance,
  /// as the recurrence and that allowance show. Then the residual in the report is a bound.
  bool HaveReachedGoals(int iterations, double tolerance, SolveReport& report) const;

  std::vector<SinglePrecisionSolver::Column> Columns;

private:
  double ResolvedIterations() const;

  double Share = 0.0, LeastShare = 0.0;
};

} // namespace SurfaceDiffusion
