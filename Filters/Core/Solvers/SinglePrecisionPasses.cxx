// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Solvers/SinglePrecisionPasses.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace SurfaceDiffusion
{

namespace
{

/// Below, rounding to single precision costs more iterations than their speed gains, unless one
/// pass reaches the tolerance.
constexpr double SmallestShare = 7e-4;
constexpr double SmallestShareOfOnePass = 1e-4;
constexpr double MostOfOnePass = 1e-5;
/// From here on (the diffusion number 3), round-off of single precision does no harm to a reduction
/// by MostOfOnePass either; otherwise it is 1e-4.
constexpr double SmallestShareOfLongPasses = 0.05;
/// A pass aims at this share of the tolerance. The rest is for round-off.
constexpr double Aim = 0.7;

} // namespace

bool SinglePrecisionPasses::MayHelp() const
{
  return this->Share >= SmallestShareOfOnePass;
}

double SinglePrecisionPasses::Plan(
  const ConjugateGradientWork& measured, double tolerance, SolveReport& report)
{
  const double most = this->Share >= SmallestShareOfLongPasses ? MostOfOnePass : 1e-4;
  constexpr double least = 0.1; // a pass that gains less is the last one of its column
  double passes = 0.0;
  report.Residual = 0.0;
  for (std::size_t c = 0; c < this->Columns.size(); ++c)
  {
    SinglePrecisionSolver::Column& column = this->Columns[c];
    const double before = column.Length;
    column.Length = std::sqrt(measured.Sums[c]);
    column.Reached = column.Length; // of a column that iterations leave
    column.Unit = measured.Unit[c];
    column.ReferenceLength = std::sqrt(measured.Reference[c]);
    column.Reduction = 1.0;
    const double residual = column.Length / column.ReferenceLength;
    if (!std::isfinite(residual))
    {
      report.Converged = false; // iterations in double precision report it
      return 0.0;
    }
    report.Residual = std::max(report.Residual, residual);
    const bool hasStalled = before > 0.0 && !(column.Length <= least * before);
    if (residual > tolerance && !hasStalled)
    {
      const double needed = Aim * tolerance / residual;
      const double ofColumn =
        needed >= MostOfOnePass ? 1.0 : std::ceil(std::log(needed) / std::log(most));
      if (ofColumn == 1.0 || this->Share >= SmallestShare)
      {
        column.Reduction = std::pow(needed, 1.0 / ofColumn);
        passes = std::max(passes, ofColumn);
      }
    }
  }
  report.Converged = report.Residual <= tolerance;
  return passes;
}

/// The number of iterations up to which round-off stays within what the pass allows for it. After k
/// iterations the residual b - A y of what a pass adds, y, differs from that of the recurrence by
/// about k epsilon |A| |y| (A. Greenbaum, SIAM J. Matrix Anal. Appl. 18, 1997). With unit diagonal
/// the eigenvalues of A are between s = LeastShare and 2 - s, so that |y| is at most about |r|/s.
/// The factor leaves room for the length of the rows and for a pass that goes on
/// along the last direction.
double SinglePrecisionPasses::ResolvedIterations() const
{
  constexpr double perIteration = 8.0 * std::numeric_limits<float>::epsilon();
  double least = 1.0;
  for (const SinglePrecisionSolver::Column& column : this->Columns)
  {
    least = std::min(least, column.Reduction);
  }
  return (1.0 / Aim - 1.0) * least * this->LeastShare / perIteration;
}

bool SinglePrecisionPasses::HaveReachedGoals(
  int iterations, double tolerance, SolveReport& report) const
{
  const double resolved = this->ResolvedIterations();
  if (!(iterations <= resolved))
  {
    return false;
  }
  double largest = 0.0;
  for (const SinglePrecisionSolver::Column& column : this->Columns)
  {
    const double goal = column.Reduction * column.Length;
    const double roundOff =
      column.Reduction < 1.0 ? (1.0 / Aim - 1.0) * goal * iterations / resolved : 0.0;
    if (!(column.Reached <= goal))
    {
      return false;
    }
    largest = std::max(largest, (column.Reached + roundOff) / column.ReferenceLength);
  }
  if (!(largest <= tolerance)) // of a column that this pass has left
  {
    return false;
  }
  report.Residual = largest;
  report.Converged = true;
  return true;
}

} // namespace SurfaceDiffusion
