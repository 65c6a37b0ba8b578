// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Core/Models/Fidelity.h"
#include "Core/Models/Harmonic/HarmonicEnergy.h"
#include "Core/Models/Harmonic/TangentMethods.h"
#include "Core/Models/ImplicitSystem.h"
#include "Core/Models/Model.h"
#include "Core/Operators/Assembler.h"

#include <memory>
#include <vector>

namespace SurfaceDiffusion
{

/// The heat flow of p-harmonic maps u into the unit sphere S^(m-1), any m >= 2, with fidelity: (20)
/// p = 2, (21) p = 1 and every p between,
///   u_t = div(g grad u) + u g |grad u|^2 + lambda chi (f - u),  g = (|grad u|^2 + beta)^((p-2)/2),
/// with the indicator chi of the known part of the surface. This is the gradient flow, among unit
/// vectors, of
///   E(u) = int ((|grad u|^2 + beta)^(p/2) - beta^(p/2)) / p + lambda/2 int chi |f - u|^2;
/// see HarmonicEnergy for the first integral and Fidelity for the second. Below, M is the lumped
/// mass matrix and K(g) the stiffness matrix.
///
/// ExplicitReaction is the paper's splitting,
///   ((1 + lambda dt chi) M + dt K(g)) w = M (u + dt r u + lambda dt chi f),  u_new = w / |w|,
/// with r the control-cell average of |grad u|^p as printed or, ConsistentReaction, of
/// g |grad u|^2. Its energy can increase.
///
/// TangentPlane moves along the tangent spaces (F. Alouges, SIAM J. Numer. Anal. 34, 1997;
/// S. Bartels, SIAM J. Numer. Anal. 43, 2005): x_i orthogonal to u_i minimises
///   Q(u + x) + |x|^2_M / (2 dt),  and  u_new = (u + x) / |u + x|,
/// where Q is E with g frozen at the old u. The energy never increases, for any dt and any
/// triangles:
/// - s -> (s + beta)^(p/2) is concave for p <= 2, so Q lies above E and touches it at u: it is
///   enough that Q(u_new) <= Q(u). The minimiser has Q(u + x) <= Q(u), and so has every iterate of
///   conjugate gradients started at x = 0.
/// - |u_i + x_i| >= 1, and if both ends are at least 1 long, normalising brings neither two
///   vectors nor a vector and another's opposite further apart. With a_ij the entries of K(g),
///   unit vectors have Q = 1/2 sum over edges of |a_ij| |u_i + sign(a_ij) u_j|^2 + const:
///   normalising cannot raise that sum. So for a_ij <= 0 (no obtuse angles) the step is proven as
///   it stands.
/// - If some a_ij > 0, the sum differs from Q off the sphere by the sum of 1/2 D_i |x_i|^2 with
///   D_i = sum of |a_ij| over j other than i, minus a_ii: the lack of diagonal dominance of K. A
///   step with D > 0 added to the matrix does not raise the sum, and is proven again. As D slows
///   down the vertices of obtuse triangles it is used only if the step without it did raise the
///   energy: first a small part of it, then all.
/// - f is a unit vector, so that normalising does not take u away from it.
/// A step that raises E by round-off only leaves u as it is.
///
/// MinimizingMovement repeats that step on E + |u - u_old|^2_M / (2 dt), weights renewed, until it
/// is stationary: backward Euler solved in full (minimising movements of De Giorgi), the same
/// proof. It costs several solves per step and has no error from frozen weights.
///
/// Line fields take signs in each triangle (HarmonicEnergy) and the nearer one of f and -f. A
/// minimum over signs lies below the energy of the signs chosen at the old u, so that the proof
/// holds.
///
/// With normals of the surface, u_i and x_i are orthogonal to the normal n_i: u is a tangent field, and
/// |grad u|^2 is that in space. The proof holds, since u_i + x_i and f_i lie in the tangent plane.
class HarmonicMap : public StateModel
{
public:
  enum class Scheme
  {
    ExplicitReaction,
    TangentPlane,
    MinimizingMovement
  };

  using Preconditioner = TangentMethods::Preconditioner;

  struct Settings
  {
    double TimeStep = 1.0; ///< in LengthUnit()^p
    double Exponent = 1.0; ///< p in [1, 2]
    double Beta = 1e-6; ///< in 1/LengthUnit()^2; > 0, or 0 if p = 2
    double Fidelity = 0.0; ///< lambda, in 1/LengthUnit()^p
    Scheme TimeScheme = Scheme::TangentPlane;
    bool ConsistentReaction = false; ///< of ExplicitReaction
    bool ProjectToSphere = true; ///< normalise after each step
    bool LineField = false;
    Values Normals; ///< n x 3 of the surface, orthogonal to u, f and fixed values; no row: any u
    int MaximumNumberOfRepetitions = 50; ///< per step of MinimizingMovement
    double LargestDiffusivity = 1.0; ///< d of anisotropic coefficients
    Preconditioner Method = Preconditioner::Automatic;
    IterationLimits Limits; ///< of the tangent spaces
  };

  /// data: unit vectors (see FillMissingUnitVectors). solver: kept by the caller from run to run;
  /// schemes other than ExplicitReaction use it as preconditioner.
  HarmonicMap(std::shared_ptr<const Assembler> assembler, CornerWeights coefficients,
    PointData data, const Settings& settings, std::shared_ptr<LinearSolver> solver,
    const ParallelFor& parallel = SerialFor());

  StepReport Advance(const ProgressMonitor& progress) override;

  /// Replace the factors w of the fidelity, one per vertex, before the next step.
  void SetFidelityFactors(const Vector& factors);

  /// E, with the p-th power of |grad u| in 1/LengthUnit()^p and areas in LengthUnit()^2.
  double Energy() const override;

  const PointData* GivenData() const override { return &this->Data; }

  DiffusionStep Diffusion() const override;
  const CornerWeights& DiffusionWeights(Eigen::Index column) override;

private:
  void FillDiagonal();
  double Freeze();
  void Copy(const Values& from, Values& to) const;
  void ExplicitReactionStep(StepReport& report, const ProgressMonitor& progress);
  void TangentPlaneStep(StepReport& report, const ProgressMonitor& progress);
  void MinimizingMovementStep(StepReport& report, const ProgressMonitor& progress);
  double Descend(double objective, StepReport& report, const ProgressMonitor& progress);
  void FindDamping();
  void ProjectToPlane(Index i);
  void ProjectToSphere();
  double Objective() const;
  double ProcessEnergy() const;

  std::shared_ptr<const Assembler> Assembly;
  PointData Data;
  Fidelity Fit;
  Settings Options;
  const ParallelFor& Parallel;
  HarmonicEnergy GradientEnergy;
  ImplicitSystem System;
  TangentMethods Tangent;
  Vector Diagonal; ///< (1 + lambda dt chi) M
  Vector Damping; ///< D, times dt; of an interface vertex in its owner only
  std::vector<double> InterfaceEntries; ///< matrix entries of the edges on interfaces
  Values Previous, Anchor, RightHandSide, Step;
  CornerWeights Weighted; ///< of DiffusionWeights()
};

} // namespace SurfaceDiffusion
