// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Core/Models/Trajectory.h"

#include <vector>

namespace SurfaceDiffusion
{

/// The history of a run: one entry per step, the first for the initial state. Quantities are sums
/// over the surfaces, in coordinate and array units; a run that has ended by itself has no entries
/// after its last step.
struct History
{
  std::vector<double> Time; ///< in the unit of TimeStep
  std::vector<std::vector<double>> Totals; ///< per component, per step: sum of A_i u_i
  std::vector<StepRecord> Records; ///< Residual: the largest
  bool CountsClamped = false;
  bool BoundsError = false;

  long long NumberOfIterations() const
  {
    long long sum = 0;
    for (const StepRecord& record : this->Records)
    {
      sum += record.Iterations;
    }
    return sum;
  }
  double LargestResidual() const
  {
    double largest = 0.0;
    for (const StepRecord& record : this->Records)
    {
      largest = record.Residual > largest ? record.Residual : largest;
    }
    return largest;
  }
};

} // namespace SurfaceDiffusion
