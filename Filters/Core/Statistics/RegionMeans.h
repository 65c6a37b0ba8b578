// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Core/Surface/PointData.h"
#include "Core/Surface/TriangleMesh.h"

#include <cstdint>
#include <vector>

namespace SurfaceDiffusion
{

/// Means of `regions` regions, a row each, from which Segmentation starts: the cluster centres of
/// the known values of f, each vertex with the weight of its control area times its fidelity factor.
/// Of a scalar they have the least sum of squares of all; see FindScalarClusters(). Otherwise they
/// are found by Lloyd's algorithm (S. Lloyd, IEEE Trans. Inf. Theory 28, 1982) from the best of
/// several starts of greedy k-means++ (D. Arthur, S. Vassilvitskii, SODA 2007). Rows are in
/// ascending order of the first component, then of the next ones. With fewer different values than
/// regions the last rows are NaN.
///
/// seeds: per vertex the label 1 .. K of a region that it belongs to, or 0; may be empty. With
/// seeds the rows stay in the order of the labels: a label with seeds starts at the mean of its
/// seeds, and the others by k-means++. randomSeed, ids: for the random numbers; ids has one number
/// per vertex.
Values FindRegionMeans(const TriangleMesh& mesh, const PointData& data, Index regions,
  const std::vector<Index>& seeds, std::int64_t randomSeed, const std::vector<std::int64_t>& ids,
  const ParallelFor& parallel = SerialFor());

/// The rows of means in ascending order of the first component, then of the next ones, and unused
/// ones last; empty if they are in this order.
std::vector<Eigen::Index> AscendingOrder(const Values& means);

/// The square of the diagonal of the box around the known values, which bounds their distance from
/// means of them; 1 if they are equal.
double LargestSquare(const PointData& data);

/// Whether the mean of a region is not NaN.
bool IsUsed(const Values& means, Eigen::Index region);

/// The rows of means of the regions that are used.
Values UsedMeans(const Values& means);

/// The contrast of the data terms r_k = |f - c_k|^2 (or of the given ones, if there is no mean):
/// the difference between the smallest two of a vertex, on average over the known vertices of which
/// they differ, each with the weight of its control area times its fidelity factor. 0 if there is
/// no such vertex. Rows of NaN do not count. For data of two values it is the square of their
/// difference, and noise hardly changes it.
double MeanContrast(const TriangleMesh& mesh, const PointData& data, const Values& means,
  const ParallelFor& parallel = SerialFor());

} // namespace SurfaceDiffusion
