// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <utility>
#include <vector>

namespace SurfaceDiffusion
{

/// The means, in ascending order, of the `clusters` clusters of numbers with the least weighted sum of
/// squares, by dynamic programming over the sorted numbers (W. Fisher, J. Amer. Statist. Assoc. 53,
/// 1958). Clusters of numbers are intervals, so that this is the global minimum. More than a few
/// thousand different numbers are taken in groups, each of which has at most a thousandth of the range
/// and a thousandth of the different numbers. Fewer means if there are fewer different numbers:
/// differences by round-off do not count.
///
/// numbers: pairs of a number and its weight > 0.
std::vector<double> FindScalarClusters(
  std::vector<std::pair<double, double>> numbers, std::size_t clusters);

} // namespace SurfaceDiffusion
