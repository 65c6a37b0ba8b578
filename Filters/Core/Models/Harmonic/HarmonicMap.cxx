// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Models/Harmonic/HarmonicMap.h"

#include "Core/Models/Harmonic/UnitVectors.h"

#include <algorithm>
#include <cmath>
#include <vector>

namespace SurfaceDiffusion
{

HarmonicMap::HarmonicMap(std::shared_ptr<const Assembler> assembler, CornerWeights coefficients,
  PointData data, const Settings& settings, std::shared_ptr<LinearSolver> solver,
  const ParallelFor& parallel)
  : StateModel(data.Start)
  , Assembly(std::move(assembler))
  , Data(std::move(data))
  , Fit(this->Data,
      { settings.Fidelity, FidelityNorm::L2, ChannelCoupling::Joint, 0.0, settings.LineField })
  , Options(settings)
  , Parallel(parallel)
  , GradientEnergy(this->Assembly->SharedMesh(), std::move(coefficients),
      { settings.Exponent, settings.Beta, settings.LargestDiffusivity, settings.LineField },
      parallel)
  , System(this->Assembly, std::move(solver), parallel)
  , Tangent(this->Assembly, this->GradientEnergy.GetCoefficients(), settings.Method,
      settings.LineField, settings.Limits, parallel)
  , Diagonal(this->U.rows())
  , Damping(this->U.rows())
  , Previous(this->U)
  , Anchor(this->U)
  , RightHandSide(this->U.rows(), this->U.cols())
  , Step(this->U.rows(), this->U.cols())
{
  this->FillDiagonal();
}

void HarmonicMap::SetFidelityFactors(const Vector& factors)
{
  this->Data.FidelityFactors = factors;
  this->FillDiagonal();
}

void HarmonicMap::FillDiagonal()
{
  const TriangleMesh& mesh = this->Assembly->Mesh();
  ForEach(this->Parallel, mesh.NumberOfVertices(),
    [&](Index i)
    {
      this->Diagonal[i] =
        mesh.ControlAreas()[i] * (1.0 + this->Options.TimeStep * this->Fit.Weight(i));
    });
}

StepReport HarmonicMap::Advance(const ProgressMonitor& progress)
{
  StepReport report;
  switch (this->Options.TimeScheme)
  {
    case Scheme::ExplicitReaction:
      this->ExplicitReactionStep(report, progress);
      break;
    case Scheme::TangentPlane:
      this->TangentPlaneStep(report, progress);
      break;
    case Scheme::MinimizingMovement:
      this->MinimizingMovementStep(report, progress);
      break;
  }
  return report;
}

// --- The energy and its terms ---

double HarmonicMap::Energy() const
{
  return this->Assembly->Mesh().GetReduction().Sum(this->ProcessEnergy());
}

/// E, summed over the triangles and vertices of this process.
double HarmonicMap::ProcessEnergy() const
{
  return this->GradientEnergy(this->U) +
    this->Fit.Energy(this->Assembly->Mesh(), this->U, this->Parallel);
}

/// E + |u - anchor|^2_M / (2 dt), which a step decreases.
double HarmonicMap::Objective() const
{
  const TriangleMesh& mesh = this->Assembly->Mesh();
  const double here = this->ProcessEnergy() +
    Sum(this->Parallel, mesh.NumberOfVertices(),
      [&](Index i)
      { return mesh.ControlAreas()[i] * (this->U.row(i) - this->Anchor.row(i)).squaredNorm(); }) /
      (2.0 * this->Options.TimeStep);
  return mesh.GetReduction().Sum(here);
}

/// The matrix (1 + lambda dt chi) M + dt K(g) with g, and the signs of lines, at u. Returns E.
double HarmonicMap::Freeze()
{
  const double gradientEnergy = this->GradientEnergy.Evaluate(this->U);
  this->System.Assemble(this->Diagonal, this->Options.TimeStep,
    this->GradientEnergy.GetCoefficients(), this->GradientEnergy.Diffusivities().data(),
    this->GradientEnergy.GetSigns());
  const TriangleMesh& mesh = this->Assembly->Mesh();
  return mesh.GetReduction().Sum(gradientEnergy + this->Fit.Energy(mesh, this->U, this->Parallel));
}

void HarmonicMap::ProjectToPlane(Index i)
{
  const Values& normals = this->Options.Normals;
  if (normals.rows() > 0)
  {
    this->U.row(i) -= this->U.row(i).dot(normals.row(i)) * normals.row(i);
  }
}

void HarmonicMap::ProjectToSphere()
{
  if (!this->Options.ProjectToSphere && this->Options.Normals.rows() == 0)
  {
    return;
  }
  ForEach(this->Parallel, this->Assembly->Mesh().NumberOfVertices(),
    [&](Index i)
    {
      if (this->Data.Fixed[i])
      {
        return;
      }
      this->ProjectToPlane(i);
      if (this->Options.ProjectToSphere && !Normalize(this->U.row(i)))
      {
        this->U.row(i) = this->Previous.row(i); // its length is zero
        return;
      }
      this->ProjectToPlane(i); // a short vector was normalised with its round-off
    });
}

void HarmonicMap::Copy(const Values& from, Values& to) const
{
  ForEachBlock(this->Parallel, this->Assembly->Mesh().NumberOfVertices(),
    [&](Index, Index begin, Index end)
    { to.middleRows(begin, end - begin) = from.middleRows(begin, end - begin); });
}

// --- ExplicitReaction ---

/// (20), (21): ((1 + lambda dt chi) M + dt K(g)) w = M (u + dt r u + lambda dt chi f), u_new = w / |w|.
void HarmonicMap::ExplicitReactionStep(StepReport& report, const ProgressMonitor& progress)
{
  const TriangleMesh& mesh = this->Assembly->Mesh();
  const double dt = this->Options.TimeStep;
  const double p = this->Options.Exponent;
  this->Previous = this->U;
  this->Freeze();
  ForEach(this->Parallel, mesh.NumberOfVertices(),
    [&](Index i)
    {
      double integral = 0.0; // of the reaction, over the control cell
      for (Index c = mesh.VertexCornersBegin()[i]; c < mesh.VertexCornersBegin()[i + 1]; ++c)
      {
        const Index t = mesh.VertexCorners()[c] / 3;
        const double square = this->GradientEnergy.GradientSquares()[t];
        const double rate = this->Options.ConsistentReaction
          ? this->GradientEnergy.Diffusivities()[t] * square
          : std::pow(square, 0.5 * p);
        integral += mesh.Shapes()[t].Area() / 3.0 * rate;
      }
      const double area = mesh.ControlAreas()[i];
      this->RightHandSide.row(i) = (area + dt * integral) * this->U.row(i) +
        (area * dt * this->Fit.Weight(i) * this->Fit.Sign(i, this->U)) * this->Data.Given.row(i);
    });
  if (this->Data.Fixed.any())
  {
    this->System.Constrain(this->Data.Fixed, this->Data.Start);
  }
  this->System.SetUpSolver(progress.Part(0.0, 0.5));
  this->System.Solve(this->RightHandSide, this->U, report, progress.Part(0.5, 1.0));
  this->ProjectToSphere();
}

DiffusionStep HarmonicMap::Diffusion() const
{
  DiffusionStep step;
  step.TimeStep = this->Options.TimeStep;
  step.Fidelity = this->Options.Fidelity;
  step.IsConstant = this->Options.Exponent == 2.0;
  return step;
}

/// K(g) with the g of the last Freeze().
const CornerWeights& HarmonicMap::DiffusionWeights(Eigen::Index /*column*/)
{
  const CornerWeights& coefficients = this->GradientEnergy.GetCoefficients();
  this->Weighted.resize(coefficients.rows(), 3);
  ForEach(this->Parallel, static_cast<Index>(coefficients.rows()),
    [&](Index t)
    { this->Weighted.row(t) = this->GradientEnergy.Diffusivities()[t] * coefficients.row(t); });
  return this->Weighted;
}

// --- TangentPlane and MinimizingMovement ---

void HarmonicMap::TangentPlaneStep(StepReport& report, const ProgressMonitor& progress)
{
  this->Copy(this->U, this->Anchor);
  const double energy = this->Freeze();
  this->Descend(energy, report, progress);
}

void HarmonicMap::MinimizingMovementStep(StepReport& report, const ProgressMonitor& progress)
{
  constexpr double stopTolerance = 1e-4; // on the last decrease, relative to that of the step
  this->Copy(this->U, this->Anchor);
  const double start = this->Freeze();
  double objective = start;
  double before = start;
  for (int k = 0; k < this->Options.MaximumNumberOfRepetitions; ++k)
  {
    before = objective;
    if (k > 0)
    {
      this->Freeze();
    }
    // Each repetition is expected to take half of the time left.
    objective = this->Descend(
      before, report, progress.Part(1.0 - std::pow(0.5, k), 1.0 - std::pow(0.5, k + 1)));
    if (before - objective <= stopTolerance * (start - objective))
    {
      return;
    }
  }
  report.UnsettledDecrease = (before - objective) / (start - objective);
}

/// After Freeze(), one step from u that does not raise Objective(), whose value at u is
/// `objective`; returns the new value.
double HarmonicMap::Descend(double objective, StepReport& report, const ProgressMonitor& progress)
{
  const TriangleMesh& mesh = this->Assembly->Mesh();
  const double dt = this->Options.TimeStep;
  this->Copy(this->U, this->Previous);
  Multiply(this->System.GetMatrix(), this->U, this->RightHandSide, this->Parallel);
  ForEach(this->Parallel, mesh.NumberOfVertices(),
    [&](Index i)
    {
      this->RightHandSide.row(i) = mesh.ControlAreas()[i] *
          (this->Anchor.row(i) +
            (dt * this->Fit.Weight(i) * this->Fit.Sign(i, this->U)) * this->Data.Given.row(i)) -
        this->RightHandSide.row(i);
    });
  double damped = 0.0;
  double done = 0.0;
  for (const double share : { 0.0, 1.0 / 16.0, 1.0 })
  {
    if (share > 0.0)
    {
      if (damped == 0.0)
      {
        this->FindDamping();
      }
      this->System.AddToDiagonal(share - damped, this->Damping);
      damped = share;
    }
    const TangentSystem tangent{ this->System.GetMatrix(), this->Previous, this->Data.Fixed,
      this->RightHandSide, this->Diagonal, mesh.GetReduction(),
      this->Options.Normals.rows() > 0 ? &this->Options.Normals : nullptr };
    const SolveReport solve = this->Tangent.Solve(
      this->System, tangent, this->Step, progress.Part(done, done + 0.5 * (1.0 - done)));
    done += 0.5 * (1.0 - done);
    report.Add(solve);
    ForEach(this->Parallel, mesh.NumberOfVertices(),
      [&](Index i) { this->U.row(i) = this->Previous.row(i) + this->Step.row(i); });
    this->ProjectToSphere();
    const double reached = this->Objective();
    if (reached <= objective)
    {
      return reached;
    }
  }
  this->U = this->Previous; // only round-off raised it
  return objective;
}

/// The lack of diagonal dominance of dt K, D of the class comment times dt. An edge on an interface
/// counts once, with the absolute value of its accumulated entry.
void HarmonicMap::FindDamping()
{
  const Reduction& reduction = this->Assembly->Mesh().GetReduction();
  const SparseMatrix& matrix = this->System.GetMatrix();
  const Index* outer = matrix.outerIndexPtr();
  const Index* inner = matrix.innerIndexPtr();
  const double* a = matrix.valuePtr();
  ForEach(this->Parallel, static_cast<Index>(matrix.rows()),
    [&](Index i)
    {
      double excess = this->Diagonal[i];
      for (Index slot = outer[i]; slot < outer[i + 1]; ++slot)
      {
        excess += inner[slot] == i ? -a[slot] : std::abs(a[slot]);
      }
      this->Damping[i] = excess;
    });
  const std::vector<std::array<Index, 2>>& edges = reduction.InterfaceEdges();
  this->InterfaceEntries.resize(edges.size());
  const auto add = [&](std::size_t edge, double sign)
  {
    for (const Index i : edges[edge])
    {
      this->Damping[i] += sign * std::abs(this->InterfaceEntries[edge]);
    }
  };
  for (std::size_t e = 0; e < edges.size(); ++e)
  {
    this->InterfaceEntries[e] = matrix.coeff(edges[e][0], edges[e][1]);
    add(e, -1.0);
  }
  reduction.AccumulateInterfaceEdges(this->InterfaceEntries.data());
  for (std::size_t e = 0; e < edges.size(); ++e)
  {
    if (reduction.OwnsInterfaceEdge(static_cast<Index>(e)))
    {
      add(e, 1.0);
    }
  }
  reduction.Accumulate(this->Damping);
  ForEach(this->Parallel, static_cast<Index>(this->Damping.size()),
    [&](Index i) { this->Damping[i] = reduction.Owns(i) ? std::max(this->Damping[i], 0.0) : 0.0; });
}

} // namespace SurfaceDiffusion
