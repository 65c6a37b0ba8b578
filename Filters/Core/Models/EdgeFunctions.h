// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cmath>

namespace SurfaceDiffusion
{

/// The edge functions g(s), s = |grad u|, of (2): the larger the gradient, the weaker the
/// diffusion. K is the edge threshold and beta a regularisation; both are in units of the gradient
/// (beta squared). Perona-Malik and Weickert sharpen edges steeper than about K: their flux s g(s)
/// falls there, and no convex energy stands behind them.
enum class EdgeFunctionKind
{
  TotalVariation, ///< (3): 1/sqrt(s^2 + beta) (Rudin, Osher, Fatemi, Physica D 60, 1992)
  PeronaMalikExponential, ///< exp(-(s/K)^2) (Perona, Malik, IEEE PAMI 12(7), 1990)
  PeronaMalikRational, ///< 1/(1 + (s/K)^2) (the same paper)
  Charbonnier, ///< 1/sqrt(1 + (s/K)^2) (Charbonnier et al., IEEE ICIP, 1994)
  Weickert, ///< 1 - exp(-3.31488/(s/K)^8), 1 at s = 0 (Weickert, Anisotropic
            ///< Diffusion in Image Processing, 1998, section 5.2)
  Constant ///< 1: linear diffusion (1)
};

struct EdgeFunction
{
  EdgeFunctionKind Kind = EdgeFunctionKind::TotalVariation;
  double Beta = 1e-6; ///< of TotalVariation; > 0, and 0 where only Potential() is used
  double Threshold = 1.0; ///< K > 0 of the others

  /// g from the square of s.
  double operator()(double squared) const
  {
    const double ratio = squared / (this->Threshold * this->Threshold); // (s/K)^2
    switch (this->Kind)
    {
      case EdgeFunctionKind::TotalVariation:
        return 1.0 / std::sqrt(squared + this->Beta);
      case EdgeFunctionKind::PeronaMalikExponential:
        return std::exp(-ratio);
      case EdgeFunctionKind::PeronaMalikRational:
        return 1.0 / (1.0 + ratio);
      case EdgeFunctionKind::Charbonnier:
        return 1.0 / std::sqrt(1.0 + ratio);
      case EdgeFunctionKind::Weickert:
        return -std::expm1(-WeickertConstant / (ratio * ratio * ratio * ratio));
      case EdgeFunctionKind::Constant:
        break;
    }
    return 1.0;
  }

  /// The energy density psi with psi'(s) = s g(s), psi(0) = 0, from the square of s.
  double Potential(double squared) const;

  /// Makes the flux s g(s) largest at s = K.
  static constexpr double WeickertConstant = 3.31488;
};

} // namespace SurfaceDiffusion
