// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Models/LaggedDiffusion.h"

#include "Core/Operators/SparsePattern.h"

#include <utility>

namespace SurfaceDiffusion
{

LaggedDiffusion::LaggedDiffusion(std::shared_ptr<const Assembler> assembler, PointData data,
  double timeStep, const Fidelity::Settings& fidelity, std::shared_ptr<LinearSolver> solver,
  const ParallelFor& parallel)
  : DataModel(std::move(data))
  , Parallel(parallel)
  , Weighted(assembler->Mesh().NumberOfTriangles(), 3)
  , Assembly(std::move(assembler))
  , Fit(this->Data, fidelity)
  , TimeStep(timeStep)
  , System(this->Assembly, std::move(solver), parallel)
  , Diagonal(this->U.rows())
  , TensorColumns(fidelity.Coupling == ChannelCoupling::Joint ? this->U.cols() : 1)
{
  if (this->Fit.CanConserve())
  {
    this->Conserved = TotalCorrection(this->Mesh(), this->Data, this->Fit.IsPresent(), parallel);
  }
  this->MakeGroups();
  this->Data.Start = Values(); // U has it, and no equation reads it
}

void LaggedDiffusion::MakeGroups()
{
  for (Eigen::Index first = 0; first < this->U.cols();)
  {
    const Eigen::Index end = (first / this->TensorColumns + 1) * this->TensorColumns;
    Eigen::Index last = first + 1;
    while (last < end && this->Fit.ChannelWeight(last) == this->Fit.ChannelWeight(first))
    {
      ++last;
    }
    std::size_t buffer = 0;
    while (buffer < this->Unknowns.size() && this->Unknowns[buffer].Change.cols() != last - first)
    {
      ++buffer;
    }
    if (buffer == this->Unknowns.size())
    {
      const Values zero = Values::Zero(this->U.rows(), last - first);
      this->Unknowns.push_back({ zero, zero });
      if (this->Data.Fixed.any() && zero.cols() > this->NoChange.cols())
      {
        this->NoChange = Values(zero); // by a move, which leaves it usable when memory runs out
      }
    }
    this->Groups.push_back({ first, last, buffer });
    first = last;
  }
}

DiffusionStep LaggedDiffusion::Diffusion() const
{
  DiffusionStep step;
  step.TimeStep = this->TimeStep;
  step.Fidelity = this->Fit.GetSettings().Weight;
  step.IsL1 = this->Fit.GetSettings().Norm == FidelityNorm::L1;
  step.SharesTensor = this->TensorColumns == this->U.cols();
  return step;
}

const CornerWeights& LaggedDiffusion::DiffusionWeights(Eigen::Index column)
{
  if (this->TensorColumns < this->U.cols()) // Weighted are those of the last columns
  {
    StepReport unused;
    const Eigen::Index first = column / this->TensorColumns * this->TensorColumns;
    this->FillWeights(first, first + this->TensorColumns, unused, ProgressMonitor());
  }
  return this->Weighted;
}

StepReport LaggedDiffusion::Advance(const ProgressMonitor& progress)
{
  StepReport report;
  const auto count = static_cast<double>(this->Groups.size());
  double done = 0.0;
  for (const Group& group : this->Groups)
  {
    this->AdvanceGroup(group, report, progress.Part(done / count, (done + 1.0) / count));
    done += 1.0;
  }
  this->Conserved.Restore(this->Mesh(), this->U, this->Parallel);
  return report;
}

/// (11), (14) with the fidelity of (17), (19), for the change d = u_new - u:
/// ((1 + lambda dt chi) M + dt K) d = dt (lambda chi M (f - u) - K u).
void LaggedDiffusion::AdvanceGroup(
  const Group& group, StepReport& report, const ProgressMonitor& progress)
{
  const TriangleMesh& mesh = this->Mesh();
  Buffers& unknowns = this->Unknowns[group.Buffer];
  const Eigen::Index first = group.First;
  const Eigen::Index last = group.Last;
  const double step = this->TimeStep * this->Fit.ChannelWeight(first);
  if (first % this->TensorColumns == 0) // the groups after it need D at the old u
  {
    this->FillWeights(first, first + this->TensorColumns, report, progress.Part(0.0, 0.2));
  }
  ForEach(this->Parallel, mesh.NumberOfVertices(),
    [&](Index i)
    {
      this->Diagonal[i] = mesh.ControlAreas()[i] *
        (this->MassDensity(i) + step * this->Fit.Weight(i, this->U, first, last));
    });
  this->System.Assemble(this->Diagonal, this->TimeStep, this->Weighted);
  this->FillChange(group);
  if (this->Damping > 0.0)
  {
    ForEach(this->Parallel, mesh.NumberOfVertices(),
      [&](Index i) { this->Diagonal[i] = DiagonalEntry(this->System.GetMatrix(), i); });
    this->System.AddToDiagonal(this->Damping, this->Diagonal);
  }
  if (this->NoChange.size() > 0)
  {
    this->System.Constrain(this->Data.Fixed, this->NoChange);
  }
  this->System.SetUpSolver(progress.Part(0.2, 0.5));
  unknowns.Change.setZero();
  this->System.Solve(unknowns.RightHandSide, unknowns.Change, report, progress.Part(0.5, 1.0));
  ForEach(this->Parallel, mesh.NumberOfVertices(),
    [&](Index i)
    {
      for (Eigen::Index k = first; k < last; ++k)
      {
        this->U(i, k) += unknowns.Change(i, k - first);
      }
    });
}

/// dt (-K(u_old) u_old + lambda chi M (f - u_old)), from differences along edges: the off-diagonal
/// entries of the matrix are those of dt K.
void LaggedDiffusion::FillChange(const Group& group)
{
  const TriangleMesh& mesh = this->Mesh();
  Values& side = this->Unknowns[group.Buffer].RightHandSide;
  const Eigen::Index first = group.First;
  const Eigen::Index last = group.Last;
  const double step = this->TimeStep * this->Fit.ChannelWeight(first);
  const Index* outer = this->System.GetMatrix().outerIndexPtr();
  const Index* inner = this->System.GetMatrix().innerIndexPtr();
  const double* a = this->System.GetMatrix().valuePtr();
  ForEach(this->Parallel, mesh.NumberOfVertices(),
    [&](Index i)
    {
      const double lambda =
        step * mesh.ControlAreas()[i] * this->Fit.Weight(i, this->U, first, last);
      for (Eigen::Index k = first; k < last; ++k)
      {
        const double u = this->U(i, k);
        double change = lambda > 0.0 ? lambda * (this->Data.Given(i, k) - u) : 0.0;
        for (Index slot = outer[i]; slot < outer[i + 1]; ++slot)
        {
          change -= a[slot] * (this->U(inner[slot], k) - u);
        }
        side(i, k - first) = change;
      }
    });
}

} // namespace SurfaceDiffusion
