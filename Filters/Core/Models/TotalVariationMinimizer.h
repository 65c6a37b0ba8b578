// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Core/Foundation/ProgressMonitor.h"
#include "Core/Models/ChannelNorms.h"
#include "Core/Models/EdgeFunctions.h"
#include "Core/Operators/Assembler.h"
#include "Core/Solvers/QuadraticDescent.h"

#include <memory>
#include <vector>

namespace SurfaceDiffusion
{

/// The linear map from the values at a triangle's corners to S grad u, a plane vector, where S may
/// stretch directions: S grad u = First (u_1 - u_0) + Second (u_2 - u_0).
struct GradientMap
{
  Eigen::Vector2d First, Second;
};

/// S = 1.
std::vector<GradientMap> PlainGradients(const TriangleMesh& mesh, const ParallelFor& parallel);

/// S = along e1 e1^T + across e2 e2^T; sqrt(along across) where the frame is zero.
std::vector<GradientMap> StretchedGradients(const TriangleMesh& mesh,
  const Eigen::Ref<const TangentVectors>& frames, double along, double across,
  const ParallelFor& parallel);

/// Finds the minimum over u of
///   E(u) = int psi(|S grad u|) + sum_i A_i (mu_i/2 |u_i - g_i|^2 + nu_i |u_i - f_i|)
/// with some u_i fixed, for a convex psi: total variation psi(s) = s, exactly, without beta;
/// Charbonnier; or s^2/2.
///
/// Method: alternating directions (ADMM; S. Boyd et al., Foundations and Trends in Machine
/// Learning 3, 2011; for total variation T. Goldstein, S. Osher, SIAM J. Imaging Sci. 2, 2009) on
/// p = S grad u and q = u - f, over-relaxed by 1.7; the quadratic problem for u is not solved but
/// improved by a few conjugate gradient iterations from the last u. The multipliers are feasible
/// for the dual problem at every iteration, so the duality gap bounds E(u) - min E from above: it
/// is what stops. Where nothing but the gradient binds u_i (mu_i = 0), the bound is that over all u
/// within Range of the data.
class TotalVariationMinimizer
{
public:
  struct Settings
  {
    EdgeFunction Function; ///< TotalVariation (beta is not used), Charbonnier or Constant
    ChannelCoupling Coupling = ChannelCoupling::Joint;
    double Range = 1.0; ///< largest max - min of the data over the channels
    double StopTolerance = 1e-4; ///< on the duality gap / E
    int MaximumNumberOfIterations = 10000;
  };

  /// quadratic, absolute: mu and nu >= 0 per vertex; in every connected component one of them must
  /// be positive somewhere, or a vertex fixed.
  TotalVariationMinimizer(std::shared_ptr<const Assembler> assembler,
    std::vector<GradientMap> gradients, Vector quadratic, Vector absolute, Flags fixed,
    const Settings& settings, const ParallelFor& parallel = SerialFor());

  struct Report
  {
    int Iterations = 0;
    /// Duality gap relative to E, or, where that is larger, to a thousandth of E of the start or a
    /// millionth of what noise of the whole Range has: below it data are constant to round-off.
    double Gap = 0.0;
  };

  /// u: the start on entry, the minimiser on return, and never of more energy than the start. The
  /// result depends on the arguments alone.
  Report Minimize(const Values& g, const Values& f, Values& u,
    const ProgressMonitor& progress = ProgressMonitor());

  /// int psi(|S grad u|).
  double GradientEnergy(const Values& u) const;

private:
  template <int K>
  struct Pass;

  /// int psi for gradients of one Range per vertex spacing.
  double NoiseEnergy() const;
  void Prepare(const Values& u);
  template <int K>
  Report MinimizeColumns(
    const Values& g, const Values& f, Values& u, const ProgressMonitor& progress);

  std::shared_ptr<const Assembler> Operators;
  std::vector<GradientMap> Gradients;
  Vector Quadratic, Absolute;
  Flags Fixed;
  Settings Options;
  const ParallelFor& Parallel;
  Vector AccumulatedAreas;
  const Vector& Areas; ///< of the control cells, consistent
  double NumberOfVertices; ///< of the surface
  Vector GradientPenalty; ///< r per triangle, times its area
  Vector ValuePenalty; ///< rho per vertex, times its area
  SparseMatrix Matrix;
  QuadraticDescent Descent;
  Values P, B; ///< per triangle: split gradient and scaled multiplier, x of all columns, then y
  Values Corners; ///< per triangle corner: what the triangle gives to a vertex
  Values Q, C; ///< per vertex: split value and scaled multiplier of L1 fidelity
  Values RightHandSide, Load;
  Values Initial; ///< u on entry
  Values Dual; ///< what the multipliers, or the corners, give to each vertex
};

} // namespace SurfaceDiffusion
