// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Models/Textures/Kinetics.h"

#include <cmath>
#include <limits>

namespace SurfaceDiffusion
{

namespace
{

// ADDING_A_MODEL.md lists what a new kinetics needs besides a struct here and a row of the list.

using P = KineticsParameters;

const double NaN = std::numeric_limits<double>::quiet_NaN();

/// (24) F = gamma - u1 u2, G = u1 u2 - u2 - mu
struct Turing
{
  static double F(const P& p, double u1, double u2) { return p[0] - u1 * u2; }
  static double G(const P& p, double u1, double u2) { return u1 * u2 - u2 - p[1]; }
  static Eigen::Matrix2d Jacobian(const P&, double u1, double u2)
  {
    return (Eigen::Matrix2d() << -u2, -u1, u2, u1 - 1.0).finished();
  }
  static Eigen::Vector2d SteadyState(const P& p)
  {
    const double u2 = p[0] - p[1];
    return u2 > 0.0 ? Eigen::Vector2d(p[0] / u2, u2) : Eigen::Vector2d(NaN, NaN);
  }
};

/// F = b - u1 u2^2, G = a - u2 + u1 u2^2
struct Schnakenberg
{
  static double F(const P& p, double u1, double u2) { return p[1] - u1 * u2 * u2; }
  static double G(const P& p, double u1, double u2) { return p[0] - u2 + u1 * u2 * u2; }
  static Eigen::Matrix2d Jacobian(const P&, double u1, double u2)
  {
    const double a = u2 * u2;
    const double b = 2.0 * u1 * u2;
    return (Eigen::Matrix2d() << -a, -b, a, b - 1.0).finished();
  }
  static Eigen::Vector2d SteadyState(const P& p)
  {
    const double u2 = p[0] + p[1];
    return { p[1] / (u2 * u2), u2 };
  }
};

/// F = 25 (f (1 - u1) - u1 u2^2), G = 25 (u1 u2^2 - (f + k) u2): the unit of time is 1/25 of the
/// literature's, so that patterns take as long as with the other kinetics.
struct GrayScott
{
  static constexpr double Speed = 25.0;
  static double F(const P& p, double u1, double u2)
  {
    return Speed * (p[0] * (1.0 - u1) - u1 * u2 * u2);
  }
  static double G(const P& p, double u1, double u2)
  {
    return Speed * (u1 * u2 * u2 - (p[0] + p[1]) * u2);
  }
  static Eigen::Matrix2d Jacobian(const P& p, double u1, double u2)
  {
    const double a = u2 * u2;
    const double b = 2.0 * u1 * u2;
    return Speed * (Eigen::Matrix2d() << -a - p[0], -b, a, b - p[0] - p[1]).finished();
  }
  static Eigen::Vector2d SteadyState(const P& p)
  {
    const double loss = p[0] + p[1];
    const double root = std::sqrt(1.0 - 4.0 * loss * loss / p[0]); // NaN: washed out
    const double u1 = 0.5 * (1.0 - root);
    return { u1, p[0] * (1.0 - u1) / loss + 0.0 * root };
  }
};

/// F = B u2 - u1 u2^2, G = A - (B + 1) u2 + u1 u2^2
struct Brusselator
{
  static double F(const P& p, double u1, double u2) { return p[1] * u2 - u1 * u2 * u2; }
  static double G(const P& p, double u1, double u2)
  {
    return p[0] - (p[1] + 1.0) * u2 + u1 * u2 * u2;
  }
  static Eigen::Matrix2d Jacobian(const P& p, double u1, double u2)
  {
    const double a = u2 * u2;
    const double b = 2.0 * u1 * u2 - p[1];
    return (Eigen::Matrix2d() << -a, -b, a, b - 1.0).finished();
  }
  static Eigen::Vector2d SteadyState(const P& p) { return { p[1] / p[0], p[0] }; }
};

/// F = nu (u2^2 - u1), G = u2^2 / (u1 (1 + kappa u2^2)) - u2
struct GiererMeinhardt
{
  static double F(const P& p, double u1, double u2) { return p[0] * (u2 * u2 - u1); }
  static double G(const P& p, double u1, double u2)
  {
    const double square = u2 * u2;
    return square / (u1 * (1.0 + p[1] * square)) - u2;
  }
  static Eigen::Matrix2d Jacobian(const P& p, double u1, double u2)
  {
    const double square = u2 * u2;
    const double saturation = 1.0 + p[1] * square;
    const double production = square / (u1 * saturation);
    return (Eigen::Matrix2d() << -p[0], 2.0 * p[0] * u2, -production / u1,
      2.0 * u2 / (u1 * saturation * saturation) - 1.0)
      .finished();
  }
  /// u1 = u2^2, u2 (1 + kappa u2^2) = 1
  static Eigen::Vector2d SteadyState(const P& p)
  {
    double u2 = 1.0;
    for (int newton = 0; newton < 60; ++newton) // convex and increasing: monotone from above
    {
      u2 -= (u2 * (1.0 + p[1] * u2 * u2) - 1.0) / (1.0 + 3.0 * p[1] * u2 * u2);
    }
    return { u2 * u2, u2 };
  }
};

/// F = epsilon (u2 - beta u1 - alpha), G = u2 - u2^3 - u1
struct FitzHughNagumo
{
  static double F(const P& p, double u1, double u2) { return p[0] * (u2 - p[1] * u1 - p[2]); }
  static double G(const P&, double u1, double u2) { return u2 - u2 * u2 * u2 - u1; }
  static Eigen::Matrix2d Jacobian(const P& p, double, double u2)
  {
    return (Eigen::Matrix2d() << -p[0] * p[1], p[0], -1.0, 1.0 - 3.0 * u2 * u2).finished();
  }
  /// u1 = u2 - u2^3 with u2^3 + (1/beta - 1) u2 = alpha/beta, by Cardano's formula
  static Eigen::Vector2d SteadyState(const P& p)
  {
    const double third = (1.0 / p[1] - 1.0) / 3.0;
    const double half = 0.5 * p[2] / p[1];
    const double root = std::sqrt(half * half + third * third * third); // NaN: three states
    const double cube = std::cbrt(std::abs(half) + root);
    const double u2 = std::copysign(cube > 0.0 ? cube - third / cube : 0.0, half);
    return { u2 - u2 * u2 * u2 + 0.0 * root, u2 + 0.0 * root };
  }
};

template <typename Terms>
void React(const P& p, Index count, const double* u1, const double* u2, double* f, double* g)
{
  for (Index i = 0; i < count; ++i)
  {
    f[i] = Terms::F(p, u1[i], u2[i]);
    g[i] = Terms::G(p, u1[i], u2[i]);
  }
}

template <typename Terms>
Kinetics Row(const char* name, const char* formula, const char* reference,
  const std::array<Kinetics::Parameter, 3>& parameters, bool nonNegative)
{
  return { name, formula, reference, parameters, nonNegative, &React<Terms>, &Terms::Jacobian,
    &Terms::SteadyState };
}

constexpr auto Positive = Kinetics::Range::Positive;
constexpr auto NonNegative = Kinetics::Range::NonNegative;
constexpr auto AnyFinite = Kinetics::Range::AnyFinite;
const Kinetics::Parameter None = { nullptr, 0.0, AnyFinite, nullptr };

const std::array<Kinetics, NumberOfKinetics> List = {
  Row<Turing>("Turing", "gamma - u1 u2, u1 u2 - u2 - mu",
    "A. Turing, Phil. Trans. R. Soc. B 237, 1952; G. Turk, SIGGRAPH 1991; (24)",
    { { { "GrowthRate", 16.0, Positive,
          "gamma of Turing, above 0, in units of ReactionRate: the production rate of u1." },
      { "DecayRate", 12.0, Positive,
        "mu of Turing, above 0 and below GrowthRate, in units of ReactionRate: the removal rate of "
        "u2." },
      None } },
    true),
  Row<Schnakenberg>("Schnakenberg", "b - u1 u2^2, a - u2 + u1 u2^2",
    "J. Schnakenberg, J. Theor. Biol. 81, 1979",
    { { { "ActivatorSupply", 0.01, Positive,
          "a of Schnakenberg, above 0, in units of ReactionRate: the supply rate of u2." },
      { "SubstrateSupply", 1.0, Positive,
        "b of Schnakenberg, above 0, in units of ReactionRate: the supply rate of u1." },
      None } },
    true),
  Row<GrayScott>("GrayScott", "25 (f (1 - u1) - u1 u2^2), 25 (u1 u2^2 - (f + k) u2)",
    "P. Gray, S. Scott, Chem. Eng. Sci. 38, 1983; J. Pearson, Science 261, 1993",
    { { { "FeedRate", 0.05, Positive,
          "f of GrayScott, above 0, in units of 25 ReactionRate: the rate at which the solution is "
          "replaced by fresh solution." },
      { "KillRate", 0.06, Positive,
        "k of GrayScott, above 0, in units of 25 ReactionRate: the removal rate of u2 in addition "
        "to FeedRate." },
      None } },
    true),
  Row<Brusselator>("Brusselator", "B u2 - u1 u2^2, A - (B + 1) u2 + u1 u2^2",
    "I. Prigogine, R. Lefever, J. Chem. Phys. 48, 1968",
    { { { "ReactantA", 2.0, Positive,
          "A of Brusselator, above 0, in units of ReactionRate: the supply rate of u2." },
      { "ReactantB", 4.0, Positive,
        "B of Brusselator, above 0, in units of ReactionRate: the rate at which u2 is converted to "
        "u1." },
      None } },
    true),
  Row<GiererMeinhardt>("GiererMeinhardt", "nu (u2^2 - u1), u2^2/(u1 (1 + kappa u2^2)) - u2",
    "A. Gierer, H. Meinhardt, Kybernetik 12, 1972",
    { { { "InhibitorDecayRate", 1.05, Positive,
          "nu of GiererMeinhardt, above 0, in units of ReactionRate: the decay rate of the "
          "inhibitor u1." },
      { "Saturation", 0.0, NonNegative,
        "kappa of GiererMeinhardt, 0 or more, without a unit: the saturation of the activator u2. "
        "With it, spots become stripes." },
      None } },
    true),
  Row<FitzHughNagumo>("FitzHughNagumo", "epsilon (u2 - beta u1 - alpha), u2 - u2^3 - u1",
    "R. FitzHugh, Biophys. J. 1, 1961; J. Nagumo et al., Proc. IRE 50, 1962",
    { { { "RecoveryRate", 1.2, Positive,
          "epsilon of FitzHughNagumo, above 0, in units of ReactionRate: the rate of the recovery "
          "variable u1." },
      { "RecoveryDamping", 0.9, Positive,
        "beta of FitzHughNagumo, above 0, without a unit: the damping of u1." },
      { "Stimulus", 0.0, AnyFinite,
        "alpha of FitzHughNagumo, without a unit: 0 gives labyrinths, other values give "
        "spots." } } },
    false)
};

} // namespace

const Kinetics& GetKinetics(KineticsName name)
{
  return List[static_cast<std::size_t>(name)];
}

} // namespace SurfaceDiffusion
