// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <limits>

namespace SurfaceDiffusion
{

/// How exactly the quadratic problem is solved and by how much the penalty has grown. A
/// method whose penalty grows diverges if its errors grow with it, and slows down if the penalty
/// grows faster than it converges: when the gap has not fallen, errors become smaller and the
/// penalty stays, and falls in the end.
struct PenaltyPace
{
  static constexpr int IterationsPerCheck = 10;
  static constexpr double LeastReduction = 0.02;
  static constexpr double MostGrowth = 4.0; ///< at a time
  static constexpr int MostChecks = 3; ///< without a smaller gap

  double Reduction = 0.1; ///< of the residual of the quadratic problem, with a growing penalty
  double Growth = 1.0; ///< of the penalty
  double Smallest = std::numeric_limits<double>::infinity(); ///< gap
  int ChecksSinceSmallest = 0;

  /// Take the gap of a check into account. rate: of the growth per iteration.
  void Take(double gap, double rate)
  {
    if (gap < this->Smallest)
    {
      this->Smallest = gap;
      this->ChecksSinceSmallest = 0;
      this->Growth = std::min(this->Growth + rate * IterationsPerCheck, MostGrowth * this->Growth);
      return;
    }
    ++this->ChecksSinceSmallest;
    this->Reduction = std::max(LeastReduction, 0.5 * this->Reduction);
    if (this->ChecksSinceSmallest % MostChecks == 0 && gap > 2.0 * this->Smallest)
    {
      this->Growth = std::max(1.0, 0.5 * this->Growth);
    }
  }
};

} // namespace SurfaceDiffusion
