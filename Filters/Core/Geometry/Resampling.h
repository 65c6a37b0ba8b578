// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Core/Foundation/Parallel.h"
#include "Core/Foundation/Types.h"

namespace SurfaceDiffusion
{

/// Weights of ResamplingWeights(), in memory of anyone.
using RowWeights = Eigen::Map<const Eigen::SparseMatrix<double, Eigen::RowMajor, Index>>;

/// Columns of values, one row per vertex, `Stride` numbers from row to row.
template <typename T>
struct ColumnView
{
  T* First;
  Eigen::Index Stride;
  Eigen::Index Columns;
};

/// The weighted means of the source's values at the target's vertices, per column. NaN is missing: the
/// others are weighed by the same weights, and a row without a known value is NaN. A constant keeps
/// its bits. T: float or double.
template <typename T>
void ResampleMeans(const RowWeights& weights, const ColumnView<const T>& source,
  const ColumnView<T>& target, const ParallelFor& parallel);

/// The labels with the largest sums of weights, per column; of equal sums, the smallest label. NaN is
/// missing, as above.
void ResampleLabels(const RowWeights& weights, const ColumnView<const double>& source,
  const ColumnView<double>& target, const ParallelFor& parallel);

} // namespace SurfaceDiffusion
