// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Run/Angles.h"

#include <cmath>
#include <limits>

namespace SurfaceDiffusion
{

namespace
{

constexpr double Turn = 6.283185307179586;

} // namespace

void VisitPeriod(SettingVisitor& visitor, double& period)
{
  visitor.Number(
    { "Period", "values",
      "The period of cyclic data, such as 360 for angles in degrees, 24 for hours of the "
      "day, or the cycle length of a re-entry. Data that differ by it are the same. The "
      "result is in the interval of that length which starts at 0, at minus half of it, "
      "or at the minimum of the data, the first that holds all of them; a second result, "
      "the coherence, is 1 where the data around are equal, and near 0 where they cancel "
      "each other. 0: the data are not cyclic." },
    period, SettingRange::NonNegative());
}

void EncodeAngles(Values& values, double period, const ParallelFor& parallel)
{
  Values vectors(values.rows(), 2 * values.cols());
  ForEach(parallel, static_cast<Index>(values.rows()),
    [&](Index i)
    {
      for (Eigen::Index k = 0; k < values.cols(); ++k)
      {
        // The remainder is exact, so that a period more changes no bit.
        const double angle = std::remainder(values(i, k), period) / period * Turn;
        vectors(i, 2 * k) = std::cos(angle);
        vectors(i, 2 * k + 1) = std::sin(angle);
      }
    });
  values = std::move(vectors);
}

Values DecodeAngles(const Values& vectors, double period, double begin, const ParallelFor& parallel)
{
  Values values(vectors.rows(), vectors.cols() / 2);
  ForEach(parallel, static_cast<Index>(values.rows()),
    [&](Index i)
    {
      for (Eigen::Index k = 0; k < values.cols(); ++k)
      {
        const double angle = std::atan2(vectors(i, 2 * k + 1), vectors(i, 2 * k)) / Turn * period;
        // Round-off just below the start stays there, and does not become the end.
        const double below = std::floor((angle - begin) / period + 1e-12);
        values(i, k) = angle - period * below;
      }
    });
  return values;
}

Values CoherenceOfAngles(const Values& vectors)
{
  Values lengths(vectors.rows(), vectors.cols() / 2);
  for (Eigen::Index k = 0; k < lengths.cols(); ++k)
  {
    lengths.col(k) = vectors.middleCols(2 * k, 2).rowwise().norm();
  }
  return lengths;
}

double BeginOfAngles(const ValueBounds& bounds, double period)
{
  for (const double begin : { 0.0, -0.5 * period })
  {
    if (bounds.Low >= begin && bounds.High <= begin + period)
    {
      return begin;
    }
  }
  return std::isfinite(bounds.Low) ? bounds.Low : 0.0;
}

} // namespace SurfaceDiffusion
