// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Core/Foundation/Types.h"

#include <array>

namespace SurfaceDiffusion
{

/// The reaction terms F and G of (22), (23). In all of them u1 diffuses faster (the inhibitor or
/// the substrate) and u2 is the activator, as in (24), so that the same diffusion rates serve all.
enum class KineticsName
{
  Turing, ///< (24)
  Schnakenberg, ///< activator-substrate
  GrayScott, ///< activator-substrate, with feed and outflow
  Brusselator, ///< activator-substrate
  GiererMeinhardt, ///< activator-inhibitor
  FitzHughNagumo ///< activator-inhibitor, values of either sign
};

/// Values of a kinetics' parameters, in the order of its list.
using KineticsParameters = std::array<double, 3>;

/// One row of the list of kinetics; see Kinetics.cxx for the formulas.
struct Kinetics
{
  /// The values that a parameter may have.
  enum class Range
  {
    Positive,
    NonNegative,
    AnyFinite
  };

  struct Parameter
  {
    const char* Name; ///< nullptr: not used
    double Default; ///< makes a pattern if D1/D2 is about 8
    Range Allowed;
    const char* Documentation; ///< with its unit
  };

  const char* Name;
  const char* Formula; ///< F and G, divided by the reaction rate
  const char* Reference;
  std::array<Parameter, 3> Parameters;
  bool NonNegative; ///< u1, u2 are concentrations

  /// f = F(u1, u2), g = G(u1, u2) for `count` values of each, with reaction rate 1.
  void (*React)(const KineticsParameters& p, Index count, const double* u1, const double* u2,
    double* f, double* g);
  /// dF/du1, dF/du2; dG/du1, dG/du2.
  Eigen::Matrix2d (*Jacobian)(const KineticsParameters& p, double u1, double u2);
  /// The steady state of the reactions that makes patterns; NaN if there is none.
  Eigen::Vector2d (*SteadyState)(const KineticsParameters& p);

  KineticsParameters Defaults() const
  {
    return { this->Parameters[0].Default, this->Parameters[1].Default,
      this->Parameters[2].Default };
  }
};

constexpr int NumberOfKinetics = 6;

const Kinetics& GetKinetics(KineticsName name);

} // namespace SurfaceDiffusion
