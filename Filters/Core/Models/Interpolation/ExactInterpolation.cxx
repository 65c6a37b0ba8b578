// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
//
// SmoothInterpolation of values that hold.

#include "Core/Models/Interpolation/SmoothInterpolationWork.h"
#include "Core/Statistics/StudentFactor.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace SurfaceDiffusion
{

void SmoothInterpolation::FitExactly(
  Work& work, Result& result, const ProgressMonitor& progress) const
{
  const ScatteredValues& rows = work.Rows;
  const Eigen::Index columns = rows.Given.cols();
  Flags held = work.None;
  Values u = work.Start;
  for (Index i = 0; i < rows.Count(); ++i)
  {
    const Index vertex = rows.Places[i].Vertex();
    if (vertex >= 0)
    {
      held[vertex] = true;
      u.row(vertex) = rows.Given.row(i);
    }
  }
  work.Start = u;
  Index withoutEnergy = 1;
  if (this->Options.ComputeError && work.Energy.IsFree() && work.Determined == 0)
  {
    ScatteredValues weightless = rows;
    weightless.Weights.setZero();
    SmoothFit prior(work.Energy, weightless, Work::IsRegularMesh(*this->Assembly), this->Parallel);
    const PivotCounts pivots = prior.Prepare(1.0, work.None, false, progress.Part(0.0, 0.0));
    withoutEnergy = pivots.Open - pivots.Negative;
  }
  this->Prepare(work, result, 1.0, held, progress.Part(0.0, 0.7));
  if (work.Determined == 0)
  {
    work.Determined = std::max<Index>(1, withoutEnergy - work.Open);
  }
  Values forces = work.Fit.Solve(rows.Given, u);
  progress.Report(0.8);
  if (this->Options.ComputeError)
  {
    const Flags isOpen = this->FindOpen(work);
    result.HasInfiniteError = isOpen.any();
    // u^T Q u is the variance of the field times a chi-square variable.
    const Vector variances = work.Fit.InverseDiagonal(progress.Part(0.8, 0.95)) +
      this->VarianceOfMean(work, held, true, progress.Part(0.95, 0.95)); // without bounds
    const Vector energies = work.Energy.Squares(u);
    const double free = std::max<double>(1.0, rows.Count() - work.Determined);
    for (Eigen::Index c = 0; c < columns; ++c)
    {
      const double factor = StudentFactor(free);
      const double scale = factor * factor * energies[c] / free;
      for (Eigen::Index i = 0; i < u.rows(); ++i)
      {
        result.Error(i, c) =
          held[i] || isOpen[i] ? 0.0 : std::sqrt(std::max(0.0, scale * variances[i]));
      }
      // The energy of values that a function without energy reaches is round-off.
      constexpr double resolved = 1e-12;
      const bool isKnown = rows.Count() > work.Determined &&
        (held.all() ||
          result.Error.col(c).maxCoeff() > work.RoundOff(c, resolved, work.Energy.IsFree()));
      if (!isKnown)
      {
        result.Error.col(c).setConstant(std::numeric_limits<double>::quiet_NaN());
        result.HasUnknownError = true;
      }
      result.Error.col(c) =
        isOpen.select(std::numeric_limits<double>::infinity(), result.Error.col(c).array());
    }
  }
  for (Eigen::Index c = 0; c < columns && this->Options.KeepRange; ++c)
  {
    Values column = u.col(c);
    Values forcesOfColumn = forces.col(c);
    this->KeepInRange(work, result, c, held, column, forcesOfColumn, progress.Part(0.95, 1.0));
    u.col(c) = column;
  }
  result.U = u;
  for (Eigen::Index c = 0; c < columns; ++c)
  {
    Column& found = result.Columns[static_cast<std::size_t>(c)];
    const Vector given = rows.Given.col(c);
    const Vector misfit = given - work.Fit.AtPoints(u).col(c);
    found.Residual = std::sqrt(rows.Weights.dot(misfit.cwiseAbs2()) / rows.Weights.sum());
    found.DegreesOfFreedom = rows.Count();
  }
}

} // namespace SurfaceDiffusion
