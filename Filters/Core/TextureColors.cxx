// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "TextureColors.h"

#include <algorithm>
#include <cmath>

namespace SurfaceDiffusion
{

namespace
{

double Percentile(Vector& values, double fraction)
{
  double* const begin = values.data();
  double* const end = begin + values.size();
  double* const at = begin + std::lround(fraction * static_cast<double>(values.size() - 1));
  std::nth_element(begin, at, end);
  return *at;
}

} // namespace

Vector StretchContrast(const Eigen::Ref<const Vector>& u)
{
  if (u.size() == 0)
  {
    return u;
  }
  Vector sorted = u;
  const double low = Percentile(sorted, 0.01);
  const double high = Percentile(sorted, 0.99);
  if (!(high > low))
  {
    return Vector::Constant(u.size(), 0.5);
  }
  return ((u.array() - low) / (high - low)).max(0.0).min(1.0);
}

Colors MixColors(const Eigen::Ref<const Vector>& shares, const std::array<double, 3>& low,
  const std::array<double, 3>& high)
{
  Colors colors(shares.size(), 3);
  for (Eigen::Index i = 0; i < shares.size(); ++i)
  {
    for (int k = 0; k < 3; ++k)
    {
      const double mixed = (1.0 - shares[i]) * low[k] + shares[i] * high[k];
      colors(i, k) = static_cast<unsigned char>(std::lround(255.0 * mixed));
    }
  }
  return colors;
}

} // namespace SurfaceDiffusion
