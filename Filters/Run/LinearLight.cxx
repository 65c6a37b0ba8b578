// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Run/LinearLight.h"

#include <algorithm>
#include <cmath>

namespace SurfaceDiffusion
{

namespace
{

constexpr double White = 255.0;

double Decode(double s)
{
  return s <= 0.04045 ? s / 12.92 : std::pow((s + 0.055) / 1.055, 2.4);
}

double Encode(double light)
{
  return light <= 0.0031308 ? 12.92 * light : 1.055 * std::pow(light, 1.0 / 2.4) - 0.055;
}

template <typename F>
void ForEachNumber(Values& colors, const ParallelFor& parallel, const F& f)
{
  ForEach(parallel, static_cast<Index>(colors.rows()),
    [&](Index i)
    {
      for (Eigen::Index k = 0; k < colors.cols(); ++k)
      {
        colors(i, k) = f(colors(i, k));
      }
    });
}

} // namespace

void DecodeColors(Values& colors, const ParallelFor& parallel)
{
  ForEachNumber(colors, parallel, [](double v) { return White * Decode(v / White); });
}

void EncodeColors(Values& colors, const ParallelFor& parallel)
{
  ForEachNumber(
    colors, parallel, [](double v) { return White * Encode(std::clamp(v / White, 0.0, 1.0)); });
}

} // namespace SurfaceDiffusion
