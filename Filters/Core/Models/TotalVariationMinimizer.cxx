// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Models/TotalVariationMinimizer.h"

#include "Core/Operators/SparsePattern.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <string>

namespace SurfaceDiffusion
{

namespace
{

constexpr double OverRelaxation = 1.7;
constexpr int InnerIterations = 4;
constexpr int IterationsPerCheck = 10;

EdgeFunction WithoutBeta(EdgeFunction function)
{
  function.Beta = 0.0;
  return function;
}

} // namespace

TotalVariationMinimizer::TotalVariationMinimizer(std::shared_ptr<const Assembler> assembler,
  std::vector<GradientMap> gradients, Vector quadratic, Vector absolute, Flags fixed,
  const Settings& settings, const ParallelFor& parallel)
  : Assembly(std::move(assembler))
  , OverProcesses(this->Assembly->Mesh().GetReduction())
  , Options(settings)
  , Parallel(parallel)
  , NumberOfVertices(this->OverProcesses.SumOverVertices(
      parallel, this->Assembly->Mesh().NumberOfVertices(), [](Index) { return 1.0; }))
  , Areas(this->OverProcesses.Accumulated(
      this->Assembly->Mesh().ControlAreas(), this->AccumulatedAreas))
  , Gradients(this->Assembly->SharedMesh(), std::move(gradients), WithoutBeta(settings.Function),
      settings.Coupling, settings.Range, this->NumberOfVertices, parallel)
  , Vertices(this->Areas, std::move(quadratic), std::move(absolute), std::move(fixed),
      { WithoutBeta(settings.Function), settings.Coupling, settings.Range }, parallel)
  , Descent(parallel)
{
  if (!GetEdgeFunction(settings.Function.Kind).Convex)
  {
    throw std::invalid_argument(std::string("the energy of the edge function ") +
      GetEdgeFunction(settings.Function.Kind).Name + " is not convex");
  }
  Vector owned;
  TakePattern(this->Assembly->Pattern(), this->Matrix, parallel);
  this->Assembly->Fill(this->Matrix,
    this->OverProcesses.OwnedPart(this->Vertices.MakeDiagonal(), owned), 1.0,
    this->Gradients.MakeCoefficients(), nullptr, parallel);
}

TotalVariationMinimizer::Report TotalVariationMinimizer::Minimize(
  const Values& g, const Values& f, Values& u, const ProgressMonitor& progress)
{
  this->Prepare(u);
  this->Initial = u;
  this->Gradients.Start(u);
  this->Vertices.Start(g, f, u);
  const double startEnergy = this->Energy(u);
  const double negligible = std::max(1e-3 * startEnergy, 1e-6 * this->NoiseEnergy());
  Report report;
  double fraction = 0.0;
  while (true)
  {
    if (report.Iterations % IterationsPerCheck == 0)
    {
      report.Gap = this->MeasureGap(u, negligible);
      const double left = std::log(std::max(1.0, report.Gap / this->Options.StopTolerance));
      fraction = std::max(fraction, 1.0 - left / std::log(1.0 / this->Options.StopTolerance));
    }
    if (report.Gap <= this->Options.StopTolerance ||
      report.Iterations == this->Options.MaximumNumberOfIterations)
    {
      break;
    }
    progress.Report(fraction);
    ++report.Iterations;
    this->Gradients.Update(u, OverRelaxation);
    this->Vertices.Update(u, OverRelaxation);
    this->UpdateResidual();
    this->Descent.Improve(u, InnerIterations);
  }
  // On nearly degenerate triangles the few inner iterations may not suffice.
  if (report.Gap > this->Options.StopTolerance && this->Energy(u) > startEnergy)
  {
    u = this->Initial;
  }
  progress.Report(1.0);
  return report;
}

/// Sizes for as many columns as u has, and the residual of a right-hand side of zero.
void TotalVariationMinimizer::Prepare(const Values& u)
{
  if (this->RightHandSide.cols() != u.cols())
  {
    this->RightHandSide.resize(u.rows(), u.cols());
    this->Gathered.resize(u.rows(), u.cols());
    this->Descent.Residual.resize(u.rows(), u.cols());
    this->Load = Values::Zero(u.rows(), u.cols());
    if (this->Vertices.GetFixed().any())
    {
      this->Assembly->Constrain(
        this->Matrix, this->Vertices.GetFixed(), u, this->Load, this->Parallel);
    }
    this->Descent.SetMatrix(this->Matrix, this->OverProcesses);
  }
  this->RightHandSide.setZero();
  Multiply(this->Matrix, u, this->Descent.Residual, this->Parallel);
  this->Descent.Residual = this->Load - this->Descent.Residual;
  this->OverProcesses.Accumulate(this->Descent.Residual);
}

/// Add the change of the right-hand side to the residual.
void TotalVariationMinimizer::UpdateResidual()
{
  ForColumns(this->RightHandSide.cols(), [&](auto columns) { this->UpdateColumns<columns()>(); });
}

template <int K>
void TotalVariationMinimizer::UpdateColumns()
{
  const ColumnCount<K> columns(this->RightHandSide.cols());
  this->OverProcesses.AccumulateEach(
    this->Parallel, this->Gathered,
    [&](Index i) { this->Gradients.GatherRightHandSide<K>(i, &this->Gathered(i, 0)); },
    [&](Index i)
    {
      if (this->Vertices.GetFixed()[i])
      {
        return;
      }
      double* side = &this->RightHandSide(i, 0);
      double* residual = &this->Descent.Residual(i, 0);
      for (int k = 0; k < columns; ++k)
      {
        const double sum = this->Vertices.RightHandSide(i, k) + this->Gathered(i, k);
        residual[k] += sum - side[k];
        side[k] = sum;
      }
    });
}

/// The duality gap of the present u and multipliers, relative to E or to `negligible`.
double TotalVariationMinimizer::MeasureGap(const Values& u, double negligible)
{
  const double energy = this->Energy(u);
  const double scale = std::max(energy, negligible);
  const double gap = scale > 0.0 ? std::max(0.0, energy - this->DualEnergy(u)) / scale : 0.0;
  if (!std::isfinite(gap))
  {
    throw std::runtime_error("the minimisation has no finite solution");
  }
  return gap;
}

double TotalVariationMinimizer::Energy(const Values& u) const
{
  return this->GradientEnergy(u) + this->Vertices.Energy(u, this->OverProcesses);
}

/// The dual function at the present multipliers y: the minimum over u of
/// int (y . S grad u - psi*(|y|)) and the terms at the vertices.
double TotalVariationMinimizer::DualEnergy(const Values& u)
{
  this->Gradients.GatherMultipliers(this->Gathered);
  this->OverProcesses.Accumulate(this->Gathered);
  return this->Vertices.DualEnergy(this->Gathered, u, this->OverProcesses) -
    this->OverProcesses.Sum(this->Gradients.ConjugateEnergy());
}

/// int psi for gradients of one Range per vertex spacing.
double TotalVariationMinimizer::NoiseEnergy() const
{
  if (this->NumberOfVertices == 0.0)
  {
    return 0.0;
  }
  const double area = this->OverProcesses.Sum(this->Assembly->Mesh().ControlAreas().sum());
  const double areaOfOne = area / this->NumberOfVertices;
  return area *
    WithoutBeta(this->Options.Function)
      .Potential(this->Options.Range * this->Options.Range / areaOfOne);
}

double TotalVariationMinimizer::GradientEnergy(const Values& u) const
{
  return this->OverProcesses.Sum(this->Gradients.Energy(u));
}

} // namespace SurfaceDiffusion
