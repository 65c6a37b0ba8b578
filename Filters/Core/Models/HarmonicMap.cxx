// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Models/HarmonicMap.h"

#include "Core/Models/UnitVectors.h"
#include "Core/Operators/SparsePattern.h"

#include <algorithm>
#include <cmath>

namespace SurfaceDiffusion
{

HarmonicMap::HarmonicMap(std::shared_ptr<const Assembler> assembler, CornerWeights coefficients,
  PointData data, const Settings& settings, std::shared_ptr<LinearSolver> solver,
  const ParallelFor& parallel)
  : Operators(std::move(assembler))
  , Coefficients(std::move(coefficients))
  , Data(std::move(data))
  , Options(settings)
  , Solver(std::move(solver))
  , Parallel(parallel)
  , Tangent(parallel)
  , Diagonal(this->Data.Start.rows())
  , Damping(this->Data.Start.rows())
  , Weights(this->Coefficients.rows())
  , Squares(this->Coefficients.rows())
  , U(this->Data.Start)
  , Previous(U)
  , Anchor(U)
  , RightHandSide(U.rows(), U.cols())
  , Step(U.rows(), U.cols())
  , Other(U.rows(), U.cols())
{
  TakePattern(this->Operators->Pattern(), this->Matrix, this->Parallel);
  if (this->Options.LineField)
  {
    this->Signs.resize(this->Coefficients.rows(), 3);
  }
  if (this->Data.Fixed.any())
  {
    this->Load.resize(U.rows(), U.cols());
  }
  const TriangleMesh& mesh = this->Operators->Mesh();
  ForEach(this->Parallel, mesh.NumberOfVertices(),
    [&](Index i)
    {
      this->Diagonal[i] =
        mesh.ControlAreas()[i] * (1.0 + this->Options.TimeStep * this->FidelityAt(i));
    });
}

void HarmonicMap::Restore(const double* checkpoint)
{
  std::copy(checkpoint, checkpoint + this->U.size(), this->U.data());
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

/// |grad u|^2 on a triangle, from c_ij = -area grad(phi_i) . D grad(phi_j): the sum over its edges
/// of c_ij |u_i - u_j|^2 is area grad u . D grad u. Of a line field also the signs that make it
/// smallest, where wanted.
double HarmonicMap::GradientSquare(Index t, double* signs) const
{
  const auto c = this->Coefficients.row(t);
  const TriangleMesh& mesh = this->Operators->Mesh();
  const auto v = mesh.TriangleVertices().row(t);
  const auto term = [&](int edge, double sign)
  {
    return c[edge] *
      (this->U.row(v[(edge + 1) % 3]) - sign * this->U.row(v[(edge + 2) % 3])).squaredNorm();
  };
  double smallest = 0.0;
  if (!this->Options.LineField)
  {
    smallest = term(0, 1.0) + term(1, 1.0) + term(2, 1.0);
  }
  else
  {
    const double same[3] = { term(0, 1.0), term(1, 1.0), term(2, 1.0) };
    const double opposite[3] = { term(0, -1.0), term(1, -1.0), term(2, -1.0) };
    smallest = same[0] + same[1] + same[2];
    int flipped = -1;
    for (int corner = 0; corner < 3; ++corner) // the two edges at this corner change
    {
      const int next = (corner + 1) % 3, last = (corner + 2) % 3;
      const double sum = same[corner] + opposite[next] + opposite[last];
      if (sum < smallest)
      {
        smallest = sum;
        flipped = corner;
      }
    }
    for (int edge = 0; signs && edge < 3; ++edge)
    {
      signs[edge] = flipped < 0 || edge == flipped ? 1.0 : -1.0;
    }
  }
  const double square = smallest / (mesh.Shapes()[t].Area() * this->Options.LargestDiffusivity);
  return std::max(square, 0.0); // round-off on slivers
}

/// g of (20), (21).
double HarmonicMap::Weight(double square) const
{
  const double p = this->Options.Exponent;
  if (p == 2.0)
  {
    return 1.0;
  }
  const double s = square + this->Options.Beta;
  return p == 1.0 ? 1.0 / std::sqrt(s) : std::pow(s, 0.5 * (p - 2.0));
}

/// ((s + beta)^(p/2) - beta^(p/2)) / p, free of cancellation for small s.
double HarmonicMap::EnergyDensity(double square) const
{
  const double p = this->Options.Exponent;
  const double beta = this->Options.Beta;
  if (p == 2.0)
  {
    return 0.5 * square;
  }
  if (p == 1.0)
  {
    return square / (std::sqrt(square + beta) + std::sqrt(beta));
  }
  return std::pow(beta, 0.5 * p) * std::expm1(0.5 * p * std::log1p(square / beta)) / p;
}

double HarmonicMap::Energy() const
{
  return this->Operators->Mesh().GetReduction().Sum(this->EnergyHere());
}

double HarmonicMap::EnergyHere() const
{
  const TriangleMesh& mesh = this->Operators->Mesh();
  double energy = this->Options.LargestDiffusivity *
    Sum(this->Parallel, mesh.NumberOfTriangles(),
      [&](Index t)
      { return mesh.Shapes()[t].Area() * this->EnergyDensity(this->GradientSquare(t, nullptr)); });
  if (this->Options.Fidelity > 0.0)
  {
    energy += 0.5 *
      Sum(this->Parallel, mesh.NumberOfVertices(),
        [&](Index i)
        {
          return mesh.ControlAreas()[i] * this->FidelityAt(i) *
            (this->U.row(i) - this->SignOfGiven(i) * this->Data.Given.row(i)).squaredNorm();
        });
  }
  return energy;
}

/// E + |u - anchor|^2_M / (2 dt), what a step makes smaller.
double HarmonicMap::Objective() const
{
  const TriangleMesh& mesh = this->Operators->Mesh();
  const double here = this->EnergyHere() +
    Sum(this->Parallel, mesh.NumberOfVertices(),
      [&](Index i)
      { return mesh.ControlAreas()[i] * (this->U.row(i) - this->Anchor.row(i)).squaredNorm(); }) /
      (2.0 * this->Options.TimeStep);
  return mesh.GetReduction().Sum(here);
}

/// The matrix (1 + lambda dt 1_D) M + dt K(g) with g, and the signs of lines, at u.
void HarmonicMap::Freeze()
{
  ForEach(this->Parallel, this->Operators->Mesh().NumberOfTriangles(),
    [&](Index t)
    {
      double signs[3];
      this->Squares[t] = this->GradientSquare(t, signs);
      this->Weights[t] = this->Weight(this->Squares[t]);
      if (this->Options.LineField)
      {
        this->Signs.row(t) << signs[0], signs[1], signs[2];
      }
    });
  this->Operators->Fill(this->Matrix, this->Diagonal, this->Options.TimeStep, this->Coefficients,
    this->Weights.data(), this->Parallel, this->Options.LineField ? &this->Signs : nullptr);
}

void HarmonicMap::ProjectToSphere()
{
  if (this->Options.ProjectToSphere)
  {
    ForEach(this->Parallel, this->Operators->Mesh().NumberOfVertices(),
      [&](Index i)
      {
        if (!this->Data.Fixed[i] && !Normalize(this->U.row(i)))
        {
          this->U.row(i) = this->Previous.row(i); // where nothing is left of a vector
        }
      });
  }
}

// --- ExplicitReaction ---

void HarmonicMap::ExplicitReactionStep(StepReport& report, const ProgressMonitor& progress)
{
  const TriangleMesh& mesh = this->Operators->Mesh();
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
        const double rate = this->Options.ConsistentReaction ? this->Weights[t] * this->Squares[t]
                                                             : std::pow(this->Squares[t], 0.5 * p);
        integral += mesh.Shapes()[t].Area() / 3.0 * rate;
      }
      const double area = mesh.ControlAreas()[i];
      this->RightHandSide.row(i) = (area + dt * integral) * this->U.row(i) +
        (area * dt * this->FidelityAt(i) * this->SignOfGiven(i)) * this->Data.Given.row(i);
    });
  if (this->Data.Fixed.any())
  {
    this->Operators->Constrain(
      this->Matrix, this->Data.Fixed, this->Data.Start, this->Load, this->Parallel);
    ForEach(this->Parallel, mesh.NumberOfVertices(),
      [&](Index i)
      {
        if (this->Data.Fixed[i])
        {
          this->RightHandSide.row(i).setZero();
        }
        this->RightHandSide.row(i) += this->Load.row(i);
      });
  }
  this->Solver->SetMatrix(this->Matrix, progress.Part(0.0, 0.5));
  const SolveReport solve =
    this->Solver->Solve(this->RightHandSide, this->U, progress.Part(0.5, 1.0));
  if (!solve.Converged)
  {
    throw NotConverged(solve);
  }
  report.Iterations = solve.Iterations;
  report.Residual = solve.Residual;
  ForEach(this->Parallel, mesh.NumberOfVertices(),
    [&](Index i)
    {
      if (this->Data.Fixed[i])
      {
        this->U.row(i) = this->Data.Start.row(i); // to the last bit
      }
    });
  this->ProjectToSphere();
}

// --- TangentPlane and MinimizingMovement ---

void HarmonicMap::TangentPlaneStep(StepReport& report, const ProgressMonitor& progress)
{
  this->Anchor = this->U;
  this->Descend(this->Energy(), report, progress);
}

void HarmonicMap::MinimizingMovementStep(StepReport& report, const ProgressMonitor& progress)
{
  constexpr int most = 50; // repetitions
  constexpr double little = 1e-4; // of the step's decrease so far: it rests
  this->Anchor = this->U;
  const double start = this->Energy();
  double objective = start;
  for (int k = 0; k < most; ++k)
  {
    const double before = objective;
    // Each repetition is expected to need half of what is left.
    objective = this->Descend(
      before, report, progress.Part(1.0 - std::pow(0.5, k), 1.0 - std::pow(0.5, k + 1)));
    if (before - objective <= little * (start - objective))
    {
      return;
    }
  }
}

/// One step from u that does not raise Objective(), which is `objective` at u; returns what it is
/// then.
double HarmonicMap::Descend(double objective, StepReport& report, const ProgressMonitor& progress)
{
  const TriangleMesh& mesh = this->Operators->Mesh();
  const double dt = this->Options.TimeStep;
  this->Previous = this->U;
  this->Freeze();
  Multiply(this->Matrix, this->U, this->RightHandSide, this->Parallel);
  ForEach(this->Parallel, mesh.NumberOfVertices(),
    [&](Index i)
    {
      this->RightHandSide.row(i) = mesh.ControlAreas()[i] *
          (this->Anchor.row(i) +
            (dt * this->FidelityAt(i) * this->SignOfGiven(i)) * this->Data.Given.row(i)) -
        this->RightHandSide.row(i);
    });
  this->FindDamping();
  double damped = 0.0;
  double done = 0.0;
  for (const double share : { 0.0, 1.0 / 16.0, 1.0 })
  {
    ForEach(this->Parallel, mesh.NumberOfVertices(),
      [&](Index i) { this->Matrix.coeffRef(i, i) += (share - damped) * this->Damping[i]; });
    damped = share;
    const SolveReport solve =
      this->SolveInTangentSpaces(progress.Part(done, done + 0.5 * (1.0 - done)));
    done += 0.5 * (1.0 - done);
    report.Iterations += solve.Iterations;
    report.Residual = std::max(report.Residual, solve.Residual);
    ForEach(this->Parallel, mesh.NumberOfVertices(),
      [&](Index i) { this->U.row(i) = this->Previous.row(i) + this->Step.row(i); });
    this->ProjectToSphere();
    const double reached = this->Objective();
    if (reached <= objective)
    {
      return reached;
    }
  }
  this->U = this->Previous; // raised by round-off only
  return objective;
}

/// D of the class comment, times dt. An edge on an interface counts once, with the absolute value
/// of its accumulated entry.
void HarmonicMap::FindDamping()
{
  const Reduction& reduction = this->Operators->Mesh().GetReduction();
  const Index* outer = this->Matrix.outerIndexPtr();
  const Index* inner = this->Matrix.innerIndexPtr();
  const double* a = this->Matrix.valuePtr();
  ForEach(this->Parallel, static_cast<Index>(this->Matrix.rows()),
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
    this->InterfaceEntries[e] = this->Matrix.coeff(edges[e][0], edges[e][1]);
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

SolveReport HarmonicMap::SolveInTangentSpaces(const ProgressMonitor& progress)
{
  const bool jacobiAlone = this->Options.Method == Preconditioner::Jacobi;
  const bool factor = this->Options.Method == Preconditioner::Factor;
  SolveReport report = this->TrySolve(factor, this->Step, progress.Part(0.0, 0.5));
  if (!report.Converged && jacobiAlone)
  {
    throw NotConverged(report);
  }
  if (!report.Converged)
  {
    // Where triangles are so bad that neither gets there, the better of the two is a step too.
    const SolveReport other = this->TrySolve(!factor, this->Other, progress.Part(0.5, 1.0));
    if (other.Residual < report.Residual)
    {
      report.Residual = other.Residual;
      this->Step.swap(this->Other);
    }
    report.Iterations += other.Iterations;
  }
  return report;
}

SolveReport HarmonicMap::TrySolve(bool factor, Values& step, const ProgressMonitor& progress)
{
  if (factor)
  {
    this->Solver->SetMatrix(this->Matrix, progress.Part(0.0, 0.5));
    this->Solver->SetLimits({ 1.0, 1 }); // a preconditioner need not be refined
  }
  const TangentSystem system{ this->Matrix, this->Previous, this->Data.Fixed, this->RightHandSide,
    this->Diagonal, this->Operators->Mesh().GetReduction() };
  return this->Tangent.Solve(system, step, factor ? this->Solver.get() : nullptr,
    this->Options.Limits, factor ? progress.Part(0.5, 1.0) : progress);
}

} // namespace SurfaceDiffusion
