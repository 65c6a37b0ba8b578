// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Core/Models/Fidelity.h"
#include "Core/Models/ImplicitSystem.h"
#include "Core/Models/Model.h"
#include "Core/Operators/Assembler.h"
#include "Core/Operators/MeanCorrection.h"

#include <cstddef>
#include <memory>
#include <vector>

namespace SurfaceDiffusion
{

/// Semi-implicit time steps of nonlinear diffusion with fidelity,
///   m u_t = div(D grad u) + lambda chi (f - u),
/// whose diffusion tensor D and mass density m depend on u: each step takes both at the old level
/// and solves one linear system with the lumped mass matrix M and the stiffness matrix K of D,
///   (m M + dt K(u_old) + dt lambda chi M) u_new = M (m u_old + dt lambda chi f).
/// It is solved for u_new - u_old, so that round-off is relative to the change and a constant stays
/// constant to the last bit, however large D may be. A subclass gives D, and m if it is not 1.
/// Columns with another fidelity weight have another matrix.
class LaggedDiffusion : public DataModel
{
public:
  StepReport Advance(const ProgressMonitor& progress) override;

  /// D is that of the old level.
  DiffusionStep Diffusion() const override;
  const CornerWeights& DiffusionWeights(Eigen::Index column) override;

protected:
  /// solver: kept by the caller, so that an ordering is reused. The columns of u share one D, or
  /// each has its own, as the coupling of the fidelity says.
  LaggedDiffusion(std::shared_ptr<const Assembler> assembler, PointData data, double timeStep,
    const Fidelity::Settings& fidelity, std::shared_ptr<LinearSolver> solver,
    const ParallelFor& parallel);

  /// Fill Weighted for the channels first .. last - 1 at the current u, and what MassDensity()
  /// needs.
  virtual void FillWeights(
    Eigen::Index first, Eigen::Index last, StepReport& report, const ProgressMonitor& progress) = 0;
  /// m at vertex i, the mean over its control cell.
  virtual double MassDensity(Index /*i*/) const { return 1.0; }

  const TriangleMesh& Mesh() const { return this->Assembly->Mesh(); }
  /// The number of columns that share one D.
  Eigen::Index ColumnsPerTensor() const { return this->TensorColumns; }
  /// No longer correct the sum of A_i u_i, which the model does not conserve.
  void DropConservation() { this->Conserved = TotalCorrection(); }
  /// Add 1e-14 of its diagonal to the matrix. That keeps the matrix positive definite where the
  /// eigenvalues of D differ by more than round-off resolves, slows the change of u in a step by as
  /// much, and leaves steady states and the decay of the energy as they are.
  void DampRoundOff() { this->Damping = 1e-14; }
  /// The energy of the fidelity term, summed over the vertices of this process.
  double FidelityEnergy() const { return this->Fit.Energy(this->Mesh(), this->U, this->Parallel); }

  const ParallelFor& Parallel;
  CornerWeights Weighted; ///< the weights (12) of D

private:
  /// Columns that have one matrix: they share D and the fidelity weight.
  struct Group
  {
    Eigen::Index First, Last;
    std::size_t Buffer; ///< number of its Buffers
  };
  /// The unknowns of a group, one column for each of its columns.
  struct Buffers
  {
    Values Change, RightHandSide;
  };

  void MakeGroups();
  void AdvanceGroup(const Group& group, StepReport& report, const ProgressMonitor& progress);
  void FillChange(const Group& group);

  std::shared_ptr<const Assembler> Assembly;
  Fidelity Fit;
  double TimeStep;
  double Damping = 0.0;
  ImplicitSystem System;
  TotalCorrection Conserved;
  Vector Diagonal;
  Eigen::Index TensorColumns;
  std::vector<Group> Groups;
  std::vector<Buffers> Unknowns; ///< of groups of the same size
  Values NoChange; ///< the Dirichlet conditions of Change of the largest group; empty: none
};

} // namespace SurfaceDiffusion
