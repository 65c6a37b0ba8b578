// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Models/NonlinearDiffusion.h"

#include "Core/Operators/CotanWeights.h"

#include <algorithm>
#include <cmath>

namespace SurfaceDiffusion
{

namespace
{

/// Squares of grad u along e1 and in all, summed over channels first .. last - 1.
struct SquaredGradient
{
  double Along = 0.0;
  double Total = 0.0;
};

SquaredGradient SquareGradient(const TriangleMesh& mesh, const TangentVectors& frames,
  const Values& u, Index t, Eigen::Index first, Eigen::Index last)
{
  const Triangles& vertices = mesh.TriangleVertices();
  SquaredGradient squared;
  for (Eigen::Index k = first; k < last; ++k)
  {
    const Eigen::Vector2d gradient =
      Gradient(mesh.Shapes()[t], u(vertices(t, 0), k), u(vertices(t, 1), k), u(vertices(t, 2), k));
    squared.Total += gradient.squaredNorm();
    if (frames.rows() > 0)
    {
      squared.Along += std::pow(frames.row(t).dot(gradient), 2);
    }
  }
  return squared;
}

} // namespace

NonlinearDiffusion::NonlinearDiffusion(std::shared_ptr<const Assembler> assembler,
  TangentVectors frames, PointData data, const Settings& settings,
  std::shared_ptr<LinearSolver> solver, const ParallelFor& parallel)
  : DataModel(std::move(data))
  , Assembly(std::move(assembler))
  , Frames(std::move(frames))
  , Fit(this->Data,
      { settings.Fidelity, settings.Norm, settings.Coupling, settings.FidelityRounding, false,
        settings.ChannelWeights })
  , Options(settings)
  , Parallel(parallel)
  , System(this->Assembly, std::move(solver), parallel)
  , Isotropic(CotanWeights(this->Assembly->Mesh(), parallel))
  , Weighted(this->Isotropic.rows(), 3)
  , Diagonal(this->Data.Start.rows())
{
  if (this->Fit.CanConserve() && settings.ConservesTotal)
  {
    this->Conserved =
      TotalCorrection(this->Assembly->Mesh(), this->Data, this->Fit.IsPresent(), parallel);
  }
  if (this->Frames.rows() > 0)
  {
    this->Directional = DirectionalWeights(this->Assembly->Mesh(), this->Frames, parallel);
    TangentVectors across(this->Frames.rows(), 2);
    across << -this->Frames.col(1), this->Frames.col(0);
    this->Perpendicular = DirectionalWeights(this->Assembly->Mesh(), across, parallel);
  }
  this->MakeGroups();
}

void NonlinearDiffusion::MakeGroups()
{
  const Eigen::Index columns = this->NormColumns();
  for (Eigen::Index first = 0; first < this->U.cols();)
  {
    const Eigen::Index end = (first / columns + 1) * columns;
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
      this->Unknowns.push_back({ zero, zero, this->Data.Fixed.any() ? zero : Values() });
    }
    this->Groups.push_back({ first, last, buffer, first % columns != 0 });
    first = last;
  }
}

StepReport NonlinearDiffusion::Advance(const ProgressMonitor& progress)
{
  StepReport report;
  const auto count = static_cast<double>(this->Groups.size());
  double done = 0.0;
  for (const Group& group : this->Groups)
  {
    this->AdvanceGroup(group, report, progress.Part(done / count, (done + 1.0) / count));
    done += 1.0;
  }
  this->Conserved.Restore(this->Assembly->Mesh(), this->U, this->Parallel);
  return report;
}

void NonlinearDiffusion::AdvanceGroup(
  const Group& group, StepReport& report, const ProgressMonitor& progress)
{
  const TriangleMesh& mesh = this->Assembly->Mesh();
  Buffers& unknowns = this->Unknowns[group.Buffer];
  const Eigen::Index first = group.First;
  const Eigen::Index last = group.Last;
  const double channelWeight = this->Fit.ChannelWeight(first);
  if (!group.SharesWeights) // later groups still need them at the old u
  {
    this->FillWeights(first, first + this->NormColumns());
  }
  ForEach(this->Parallel, mesh.NumberOfVertices(),
    [&](Index i)
    {
      this->Diagonal[i] = mesh.ControlAreas()[i] *
        (1.0 + this->Options.TimeStep * channelWeight * this->Fit.Weight(i, this->U, first, last));
    });
  this->System.Assemble(this->Diagonal, this->Options.TimeStep, this->Weighted);
  this->FillChange(group);
  if (this->Data.Fixed.any())
  {
    this->System.Constrain(this->Data.Fixed, unknowns.NoChange);
  }
  this->System.SetUpSolver(progress.Part(0.0, 0.5));
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

/// The weights (12) of each triangle, with g1 and g2 at the old |grad u|.
void NonlinearDiffusion::FillWeights(Eigen::Index first, Eigen::Index last)
{
  const TriangleMesh& mesh = this->Assembly->Mesh();
  ForEach(this->Parallel, mesh.NumberOfTriangles(),
    [&](Index t)
    {
      const double squared = SquareGradient(mesh, this->Frames, this->U, t, first, last).Total;
      const double g1 = this->Options.AlongDiffusivity * this->Options.Along(squared);
      if (this->Frames.rows() == 0)
      {
        this->Weighted.row(t) = g1 * this->Isotropic.row(t);
        return;
      }
      const double g2 = this->Options.AcrossDiffusivity * this->Options.Across(squared);
      this->Weighted.row(t) = AnisotropicWeights(HasDirection(this->Frames, t),
        this->Isotropic.row(t), this->Directional.row(t), this->Perpendicular.row(t), g1, g2);
    });
}

/// dt (-K(u_old) u_old + lambda chi M (f - u_old)), from differences along edges: the off-diagonal
/// entries of the matrix are those of dt K.
void NonlinearDiffusion::FillChange(const Group& group)
{
  const TriangleMesh& mesh = this->Assembly->Mesh();
  Values& side = this->Unknowns[group.Buffer].RightHandSide;
  const Eigen::Index first = group.First;
  const Eigen::Index last = group.Last;
  const double step = this->Options.TimeStep * this->Fit.ChannelWeight(first);
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

double NonlinearDiffusion::Energy() const
{
  const TriangleMesh& mesh = this->Assembly->Mesh();
  const Eigen::Index columns = this->NormColumns();
  double energy = 0.0;
  for (Eigen::Index first = 0; first < this->U.cols(); first += columns)
  {
    const Eigen::Index last = first + columns;
    energy += Sum(this->Parallel, mesh.NumberOfTriangles(),
      [&](Index t)
      {
        const SquaredGradient squared = SquareGradient(mesh, this->Frames, this->U, t, first, last);
        double psi1 = this->Options.AlongDiffusivity * this->Options.Along.Potential(squared.Total);
        if (this->Frames.rows() > 0 && squared.Total > 0.0)
        {
          const double psi2 =
            this->Options.AcrossDiffusivity * this->Options.Across.Potential(squared.Total);
          psi1 = HasDirection(this->Frames, t)
            ? psi2 + (psi1 - psi2) * (squared.Along / squared.Total)
            : IsotropicMean(psi1, psi2);
        }
        return mesh.Shapes()[t].Area() * psi1;
      });
  }
  return mesh.GetReduction().Sum(energy + this->Fit.Energy(mesh, this->U, this->Parallel));
}

} // namespace SurfaceDiffusion
