// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <cmath>
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

  /// share: of the area, where there are no data. The energy is not strongly convex there, and what the
  /// hole is filled with hardly moves under a large penalty: 260 iterations in place of 650 to 10,000
  /// were measured. In a small hole it has a shorter way.
  static double LargestGrowth(double share)
  {
    constexpr double ofHoles = 6.0;
    constexpr double ofSmall = 1.5;
    return share > 0.0 ? std::max(ofHoles, ofSmall / std::sqrt(share))
                       : std::numeric_limits<double>::infinity();
  }

  double Largest = std::numeric_limits<double>::infinity(); ///< of Growth
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
      this->Growth = std::min({ this->Growth + rate * IterationsPerCheck, MostGrowth * this->Growth,
        std::max(this->Largest, this->Growth) });
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
