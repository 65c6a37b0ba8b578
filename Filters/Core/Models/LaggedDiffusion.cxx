// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Models/LaggedDiffusion.h"

#include <utility>

namespace SurfaceDiffusion
{

LaggedDiffusion::LaggedDiffusion(std::shared_ptr<const Assembler> assembler, PointData data,
  double timeStep, const Fidelity::Settings& fidelity, std::shared_ptr<LinearSolver> solver,
  const ParallelFor& parallel)
  : StateModel(data.Start)
  , Parallel(parallel)
  , Weighted(assembler->Mesh().NumberOfTriangles(), 3)
  , Assembly(std::move(assembler))
  , Data(std::move(data))
  , Fit(this->Data, fidelity)
  , TimeStep(timeStep)
  , System(this->Assembly, std::move(solver), parallel)
  , Diagonal(this->U.rows())
  , Change(this->U.rows(), fidelity.Coupling == ChannelCoupling::Joint ? this->U.cols() : 1)
  , RightHandSide(this->Change.rows(), this->Change.cols())
{
  if (this->Fit.CanConserve())
  {
    this->Conserved = TotalCorrection(this->Mesh(), this->Data, this->Fit.IsPresent(), parallel);
  }
  if (this->Data.Fixed.any())
  {
    this->NoChange = Values::Zero(this->Change.rows(), this->Change.cols());
  }
}

StepReport LaggedDiffusion::Advance(const ProgressMonitor& progress)
{
  StepReport report;
  const Eigen::Index columns = this->Change.cols();
  const Eigen::Index systems = this->U.cols() / columns;
  for (Eigen::Index system = 0; system < systems; ++system)
  {
    const double done = static_cast<double>(system) / static_cast<double>(systems);
    this->AdvanceColumns(system * columns, (system + 1) * columns, report,
      progress.Part(done, done + 1.0 / static_cast<double>(systems)));
  }
  this->Conserved.Restore(this->Mesh(), this->U, this->Parallel);
  return report;
}

void LaggedDiffusion::AdvanceColumns(
  Eigen::Index first, Eigen::Index last, StepReport& report, const ProgressMonitor& progress)
{
  const TriangleMesh& mesh = this->Mesh();
  this->FillWeights(first, last, report, progress.Part(0.0, 0.2));
  ForEach(this->Parallel, mesh.NumberOfVertices(),
    [&](Index i)
    {
      this->Diagonal[i] = mesh.ControlAreas()[i] *
        (this->MassDensity(i) + this->TimeStep * this->Fit.Weight(i, this->U, first, last));
    });
  this->System.Assemble(this->Diagonal, this->TimeStep, this->Weighted);
  this->FillChange(first, last);
  if (this->Damping > 0.0)
  {
    ForEach(this->Parallel, mesh.NumberOfVertices(),
      [&](Index i) { this->Diagonal[i] = this->System.GetMatrix().coeff(i, i); });
    this->System.AddToDiagonal(this->Damping, this->Diagonal);
  }
  if (this->NoChange.size() > 0)
  {
    this->System.Constrain(this->Data.Fixed, this->NoChange);
  }
  this->System.SetUpSolver(progress.Part(0.2, 0.5));
  this->Change.setZero();
  this->System.Solve(this->RightHandSide, this->Change, report, progress.Part(0.5, 1.0));
  ForEach(this->Parallel, mesh.NumberOfVertices(),
    [&](Index i)
    {
      for (Eigen::Index k = first; k < last; ++k)
      {
        this->U(i, k) += this->Change(i, k - first);
      }
    });
}

/// dt (-K(u_old) u_old + lambda chi M (f - u_old)), from differences along edges: the off-diagonal
/// entries of the matrix are those of dt K.
void LaggedDiffusion::FillChange(Eigen::Index first, Eigen::Index last)
{
  const TriangleMesh& mesh = this->Mesh();
  const Index* outer = this->System.GetMatrix().outerIndexPtr();
  const Index* inner = this->System.GetMatrix().innerIndexPtr();
  const double* a = this->System.GetMatrix().valuePtr();
  ForEach(this->Parallel, mesh.NumberOfVertices(),
    [&](Index i)
    {
      const double lambda =
        this->TimeStep * mesh.ControlAreas()[i] * this->Fit.Weight(i, this->U, first, last);
      for (Eigen::Index k = first; k < last; ++k)
      {
        const double u = this->U(i, k);
        double change = lambda > 0.0 ? lambda * (this->Data.Given(i, k) - u) : 0.0;
        for (Index slot = outer[i]; slot < outer[i + 1]; ++slot)
        {
          change -= a[slot] * (this->U(inner[slot], k) - u);
        }
        this->RightHandSide(i, k - first) = change;
      }
    });
}

} // namespace SurfaceDiffusion
