// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <tuple>
#include <type_traits>
#include <utility>

namespace SurfaceDiffusion
{

/// How the channels of a colour are combined in norms, of the gradient and of L1 fidelity.
enum class ChannelCoupling
{
  PerChannel, ///< every channel has its own norm
  Joint ///< one Euclidean norm over all: edges of all channels stay in one place
};

/// Call act(first, last) for the channels that share a norm: all, or one after the other.
template <typename Act>
void ForEachNorm(ChannelCoupling coupling, int channels, const Act& act)
{
  if (coupling == ChannelCoupling::Joint)
  {
    act(0, channels);
    return;
  }
  for (int k = 0; k < channels; ++k)
  {
    act(k, k + 1);
  }
}

/// The edge-stopping functions (diffusivities) g(s), s = |grad u|, of (2) and (3): the larger the
/// gradient, the weaker the diffusion. K is the edge threshold and beta a regularisation; both are
/// in units of the gradient (beta squared). Perona-Malik and Weickert sharpen edges steeper than
/// about K: their flux s g(s) decreases there, so that they are not gradients of a convex energy.
///
/// ADDING_A_MODEL.md lists what a new function needs besides a struct and a place in
/// EdgeFunctionList, and a name here.
enum class EdgeFunctionKind
{
  TotalVariation,
  PeronaMalikExponential,
  PeronaMalikRational,
  Charbonnier,
  Weickert,
  Constant
};

/// Each struct has, as functions of the square of s,
///   Weight     g;
///   Potential  the energy density psi with psi'(s) = s g(s), psi(0) = 0;
/// and with a convex psi
///   Shrinkage  the proximal map of psi/r: the solution p of p + psi'(p)/r = s, as a share of s;
///   Conjugate  the convex conjugate psi*(|y|), from the square of |y| <= sup psi'.
namespace EdgeFunctionList
{

/// (3) g = 1/sqrt(s^2 + beta) (L. Rudin, S. Osher, E. Fatemi, Physica D 60, 1992). Shrinkage and
/// conjugate are those of beta = 0.
struct TotalVariation
{
  static constexpr const char* Name = "TotalVariation";
  static constexpr bool Convex = true;
  static constexpr bool Dimensionless = false;
  double Beta, Threshold;

  double Weight(double squared) const { return 1.0 / std::sqrt(squared + this->Beta); }
  double Potential(double squared) const // sqrt(s^2 + beta) - sqrt(beta)
  {
    return squared > 0.0 ? squared / (std::sqrt(squared + this->Beta) + std::sqrt(this->Beta))
                         : 0.0;
  }
  double Shrinkage(double r, double s) const { return r * s > 1.0 ? 1.0 - 1.0 / (r * s) : 0.0; }
  double Conjugate(double) const { return 0.0; }
};

/// The functions of s/K.
struct WithThreshold
{
  static constexpr bool Convex = false;
  static constexpr bool Dimensionless = true;
  double Beta, Threshold;

  double SquaredThreshold() const { return this->Threshold * this->Threshold; }
  double Ratio(double squared) const { return squared / this->SquaredThreshold(); } ///< (s/K)^2
};

/// g = exp(-(s/K)^2) (P. Perona, J. Malik, IEEE PAMI 12(7), 1990)
struct PeronaMalikExponential : WithThreshold
{
  static constexpr const char* Name = "PeronaMalikExponential";

  double Weight(double squared) const { return std::exp(-this->Ratio(squared)); }
  double Potential(double squared) const
  {
    return -0.5 * this->SquaredThreshold() * std::expm1(-this->Ratio(squared));
  }
};

/// g = 1/(1 + (s/K)^2) (the same paper)
struct PeronaMalikRational : WithThreshold
{
  static constexpr const char* Name = "PeronaMalikRational";

  double Weight(double squared) const { return 1.0 / (1.0 + this->Ratio(squared)); }
  double Potential(double squared) const
  {
    return 0.5 * this->SquaredThreshold() * std::log1p(this->Ratio(squared));
  }
};

/// g = 1/sqrt(1 + (s/K)^2) (P. Charbonnier et al., IEEE ICIP, 1994)
struct Charbonnier : WithThreshold
{
  static constexpr const char* Name = "Charbonnier";
  static constexpr bool Convex = true;

  double Weight(double squared) const { return 1.0 / std::sqrt(1.0 + this->Ratio(squared)); }
  double Potential(double squared) const // K^2 (sqrt(1 + (s/K)^2) - 1)
  {
    return squared / (1.0 + std::sqrt(1.0 + this->Ratio(squared)));
  }
  double Shrinkage(double r, double s) const
  {
    // The left side is concave: Newton's iterates increase to the solution.
    const double start = r / (1.0 + r);
    double p = start * s;
    for (int i = 0; i < 30 && s > 0.0; ++i)
    {
      const double ratio = p / this->Threshold;
      const double g = 1.0 / std::sqrt(1.0 + ratio * ratio);
      const double step = (s - p - p * g / r) / (1.0 + g * g * g / r);
      p += step;
      if (!(step > 1e-15 * s))
      {
        break;
      }
    }
    return s > 0.0 ? std::min(1.0, p / s) : start;
  }
  double Conjugate(double squared) const
  {
    return this->SquaredThreshold() * (1.0 - std::sqrt(std::max(0.0, 1.0 - this->Ratio(squared))));
  }
};

/// g = 1 - exp(-3.31488/(s/K)^8), 1 at s = 0 (J. Weickert, Anisotropic Diffusion in Image
/// Processing, 1998, section 5.2)
struct Weickert : WithThreshold
{
  static constexpr const char* Name = "Weickert";
  static constexpr double C = 3.31488; ///< makes the flux s g(s) largest at s = K

  double Weight(double squared) const
  {
    const double ratio = this->Ratio(squared);
    return -std::expm1(-C / (ratio * ratio * ratio * ratio));
  }
  double Potential(double squared) const;
};

/// g = 1: linear diffusion (1)
struct Constant
{
  static constexpr const char* Name = "Constant";
  static constexpr bool Convex = true;
  static constexpr bool Dimensionless = true;
  double Beta, Threshold;

  double Weight(double) const { return 1.0; }
  double Potential(double squared) const { return 0.5 * squared; }
  double Shrinkage(double r, double) const { return r / (1.0 + r); }
  double Conjugate(double squared) const { return 0.5 * squared; }
};

/// In the order of EdgeFunctionKind.
using All = std::tuple<TotalVariation, PeronaMalikExponential, PeronaMalikRational, Charbonnier,
  Weickert, Constant>;

} // namespace EdgeFunctionList

constexpr int NumberOfEdgeFunctions = static_cast<int>(std::tuple_size_v<EdgeFunctionList::All>);

/// What is known of an edge-stopping function without its parameters.
struct EdgeFunctionProperties
{
  const char* Name;
  bool Convex; ///< its energy is convex
  bool Dimensionless; ///< g has no unit; otherwise that of 1/s
};

EdgeFunctionProperties GetEdgeFunction(EdgeFunctionKind kind);

/// An edge-stopping function with its parameters.
struct EdgeFunction
{
  EdgeFunctionKind Kind = EdgeFunctionKind::TotalVariation;
  double Beta = 1e-6; ///< of TotalVariation; > 0, and 0 if only Potential() is used
  double Threshold = 1.0; ///< K > 0 of the others

  /// g from the square of s.
  double operator()(double squared) const
  {
    return this->Visit([squared](const auto& g) { return g.Weight(squared); });
  }
  double Potential(double squared) const
  {
    return this->Visit([squared](const auto& g) { return g.Potential(squared); });
  }
  /// 1 for functions whose potential is not convex.
  double Shrinkage(double r, double s) const
  {
    return this->Visit(
      [r, s](const auto& g)
      {
        if constexpr (std::decay_t<decltype(g)>::Convex)
        {
          return g.Shrinkage(r, s);
        }
        else
        {
          return 1.0;
        }
      });
  }
  /// 0 for functions whose potential is not convex.
  double Conjugate(double squared) const
  {
    return this->Visit(
      [squared](const auto& g)
      {
        if constexpr (std::decay_t<decltype(g)>::Convex)
        {
          return g.Conjugate(squared);
        }
        else
        {
          return 0.0;
        }
      });
  }

private:
  /// f(struct of EdgeFunctionList): a chain of comparisons with Kind, as in a switch.
  template <std::size_t N = 0, typename F>
  double Visit(const F& f) const
  {
    if constexpr (N + 1 < std::tuple_size_v<EdgeFunctionList::All>)
    {
      if (static_cast<std::size_t>(this->Kind) != N)
      {
        return this->Visit<N + 1>(f);
      }
    }
    std::tuple_element_t<N, EdgeFunctionList::All> function;
    function.Beta = this->Beta;
    function.Threshold = this->Threshold;
    return f(function);
  }
};

} // namespace SurfaceDiffusion
