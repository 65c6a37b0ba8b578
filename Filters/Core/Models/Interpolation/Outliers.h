// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Core/Models/Interpolation/SmoothInterpolation.h"

#include <vector>

namespace SurfaceDiffusion
{

/// The residuals d_i - u(p_i) of given values, d x k, of a fit u, n x k.
Values ResidualsOf(const ScatteredValues& data, const Values& u);

/// Residuals of a column beyond this many standard deviations are those of outliers.
constexpr double OutlierDeviations = 4.0;

/// How many residuals are beyond OutlierDeviations deviations sigma of the others, sigma = 1.4826 times their
/// median magnitude. 0 of fewer than 20 values, and of so few that white noise has as many once in
/// fifty times.
Index CountOutliers(const ScatteredValues& data, const Values& residuals, Eigen::Index column);

/// The values of a column that the others contradict, nonzero: those whose residual over
///   sigma / sqrt(w_i) sqrt(1 - S_ii)  or, without them in the fit,  sigma / sqrt(w_i) sqrt(1 + w_i H^-1_ii)
/// is beyond OutlierDeviations. The fits start with Huber's weights (P. Huber, Ann. Math. Statist. 35, 1964),
/// of which no value has much influence; then outliers are left out until the others stay. sigma is by
/// the median, so that up to half of the values may be wrong. None of fewer than eight values.
///
/// search: with ComputeLeverage. Throws as SmoothInterpolation::Fit().
std::vector<char> FindOutliers(const SmoothInterpolation& search, const ScatteredValues& data,
  Eigen::Index column, const ProgressMonitor& progress = ProgressMonitor());

} // namespace SurfaceDiffusion
