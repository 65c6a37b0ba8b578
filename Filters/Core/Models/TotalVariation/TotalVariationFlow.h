// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Core/Models/Fidelity.h"
#include "Core/Models/Model.h"
#include "Core/Models/TotalVariation/VariationMinimizer.h"
#include "Core/Operators/Assembler.h"
#include "Core/Operators/MeanCorrection.h"

#include <memory>
#include <vector>

namespace SurfaceDiffusion
{

/// The gradient flow of a convex energy, total variation (2) and others, with fidelity (17), (19),
/// for edge-stopping functions with a convex energy (TotalVariation without beta, Charbonnier,
/// Constant), by minimising that energy:
///
/// - a time step is backward Euler with the weights at the new level, the minimiser of
///   E(u) + int |u - u_old|^2/(2 dt). It has no error from lagged weights and may be of any size.
/// - the steady state is the minimiser of E itself, in one step:
///   E(u) = int psi(|grad u|) + lambda/2 int chi |u - f|^2, or lambda int chi |u - f| with L1,
///   with the indicator chi of the known part of the surface.
///
/// With diffusivities g1 along and g2 across a direction, E has
///   total variation: sqrt((g1 grad u . e1)^2 + (g2 grad u . e2)^2);
///   others: g psi(sqrt((g1/g) (grad u . e1)^2 + (g2/g) (grad u . e2)^2)), g the larger of the two:
/// for gradients along e1 or e2, and always if g1 = g2, the flux is that of (4).
///
/// The steady state of total variation with g1 = g2 may have total generalised variation in its
/// place (GeneralizedVariationMinimizer).
///
/// A time step starts from the multipliers of the last one, so that short steps cost less than long
/// ones.
class TotalVariationFlow : public DataModel
{
public:
  struct Settings
  {
    bool SteadyState = false;
    double TimeStep = 1.0;
    double Fidelity = 0.0; ///< lambda, in 1/time; value/time with L1
    EdgeFunction Function; ///< of a convex energy
    double AlongDiffusivity = 1.0;
    double AcrossDiffusivity = 1.0;
    double GeneralizedLength = 0.0; ///< alpha of total generalised variation; 0: of total variation
    ChannelCoupling Coupling = ChannelCoupling::Joint;
    FidelityNorm Norm = FidelityNorm::L2;
    double StopTolerance = 1e-4; ///< relative duality gap, see VariationMinimizer
    int MaximumNumberOfIterations = 10000;
    bool ConservesTotal = true; ///< whether states without fidelity keep the total of the start
    std::vector<double> ChannelWeights = {}; ///< of L2, see Fidelity
  };

  /// frames: e1 per triangle (see TangentVectors.h), without rows if g1 = g2.
  TotalVariationFlow(std::shared_ptr<const Assembler> assembler, const TangentVectors& frames,
    PointData data, const Settings& settings, const ParallelFor& parallel = SerialFor());

  /// Reports the iterations of the minimiser; as the residual its relative duality gap, which is
  /// above the tolerance if the largest number of iterations was reached; and as the error bound
  ///   sqrt(2 gap/(mu A)),
  /// where gap is the duality gap itself over the diffusivity, mu the smallest weight of the
  /// quadratic terms (lambda, 1/dt and their sum) and A the area where they act: the root mean
  /// square of u - u* is not larger, since the energy is strongly convex. Infinite if there are no
  /// such terms.
  StepReport Advance(const ProgressMonitor& progress) override;

  using DataModel::SetState;
  /// Replace the state. The next step starts from the multipliers of the last one, or from none.
  void SetState(const Values& u, bool keepMultipliers)
  {
    this->U = u;
    this->KeepsMultipliers = keepMultipliers;
  }

  /// StopTolerance and MaximumNumberOfIterations of later steps.
  void SetLimits(double stopTolerance, int maximumNumberOfIterations);

  /// E(u).
  double Energy() const override;

  /// D is that of LaggedDiffusion at the new u.
  DiffusionStep Diffusion() const override;
  const CornerWeights& DiffusionWeights(Eigen::Index column) override;

  /// With time steps also the multipliers, from which the next step starts, and w of total
  /// generalised variation.
  std::size_t CheckpointSize() const override;
  void Save(double* checkpoint) const override;
  void Restore(const double* checkpoint) override;

private:
  /// Columns whose energies do not depend on each other are minimised one after the other: each
  /// comes out as if it were alone.
  struct System
  {
    Eigen::Index First, Columns;
    std::unique_ptr<VariationMinimizer> Minimizer;
  };

  VariationMinimizer::Report Minimize(const System& system, const ProgressMonitor& progress);
  bool SavesMultipliers() const
  {
    return !this->Options.SteadyState || this->Options.GeneralizedLength > 0.0;
  }
  Values QuadraticWeights(Eigen::Index first, Eigen::Index columns) const;
  void MeasureWeights();
  void SetTarget();

  std::shared_ptr<const Assembler> Assembly;
  TangentVectors Frames;
  CornerWeights Weighted; ///< of DiffusionWeights()
  Fidelity Fit;
  Settings Options;
  const ParallelFor& Parallel;
  TotalCorrection Conserved;
  double Diffusivity; ///< the larger of the two, the factor of the first integral of E
  double LargestInverseWeight = 0.0; ///< 1/mu where mu > 0, times Diffusivity
  double WeightedArea = 0.0; ///< of the control cells with mu > 0
  std::vector<System> Systems;
  bool KeepsMultipliers = true; ///< in the next step
  Values Target;
  Values SteadyStart; ///< from which the steady state of L1 is sought, which removes outliers
  mutable Values ColumnU;
  Values ColumnTarget, ColumnGiven; ///< of one of several systems
};

} // namespace SurfaceDiffusion
