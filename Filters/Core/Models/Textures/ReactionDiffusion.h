// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Core/Models/ImplicitSystem.h"
#include "Core/Models/Model.h"
#include "Core/Models/Textures/Reaction.h"
#include "Core/Operators/Assembler.h"
#include "Core/Operators/MeanCorrection.h"

#include <array>
#include <exception>
#include <memory>
#include <stdexcept>

namespace SurfaceDiffusion
{

/// Thrown if a concentration leaves all bounds.
struct UnboundedGrowth : std::runtime_error
{
  UnboundedGrowth()
    : std::runtime_error("the concentrations grow without bounds")
  {
  }
};

/// Reaction-diffusion equations of two chemicals (22), (23),
///   u1_t = div(D1 grad u1) + F(u1, u2),  u2_t = div(D2 grad u2) + G(u1, u2),
/// with diffusion tensors D1, D2 that may be anisotropic and differ from triangle to triangle. An
/// implicit-explicit method (IMEX): diffusion is implicit, with one matrix M + dt K per chemical
/// for all steps, the reaction is explicit. Fixed vertices have Dirichlet conditions; fidelity does
/// not apply.
///
/// Concentrations stay >= 0: (24) as printed runs away as soon as u2 < 0, since its decay mu acts
/// even at u2 = 0. With bounds the equations hold at vertices with u > 0; at u = 0 a force l >= 0
/// balances the loss by the reaction (an obstacle problem, l its Lagrange multiplier).
class ReactionDiffusion : public StateModel
{
public:
  enum class Scheme
  {
    /// Backward Euler, explicit reaction; negative values are set to 0 after the step. First order.
    FirstOrder,
    /// ARS(2,2,2) (Ascher, Ruuth, Spiteri, Appl. Numer. Math. 25, 1997): two stages with one
    /// matrix, L-stable diffusion. l, known from the state, enters the stages like a reaction, and
    /// each stage's own share of it is corrected after its solve (operator splitting; Ikonen,
    /// Toivanen, Appl. Math. Lett. 17, 2004). Second order also with bounds, for which clamping
    /// alone would be first order.
    SecondOrder
  };

  struct Settings
  {
    double TimeStep = 1.0 / 16.0;
    Scheme TimeScheme = Scheme::SecondOrder;
    bool KeepNonNegative = true;
    /// The pattern is stationary, and further steps change nothing, once |u_new - u| / (dt |u_new -
    /// its mean|), in L2 norms over the surface, is at most this for both chemicals: the relative
    /// change per unit time. It is about the growth rate while the pattern grows. 0: never.
    double StopTolerance = 0.0;
  };

  /// The diffusion of one chemical: the coefficients of D (CotanWeights.h) in LengthUnit()^2/time,
  /// and the solver of its matrix, kept by the caller from run to run. In a CoarseSpace, Stiffness
  /// is the stiffness matrix in place of the coefficients, and no vertex may be fixed.
  struct Chemical
  {
    CornerWeights Coefficients;
    std::shared_ptr<LinearSolver> Solver;
    SparseMatrix Stiffness = {};
  };

  /// data.Start: u1, u2 at t = 0.
  ReactionDiffusion(std::shared_ptr<const Assembler> assembler, const Reaction& reaction,
    std::array<Chemical, 2> chemicals, PointData data, const Settings& settings,
    const ParallelFor& parallel = SerialFor());

  StepReport Advance(const ProgressMonitor& progress) override;

  /// The pattern is stationary by StopTolerance.
  bool Finished() const override { return this->Done; }

  /// 1/2 int D1 grad u1 . grad u1 + D2 grad u2 . grad u2, in value^2 LengthUnit()^2/time: how much
  /// pattern there is. Reaction-diffusion has no energy that must fall.
  double Energy() const override;

  /// The state and whether it is finished.
  std::size_t CheckpointSize() const override;
  void Save(double* checkpoint) const override;
  void Restore(const double* checkpoint) override;

private:
  using Pair = std::array<Values, 2>; ///< one column per chemical

  struct Solution
  {
    StepReport Report;
    std::exception_ptr Failure;
  };

  void Prepare(const ProgressMonitor& progress);
  void FirstOrderStep(StepReport& report, const ProgressMonitor& progress);
  void SecondOrderStep(StepReport& report, const ProgressMonitor& progress);
  void React(const Pair& u, Pair& f) const;
  void AddHoldingForce(const Pair& u, Pair& f);
  double IntegrateDiffusion(int chemical, const Values& u, Index i) const;
  void Solve(StepReport& report, const ProgressMonitor& progress);
  void SolveFor(int chemical, const ProgressMonitor& progress);
  bool CanSolveSideBySide() const;
  void Project(double dt, StepReport& report);
  void FinishStep();

  std::shared_ptr<const Assembler> Assembly;
  Reaction Terms;
  std::array<CornerWeights, 2> Coefficients;
  std::array<SparseMatrix, 2> Stiffness; ///< empty, or in place of Coefficients
  PointData Data;
  Settings Options;
  const ParallelFor& Parallel;
  double ImplicitTime; ///< dt times the implicit part of a stage
  std::array<ImplicitSystem, 2> Systems;
  Vector AccumulatedAreas;
  const Vector& Areas; ///< of the control cells, consistent
  MeanCorrection Means; ///< the sums of the equations hold to round-off, on needles too
  bool Prepared = false;
  bool Done = false;
  Pair Old, New, Rates, Force, Explicit, RightHandSide;
  std::array<Solution, 2> Solutions;
};

} // namespace SurfaceDiffusion
