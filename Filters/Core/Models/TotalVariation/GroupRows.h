// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Core/Foundation/Columns.h"
#include "Core/Foundation/Types.h"

#include <cstddef>

namespace SurfaceDiffusion
{

// Groups of two rows of Values, with K columns, or any number of them for K = 0: see
// GeneralizedGradient.

template <int K>
const double* GroupOf(const Values& values, Index g)
{
  const ColumnCount<K> columns(values.cols());
  return values.data() + static_cast<std::ptrdiff_t>(2 * g) * columns;
}
template <int K>
double* GroupOf(Values& values, Index g)
{
  const ColumnCount<K> columns(values.cols());
  return values.data() + static_cast<std::ptrdiff_t>(2 * g) * columns;
}

/// Column k of a group of two rows.
template <int K>
Eigen::Vector2d VectorAt(const Values& values, Index g, int k)
{
  const ColumnCount<K> columns(values.cols());
  const double* const group = GroupOf<K>(values, g);
  return { group[k], group[columns + k] };
}

/// The square of a group over all columns.
template <int K>
double SquareOf(const double* group, Eigen::Index count)
{
  const ColumnCount<K> columns(count);
  double sum = 0.0;
  for (int k = 0; k < 2 * columns; ++k)
  {
    sum += group[k] * group[k];
  }
  return sum;
}

template <int K>
void SetVector(Values& values, Index g, int k, const Eigen::Vector2d& vector)
{
  const ColumnCount<K> columns(values.cols());
  double* const group = GroupOf<K>(values, g);
  group[k] = vector[0];
  group[columns + k] = vector[1];
}

} // namespace SurfaceDiffusion
