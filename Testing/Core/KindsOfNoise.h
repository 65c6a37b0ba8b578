// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Core/Foundation/Random.h"

#include <algorithm>
#include <cmath>
#include <cstdint>

namespace SurfaceDiffusion::Testing
{

enum class NoiseKind
{
  Gaussian,
  Uniform,
  Laplace,
  Uneven, ///< every second value ten times as noisy as the others
  Outliers, ///< 5 times as large in 10 % of the values
  Quantized, ///< Gaussian, rounded to eighths
  SaltAndPepper, ///< +-4 sigma in 5 % of the values, and sigma/4 in all
  Poisson, ///< its variance grows with f
  Rician
};

constexpr const char* NamesOfNoise[] = { "Gaussian", "uniform", "Laplace", "uneven", "outliers",
  "quantized", "salt and pepper", "Poisson", "Rician" };

inline double GaussianNumber(std::int64_t i, int seed)
{
  const double r = std::sqrt(-2.0 * std::log(1.0 - UniformRandom(seed, 0, i)));
  return r * std::cos(2.0 * 3.14159265358979323846 * UniformRandom(seed, 1, i));
}

/// The value f, about -0.5 to 1, of place i with noise of about the deviation sigma.
inline double WithNoise(NoiseKind kind, double f, double sigma, std::int64_t i)
{
  const double uniform = UniformRandom(4, 2, i) - 0.5;
  const double gaussian = sigma * GaussianNumber(i, 4);
  switch (kind)
  {
    case NoiseKind::Uniform:
      return f + std::sqrt(12.0) * sigma * uniform;
    case NoiseKind::Laplace:
      return f -
        std::copysign(sigma / std::sqrt(2.0), uniform) * std::log(1.0 - 2.0 * std::abs(uniform));
    case NoiseKind::Uneven:
      return f + (i % 2 == 0 ? 0.14 : 1.4) * gaussian;
    case NoiseKind::Outliers:
      return f + (UniformRandom(5, 0, i) < 0.1 ? 5.0 : 1.0) * gaussian;
    case NoiseKind::Quantized:
      return std::round((f + gaussian) * 8.0) / 8.0;
    case NoiseKind::SaltAndPepper:
      return f + 0.25 * gaussian +
        (UniformRandom(5, 0, i) < 0.05 ? std::copysign(4.0 * sigma, uniform) : 0.0);
    case NoiseKind::Poisson:
      return f + std::sqrt(std::max(0.05, f + 0.6)) * gaussian;
    case NoiseKind::Rician:
      return std::hypot(f + 1.0 + gaussian, sigma * GaussianNumber(i, 11)) - 1.0;
    default:
      return f + gaussian;
  }
}

} // namespace SurfaceDiffusion::Testing
