// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Statistics/ValueRange.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace SurfaceDiffusion
{

namespace
{

constexpr double RoundOff = 1e-12; ///< relative variation that is no data

} // namespace

double ValueRange(const Eigen::Ref<const Values>& u, const Reduction& reduction)
{
  constexpr double none = -std::numeric_limits<double>::infinity();
  double range = 0.0;
  for (Eigen::Index k = 0; k < u.cols(); ++k)
  {
    double bounds[2] = { none, none };
    if (u.rows() > 0)
    {
      bounds[0] = u.col(k).maxCoeff();
      bounds[1] = -u.col(k).minCoeff();
    }
    reduction.Max(bounds, 2);
    const double magnitude = std::max(std::abs(bounds[0]), std::abs(bounds[1]));
    const double ofColumn = bounds[0] + bounds[1];
    if (ofColumn > RoundOff * magnitude)
    {
      range = std::max(range, ofColumn);
    }
  }
  return range > 0.0 ? range : 1.0;
}

double TypicalRange(const Eigen::Ref<const Values>& u, const Reduction& reduction)
{
  double typical = 0.0;
  for (Eigen::Index k = 0; k < u.cols(); ++k)
  {
    const Vector column = u.col(k);
    const auto between = [&](double fraction)
    { return reduction.Quantile(column, 1.0 - fraction) - reduction.Quantile(column, fraction); };
    typical = std::max({ typical, between(0.05), 0.3 * between(0.005) });
  }
  return std::max(typical, 1e-4 * ValueRange(u, reduction));
}

Values WithoutOutliers(const Values& u, const Reduction& reduction)
{
  Values clipped = u;
  for (Eigen::Index k = 0; k < u.cols(); ++k)
  {
    const Vector column = u.col(k);
    const double margin = TypicalRange(u.col(k), reduction);
    const double low = reduction.Quantile(column, 0.005) - margin;
    const double high = reduction.Quantile(column, 0.995) + margin;
    clipped.col(k) = column.cwiseMax(low).cwiseMin(high);
  }
  return clipped;
}

double RangeOnTriangle(const TriangleMesh& mesh, const Eigen::Ref<const Values>& u, Index triangle)
{
  const auto corners = mesh.TriangleVertices().row(triangle);
  double range = 0.0;
  for (Eigen::Index k = 0; k < u.cols(); ++k)
  {
    const auto [low, high] = std::minmax({ u(corners[0], k), u(corners[1], k), u(corners[2], k) });
    range = std::max(range, high - low);
  }
  return range;
}

} // namespace SurfaceDiffusion
