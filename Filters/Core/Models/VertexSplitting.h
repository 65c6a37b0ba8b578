// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Core/Foundation/Parallel.h"
#include "Core/Foundation/Reduction.h"
#include "Core/Foundation/Types.h"
#include "Core/Models/EdgeFunctions.h"

namespace SurfaceDiffusion
{

/// The terms sum_i A_i (mu_i/2 |u_i - g_i|^2 + nu_i |u_i - f_i|) of an energy in the alternating
/// direction method of multipliers (see TotalVariationMinimizer): the second one acts on q = u - f,
/// split from u, with a penalty rho and the scaled multiplier c.
class VertexSplitting
{
public:
  struct Settings
  {
    EdgeFunction Function; ///< of the gradient term, for the size of the penalty
    ChannelCoupling Coupling;
    double Range; ///< largest max - min of the data over the channels
  };

  /// areas: consistent, must outlive it. quadratic, absolute: mu, nu. ranges: typical range of the
  /// values around each vertex, consistent.
  VertexSplitting(const Vector& areas, Vector quadratic, Vector absolute, Flags fixed,
    const Vector& ranges, const Settings& settings, const ParallelFor& parallel);

  /// The diagonal A (mu + rho) of the equation for u, consistent.
  Vector MakeDiagonal() const;

  /// Sum of A mu over the vertices of the surface.
  double QuadraticWeight(const Reduction& reduction) const;

  /// Whether nu > 0 somewhere, so that there are multipliers c.
  bool IsSplit() const { return this->HasAbsolute; }

  const Flags& GetFixed() const { return this->Fixed; }

  /// q = u - f, and c = 0 unless there are multipliers to start from. g and f must stay as they are
  /// until the next start.
  void Start(const Values& g, const Values& f, const Values& u, bool keepMultipliers);

  /// c, one row per vertex; no row if nu = 0 everywhere.
  Values& Multipliers() { return this->C; }
  const Values& Multipliers() const { return this->C; }

  /// q and c from the present u, over-relaxed.
  void Update(const Values& u, double relaxation);

  /// What the terms give to the equation for u at vertex i, consistent.
  double RightHandSide(Index i, int k) const
  {
    const double side = this->Areas[i] * this->Quadratic[i] * (*this->G)(i, k);
    const double rho = this->Penalty[i];
    return rho > 0.0 ? side + rho * ((*this->F)(i, k) + this->Q(i, k) - this->C(i, k)) : side;
  }

  /// The terms at u, summed over the vertices of the surface.
  double Energy(const Values& u, const Reduction& reduction) const;

  /// Their part of the dual function, likewise: the minimum over u of d . u and the terms, for
  /// given d, consistent. u: of fixed vertices, and the centre of the ball of radius Range in which
  /// the minimum is sought if mu_i = 0.
  double DualEnergy(const Values& d, const Values& u, const Reduction& reduction) const;

  /// The largest s <= 1 for which |s d| <= nu A at all vertices with mu = 0 < nu that are not
  /// fixed.
  double FeasibleShare(const Values& d, const Reduction& reduction) const;

private:
  double DualAt(Index i, const Values& d, const Values& u, int first, int last) const;

  const Vector& Areas;
  Vector Quadratic, Absolute;
  Flags Fixed;
  Settings Options;
  const ParallelFor& Parallel;
  bool HasAbsolute;
  Vector Penalty; ///< rho per vertex, times its area
  const Values* G = nullptr;
  const Values* F = nullptr;
  Values Q, C;
};

} // namespace SurfaceDiffusion
