// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Core/Models/Fidelity.h"
#include "Core/Models/ImplicitSystem.h"
#include "Core/Models/Model.h"
#include "Core/Operators/Assembler.h"
#include "Core/Operators/MeanCorrection.h"

#include <memory>
#include <vector>

namespace SurfaceDiffusion
{

/// The Mumford-Shah functional in the approximation of Ambrosio and Tortorelli (L. Ambrosio, V.
/// Tortorelli, CPAM 43, 1990; on meshes N. Bonneel, D. Coeurjolly, P. Gueth, J.-O. Lachaud,
/// Computer Graphics Forum 37(7), 2018): a piecewise smooth u, and v in (0, 1] that is near 0 on
/// the edges of u and 1 elsewhere, of minimal
///   E(u, v) = lambda/2 int chi |u - f|^2 + 1/2 int (v^2 + kappa) D grad u . grad u
///             + beta int (eps |grad v|^2 + (1 - v)^2 / (4 eps)),
/// with the indicator chi of the known part of the surface and a constant diffusion tensor D (1 in
/// the literature). Data are smoothed over sqrt(1/lambda) away from edges. An edge costs beta per
/// length, and v = 1 - exp(-d / (2 eps)) at the distance d from it. All channels of u share v.
///
/// Both are piecewise linear; v^2 is integrated by the mean of the corners, so that triangle t has
/// the weight w_t = kappa + (v_0^2 + v_1^2 + v_2^2)/3. A step minimises the discrete energy first
/// over u, then over v, with the lumped mass matrix M and the stiffness matrix K:
///   (lambda M chi + K(w)) u = lambda M chi f,
///   (Q + beta/(2 eps) M + 2 beta eps K) v = beta/(2 eps) M 1,
///   Q_i = sum over the triangles at vertex i of 1/3 int D grad u . grad u.
/// Both systems are solved for the change. The energy falls in every half step, on any mesh and
/// with any tolerance of the solver, since conjugate gradients lower it in every iteration. On
/// Delaunay meshes the exact v stays in [0, 1].
///
/// The energy is not convex: the result is a local minimum. Edges form with a large eps, and it is
/// halved from stage to stage. The last stage ends when a step lowers the energy by no more than
/// StopTolerance, those before at 100 times that. E is comparable within a stage only.
class MumfordShah : public StateModel
{
public:
  struct Settings
  {
    double Fidelity = 1.0; ///< lambda, in 1/LengthUnit()^2
    double EdgeCost = 1.0; ///< beta, in value^2/LengthUnit()
    double EdgeWidth = 1.0; ///< eps of the last stage, in LengthUnit()
    double Leakage = 1e-6; ///< kappa, > 0
    double StopTolerance = 1e-5; ///< on the relative decrease of the energy in one step
    int NumberOfStages = 3; ///< stage s has 2^(NumberOfStages - 1 - s) EdgeWidth
    /// Of each connected component: s > 0, with which E is that of s u and s f there. Components do
    /// not interact, so each has the edge cost EdgeCost/s^2. With scales at which their edges cost
    /// alike, they are solved with the same relative accuracy. Empty: 1.
    std::vector<double> ValueScales = {};
  };

  /// coefficients: of D, see CotanWeights.h. smoothing, edges: the solvers of both systems, kept by
  /// the caller; their tolerances are relative to the residual at the start of the solve. cuts:
  /// vertices with the Dirichlet condition v = 0, which are known edges; may be empty.
  MumfordShah(std::shared_ptr<const Assembler> assembler, CornerWeights coefficients,
    PointData data, const Settings& settings, std::shared_ptr<LinearSolver> smoothing,
    std::shared_ptr<LinearSolver> edges, const ParallelFor& parallel = SerialFor(),
    Flags cuts = Flags());

  StepReport Advance(const ProgressMonitor& progress) override;

  /// Whether the last stage has ended.
  bool Finished() const override { return this->IsSettled && this->IsLastStage(); }

  /// E with the eps of the current stage.
  double Energy() const override { return this->CurrentEnergy; }
  /// The part of it that edges cost: beta times their length, and a little more (see the Run
  /// layer).
  double EdgeEnergy() const;

  /// eps of the current stage.
  double CurrentEdgeWidth() const;

  /// The limit that the half step in u takes, with the new v.
  DiffusionStep Diffusion() const override;
  const CornerWeights& DiffusionWeights(Eigen::Index column) override;

  /// Edges().
  std::map<std::string, Values> Results() const override { return { { "Edges", this->Edges() } }; }

  /// 1 - v: 1 on edges. Values that a solver's error puts outside [0, 1] are clamped.
  Vector Edges() const;

  const PointData* GivenData() const override { return &this->Data; }

  /// u, v, and the state of the continuation.
  std::size_t CheckpointSize() const override;
  void Save(double* checkpoint) const override;
  void Restore(const double* checkpoint) override;

private:
  bool IsLastStage() const { return this->Stage + 1 >= this->Options.NumberOfStages; }
  void SmoothData(StepReport& report, const ProgressMonitor& progress);
  void FindEdges(StepReport& report, const ProgressMonitor& progress);
  void AssembleEdgeStiffness();
  void SquareGradients();
  double Weight(Index t) const;
  double Scale(Index vertex) const { return this->Scales.size() > 0 ? this->Scales[vertex] : 1.0; }
  double FidelityEnergy() const;
  double MeasureEnergy() const;

  std::shared_ptr<const Assembler> Assembly;
  CornerWeights Coefficients; ///< of D
  CornerWeights Isotropic; ///< cotan weights, for v
  PointData Data;
  Fidelity Fit;
  Settings Options;
  const ParallelFor& Parallel;
  ImplicitSystem Smoothing, EdgeSystem;
  TotalCorrection Conserved;
  Flags Cuts;
  Vector Scales; ///< of ValueScales, per vertex; empty: 1

  Values V; ///< n x 1
  int Stage = 0;
  bool IsSettled = false; ///< the last step lowered the energy by no more than the tolerance
  double CurrentEnergy = 0.0;

  Vector OfTriangles; ///< w, then int D grad u . grad u
  Vector Diagonal;
  Vector EdgeStiffness; ///< diagonal of 2 beta eps K, with the eps of EdgeStage
  int EdgeStage = -1;
  Values Change, RightHandSide, NoChange;
  CornerWeights Weighted; ///< of DiffusionWeights()
  Values EdgeChange, EdgeRightHandSide, NoEdgeChange;
};

} // namespace SurfaceDiffusion
