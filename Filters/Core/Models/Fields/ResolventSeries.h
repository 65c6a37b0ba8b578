// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Core/Foundation/Parallel.h"
#include "Core/Foundation/ProgressMonitor.h"
#include "Core/Foundation/Types.h"

#include <utility>
#include <vector>

namespace SurfaceDiffusion
{

/// u becomes p(Y) u with a Chebyshev series of p on [0, 1], as of ChebyshevSeries(), by Clenshaw's
/// recurrence for the polynomials of 2 Y - 1. apply(b, y, part): y = Y b, reporting to its part.
template <typename Apply>
void SumResolvents(const std::vector<double>& series, Values& u, const Apply& apply,
  const ParallelFor& parallel, const ProgressMonitor& progress)
{
  const auto n = static_cast<Index>(u.rows());
  const std::size_t degree = series.size() - 1;
  Values b = series[degree] * u;
  Values next = Values::Zero(u.rows(), u.cols());
  Values y;
  for (std::size_t k = degree; k-- > 0;)
  {
    const auto all = static_cast<double>(degree);
    const double done = static_cast<double>(degree - 1 - k) / all;
    apply(b, y, progress.Part(done, done + 1.0 / all));
    const double twice = k == 0 ? 1.0 : 2.0;
    ForEach(parallel, n,
      [&](Index i)
      { next.row(i) = series[k] * u.row(i) + twice * (2.0 * y.row(i) - b.row(i)) - next.row(i); });
    std::swap(b, next);
  }
  u.swap(b);
}

} // namespace SurfaceDiffusion
