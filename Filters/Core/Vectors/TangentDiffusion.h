// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Core/Models/LinearDiffusion.h"
#include "Core/Operators/ExponentialSeries.h"
#include "Core/Vectors/VectorLaplacian.h"

namespace SurfaceDiffusion
{

/// What becomes of the part of vectors along the normal.
enum class NormalPart
{
  Drop,
  Keep, ///< as it is at the start
  Diffuse ///< as a scalar, by LinearDiffusion
};

/// Linear diffusion of m tangent vector fields, 3m columns, by one of the VectorLaplacians:
///   M w' = -K w + lambda M chi (f - w)
/// for their coordinates w in TangentPlanes, with the time schemes, fidelity and Dirichlet conditions
/// of LinearDiffusion. The steady state is a step of backward Euler of 1e10 times the area of a
/// component: without data and fixed vertices what K maps to 0 is left, parallel fields of Connection,
/// of which closed surfaces usually have none.
class TangentDiffusion : public Model
{
public:
  struct Settings
  {
    LinearDiffusion::Settings Diffusion;
    VectorLaplacian Laplacian = VectorLaplacian::Connection;
    SurfaceDiffusion::NormalPart NormalPart = SurfaceDiffusion::NormalPart::Drop;
  };

  /// planes: of the assembler's mesh. coefficients: as in VectorStiffness. normal: a model of the n x m
  /// normal parts for NormalPart Diffuse, otherwise null. solver: as in LinearDiffusion.
  TangentDiffusion(std::shared_ptr<const Assembler> assembler,
    std::shared_ptr<const TangentPlanes> planes, CornerWeights coefficients, PointData data,
    const Settings& settings, std::shared_ptr<LinearSolver> solver, std::unique_ptr<Model> normal,
    const ParallelFor& parallel = SerialFor());

  const Values& State() const override { return this->U; }
  StepReport Advance(const ProgressMonitor& progress) override;
  double Energy() const override;
  DiffusionStep Diffusion() const override { return this->Options.Diffusion.Diffusion(); }
  const CornerWeights& DiffusionWeights(Eigen::Index /*column*/) override
  {
    return this->Stiffness.GetCoefficients();
  }

  std::size_t CheckpointSize() const override;
  void Save(double* checkpoint) const override;
  void Restore(const double* checkpoint) override;

private:
  void Prepare(const ProgressMonitor& progress);
  void TakeStep(StepReport& report, const ProgressMonitor& progress);
  void StepExponential(double dt, StepReport& report, const ProgressMonitor& progress);
  void StartFrom(const Values& w);
  void Solve(double dt, StepReport& report, const ProgressMonitor& progress);
  void MakeState();
  double RowWeight(Index row) const { return this->Fit.Weight(row / 2); }
  double Area(Index row) const { return this->Assembly->Mesh().ControlAreas()[row / 2]; }

  std::shared_ptr<const Assembler> Assembly;
  std::shared_ptr<const TangentPlanes> Planes;
  PointData Data;
  Fidelity Fit;
  Settings Options;
  VectorStiffness Stiffness;
  std::shared_ptr<LinearSolver> Solver;
  std::unique_ptr<Model> Normal;
  const ParallelFor& Parallel;

  Values W, F; ///< coordinates of the state and of the data
  Values NormalParts; ///< of Keep
  Values U; ///< 3m columns
  Vector Inertia; ///< diag(M), or of a steady state a small part of it
  SparseMatrix Matrix, MassDifference;
  Values B, Solution; ///< of a solve
  Values Term; ///< of SDIRK2
  ExponentialSeries::Work Series;
  Values Load; ///< of Dirichlet conditions, and their right-hand side
  bool Prepared = false;
};

} // namespace SurfaceDiffusion
