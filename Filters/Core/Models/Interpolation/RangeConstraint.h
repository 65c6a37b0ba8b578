// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Core/Foundation/ProgressMonitor.h"
#include "Core/Models/Interpolation/ScatteredValues.h"
#include "Core/Models/Interpolation/SmoothFit.h"

#include <functional>
#include <vector>

namespace SurfaceDiffusion
{

/// The bounds min d <= u <= max d of a smooth fit to a column d of the data, by a primal-dual active
/// set (M. Hintermueller, K. Ito, K. Kunisch, SIAM J. Optim. 13, 2002): vertices beyond a bound are
/// held at it, and are released when the energy draws them inwards.
class RangeConstraint
{
public:
  /// data: must outlive it. isExact: the values hold. low, high: the bounds, per vertex.
  RangeConstraint(
    const ScatteredValues& data, Eigen::Index column, bool isExact, Vector low, Vector high);

  /// Prepares the fit with more vertices held.
  using Prepare = std::function<void(const Flags&, const ProgressMonitor&)>;

  /// u: the minimiser without bounds, of which the vertices of `held` stay as they are; becomes the
  /// minimiser under the bounds. forces: its multipliers of exact values. Returns whether it is
  /// optimal: the set may not settle, and exact values inside triangles may exclude each other.
  /// Throws Aborted, and what `prepare` throws.
  bool Impose(SmoothFit& fit, const Prepare& prepare, const Flags& held, Values& u, Values& forces,
    const ProgressMonitor& progress) const;

private:
  enum Side : signed char
  {
    Below = -1,
    Inside = 0,
    Above = 1
  };

  bool Force(const Flags& held, std::vector<Side>& active, std::vector<char>& isForced) const;

  const ScatteredValues& Data;
  const Eigen::Index Column;
  const bool IsExact;
  const Vector Low, High;
};

} // namespace SurfaceDiffusion
