// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Core/Foundation/Types.h"

#include <array>
#include <cstddef>

namespace SurfaceDiffusion
{

/// An approximation of exp(-dt L), for an operator L of eigenvalues 0 or above, by a polynomial in
/// its resolvent, which is a step of backward Euler of the length s dt:
///
///     exp(-dt L) ~ p(Y),  Y = (1 + s dt L)^-1,  p(y) = sum over k of c_k T_k(2 y - 1)
///
/// with the Chebyshev polynomials T_k (one pole: S. Norsett, SIAM J. Numer. Anal. 15, 1978). With
/// z = dt lambda and y = 1/(1 + s z), the coefficients minimise
///
///     int from z = 0 to infinity of (p(y) - exp(-z))^2 dz
///
/// under the conditions p = 1 and dp/dz = -1 at z = 0, and p = 0 at z = infinity. The eigenvalues
/// of a surface have a constant density (Weyl's law), so that the integral is the square of the
/// error for white noise: 0.46 % of the exact result, however long the step is and however small
/// the triangles are. The conditions keep constants and make the variance of the kernel, 2 dt in
/// each direction, exact. The error for any eigenfunction is at most 0.0014.
struct ExponentialSeries
{
  static constexpr double Step = 0.2; ///< s
  static constexpr int Degree = 6;
  static constexpr std::array<double, Degree + 1> Coefficients = { // c_k, of the sum 1
    0.23219251097366198, 0.3995095044281711, 0.2492498506907564, 0.1037724077702688,
    0.02082438761217644, -0.003281912198437957, -0.002266749276596778
  };

  /// T_k(2 Y - 1) u for k = 1 to Degree from y = Y T_(k-1), T_(k-1) and T_(k-2); T_(-1) stands for
  /// T_0. The factors add up to 1, so that a step of backward Euler with a source and Dirichlet
  /// conditions can take the place of Y: exp(-dt L) is then applied to the difference from the
  /// steady state.
  static double NextTerm(int k, double y, double last, double beforeLast)
  {
    return k == 1 ? 2.0 * y - last : 4.0 * y - 2.0 * last - beforeLast;
  }

  /// The terms of Apply(), which later calls do not allocate again.
  struct Work
  {
    Values Last, BeforeLast, Y;
  };

  /// u becomes exp(-dt L) u. solve(k, last, y): y = Y last for k = 1 to Degree; on entry y is u, and
  /// then that of the call before.
  template <typename Solve>
  static void Apply(Values& u, Work& work, const Solve& solve)
  {
    work.Last = work.BeforeLast = work.Y = u;
    u *= Coefficients[0];
    for (int k = 1; k <= Degree; ++k)
    {
      solve(k, work.Last, work.Y);
      for (Eigen::Index i = 0; i < u.size(); ++i)
      {
        double& next = work.BeforeLast.data()[i];
        next = NextTerm(k, work.Y.data()[i], work.Last.data()[i], next);
        u.data()[i] += Coefficients[static_cast<std::size_t>(k)] * next;
      }
      work.Last.swap(work.BeforeLast);
    }
  }
};

} // namespace SurfaceDiffusion
