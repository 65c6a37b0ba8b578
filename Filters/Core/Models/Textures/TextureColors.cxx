// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Models/Textures/TextureColors.h"

#include <cmath>

namespace SurfaceDiffusion
{

std::array<double, 2> ContrastLimits(const Eigen::Ref<const Vector>& u, const Reduction& reduction)
{
  return { reduction.Quantile(u, 0.01), reduction.Quantile(u, 0.99) };
}

Vector StretchContrast(const Eigen::Ref<const Vector>& u, const std::array<double, 2>& limits)
{
  const double low = limits[0];
  const double high = limits[1];
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
